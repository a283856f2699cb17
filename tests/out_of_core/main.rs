//! Files simplified by way of blocks on disk: what is promised of meshes in memory holds, whatever the blocks;
//! and work that was ended is gone on with.

#![cfg(feature = "io")]

mod files;
mod resume;
mod workbench;

use decimesh::mesh::{Rings, Topology as Found, Weld, shapes, verify};
use decimesh::{Attributes, Mesh, Monitor, Options, StoppedBy, Target, Topology, simplify};

use workbench::{MEGABYTE, Workbench, noise};

/// A stone of 172,800 triangles: too many for the memory that the tests allow, by three times.
fn stone() -> Mesh {
    shapes::bumpy_sphere(120, 5)
}

/// A rough field of 80,000 triangles with four holes.
fn field() -> Mesh {
    let height = |x: f32, y: f32| 0.05 * (9.0 * x).sin() * (11.0 * y).cos() + 0.01 * (70.0 * x * y).sin();
    let mesh = shapes::height_field(200, height).unwrap();
    let is_hole = |index: usize| [30_000, 30_001, 50_402, 50_403, 61_234, 70_801].contains(&index);
    let triangles = mesh.triangles().iter().enumerate().filter(|(index, _)| !is_hole(*index));
    let triangles = triangles.map(|(_, triangle)| *triangle).collect();
    Mesh::new(mesh.positions().to_vec(), triangles).unwrap()
}

/// The same mesh, its vertices and triangles in an order without rhyme or reason.
fn shuffled(mesh: &Mesh) -> Mesh {
    let order = |count: usize, seed: u64| {
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|&index| noise(seed, index));
        order
    };
    let vertices = order(mesh.positions().len(), 1);
    let mut places = vec![0; vertices.len()];
    vertices.iter().enumerate().for_each(|(place, &vertex)| places[vertex] = place as u32);
    let triangles = order(mesh.triangles().len(), 2);
    Mesh::new(
        vertices.iter().map(|&vertex| mesh.positions()[vertex]).collect(),
        triangles.iter().map(|&t| mesh.triangles()[t].map(|vertex| places[vertex as usize])).collect(),
    )
    .unwrap()
}

#[test]
fn surfaces_keep_what_they_are() {
    for (mesh, memory) in
        [(stone(), 5 * MEGABYTE), (field(), 4 * MEGABYTE), (shuffled(&stone()), 5 * MEGABYTE)]
    {
        let bench = Workbench::with(&mesh);
        // The first two end with rounds, the last with one run over what the blocks have left.
        for ratio in [0.7, 0.3, 0.02] {
            let options = Options { topology: Topology::Keep, ..Options::new(Target::Ratio(ratio)) };
            let (outcome, simplified) = bench.simplify(&options, memory);
            let target = (mesh.triangles().len() as f64 * ratio) as usize;
            assert!((target - 1..=target).contains(&outcome.triangles), "{outcome:?} for {target}");
            assert_eq!(outcome.triangles, simplified.triangles().len());
            assert_eq!(outcome.vertices, simplified.positions().len());
            assert_eq!(outcome.triangles_in, mesh.triangles().len());
            assert_eq!(outcome.vertices_in, mesh.positions().len());
            assert_eq!(outcome.stopped_by, StoppedBy::Target);
            assert!(outcome.blocks >= 2 && outcome.rounds >= 1, "{outcome:?}");
            assert!(outcome.error > 0.0 && !outcome.resumed && !outcome.topology_changed, "{outcome:?}");
            verify(&mesh, &simplified, true).unwrap();
        }
        assert_eq!(bench.files(), ["in.ply", "out.ply"]);
    }
}

#[test]
fn dirt_comes_through() {
    // Faces on each other, upside down, with two corners in one, three at an edge; vertices of no face.
    let stone = shapes::bumpy_sphere(90, 3);
    let mut triangles = Vec::new();
    for (index, &[a, b, c]) in stone.triangles().iter().enumerate() {
        triangles.extend(match noise(7, index) % 100 {
            0 => vec![],
            1 => vec![[a, b, c], [a, b, c]],
            2 => vec![[a, c, b]],
            3 => vec![[a, b, c], [a, a, b]],
            4 => vec![[a, b, c], [a, b, (a + 1000) % 5000]],
            _ => vec![[a, b, c]],
        });
    }
    let mut positions = stone.positions().to_vec();
    positions.extend([[9.0; 3], [-9.0; 3]]);
    let mesh = Mesh::new(positions, triangles).unwrap();
    let bench = Workbench::with(&mesh);
    for (ratio, topology) in [(0.5, Topology::Keep), (0.1, Topology::RelaxIfStuck)] {
        let options = Options { topology, ..Options::new(Target::Ratio(ratio)) };
        let (outcome, simplified) = bench.simplify(&options, 4 * MEGABYTE);
        assert!(outcome.blocks >= 2, "{outcome:?}");
        verify(&mesh, &simplified, false).unwrap();
        let target = (mesh.triangles().len() as f64 * ratio) as usize;
        assert_eq!(outcome.stopped_by == StoppedBy::Target, outcome.triangles <= target, "{outcome:?}");
    }
}

