//! What refinement does to a result: it is nearer to the input, and all else is what it was.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use decimesh::deviation::{Sampling, deviation};
use decimesh::mesh::{shapes, verify};
use decimesh::{
    Mesh, Monitor, Options, Placement, Simplified, SimplifyError, Target, Topology, build_levels, simplify,
};
use proptest::prelude::*;

use crate::check::boundary;
use crate::meshes::{dirty_mesh, moved, shuffled, torn_mesh};

fn run(mesh: &Mesh, options: &Options) -> Simplified {
    simplify(mesh, options, &mut Monitor::silent()).unwrap()
}

fn refined(target: Target) -> Options {
    Options { refine: true, ..Options::new(target) }
}

fn rms(input: &Mesh, output: &Mesh) -> f64 {
    let sampling = Sampling { samples: 40_000, ..Sampling::default() };
    deviation(input, output, &sampling, &mut Monitor::silent()).unwrap().rms
}

#[test]
fn it_is_nearer() {
    let shapes =
        [shapes::bumpy_sphere(64, 3), shapes::statue(40_000), shapes::torus(120, 60), shapes::sphere(40)];
    for mesh in &shapes {
        for ratio in [0.5, 0.2, 0.05, 0.02] {
            let plain = run(mesh, &Options::new(Target::Ratio(ratio)));
            let better = run(mesh, &refined(Target::Ratio(ratio)));
            let (before, after) = (rms(mesh, &plain.mesh), rms(mesh, &better.mesh));
            assert!(after < 0.97 * before, "{before} became {after} at {ratio}");
            assert_eq!(better.mesh.triangles().len(), plain.mesh.triangles().len());
            assert_eq!(verify(mesh, &better.mesh, !better.topology_changed), Ok(()));
        }
    }
}

#[test]
fn threads_change_nothing() {
    let mesh = shuffled(&shapes::bumpy_sphere(160, 5), 7);
    for ratio in [0.6, 0.1] {
        let with = |threads| run(&mesh, &Options { threads, ..refined(Target::Ratio(ratio)) }).mesh;
        let one = with(1);
        assert!(one.positions().len() > 4096 || ratio < 0.5, "one block shows nothing");
        for threads in [1, 2, 3, 7] {
            assert_eq!(with(threads), one, "{threads} threads");
        }
    }
}

#[test]
fn what_has_no_error_stays() {
    let tilted = |mesh: &Mesh| moved(mesh, |[x, y, z]| [x + 0.5 * y, y - 0.25 * z, z + 0.125 * x]);
    for mesh in [shapes::plane(20), shapes::cube(12), tilted(&shapes::plane(20)), tilted(&shapes::cube(12))] {
        for ratio in [1.0, 0.5, 0.1] {
            let target = Target::Ratio(ratio);
            assert_eq!(run(&mesh, &refined(target)).mesh, run(&mesh, &Options::new(target)).mesh, "{ratio}");
        }
    }
    let mesh = shapes::bumpy_sphere(24, 2);
    assert_eq!(run(&mesh, &refined(Target::Ratio(1.0))).mesh, mesh);
}

#[test]
fn borders_and_locked_vertices_stay() {
    let hill = moved(&shapes::plane(60), |[x, y, z]| [x, y, z + 0.2 * (5.0 * x).sin() * (4.0 * y).cos()]);
    let locked: Vec<u32> = (0..hill.positions().len() as u32).step_by(97).collect();
    let target = Target::Ratio(0.2);
    let places = |mesh: &Mesh, vertices: &BTreeSet<u32>| -> BTreeSet<[u32; 3]> {
        vertices.iter().map(|&vertex| mesh.positions()[vertex as usize].map(f32::to_bits)).collect()
    };
    let plain = run(&hill, &Options { locked: locked.clone(), ..Options::new(target) });
    let better = run(&hill, &Options { locked: locked.clone(), ..refined(target) });
    assert_ne!(plain.mesh.positions(), better.mesh.positions());
    let border = |mesh: &Mesh| places(mesh, &boundary(mesh));
    assert_eq!(border(&plain.mesh), border(&better.mesh));
    let all = places(&better.mesh, &(0..better.mesh.positions().len() as u32).collect());
    assert!(places(&hill, &locked.into_iter().collect()).is_subset(&all));
}

