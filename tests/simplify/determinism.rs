//! Same bytes for any number of threads, and from one run to the next.

use decimesh::hqms::build_levels;
use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Selection, Simplified, Target, simplify};

use crate::meshes::{attributed, shuffled};

/// FNV-1a over all that a result holds, bit for bit.
fn hash(result: &Simplified) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut add = |bits: u32| hash = (hash ^ u64::from(bits)).wrapping_mul(0x100_0000_01b3);
    let mesh = &result.mesh;
    mesh.positions().as_flattened().iter().for_each(|x| add(x.to_bits()));
    mesh.triangles().as_flattened().iter().for_each(|&vertex| add(vertex));
    let attributes = mesh.attributes();
    attributes.normals.iter().flatten().flatten().for_each(|x| add(x.to_bits()));
    attributes.colors.iter().flatten().for_each(|&color| add(u32::from_le_bytes(color)));
    attributes.uvs.iter().flatten().flatten().for_each(|x| add(x.to_bits()));
    result.origins.iter().flatten().for_each(|&origin| add(origin));
    add(result.error.to_bits());
    add(result.passes as u32);
    add(u32::from(result.topology_changed));
    hash
}

/// 203 thousand triangles, seven tiles; one ordered, one shuffled, one with attributes.
fn meshes() -> [Mesh; 3] {
    let stone = shapes::bumpy_sphere(130, 11);
    [shuffled(&stone, 5), attributed(shapes::statue(120_000), 2), stone]
}

#[test]
fn threads_and_repetition_change_nothing() {
    for mesh in meshes() {
        for selection in [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }] {
            let of = |threads, target| {
                let options = Options { threads, selection, track_origins: true, ..Options::new(target) };
                hash(&simplify(&mesh, &options, &mut Monitor::silent()).unwrap())
            };
            let expected = of(1, Target::Ratio(0.1));
            for threads in [1, 2, 3, 5, 0] {
                assert_eq!(of(threads, Target::Ratio(0.1)), expected, "{threads} threads, {selection:?}");
            }
        }
    }
}

/// Few collapses on a large mesh take another way than many.
#[test]
fn the_last_percents_are_the_same_too() {
    for mesh in &meshes()[..2] {
        for target in [Target::Ratio(0.98), Target::MaxError(1e-3), Target::Vertices(50_000)] {
            let of = |threads| {
                let options = Options { threads, ..Options::new(target) };
                hash(&simplify(mesh, &options, &mut Monitor::silent()).unwrap())
            };
            assert_eq!(of(1), of(3), "{target:?}");
        }
    }
}

#[test]
fn levels_are_the_same_for_any_number_of_threads() {
    let targets = [0.5, 0.2, 0.03].map(Target::Ratio);
    for mesh in &meshes()[..2] {
        for selection in [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }] {
            let of = |threads| {
                let options = Options { threads, selection, ..Options::new(Target::Ratio(1.0)) };
                let levels = build_levels(mesh, &targets, &options, &mut Monitor::silent()).unwrap();
                levels.iter().map(hash).collect::<Vec<_>>()
            };
            let expected = of(1);
            for threads in [1, 2, 5] {
                assert_eq!(of(threads), expected, "{threads} threads, {selection:?}");
            }
        }
    }
}
