//! The bound on the distance between surfaces: never below what is measured, and close to it.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use decimesh::deviation::{Bound, BoundOptions, DeviationError, Sampling, bound, deviation};
use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Placement, Target, simplify};
use proptest::prelude::*;

fn bounded(a: &Mesh, b: &Mesh) -> Bound {
    bounded_with(a, b, &BoundOptions::default())
}

fn bounded_with(a: &Mesh, b: &Mesh, options: &BoundOptions) -> Bound {
    bound(a, b, options, &mut Monitor::silent()).expect("both meshes have triangles")
}

/// The largest distance of many points.
fn sampled(a: &Mesh, b: &Mesh, samples: usize) -> f64 {
    let sampling = Sampling { samples, ..Sampling::default() };
    deviation(a, b, &sampling, &mut Monitor::silent()).expect("both meshes have triangles").max
}

fn simplified(mesh: &Mesh, ratio: f64, placement: Placement) -> Mesh {
    let options = Options { placement, ..Options::new(Target::Ratio(ratio)) };
    simplify(mesh, &options, &mut Monitor::silent()).expect("the options are valid").mesh
}

fn mapped(original: &Mesh, change: impl Fn([f32; 3]) -> [f32; 3]) -> Mesh {
    let positions = original.positions().iter().map(|&position| change(position)).collect();
    Mesh::new(positions, original.triangles().to_vec()).expect("test meshes are valid")
}

fn moved(original: &Mesh, by: [f32; 3]) -> Mesh {
    mapped(original, |[x, y, z]| [x + by[0], y + by[1], z + by[2]])
}

fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let first = a.positions().len() as u32;
    let shifted = b.triangles().iter().map(|corners| corners.map(|index| index + first));
    let triangles = a.triangles().iter().copied().chain(shifted).collect();
    Mesh::new([a.positions(), b.positions()].concat(), triangles).expect("test meshes are valid")
}

/// As close as asked for by default, around a distance known by heart.
fn assert_tight(found: &Bound, expected: f64) {
    let room = 1e-6 * (1.0 + expected);
    assert!(found.lower <= expected + room, "{found:?} is not {expected}");
    assert!(found.upper >= expected, "{found:?} is not {expected}");
    assert!(found.upper <= found.lower * 1.01 + 4.0 * found.diagonal * 1e-6, "{found:?} is not close");
}

fn shape() -> impl Strategy<Value = Mesh> {
    let waves = |n: usize| shapes::height_field(n, |x, y| 0.2 * (9.0 * x).sin() * (7.0 * y + x).cos());
    prop_oneof![
        (4usize..14, any::<u32>()).prop_map(|(n, seed)| shapes::bumpy_sphere(n, seed)),
        (6usize..24, 5usize..16).prop_map(|(n, m)| shapes::torus(n, m)),
        (1usize..10).prop_map(shapes::cube),
        (2usize..24).prop_map(move |n| waves(n).expect("heights are finite")),
    ]
}

