//! Half-edge collapse: what must be true of every cost and selection.

use decimesh::mesh::{shapes, verify};
use decimesh::multiple_choice::{Cost, Decimation, NoSuchVertex, Selection};
use decimesh::{Mesh, Monitor};
use proptest::prelude::*;
use std::num::NonZeroU32;
use std::ops::ControlFlow;

use crate::check::is_face;
use crate::meshes::{attributed, dirty_mesh, fan, moved, torn_mesh};

const COSTS: [Cost; 3] = [Cost::Visual, Cost::Melax, Cost::Quadric];

fn drawn(candidates: u32, seed: u64) -> Selection {
    Selection::MultipleChoice { candidates: NonZeroU32::new(candidates).unwrap(), seed }
}

fn selections() -> [Selection; 3] {
    [Selection::default(), Selection::LazyHeap, Selection::EagerHeap]
}

fn decimation() -> impl Strategy<Value = (Cost, Selection)> {
    let drawn = (1u32..8, any::<u64>()).prop_map(|(candidates, seed)| drawn(candidates, seed));
    let heap = prop::sample::select(&[Selection::LazyHeap, Selection::EagerHeap][..]);
    (prop::sample::select(&COSTS[..]), prop_oneof![drawn, heap])
}

/// The triangles on the input's vertices, as a mesh without the vertices that none of them uses.
fn compacted(input: &Mesh, triangles: &[[u32; 3]]) -> Mesh {
    let mut map = vec![u32::MAX; input.positions().len()];
    let mut positions = Vec::new();
    let mut rename = |vertex: u32| {
        let place = &mut map[vertex as usize];
        if *place == u32::MAX {
            *place = positions.len() as u32;
            positions.push(input.positions()[vertex as usize]);
        }
        *place
    };
    let triangles = triangles.iter().map(|triangle| triangle.map(&mut rename)).collect();
    Mesh::new(positions, triangles).unwrap()
}

/// Does one collapse in the plainest way.
fn replay(triangles: &mut Vec<[u32; 3]>, source: u32, target: u32) {
    for corner in triangles.as_flattened_mut() {
        if *corner == source {
            *corner = target;
        }
    }
    triangles.retain(is_face);
}

/// The input's triangles after these collapses.
fn replayed(mesh: &Mesh, decimation: &Decimation) -> Vec<[u32; 3]> {
    let mut triangles: Vec<[u32; 3]> = mesh.triangles().to_vec();
    triangles.retain(is_face);
    for collapse in decimation.collapses() {
        replay(&mut triangles, collapse.source, collapse.target);
    }
    triangles
}

fn check(mesh: &Mesh, cost: Cost, selection: Selection, share: f64) {
    let mut decimation = Decimation::new(mesh, cost, selection);
    let before = decimation.triangles().len();
    let wanted = (before as f64 * share) as usize;
    let reached = decimation.reduce_to(wanted, &mut Monitor::silent()).unwrap();
    let triangles = decimation.triangles();
    assert_eq!(reached, triangles.len() <= wanted);
    assert!(before <= wanted || triangles.len() + 1 >= wanted, "{} of {wanted}", triangles.len());
    assert_eq!(triangles, replayed(mesh, &decimation));
    if let Err(violation) = verify(mesh, &compacted(mesh, &triangles), true) {
        panic!("{violation}");
    }
}

