//! Nested levels: prefixes of one vertex buffer.

use decimesh::lod::NestedLevels;
use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Placement, StoppedBy, Target, Topology, build_levels};
use proptest::prelude::*;

use crate::collapses::seamed;
use crate::meshes::{attributed, dirty_mesh, joined, torn_mesh};

const RATIOS: [f64; 4] = [0.6, 0.3, 0.1, 0.02];

fn targets() -> Vec<Target> {
    RATIOS.map(Target::Ratio).to_vec()
}

fn options() -> Options {
    Options::new(Target::Ratio(1.0))
}

fn nested(mesh: &Mesh, options: &Options) -> NestedLevels {
    NestedLevels::build(mesh, &targets(), options, &mut Monitor::silent()).unwrap()
}

fn check(mesh: &Mesh, options: &Options) {
    let nested = nested(mesh, options);
    let (levels, order) = (nested.levels(), nested.order());
    assert_eq!(levels.len(), RATIOS.len() + 1);
    let mut sorted = order.to_vec();
    sorted.sort_unstable();
    assert!(sorted.into_iter().eq(0..mesh.positions().len() as u32), "the order is no permutation");
    for (vertex, &input) in order.iter().enumerate() {
        assert_eq!(nested.mesh().positions()[vertex], mesh.positions()[input as usize]);
    }
    let named = |triangle: &[u32; 3]| triangle.map(|vertex| order[vertex as usize]);
    let first: Vec<_> = nested.triangles(0).iter().map(named).collect();
    assert_eq!(first, mesh.triangles());

    let mut ends: Vec<usize> = levels.iter().map(|level| level.vertices).collect();
    assert!(ends.is_sorted_by(|finer, coarser| finer >= coarser));
    ends.push(0);
    let groups = ends.windows(2).map(|pair| pair[1]..pair[0]).chain(std::iter::once(ends[0]..order.len()));
    for group in groups {
        assert!(order[group].is_sorted(), "a group is out of order");
    }
    assert!(levels.is_sorted_by(|finer, coarser| finer.error <= coarser.error));

    for (number, level) in levels.iter().enumerate() {
        let corners = nested.triangles(number).as_flattened();
        assert!(corners.iter().all(|&vertex| (vertex as usize) < level.vertices), "level {number}");
        let alone = nested.level_mesh(number);
        assert_eq!((alone.positions().len(), alone.triangles()), (level.vertices, nested.triangles(number)));
    }

    let plain = Options { placement: Placement::Existing, track_sources: true, ..options.clone() };
    let chain = build_levels(mesh, &targets(), &plain, &mut Monitor::silent()).unwrap();
    for (number, simplified) in (1..).zip(&chain) {
        let sources = simplified.sources.as_ref().unwrap();
        let mut expected: Vec<_> = simplified
            .mesh
            .triangles()
            .iter()
            .map(|triangle| triangle.map(|vertex| sources[vertex as usize]))
            .collect();
        expected.retain(|[a, b, c]| a != b && b != c && c != a);
        let triangles: Vec<_> = nested.triangles(number).iter().map(named).collect();
        assert_eq!(triangles, expected, "level {number}");
    }

    let place = |vertex: u32| nested.mesh().positions()[vertex as usize];
    for number in 0..RATIOS.len() {
        let (finer, coarser) = (&levels[number], &levels[number + 1]);
        assert_eq!(finer.morphs.len(), finer.vertices);
        for (vertex, &morph) in (0..).zip(&finer.morphs) {
            assert!(morph == vertex || vertex as usize >= coarser.vertices, "a vertex that stays moves");
            assert!(
                morph == vertex || (morph as usize) < coarser.vertices,
                "a vertex goes into none that stays"
            );
        }
        if coarser.topology_changed {
            continue;
        }
        // What is left when all have gone where they go is the next level; triangles with two corners at
        // one place, which an unclean mesh may have on any level, set apart.
        let mut morphed = nested.triangles(number).to_vec();
        morphed.as_flattened_mut().iter_mut().for_each(|vertex| *vertex = finer.morphs[*vertex as usize]);
        let mut next = nested.triangles(number + 1).to_vec();
        for triangles in [&mut morphed, &mut next] {
            triangles.retain(|triangle| {
                let [a, b, c] = triangle.map(place);
                a != b && b != c && c != a
            });
            triangles.iter_mut().for_each(|triangle| {
                let least = (0..3).min_by_key(|&corner| triangle[corner]).unwrap();
                triangle.rotate_left(least);
            });
            triangles.sort_unstable();
        }
        assert!(is_subset(&next, &morphed), "level {number} does not morph into the next");
    }
    assert!(levels[RATIOS.len()].morphs.is_empty());
}

