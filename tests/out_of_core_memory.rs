//! What is allowed is enough: memory is counted while files are simplified that take many times as much.

#![cfg(feature = "io")]

use std::alloc::System;

use decimesh::io::{self, WriteOptions};
use decimesh::mesh::shapes;
use decimesh::out_of_core::simplify_file;
use decimesh::{Attributes, Mesh, Monitor, Options, Target};
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};

#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

const MEGABYTE: usize = 1 << 20;

/// Every triangle has three vertices of its own.
fn soup(mesh: &Mesh) -> Mesh {
    let corners: Vec<[f32; 3]> =
        mesh.triangles().as_flattened().iter().map(|&vertex| mesh.positions()[vertex as usize]).collect();
    let triangles = (0..mesh.triangles().len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Mesh::new(corners, triangles).unwrap()
}

/// Every vertex has all that it can have.
fn adorned(mesh: &Mesh) -> Mesh {
    let count = mesh.positions().len();
    let attributes = Attributes {
        normals: Some(vec![[0.0, 0.0, 1.0]; count]),
        colors: Some(vec![[1, 2, 3, 4]; count]),
        uvs: Some(vec![[0.5; 2]; count]),
    };
    Mesh::with_attributes(mesh.positions().to_vec(), mesh.triangles().to_vec(), attributes).unwrap()
}

/// Neighbours are far apart in memory.
fn scattered(mesh: &Mesh) -> Mesh {
    let count = mesh.positions().len() as u64;
    // A factor that is prime to the count is a permutation.
    let factor = (0x9E37_79B1..).find(|factor| gcd(*factor, count) == 1).unwrap();
    let place = |vertex: u32| (u64::from(vertex) * factor % count) as u32;
    let mut positions = vec![[0.0; 3]; count as usize];
    for (vertex, &position) in (0..).zip(mesh.positions()) {
        positions[place(vertex) as usize] = position;
    }
    Mesh::new(positions, mesh.triangles().iter().map(|triangle| triangle.map(place)).collect()).unwrap()
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// One test, for all threads of the process count.
#[test]
fn no_more_memory_is_taken_than_was_allowed() {
    let stone = shapes::bumpy_sphere(150, 5);
    let small = shapes::bumpy_sphere(70, 5);
    let directory = tempfile::tempdir().unwrap();
    let (from, to) = (directory.path().join("in.ply"), directory.path().join("out.ply"));
    for (what, mesh, memory) in [
        ("a stone", stone.clone(), 4 * MEGABYTE),
        ("a stone", stone.clone(), 8 * MEGABYTE),
        ("a stone of scattered vertices", scattered(&stone), 5 * MEGABYTE),
        ("a stone with attributes", adorned(&stone), 7 * MEGABYTE),
        ("a soup", soup(&small), 8 * MEGABYTE),
    ] {
        io::write(&mesh, &from, &WriteOptions::default()).unwrap();
        drop(mesh);
        for ratio in [0.9, 0.5, 0.1] {
            let options = Options { threads: 2, ..Options::new(Target::Ratio(ratio)) };
            ALLOCATOR.reset_peak_memory();
            let outcome = simplify_file(&from, &to, &options, memory, &mut Monitor::silent()).unwrap();
            let peak = ALLOCATOR.get_peak_memory();
            assert!(outcome.blocks >= 2, "{what}: {outcome:?}");
            assert!(peak <= memory, "{what} at {ratio}: {peak} bytes of {memory}");
        }
    }
}
