//! Chains of levels.

use decimesh::hqms::build_levels;
use decimesh::mesh::shapes;
use decimesh::{Monitor, Options, Selection, StoppedBy, Target, Topology, simplify};

use crate::check::{check, check_target};
use crate::meshes::attributed;

#[test]
fn levels_are_exact_and_ever_coarser() {
    let ratios = [1.0, 0.7, 0.5, 0.499, 0.2, 0.05, 0.05, 0.02, 0.01];
    let targets = ratios.map(Target::Ratio);
    for mesh in [shapes::bumpy_sphere(50, 3), attributed(shapes::statue(20_000), 3), shapes::torus(60, 40)] {
        for selection in [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }] {
            let options = Options { selection, track_origins: true, ..Options::new(Target::Ratio(1.0)) };
            let levels = build_levels(&mesh, &targets, &options, &mut Monitor::silent()).unwrap();
            assert_eq!(levels.len(), targets.len());
            for (level, &target) in levels.iter().zip(&targets) {
                assert_eq!(level.stopped_by, StoppedBy::Target);
                check(&mesh, &Options { target, ..options.clone() }, level);
            }
            for pair in levels.windows(2) {
                assert!(pair[0].mesh.triangles().len() >= pair[1].mesh.triangles().len());
                assert!(pair[0].mesh.positions().len() >= pair[1].mesh.positions().len());
                assert!(pair[0].error <= pair[1].error, "{} and {}", pair[0].error, pair[1].error);
                assert!(pair[0].passes <= pair[1].passes);
            }
        }
    }
}

/// What a coarser level has merged, a finer one cannot have kept apart the other way round: two
/// vertices in one place stay in one place.
#[test]
fn origins_are_nested() {
    let mesh = shapes::bumpy_sphere(30, 3);
    let targets = [0.6, 0.3, 0.1, 0.02].map(Target::Ratio);
    let options = Options { track_origins: true, ..Options::new(Target::Ratio(1.0)) };
    let levels = build_levels(&mesh, &targets, &options, &mut Monitor::silent()).unwrap();
    for pair in levels.windows(2) {
        let (Some(fine), Some(coarse)) = (&pair[0].origins, &pair[1].origins) else { panic!("no origins") };
        let mut successor = vec![None; pair[0].mesh.positions().len()];
        for (&fine, &coarse) in fine.iter().zip(coarse) {
            let successor = successor[fine as usize].get_or_insert(coarse);
            assert_eq!(*successor, coarse);
        }
    }
}

#[test]
fn the_first_level_is_what_simplify_gives() {
    let mesh = shapes::bumpy_sphere(60, 3);
    for selection in [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }] {
        for target in [Target::Ratio(0.5), Target::Vertices(900), Target::MaxError(0.01)] {
            let options = Options { selection, ..Options::new(target) };
            let alone = simplify(&mesh, &options, &mut Monitor::silent()).unwrap();
            let targets = [target, Target::Triangles(100)];
            let levels = build_levels(&mesh, &targets, &options, &mut Monitor::silent()).unwrap();
            assert_eq!(levels[0].mesh, alone.mesh);
            assert_eq!(levels[0].error, alone.error);
            assert_eq!(levels[0].stopped_by, alone.stopped_by);
        }
    }
}

#[test]
fn levels_out_of_order_and_out_of_reach_say_so() {
    let mesh = shapes::torus(24, 12);
    let targets = [100, 400, 10, 2, 50].map(Target::Triangles);
    let options = Options { topology: Topology::Keep, ..Options::new(Target::Ratio(1.0)) };
    let levels = build_levels(&mesh, &targets, &options, &mut Monitor::silent()).unwrap();
    let counts: Vec<usize> = levels.iter().map(|level| level.mesh.triangles().len()).collect();
    assert!(counts.is_sorted_by(|a, b| a >= b), "{counts:?}");
    // A finer level than the one before is met by it.
    assert_eq!(levels[1].mesh, levels[0].mesh);
    assert_eq!(levels[1].stopped_by, StoppedBy::Target);
    // No torus has fewer than fourteen triangles.
    assert!(counts[2] >= 14, "{counts:?}");
    assert_eq!((levels[2].stopped_by, levels[3].stopped_by), (StoppedBy::Stuck, StoppedBy::Stuck));
    assert_eq!(levels[3].mesh.triangles().len(), levels[2].mesh.triangles().len());
    check_target(&mesh, &Options { target: targets[0], ..options }, &levels[0]);
}

/// Topology given up for one level is given up for those after it, and said so.
#[test]
fn relaxed_levels() {
    let mesh = shapes::torus(24, 12);
    let targets = [100, 13, 8, 4].map(Target::Triangles);
    let options = Options { track_origins: true, ..Options::new(Target::Ratio(1.0)) };
    let levels = build_levels(&mesh, &targets, &options, &mut Monitor::silent()).unwrap();
    for (level, &target) in levels.iter().zip(&targets) {
        check(&mesh, &Options { target, ..options.clone() }, level);
    }
    let changed: Vec<bool> = levels.iter().map(|level| level.topology_changed).collect();
    assert!(!changed[0] && changed.is_sorted(), "{changed:?}");
}