#[test]
fn scale_changes_nothing_and_distance_little() {
    let mesh = shapes::bumpy_sphere(48, 9);
    let target = Target::Ratio(0.1);
    let better = run(&mesh, &refined(target)).mesh;
    for exponent in [-40, -20, 20, 40] {
        let scale = f32::exp2(exponent as f32);
        let scaled = |mesh: &Mesh| moved(mesh, |x| x.map(|x| x * scale));
        assert_eq!(run(&scaled(&mesh), &refined(target)).mesh, scaled(&better), "2^{exponent}");
    }
    let away = moved(&mesh, |[x, y, z]| [1000.0 * x + 1e6, 1000.0 * y - 2e6, 1000.0 * z]);
    let [before, after] =
        [Options::new(target), refined(target)].map(|options| rms(&away, &run(&away, &options).mesh));
    assert!(after < 0.97 * before, "{before} became {after}");
}

#[test]
fn each_level_is_refined() {
    let mesh = shapes::bumpy_sphere(64, 4);
    let targets = [0.3, 0.1, 0.03].map(Target::Ratio);
    let levels = |options: Options| build_levels(&mesh, &targets, &options, &mut Monitor::silent()).unwrap();
    let plain = levels(Options { track_origins: true, ..Options::new(targets[0]) });
    let better = levels(Options { track_origins: true, ..refined(targets[0]) });
    for (plain, better) in plain.iter().zip(&better) {
        assert_eq!(plain.mesh.triangles().len(), better.mesh.triangles().len());
        assert!(rms(&mesh, &better.mesh) < 0.97 * rms(&mesh, &plain.mesh));
        assert_eq!(verify(&mesh, &better.mesh, true), Ok(()));
        let origins = better.origins.as_ref().unwrap();
        assert!(origins.iter().all(|&origin| (origin as usize) < better.mesh.positions().len()));
    }
}

#[test]
fn vertices_that_stay_cannot_be_refined() {
    let options = Options { placement: Placement::Existing, ..refined(Target::Ratio(0.5)) };
    let error = simplify(&shapes::sphere(8), &options, &mut Monitor::silent()).unwrap_err();
    assert!(
        matches!(&error, SimplifyError::InvalidOption(message) if message.contains("refined")),
        "{error}"
    );
}

#[test]
fn it_can_be_cancelled_and_says_how_far_it_is() {
    let mesh = shapes::bumpy_sphere(32, 1);
    let options = refined(Target::Ratio(0.1));
    let mut steps = Vec::new();
    let mut monitor = Monitor::new(|done| {
        steps.push(done);
        ControlFlow::Continue(())
    });
    simplify(&mesh, &options, &mut monitor).unwrap();
    drop(monitor);
    assert!(steps.is_sorted() && steps.last() == Some(&1.0), "{steps:?}");
    for step in 0..steps.len() {
        let mut left = step;
        let mut monitor = Monitor::new(|_| {
            if left == 0 {
                return ControlFlow::Break(());
            }
            left -= 1;
            ControlFlow::Continue(())
        });
        assert!(
            matches!(simplify(&mesh, &options, &mut monitor), Err(SimplifyError::Cancelled(_))),
            "{step}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// No vertex is won or lost, none of a border moves, and no flaw is added to those of the plain result.
    #[test]
    fn the_rest_stays_what_it_was(mesh in prop_oneof![torn_mesh(), dirty_mesh()], ratio in 0.05f64..1.0, keep: bool) {
        let topology = if keep { Topology::Keep } else { Topology::RelaxIfStuck };
        let plain = run(&mesh, &Options { topology, ..Options::new(Target::Ratio(ratio)) });
        let better = run(&mesh, &Options { topology, ..refined(Target::Ratio(ratio)) });
        prop_assert_eq!(verify(&plain.mesh, &better.mesh, true), Ok(()));
        prop_assert_eq!(better.mesh.positions().len(), plain.mesh.positions().len());
        prop_assert_eq!(better.mesh.triangles().len(), plain.mesh.triangles().len());
        prop_assert_eq!(better.stopped_by, plain.stopped_by);
        for vertex in boundary(&plain.mesh) {
            let [before, after] = [&plain, &better].map(|result| result.mesh.positions()[vertex as usize]);
            prop_assert_eq!(before.map(f32::to_bits), after.map(f32::to_bits));
        }
    }
}
