//! The conditions of a collapse, against collapses that are carried out and looked at.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3A;
use proptest::prelude::*;

use super::ring::Ring;
use super::surface::{Setting, Surface, flag};
use super::{Edge, LINE, are_lines, fold, is_line};
use crate::lanes::{Numbers, Vectors};
use crate::mesh::{Mesh, Topology, shapes};
use crate::workers::Workers;

/// By the ends of each edge how many faces run along it, backwards and forwards.
fn sides(mesh: &Mesh) -> BTreeMap<[u32; 2], [usize; 2]> {
    let mut sides: BTreeMap<[u32; 2], [usize; 2]> = BTreeMap::new();
    for &[a, b, c] in mesh.triangles().iter().filter(|[a, b, c]| a != b && b != c && c != a) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            sides.entry([from.min(to), from.max(to)]).or_default()[usize::from(from < to)] += 1;
        }
    }
    sides
}

fn ring(mesh: &Mesh, vertex: u32, boundary: bool) -> Ring {
    let position = |vertex: u32| Vec3A::from(mesh.positions()[vertex as usize]);
    let around = || mesh.triangles().iter().filter(|triangle| triangle.contains(&vertex));
    let mut ring = Ring::default();
    let mut gathering = ring.begin(around().count());
    for triangle in around() {
        let corner = triangle.iter().position(|&corner| corner == vertex).unwrap();
        let (next, previous) = (triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]);
        let origin = position(vertex);
        gathering.push((next, previous), position(next) - origin, position(previous) - origin);
    }
    let count = gathering.count();
    ring.complete(vertex, boundary, count);
    ring
}

/// The mesh after a collapse, legal or not.
fn collapsed(mesh: &Mesh, source: u32, target: u32) -> Mesh {
    let renamed = mesh.triangles().iter().map(|face| face.map(|v| if v == source { target } else { v }));
    let faces = renamed.filter(|[a, b, c]| a != b && b != c && c != a);
    Mesh::new(mesh.positions().to_vec(), faces.collect()).unwrap()
}

fn duplicates(mesh: &Mesh) -> usize {
    let sorted = |face: &[u32; 3]| {
        let mut face = *face;
        face.sort_unstable();
        face
    };
    mesh.triangles().len() - mesh.triangles().iter().map(sorted).collect::<BTreeSet<_>>().len()
}

/// What a collapse must keep.
fn signature(topology: &Topology) -> (bool, i64, usize, usize) {
    let euler = topology.euler_characteristic();
    (topology.is_oriented_manifold(), euler, topology.boundary_loops, topology.components)
}

/// Checks the condition at each edge of a mesh: what it allows keeps the topology, and, if the mesh
/// is a manifold, it allows all that does.
fn check_every_edge(mesh: &Mesh) -> Result<(), TestCaseError> {
    let sides = sides(mesh);
    let borders: BTreeSet<u32> =
        sides.iter().filter(|(_, sides)| sides[0] != sides[1]).flat_map(|(edge, _)| *edge).collect();
    let before = mesh.topology();
    let rings: Vec<Ring> = (0..mesh.positions().len() as u32)
        .map(|vertex| ring(mesh, vertex, borders.contains(&vertex)))
        .collect();
    for &[a, b] in sides.keys() {
        for (source, target) in [(a, b), (b, a)] {
            let edge = Edge {
                source: &rings[source as usize],
                target: &rings[target as usize],
                source_point: Vec3A::from(mesh.positions()[source as usize]).extend(0.0),
                target_point: Vec3A::from(mesh.positions()[target as usize]).extend(0.0),
                target_locked: false,
            };
            let allowed = edge.keeps_topology(&mut Default::default());
            let result = collapsed(mesh, source, target);
            let after = result.topology();
            let vanished = before.vertices - after.vertices != 1;
            let no_more_duplicates = duplicates(&result) <= duplicates(mesh);
            let kept = signature(&after) == signature(&before) && no_more_duplicates && !vanished;
            if before.is_oriented_manifold() {
                prop_assert_eq!(allowed, kept, "{} into {} of {:?}", source, target, mesh.triangles());
            } else if allowed {
                prop_assert!(no_more_duplicates, "{} into {} of {:?}", source, target, mesh.triangles());
                prop_assert!(!vanished, "{} into {} of {:?}", source, target, mesh.triangles());
            }
        }
    }
    Ok(())
}