/// Positions and triangles with doubled, degenerate and crossing ones among them.
fn soup() -> impl Strategy<Value = Mesh> {
    let coarse = prop::array::uniform3((-3..=3i8).prop_map(f32::from));
    let fine = prop::array::uniform3(-3f32..3.0);
    let positions = prop::collection::vec(prop_oneof![coarse, fine], 3..20);
    let triangles = positions.prop_flat_map(|positions| {
        let index = 0..positions.len() as u32;
        (Just(positions), prop::collection::vec(prop::array::uniform3(index), 1..20))
    });
    triangles
        .prop_map(|(positions, triangles)| Mesh::new(positions, triangles).expect("indices are in range"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_sample_of_a_simplified_shape_is_beyond_the_bound(
        original in shape(),
        ratio in 0.05f64..0.9,
        placement in prop::sample::select(vec![Placement::Optimal, Placement::Existing]),
    ) {
        let coarse = simplified(&original, ratio, placement);
        prop_assume!(!coarse.triangles().is_empty());
        let found = bounded(&original, &coarse);
        prop_assert!(found.upper >= sampled(&original, &coarse, 5_000), "{found:?}");
        prop_assert!(found.upper <= found.lower * 1.01 + 4e-6 * found.diagonal, "{found:?}");
        let exchanged = bounded(&coarse, &original);
        prop_assert!(exchanged.upper >= found.lower && found.upper >= exchanged.lower, "{found:?}");
    }

    #[test]
    fn no_sample_of_two_soups_is_beyond_the_bound(
        a in soup(),
        b in soup(),
        scale in prop::sample::select(vec![1.0f32, 1e-30, 1e30]),
        pieces in prop::sample::select(vec![0, 100, 100_000]),
    ) {
        let (a, b) = (mapped(&a, |p| p.map(|x| x * scale)), mapped(&b, |p| p.map(|x| x * scale)));
        let found = bounded_with(&a, &b, &BoundOptions { pieces, ..BoundOptions::default() });
        let measured = sampled(&a, &b, 2_000);
        prop_assert!(found.upper >= measured && found.upper.is_finite(), "{found:?} {measured}");
        prop_assert!(found.lower <= found.upper, "{found:?}");
        if pieces == 100_000 {
            let close = found.lower * 1.01 + 1e-5 * f64::from(scale) * 10.0;
            prop_assert!(found.upper <= close, "{found:?}");
        }
    }
}

#[test]
fn parallel_squares_are_at_their_distance() {
    for height in [1.0f32, 0.25, 1.0 / 64.0] {
        let high = moved(&shapes::plane(7), [0.0, 0.0, height]);
        assert_tight(&bounded(&shapes::plane(5), &high), f64::from(height));
    }
}

#[test]
fn a_cube_in_a_larger_one_is_farthest_from_its_corners() {
    let large = mapped(&shapes::cube(3), |p| p.map(|x| 3.0 * x - 1.0));
    assert_tight(&bounded(&shapes::cube(4), &large), 3f64.sqrt());
}

#[test]
fn a_bump_is_as_far_as_it_is_high() {
    let bump = |x: f32, y: f32| if (x, y) == (0.5, 0.5) { 0.125 } else { 0.0 };
    let bumpy = shapes::height_field(8, bump).expect("heights are finite");
    assert_tight(&bounded(&shapes::plane(1), &bumpy), 0.125);
}

#[test]
fn what_is_farthest_inside_of_a_triangle_is_seen() {
    // Over the gap between two strips the square has no vertex.
    let strip = mapped(&shapes::plane(1), |[x, y, z]| [0.25 * x, y, z]);
    let strips = joined(&strip, &moved(&strip, [0.75, 0.0, 0.0]));
    let square = shapes::plane(1);
    assert!(sampled(&square, &strips, 0) < 1e-6);
    assert_tight(&bounded(&square, &strips), 0.25);
}

#[test]
fn surfaces_that_are_the_same_are_at_no_distance() {
    let start = Instant::now();
    let stone = shapes::bumpy_sphere(24, 1);
    let found = bounded(&stone, &stone);
    assert!(found.lower == 0.0 && found.upper < 1e-11 && found.pieces == 0, "{found:?}");
    // The same squares in other triangles.
    let found = bounded(&shapes::plane(17), &shapes::plane(23));
    assert!(found.upper <= 2e-6, "{found:?}");
    let cube = shapes::cube(11);
    let found = bounded(&cube, &simplified(&cube, 0.009, Placement::Optimal));
    assert!(found.upper <= 1e-5, "{found:?}");
    assert!(start.elapsed() < Duration::from_secs(20));
}

#[test]
fn moving_both_changes_nothing() {
    let stone = shapes::bumpy_sphere(12, 3);
    // Whole numbers of a step that stays exact when moved.
    let stone = mapped(&stone, |p| p.map(|x| (x * 1024.0).round() / 1024.0));
    let coarse = simplified(&stone, 0.2, Placement::Existing);
    let here = bounded(&stone, &coarse);
    let by = [512.0, -256.0, 1024.0];
    let there = bounded(&moved(&stone, by), &moved(&coarse, by));
    assert!((here.lower - there.lower).abs() < 0.011 * here.lower, "{here:?} {there:?}");
    assert!(here.upper >= there.lower && there.upper >= here.lower, "{here:?} {there:?}");
}

#[test]
fn threads_change_nothing() {
    let stone = shapes::bumpy_sphere(24, 1);
    let coarse = simplified(&stone, 0.1, Placement::Optimal);
    let with = |threads| bounded_with(&stone, &coarse, &BoundOptions { threads, ..BoundOptions::default() });
    assert_eq!(with(1), with(2));
    assert_eq!(with(1), with(3));
}

#[test]
fn less_work_makes_a_wider_bound_that_holds() {
    let stone = shapes::bumpy_sphere(24, 1);
    let coarse = simplified(&stone, 0.02, Placement::Optimal);
    let with = |pieces| {
        let options = BoundOptions { pieces, tolerance: 0.0, ..BoundOptions::default() };
        bounded_with(&stone, &coarse, &options)
    };
    let bounds = [0, 3_000, 100_000].map(with);
    let measured = sampled(&stone, &coarse, 200_000);
    for found in &bounds {
        assert!(found.upper >= measured, "{found:?} {measured}");
    }
    assert!(bounds.is_sorted_by(|wide, close| wide.upper >= close.upper && wide.lower <= close.lower));
    assert!(bounds[2].upper < 1.02 * measured, "{:?} {measured}", bounds[2]);
}

#[test]
fn the_ends_of_f32_do_not_overflow() {
    for size in [f32::MAX, 1e30, 1e-30, f32::MIN_POSITIVE, f32::from_bits(8)] {
        let here = mapped(&shapes::cube(1), |p| p.map(|x| x * size));
        let there = mapped(&here, |[x, y, _]| [x, y, 0.0]);
        let found = bounded(&here, &there);
        assert!(found.upper >= f64::from(size) && found.upper <= 1.011 * f64::from(size), "{found:?}");
    }
}

#[test]
fn what_is_no_surface_or_no_tolerance_is_an_error() {
    let quiet = &mut Monitor::silent();
    let (square, nothing) = (shapes::plane(1), Mesh::default());
    let defaults = BoundOptions::default();
    let error = bound(&nothing, &square, &defaults, quiet).expect_err("there is no surface");
    assert!(matches!(error, DeviationError::Empty { mesh: "first" }));
    let error = bound(&square, &nothing, &defaults, quiet).expect_err("there is no surface");
    assert!(matches!(error, DeviationError::Empty { mesh: "second" }));
    for tolerance in [-0.1, f64::NAN, f64::INFINITY] {
        let options = BoundOptions { tolerance, ..BoundOptions::default() };
        let error = bound(&square, &square, &options, quiet).expect_err("that is no tolerance");
        assert!(error.to_string().contains("tolerance"), "{error}");
    }
    // A point and a needle, where triangles should be.
    let point = Mesh::new(vec![[1.0, 0.0, 0.0]; 3], vec![[0, 1, 2], [0, 0, 0]]).expect("it is valid");
    assert_tight(&bounded(&square, &point), 2f64.sqrt());
    let needle = Mesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0]], vec![[0, 1, 1]]).expect("it is valid");
    assert_tight(&bounded(&square, &needle), 1.0);
}

#[test]
fn cancelling_ends_it() {
    let stone = shapes::bumpy_sphere(16, 1);
    let coarse = simplified(&stone, 0.1, Placement::Optimal);
    let options = BoundOptions { tolerance: 0.0, pieces: 10_000, threads: 1 };
    let mut reports = 0;
    let mut count = Monitor::new(|_| {
        reports += 1;
        ControlFlow::Continue(())
    });
    bound(&stone, &coarse, &options, &mut count).expect("nobody cancels");
    drop(count);
    for last in 0..reports {
        let mut left = last;
        let mut monitor = Monitor::new(|_| {
            left -= 1;
            if left < 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let error = bound(&stone, &coarse, &options, &mut monitor).expect_err("it was cancelled");
        assert!(matches!(error, DeviationError::Cancelled(_)));
    }
}