fn normal(mesh: &Mesh, triangle: [u32; 3]) -> glam::DVec3 {
    let [a, b, c] = triangle.map(|vertex| glam::Vec3::from(mesh.positions()[vertex as usize]).as_dvec3());
    (b - a).cross(c - a)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn torn_meshes(mesh in torn_mesh(), (cost, selection) in decimation(), share in 0.0..1.0) {
        check(&mesh, cost, selection, share);
    }

    #[test]
    fn dirty_meshes(mesh in dirty_mesh(), (cost, selection) in decimation(), share in 0.0..1.0) {
        check(&mesh, cost, selection, share);
    }

    /// No collapse turns a face to its back.
    #[test]
    fn no_collapse_flips_a_face(mesh in torn_mesh(), (cost, selection) in decimation()) {
        let mut decimation = Decimation::new(&mesh, cost, selection);
        decimation.reduce_to(0, &mut Monitor::silent()).unwrap();
        let mut triangles: Vec<[u32; 3]> = mesh.triangles().iter().copied().filter(is_face).collect();
        for collapse in decimation.collapses() {
            let (source, target) = (collapse.source, collapse.target);
            for &triangle in triangles.iter().filter(|triangle| triangle.contains(&source)) {
                let after = triangle.map(|vertex| if vertex == source { target } else { vertex });
                if is_face(&after) {
                    let [before, after] = [triangle, after].map(|face| normal(&mesh, face).normalize_or_zero());
                    // The engine calculates in single precision.
                    prop_assert!(before.dot(after) > -1e-3, "{before} became {after}");
                }
            }
            replay(&mut triangles, source, target);
        }
    }

    #[test]
    fn locked_vertices_stay(
        mesh in torn_mesh(),
        (cost, selection) in decimation(),
        picks in prop::collection::vec(any::<prop::sample::Index>(), 0..40),
    ) {
        let locked: Vec<u32> =
            picks.iter().map(|pick| pick.index(mesh.positions().len()) as u32).collect();
        let mut decimation = Decimation::with_locked(&mesh, cost, selection, &locked).unwrap();
        decimation.reduce_to(0, &mut Monitor::silent()).unwrap();
        prop_assert!(decimation.collapses().iter().all(|collapse| !locked.contains(&collapse.source)));
    }

    /// To stop on the way changes nothing, and neither does scale.
    #[test]
    fn levels_are_those_of_one_run(mesh in torn_mesh(), (cost, selection) in decimation(), shift in -60i32..60) {
        let mut once = Decimation::new(&mesh, cost, selection);
        once.reduce_to(mesh.triangles().len() / 5, &mut Monitor::silent()).unwrap();
        let scaled = moved(&mesh, |x| x.map(|x| x * (shift as f32).exp2()));
        let mut twice = Decimation::new(&scaled, cost, selection);
        twice.reduce_to(mesh.triangles().len() / 2, &mut Monitor::silent()).unwrap();
        let finer = twice.collapses().to_vec();
        twice.reduce_to(mesh.triangles().len() / 5, &mut Monitor::silent()).unwrap();
        prop_assert!(twice.collapses().starts_with(&finer));
        prop_assert_eq!(once.collapses(), twice.collapses());
    }
}

#[test]
fn seeds_matter_and_nothing_else_does() {
    let mesh = shapes::bumpy_sphere(40, 1);
    let run = |cost, selection| {
        let mut decimation = Decimation::new(&mesh, cost, selection);
        assert!(decimation.reduce_to(500, &mut Monitor::silent()).unwrap());
        (decimation.collapses().to_vec(), decimation.triangles())
    };
    for cost in COSTS {
        for selection in [drawn(6, 1), Selection::LazyHeap, Selection::EagerHeap] {
            assert_eq!(run(cost, selection), run(cost, selection));
        }
        assert_ne!(run(cost, drawn(6, 1)), run(cost, drawn(6, 2)));
    }
}

#[test]
fn no_face_looks_the_wrong_way_in_the_end() {
    for mesh in [shapes::bumpy_sphere(20, 1), shapes::torus(40, 30), shapes::cube(12)] {
        let mut outward = vec![glam::DVec3::ZERO; mesh.positions().len()];
        for &triangle in mesh.triangles() {
            triangle.iter().for_each(|&vertex| outward[vertex as usize] += normal(&mesh, triangle));
        }
        for cost in COSTS {
            for selection in selections() {
                let mut decimation = Decimation::new(&mesh, cost, selection);
                assert!(decimation.reduce_to(100, &mut Monitor::silent()).unwrap());
                for triangle in decimation.triangles() {
                    let facing = triangle.map(|vertex| outward[vertex as usize].normalize());
                    let cosine = normal(&mesh, triangle).normalize().dot(facing.iter().sum());
                    // The engine calculates in single precision.
                    assert!(cosine > -1e-4, "{cost:?} {selection:?}: {triangle:?} {cosine}");
                }
            }
        }
    }
}

#[test]
fn a_vertex_that_is_not_there_cannot_be_locked() {
    let plane = shapes::plane(3);
    let lock = |locked: &[u32]| {
        Decimation::with_locked(&plane, Cost::Visual, Selection::default(), locked).map(|_| ())
    };
    assert_eq!(lock(&[]), Ok(()));
    assert_eq!(lock(&[15, 15]), Ok(()));
    let error = lock(&[3, 16]).unwrap_err();
    assert_eq!(error, NoSuchVertex { vertex: 16, vertices: 16 });
    assert_eq!(error.to_string(), "locked vertex 16 does not exist: there are 16 vertices");
}