#[test]
fn what_fits_the_memory_is_simplified_as_it_is() {
    let mut mesh = shapes::bumpy_sphere(40, 2);
    let color = |vertex: usize| [vertex as u8, (vertex >> 8) as u8, 77, 255];
    let colors = (0..mesh.positions().len()).map(color).collect();
    let attributes = Attributes { colors: Some(colors), ..Attributes::default() };
    mesh = Mesh::with_attributes(mesh.positions().to_vec(), mesh.triangles().to_vec(), attributes).unwrap();
    let bench = Workbench::with(&mesh);
    for target in [Target::Ratio(0.3), Target::Ratio(1.0), Target::Triangles(50)] {
        let options = Options::new(target);
        let (outcome, simplified) = bench.simplify(&options, 64 * MEGABYTE);
        let expected = simplify(&mesh, &options, &mut Monitor::silent()).unwrap();
        assert_eq!(simplified, expected.mesh);
        assert_eq!(outcome.error, expected.error);
        assert_eq!((outcome.rounds, outcome.blocks), (0, 0));
    }
}

#[test]
fn threads_change_nothing() {
    let bench = Workbench::with(&stone());
    for ratio in [0.4, 0.05] {
        let bytes = [1, 2, 3].map(|threads| {
            bench.simplify(&Options { threads, ..Options::new(Target::Ratio(ratio)) }, 5 * MEGABYTE);
            bench.output()
        });
        assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2], "threads make a difference at {ratio}");
    }
}

#[test]
fn borders_stay_where_they_are_locked() {
    let mesh = field();
    let border = |mesh: &Mesh| {
        let mut edges = std::collections::HashMap::new();
        for &[a, b, c] in mesh.triangles() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from.min(to), from.max(to))).or_insert(0) += 1;
            }
        }
        let ends = edges.into_iter().filter(|(_, faces)| *faces == 1).flat_map(|((a, b), _)| [a, b]);
        let mut places: Vec<_> = ends.map(|v| mesh.positions()[v as usize].map(f32::to_bits)).collect();
        places.sort_unstable();
        places
    };
    let bench = Workbench::with(&mesh);
    for ratio in [0.5, 0.1] {
        let options = Options { lock_boundary: true, ..Options::new(Target::Ratio(ratio)) };
        let (_, simplified) = bench.simplify(&options, 4 * MEGABYTE);
        assert_eq!(border(&mesh), border(&simplified));
    }
}

/// A stone in two halves that differ in texture coordinates where they meet, and so share no vertex.
fn seamed() -> Mesh {
    let stone = shapes::bumpy_sphere(100, 9);
    let (mut positions, mut uvs, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for half in [0.0, 1.0] {
        let mut names = std::collections::HashMap::new();
        for triangle in stone.triangles() {
            let sum: f32 = triangle.iter().map(|&v| stone.positions()[v as usize][0]).sum();
            if (sum < 0.0) != (half == 0.0) {
                continue;
            }
            triangles.push(triangle.map(|vertex| {
                *names.entry(vertex).or_insert_with(|| {
                    let position = stone.positions()[vertex as usize];
                    positions.push(position);
                    uvs.push([half, position[1]]);
                    positions.len() as u32 - 1
                })
            }));
        }
    }
    let attributes = Attributes { uvs: Some(uvs), ..Attributes::default() };
    Mesh::with_attributes(positions, triangles, attributes).unwrap()
}

#[test]
fn seams_between_attributes_stay_closed() {
    let mesh = seamed();
    let bench = Workbench::with(&mesh);
    for ratio in [0.5, 0.05] {
        let (outcome, simplified) = bench.simplify(&Options::new(Target::Ratio(ratio)), 5 * MEGABYTE);
        assert!(outcome.blocks >= 2, "{outcome:?}");
        let uvs = simplified.attributes().uvs.as_ref().unwrap();
        for (uv, position) in uvs.iter().zip(simplified.positions()) {
            assert!(uv[0] == 0.0 || uv[0] == 1.0, "{uv:?}");
            assert!((uv[1] - position[1]).abs() < 0.1, "{uv:?} at {position:?}");
        }
        let welded = simplified.weld(Weld::Exact).unwrap().mesh;
        let found = Found::new(&welded, &Rings::new(&welded));
        // No crack; each side by itself may make an edge between two vertices of the seam, in memory as well.
        assert!(found.is_closed() && found.inconsistent_edges == 0, "{found:?}");
        assert_eq!(found.components, 1);
    }
}

#[cfg(feature = "deviation")]
#[test]
fn the_error_is_that_of_one_run() {
    use decimesh::deviation::{Sampling, deviation};

    let sampling = Sampling { samples: 200_000, ..Sampling::default() };
    // Parts of the statue are polished, others rough.
    for mesh in [stone(), shapes::statue(150_000)] {
        let bench = Workbench::with(&mesh);
        let rms =
            |simplified: &Mesh| deviation(&mesh, simplified, &sampling, &mut Monitor::silent()).unwrap().rms;
        for ratio in [0.3, 0.05] {
            let options = Options::new(Target::Ratio(ratio));
            let in_core = simplify(&mesh, &options, &mut Monitor::silent()).unwrap().mesh;
            let (outcome, simplified) = bench.simplify(&options, 5 * MEGABYTE);
            assert!(outcome.blocks >= 2, "{outcome:?}");
            let (ours, theirs) = (rms(&simplified), rms(&in_core));
            assert!(ours < 1.03 * theirs, "{ours} and {theirs} in core at {ratio}");
        }
    }
}