/// Whether each of `some` is among `all`; both sorted.
fn is_subset(some: &[[u32; 3]], all: &[[u32; 3]]) -> bool {
    some.iter().all(|triangle| all.binary_search(triangle).is_ok())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn torn_meshes(mesh in torn_mesh(), keep in any::<bool>()) {
        let topology = if keep { Topology::Keep } else { Topology::RelaxIfStuck };
        check(&mesh, &Options { topology, ..options() });
    }

    #[test]
    fn dirty_meshes(mesh in dirty_mesh(), seed in any::<u64>(), bare in any::<bool>()) {
        check(&if bare { mesh } else { attributed(mesh, seed) }, &options());
    }
}

#[test]
fn shapes_open_and_closed() {
    let shapes = [shapes::bumpy_sphere(30, 1), shapes::torus(40, 20), shapes::plane(30), seamed(30)];
    for mesh in &shapes {
        check(mesh, &options());
    }
    check(&joined(&shapes[..3]), &options());
}

#[test]
fn levels_say_why_they_stopped() {
    let torus = shapes::torus(24, 12);
    let kept = nested(&torus, &Options { topology: Topology::Keep, ..options() });
    assert_eq!(kept.levels()[0].stopped_by, StoppedBy::Target);
    assert_eq!(kept.levels()[4].stopped_by, StoppedBy::Stuck);
    let relaxed = nested(&torus, &options());
    assert!(relaxed.levels()[4].topology_changed && !relaxed.levels()[0].topology_changed);
}

#[test]
fn the_coarsest_that_is_good_enough() {
    let nested = nested(&shapes::bumpy_sphere(30, 1), &options());
    for (number, level) in nested.levels().iter().enumerate() {
        assert_eq!(nested.coarsest_within(level.error), number);
    }
    assert_eq!(nested.coarsest_within(-1.0), 0);
}

#[test]
fn no_levels_and_nothing() {
    let options = options();
    let none = NestedLevels::build(&shapes::cube(2), &[], &options, &mut Monitor::silent()).unwrap();
    assert_eq!(none.levels().len(), 1);
    assert!(none.levels()[0].morphs.is_empty());
    let nothing = nested(&Mesh::default(), &options);
    assert!(nothing.levels().iter().all(|level| level.vertices == 0));
    let wrong = [Target::Ratio(2.0)];
    assert!(NestedLevels::build(&shapes::cube(2), &wrong, &options, &mut Monitor::silent()).is_err());
}

#[cfg(feature = "deviation")]
#[test]
fn certified_errors_are_bounds() {
    use decimesh::deviation::{BoundOptions, DeviationError, Sampling, deviation};
    use std::ops::ControlFlow;

    let mesh = shapes::bumpy_sphere(12, 1);
    let mut levels = nested(&mesh, &options());
    let estimated = levels.clone();
    let mut cancel =
        Monitor::new(|done| if done > 0.3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) });
    let bounds = BoundOptions { tolerance: 0.05, ..BoundOptions::default() };
    assert!(matches!(levels.certify(&bounds, &mut cancel), Err(DeviationError::Cancelled(_))));
    assert_eq!(levels, estimated);

    let found = levels.certify(&bounds, &mut Monitor::silent()).unwrap();
    assert_eq!(found.len(), RATIOS.len());
    let certified = levels.levels();
    assert_eq!(certified[0].error, 0.0);
    assert!(certified.is_sorted_by(|finer, coarser| finer.error <= coarser.error));
    for (number, (level, bound)) in certified[1..].iter().zip(&found).enumerate() {
        assert!(f64::from(level.error) >= bound.upper);
        let sampling = Sampling { samples: 2000, ..Sampling::default() };
        let coarse = levels.level_mesh(number + 1);
        let measured = deviation(&mesh, &coarse, &sampling, &mut Monitor::silent()).unwrap();
        assert!(measured.max <= f64::from(level.error), "{} > {}", measured.max, level.error);
    }

    let vanished = [Target::Triangles(0)];
    let mut levels = NestedLevels::build(&mesh, &vanished, &options(), &mut Monitor::silent()).unwrap();
    let outcome = levels.certify(&bounds, &mut Monitor::silent());
    assert_eq!(outcome.is_err(), levels.triangles(1).is_empty());
}