/// Others go into a locked vertex, and the corners of a plane are all that is needed.
#[test]
fn locked_vertices_are_gone_into() {
    let plane = shapes::plane(10);
    for selection in selections() {
        let mut decimation =
            Decimation::with_locked(&plane, Cost::Quadric, selection, &[0, 10, 60, 110, 120]).unwrap();
        decimation.reduce_to(4, &mut Monitor::silent()).unwrap();
        assert!(decimation.collapses().iter().any(|collapse| collapse.target == 60), "{selection:?}");
        for locked in [0, 10, 60, 110, 120] {
            assert!(decimation.triangles().as_flattened().contains(&locked), "{selection:?}: {locked}");
        }
    }
}

#[test]
fn a_plane_stays_a_plane() {
    let flat = shapes::plane(30);
    let area = |plane: &Mesh, triangles: &[[u32; 3]]| {
        triangles.iter().map(|&face| normal(plane, face).length()).sum::<f64>()
    };
    // Tilted, so that the products of its normals are 1 but for rounding, to either side.
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.4, 0.7, 1.1);
    let tilted = moved(&flat, |x| (turn * glam::Vec3::from(x)).to_array());
    for plane in [flat, tilted] {
        let up = normal(&plane, plane.triangles()[0]);
        for cost in COSTS {
            for selection in selections() {
                let mut decimation = Decimation::new(&plane, cost, selection);
                decimation.reduce_to(20, &mut Monitor::silent()).unwrap();
                let triangles = decimation.triangles();
                assert!(triangles.len() < 200, "{cost:?} {selection:?}: {}", triangles.len());
                let upright = triangles.iter().all(|&face| normal(&plane, face).dot(up) > 0.0);
                assert!(upright, "a face is folded over");
                if selection != Selection::default() && cost != Cost::Melax {
                    let (before, after) = (area(&plane, plane.triangles()), area(&plane, &triangles));
                    assert!((before - after).abs() < 1e-6 * before, "{cost:?}: area {before} became {after}");
                }
            }
        }
    }
}

/// Vertices at one place, the sides of a seam, stay; without attributes there is no seam.
#[test]
fn seams_stay() {
    let (positions, triangles, _) = shapes::plane(8).into_parts();
    let left: Vec<u32> = (0..9).collect();
    let doubled: Vec<[f32; 3]> =
        positions.iter().chain(left.iter().map(|&vertex| &positions[vertex as usize])).copied().collect();
    let bare = Mesh::new(doubled, triangles).unwrap();
    let moves_seam = |mesh: &Mesh| {
        let mut decimation = Decimation::new(mesh, Cost::Visual, Selection::LazyHeap);
        decimation.reduce_to(0, &mut Monitor::silent()).unwrap();
        assert!(!decimation.collapses().is_empty());
        decimation.collapses().iter().any(|collapse| left.contains(&collapse.source))
    };
    assert!(moves_seam(&bare));
    assert!(!moves_seam(&attributed(bare, 3)));
}

#[test]
fn a_hub_does_not_take_quadratic_time() {
    let hub = fan(200_000);
    for selection in selections() {
        let mut decimation = Decimation::new(&hub, Cost::Visual, selection);
        decimation.reduce_to(10, &mut Monitor::silent()).unwrap();
    }
}

#[test]
fn one_can_go_on_after_a_cancel() {
    let mesh = shapes::bumpy_sphere(60, 1);
    let mut decimation = Decimation::new(&mesh, Cost::Visual, Selection::default());
    assert!(decimation.reduce_to(500, &mut Monitor::new(|_| ControlFlow::Break(()))).is_err());
    assert!(!decimation.collapses().is_empty() && decimation.triangles().len() > 500);
    assert!(decimation.reduce_to(500, &mut Monitor::silent()).unwrap());
    let mut at_once = Decimation::new(&mesh, Cost::Visual, Selection::default());
    at_once.reduce_to(500, &mut Monitor::silent()).unwrap();
    assert_eq!(decimation.collapses(), at_once.collapses());
}
