//! The monitor is told the truth, on the caller's thread, and may end a run at any report.

use std::ops::ControlFlow;

use decimesh::hqms::{SimplifyError, build_levels};
use decimesh::mesh::shapes;
use decimesh::{Cancelled, Mesh, Monitor, Options, Selection, Target, simplify};

use crate::meshes::tetrahedron;

/// Runs and breaks at the report after `allowed` ones: what was reported, and whether it ended well.
fn reports(allowed: usize, run: impl FnOnce(&mut Monitor) -> Result<(), SimplifyError>) -> (Vec<f32>, bool) {
    let caller = std::thread::current().id();
    let mut fractions = Vec::new();
    let mut monitor = Monitor::new(|fraction| {
        assert_eq!(std::thread::current().id(), caller);
        fractions.push(fraction);
        if fractions.len() > allowed { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let outcome = run(&mut monitor);
    drop(monitor);
    match outcome {
        Ok(()) => (fractions, true),
        Err(SimplifyError::Cancelled(Cancelled)) => (fractions, false),
        Err(error) => panic!("{error}"),
    }
}

/// Cancels at each report there is.
pub(crate) fn cancel_everywhere(run: impl Fn(&mut Monitor) -> Result<(), SimplifyError>) -> Vec<f32> {
    let (fractions, done) = reports(usize::MAX, &run);
    assert!(done);
    assert!(fractions.iter().all(|fraction| (0.0..=1.0).contains(fraction)), "{fractions:?}");
    assert!(fractions.is_sorted(), "{fractions:?}");
    assert_eq!(fractions.last(), Some(&1.0));
    for allowed in 0..fractions.len() {
        let (until, done) = reports(allowed, &run);
        assert!(!done, "went on after report {allowed}");
        assert_eq!(until, fractions[..=allowed], "another course than before");
    }
    fractions
}

fn cases() -> Vec<(Mesh, Options)> {
    let stone = || shapes::bumpy_sphere(76, 7);
    let threads = 2;
    let replacement = Selection::ReplacementSelection { records: 15 };
    vec![
        (stone(), Options { threads, ..Options::new(Target::Ratio(0.01)) }),
        (stone(), Options { threads, selection: replacement, ..Options::new(Target::Ratio(0.2)) }),
        (stone(), Options { threads, ..Options::new(Target::MaxError(0.01)) }),
        (tetrahedron([0.0; 3], 1.0), Options { threads, ..Options::new(Target::Triangles(2)) }),
        (shapes::sphere(2), Options { threads, ..Options::new(Target::Triangles(6)) }),
        (shapes::sphere(2), Options { threads, ..Options::new(Target::Triangles(1000)) }),
        (Mesh::default(), Options { threads, ..Options::new(Target::Triangles(0)) }),
    ]
}

#[test]
fn a_run_ends_at_any_report() {
    for (mesh, options) in cases() {
        let before = mesh.clone();
        let expected = simplify(&mesh, &options, &mut Monitor::silent()).unwrap().mesh;
        cancel_everywhere(|monitor| simplify(&mesh, &options, monitor).map(drop));
        assert_eq!(mesh, before);
        assert_eq!(simplify(&mesh, &options, &mut Monitor::silent()).unwrap().mesh, expected);
    }
}

#[test]
fn levels_end_at_any_report() {
    let stone = shapes::bumpy_sphere(40, 7);
    let targets = [0.5, 0.25, 0.1, 0.02].map(Target::Ratio);
    let options = Options::new(Target::Ratio(1.0));
    let fractions = cancel_everywhere(|monitor| build_levels(&stone, &targets, &options, monitor).map(drop));
    // The end is reported at the end.
    let finished = fractions.iter().filter(|&&fraction| fraction == 1.0).count();
    assert!(finished < fractions.len() / 2, "{fractions:?}");
}

/// A large mesh is reported on many times, so that a cancel is heard soon.
#[test]
fn no_step_is_long() {
    let stone = shapes::bumpy_sphere(76, 7);
    for selection in [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }] {
        let options = Options { selection, ..Options::new(Target::Ratio(0.02)) };
        let (fractions, _) = reports(usize::MAX, |monitor| simplify(&stone, &options, monitor).map(drop));
        let longest = fractions.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f32::max);
        assert!(longest < 0.6, "{fractions:?}");
    }
}