/// Small surfaces with some of their faces gone: closed and open manifolds, and vertices where two
/// fans meet.
pub(crate) fn torn() -> impl Strategy<Value = Mesh> {
    let shape = prop_oneof![
        (1usize..3).prop_map(shapes::cube),
        (1usize..5).prop_map(shapes::plane),
        (3usize..6, 3usize..6).prop_map(|(n, m)| shapes::torus(n, m)),
    ];
    let gone = prop::collection::vec(prop::bool::weighted(0.15), 100);
    (shape, any::<bool>(), gone).prop_map(|(mesh, whole, gone)| {
        let kept = |&(face, _): &(usize, &[u32; 3])| whole || !gone[face % gone.len()];
        let faces = mesh.triangles().iter().enumerate().filter(kept).map(|(_, face)| *face).collect();
        Mesh::new(mesh.positions().to_vec(), faces).unwrap()
    })
}

/// Any faces on a few vertices.
pub(crate) fn dirty() -> impl Strategy<Value = Mesh> {
    prop::collection::vec([0u32..9, 0u32..9, 0u32..9], 0..24).prop_map(|faces| {
        let positions =
            (0..9).map(|vertex| [vertex as f32, (vertex * vertex % 5) as f32, (vertex % 4) as f32]);
        let faces = faces.into_iter().filter(|[a, b, c]| a != b && b != c && c != a);
        Mesh::new(positions.collect(), faces.collect()).unwrap()
    })
}

proptest! {
    #[test]
    fn link_condition_against_the_collapse_itself(mesh in torn()) {
        check_every_edge(&mesh)?;
    }

    #[test]
    fn link_condition_on_filth(mesh in dirty()) {
        check_every_edge(&mesh)?;
    }

    /// A vertex is flagged if an edge of it has not as many faces in one direction as in the other.
    #[test]
    fn boundary_against_counting(mesh in prop_oneof![torn(), dirty()], lock in any::<bool>()) {
        let mut surface = Surface::new(Cow::Borrowed(&mesh), &Setting::default(), &Workers::Caller);
        let unreferenced = surface.classify(lock, &Workers::Caller);
        let sides = sides(&mesh);
        let used: BTreeSet<u32> = sides.keys().flatten().copied().collect();
        prop_assert_eq!(unreferenced, mesh.positions().len() - used.len());
        let borders: BTreeSet<u32> =
            sides.iter().filter(|(_, sides)| sides[0] != sides[1]).flat_map(|(edge, _)| *edge).collect();
        for (vertex, &flags) in (0..).zip(&surface.flags) {
            prop_assert_eq!(flags & flag::BOUNDARY != 0, borders.contains(&vertex), "vertex {}", vertex);
            prop_assert_eq!(flags & flag::LOCKED != 0, lock && borders.contains(&vertex));
            prop_assert_eq!(flags & flag::DEAD != 0, !used.contains(&vertex));
        }
    }

    /// What is not called a fold turns no face by more than the angle promised, and the distance
    /// found is the largest from the planes.
    #[test]
    fn a_fold_is_a_face_that_turns(offset in [-1.5f32..1.5, -1.5f32..1.5, -1.5f32..1.5], heights in prop::collection::vec(-0.5f32..0.5, 49)) {
        let mesh = shapes::plane(6);
        let raised = mesh.positions().iter().zip(&heights).map(|(&[x, y, _], &height)| [6.0 * x, 6.0 * y, height]);
        let mesh = Mesh::new(raised.collect(), mesh.triangles().to_vec()).unwrap();
        let (vertex, other) = (24, 25);
        let ring = ring(&mesh, vertex, false);
        let offset = Vec3A::from(offset);
        let found = fold(&ring, other, offset);
        let mut least_cosine = 1f64;
        let mut distance = 0f64;
        for ((following, preceding), spoke) in ring.names().zip(ring.spokes()) {
            let offset = offset.as_dvec3();
            let (next, previous) = (spoke.to_next.as_dvec3(), spoke.to_previous.as_dvec3());
            let before = next.cross(previous).normalize();
            distance = distance.max(before.dot(offset).abs());
            if following != other && preceding != other {
                let after = (next - offset).cross(previous - offset).normalize();
                least_cosine = least_cosine.min(before.dot(after));
            }
        }
        // Next to the limit of 84 degrees either answer is right.
        if least_cosine > 0.101 {
            prop_assert!(found.is_some());
        } else if least_cosine < 0.099 {
            prop_assert!(found.is_none());
        }
        if let Some(moved) = found {
            prop_assert!((f64::from(moved.distance_squared).sqrt() - distance).abs() < 1e-4);
        }
    }
}

/// Two faces on the same vertices have one vertex opposite their edge, not two: vertex 4, which both ends
/// know too, must not pass for the other.
#[test]
fn a_pillow_has_one_opposite_vertex() -> Result<(), TestCaseError> {
    let faces = [[4, 8, 0], [4, 0, 8], [0, 2, 3], [0, 4, 7], [3, 2, 0], [4, 0, 7], [4, 2, 5]];
    let positions = (0..9).map(|vertex| [vertex as f32, (vertex * vertex % 5) as f32, (vertex % 4) as f32]);
    check_every_edge(&Mesh::new(positions.collect(), faces.to_vec()).unwrap())
}

/// A thin face, seen from its far end, whose corner moves onto the line through the other two: what
/// is left of its area is rounding, many times what its small side and the way moved suggest.
#[test]
fn a_sliver_does_not_become_a_line() {
    let corner = Vec3A::new(-0.670_041_3, 16.493_677, 0.740_794_2);
    let next = Vec3A::new(-0.740_793_94, 24.327_171, 0.740_794_1);
    let previous = Vec3A::new(-0.740_793_94, 24.355_652, 0.740_794_1);
    let mut ring = Ring::default();
    ring.begin(1).push((1, 2), next - corner, previous - corner);
    ring.complete(0, false, 1);
    let onto_the_line = Vec3A::new(next.x, corner.y, next.z) - corner;
    assert_eq!(fold(&ring, 3, onto_the_line), None);
    assert!(fold(&ring, 3, 0.5 * onto_the_line).is_some());
}

proptest! {
    /// What is decided for faces side by side is what is decided for each.
    #[test]
    fn lines_are_lines_side_by_side(
        corner in [-2.0f32..2.0, -2.0..2.0, -2.0..2.0],
        next in [-2.0f32..2.0, -2.0..2.0, -2.0..2.0],
        along in -2.0f32..2.0,
        off in prop_oneof![Just(0.0f32), -1e-6f32..1e-6, -1e-2f32..1e-2],
    ) {
        let [corner, next] = [corner, next].map(Vec3A::from);
        let previous = next * along + Vec3A::new(0.0, 0.0, off);
        let mut ring = Ring::default();
        ring.begin(1).push((1, 2), next - corner, previous - corner);
        ring.complete(0, false, 1);
        let offset = -corner;
        let (spokes, _) = ring.surviving_spokes(3).next().unwrap();
        let area = spokes.moved(Vectors::splat(offset)).length_squared();
        let narrowest = Numbers::splat(LINE * LINE * offset.length_squared());
        let side_by_side = are_lines(area, spokes, narrowest).to_bitmask() & 1 == 1;
        prop_assert_eq!(side_by_side, is_line(area.to_array()[0], next - corner, previous - corner, offset));
    }
}
