//! Distance between surfaces: against brute force, against geometry known by heart, and on meshes
//! that wish us ill.

use std::ops::ControlFlow;

use decimesh::deviation::{Deviation, DeviationError, Directed, Sampling, deviation, vertex_distances};
use decimesh::{Mesh, Monitor};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

fn measure(a: &Mesh, b: &Mesh, samples: usize) -> Deviation {
    measure_with(a, b, &Sampling { samples, ..Sampling::default() })
}

fn measure_with(a: &Mesh, b: &Mesh, sampling: &Sampling) -> Deviation {
    deviation(a, b, sampling, &mut Monitor::silent()).expect("both meshes have triangles")
}

fn of_vertices(from: &Mesh, to: &Mesh, threads: usize) -> Vec<f32> {
    vertex_distances(from, to, threads, &mut Monitor::silent()).expect("the second mesh has triangles")
}

fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(positions, triangles).expect("test meshes are valid")
}

fn mapped(original: &Mesh, change: impl Fn(Vec3) -> Vec3) -> Mesh {
    let positions = original.positions().iter().map(|&position| change(position.into()).into());
    mesh(positions.collect(), original.triangles().to_vec())
}

fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let first = a.positions().len() as u32;
    let shifted = b.triangles().iter().map(|corners| corners.map(|index| index + first));
    mesh([a.positions(), b.positions()].concat(), a.triangles().iter().copied().chain(shifted).collect())
}

fn flipped(original: &Mesh) -> Mesh {
    let triangles = original.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    mesh(original.positions().to_vec(), triangles)
}

/// `columns` by `rows` unit squares in the plane z = 0.
fn plane(columns: u32, rows: u32) -> Mesh {
    let positions = (0..=rows).flat_map(|y| (0..=columns).map(move |x| [x as f32, y as f32, 0.0])).collect();
    let square = |x: u32, y: u32| {
        let corner = y * (columns + 1) + x;
        let above = corner + columns + 1;
        [[corner, corner + 1, above + 1], [corner, above + 1, above]]
    };
    let triangles = (0..rows).flat_map(|y| (0..columns).flat_map(move |x| square(x, y))).collect();
    mesh(positions, triangles)
}

/// The surface of the cube from -1 to 1, `cells` squares along an edge, facing outwards.
fn cube(cells: u32) -> Mesh {
    let side = mapped(&plane(cells, cells), |p| (p * 2.0 / cells as f32 - Vec3::ONE).with_z(1.0));
    let turns: [fn(Vec3) -> Vec3; 6] = [
        |p| p,
        |p| Vec3::new(p.z, p.x, p.y),
        |p| Vec3::new(p.y, p.z, p.x),
        |p| Vec3::new(p.y, p.x, -p.z),
        |p| Vec3::new(-p.z, p.y, p.x),
        |p| Vec3::new(p.x, -p.z, p.y),
    ];
    turns.iter().map(|turn| mapped(&side, turn)).reduce(|a, b| joined(&a, &b)).expect("six sides")
}

fn sphere(cells: u32) -> Mesh {
    mapped(&cube(cells), Vec3::normalize)
}

/// A closed wavy thing without any symmetry.
fn blob(cells: u32) -> Mesh {
    mapped(&sphere(cells), |p| {
        p * (1.0 + 0.2 * (3.0 * p.x + p.y).sin() + 0.1 * (7.0 * p.z - 2.0 * p.y).cos())
    })
}

fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}, give or take {tolerance}");
}

/// The six lengths of the directions, the three over both, the diagonal, and what has no unit.
fn values(measured: &Deviation) -> [f64; 14] {
    let Deviation { forward, backward, rms, mean, max, diagonal, normal_rms_degrees, .. } = *measured;
    let (rms_rel, mean_rel, max_rel) = (measured.rms_rel(), measured.mean_rel(), measured.max_rel());
    let Directed { rms: rms_there, mean: mean_there, max: max_there } = forward;
    let Directed { rms: rms_back, mean: mean_back, max: max_back } = backward;
    let there = [rms_there, mean_there, max_there];
    let back = [rms_back, mean_back, max_back];
    let both = [rms, mean, max, diagonal];
    let unitless = [normal_rms_degrees, rms_rel, mean_rel, max_rel];
    let mut all = there.into_iter().chain(back).chain(both).chain(unitless);
    std::array::from_fn(|_| all.next().expect("fourteen values"))
}

// Against brute force.

/// The nearest point of a triangle by the regions of its corners, edges and face (Ericson,
/// "Real-Time Collision Detection", 5.1.5): another road than the one under test takes.
fn nearest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    a + (ab * vb + ac * vc) / (va + vb + vc)
}

/// Distance to every triangle in turn.
fn brute_distance(p: DVec3, to: &Mesh) -> f64 {
    let to_each = to.triangles().iter().map(|corners| {
        let [a, b, c] = corners.map(|index| Vec3::from(to.positions()[index as usize]).as_dvec3());
        // All three ways round: rounding can mislead the regions of a needle from one of them, and
        // a triangle without area is covered by its edges.
        let ways = [[a, b, c], [b, c, a], [c, a, b], [a, b, b], [b, c, c], [c, a, a]];
        ways.map(|way| p.distance(nearest_on_triangle(p, way))).into_iter().fold(f64::INFINITY, f64::min)
    });
    to_each.fold(f64::INFINITY, f64::min)
}

/// Mean, RMS and maximum over the vertices in use.
fn brute_force(from: &Mesh, to: &Mesh) -> Directed {
    let mut vertices = from.triangles().as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let distances: Vec<f64> = vertices
        .iter()
        .map(|&vertex| brute_distance(Vec3::from(from.positions()[vertex as usize]).as_dvec3(), to))
        .collect();
    let count = distances.len() as f64;
    Directed {
        rms: (distances.iter().map(|d| d * d).sum::<f64>() / count).sqrt(),
        mean: distances.iter().sum::<f64>() / count,
        max: distances.iter().copied().fold(0.0, f64::max),
    }
}

/// Positions and triangles with doubled, degenerate and crossing ones among them.
fn soup() -> impl Strategy<Value = (Vec<[f32; 3]>, Vec<[u32; 3]>)> {
    let coarse = prop::array::uniform3((-3..=3i8).prop_map(f32::from));
    let fine = prop::array::uniform3(-3f32..3.0);
    let positions = prop::collection::vec(prop_oneof![coarse, fine], 3..40);
    positions.prop_flat_map(|positions| {
        let index = 0..positions.len() as u32;
        (Just(positions), prop::collection::vec(prop::array::uniform3(index), 1..60))
    })
}

fn placed((positions, triangles): (Vec<[f32; 3]>, Vec<[u32; 3]>), scale: f32, offset: f32) -> Mesh {
    let place = |position: [f32; 3]| position.map(|x| x * scale + offset);
    mesh(positions.into_iter().map(place).collect(), triangles)
}

proptest! {
    #[test]
    fn vertices_find_the_nearest_triangle(
        a in soup(),
        b in soup(),
        (scale, offset) in
            prop::sample::select(vec![(1.0, 0.0), (1.0, 1e6), (1e-6, 0.0), (1e-30, 0.0), (1e30, 0.0)]),
    ) {
        let (a, b) = (placed(a, scale, offset), placed(b, scale, offset));
        let expected = [brute_force(&a, &b), brute_force(&b, &a)];
        let tolerance = 1e-9 * f64::from(scale);
        let by_vertices = measure(&a, &b, 0);
        for (found, expected) in [by_vertices.forward, by_vertices.backward].iter().zip(&expected) {
            prop_assert!((found.max - expected.max).abs() <= tolerance, "{found:?} {expected:?}");
            prop_assert!((found.mean - expected.mean).abs() <= tolerance, "{found:?} {expected:?}");
            prop_assert!((found.rms - expected.rms).abs() <= tolerance, "{found:?} {expected:?}");
        }
        // Each by itself, used by a triangle or not, rounded to `f32`.
        for (position, found) in a.positions().iter().zip(of_vertices(&a, &b, 1)) {
            let expected = brute_distance(Vec3::from(*position).as_dvec3(), &b);
            let rounding = f64::from(f32::EPSILON) * expected;
            prop_assert!((f64::from(found) - expected).abs() <= tolerance + rounding, "{found} {expected}");
        }
        // With samples, the search for most vertices ends early: never for one that is the farthest.
        let sampled = measure(&a, &b, 50);
        prop_assert!(sampled.forward.max >= expected[0].max - tolerance, "{sampled:?} {expected:?}");
        prop_assert!(sampled.backward.max >= expected[1].max - tolerance, "{sampled:?} {expected:?}");
        let relative = [sampled.rms_rel(), sampled.mean_rel(), sampled.max_rel()];
        prop_assert!(relative.iter().all(|value| *value >= 0.0), "{sampled:?}");
        prop_assert!(values(&sampled)[..11].iter().all(|value| value.is_finite() && *value >= 0.0));
    }

    #[test]
    fn samples_find_the_nearest_triangle(b in soup(), at in prop::array::uniform3(-4f32..4.0)) {
        // All samples of so small a triangle are in one place, but for its size.
        let size = 1e-3;
        let b = placed(b, 1.0, 0.0);
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| (Vec3::from(at) + corner * size).to_array());
        let speck = mesh(corners.to_vec(), vec![[0, 1, 2]]);
        let found = measure(&speck, &b, 3).forward;
        let expected = brute_distance(Vec3::from(at).as_dvec3(), &b);
        for distance in [found.mean, found.rms, found.max] {
            prop_assert!((distance - expected).abs() < 2e-3, "{found:?} is not {expected}");
        }
    }
}

// Known by heart.

#[test]
fn a_lifted_plane_is_its_lift_away() {
    let ground = plane(7, 5);
    let lifted = mapped(&ground, |p| p.with_z(0.5));
    let measured = measure(&ground, &lifted, 10_000);
    for found in &values(&measured)[..9] {
        assert_close(*found, 0.5, 1e-15);
    }
    assert_eq!(measured.normal_rms_degrees, 0.0);
    assert_close(measured.diagonal, 74f64.sqrt(), 1e-12);
    assert_close(measured.max_rel(), 0.5 / 74f64.sqrt(), 1e-12);
}

#[test]
fn a_grown_sphere_is_its_growth_away() {
    let measured = measure(&sphere(40), &mapped(&sphere(40), |p| p * 1.25), 50_000);
    // The facets stand back from the spheres by less than this.
    let facet = 1e-3;
    for found in &values(&measured)[..9] {
        assert_close(*found, 0.25, facet);
    }
    assert!(measured.normal_rms_degrees < 1.5, "{measured:?}");
}

#[test]
fn samples_are_uniform_over_the_area() {
    // A ramp z = x over the unit square, its triangles crowded towards one side: the height of a
    // point spread evenly over it has mean 1/2 and mean square 1/3, however it is cut.
    let crowded = mapped(&plane(40, 1), |p| Vec3::new((p.x / 40.0).powi(3), p.y, 0.0));
    let ramp = mapped(&crowded, |p| p.with_z(p.x));
    let ground = mapped(&plane(2, 2), |p| p * 4.0 - Vec3::new(4.0, 4.0, 0.0));
    for seed in 0..4 {
        let measured = measure_with(&ramp, &ground, &Sampling { samples: 20_000, seed, threads: 1 });
        assert_close(measured.forward.mean, 0.5, 1e-3);
        assert_close(measured.forward.rms, 3f64.sqrt().recip(), 1e-3);
        assert_eq!(measured.forward.max, 1.0);
    }
}

#[test]
fn tilted_planes_meet_at_their_angle() {
    let ground = mapped(&plane(4, 4), |p| p * 10.0 - Vec3::new(20.0, 20.0, 0.0));
    let tilted = mapped(&plane(3, 3), |p| Vec3::new(p.x, p.y, p.x * 0.75));
    let angle = 0.75f64.atan().to_degrees();
    let small_first = measure(&tilted, &ground, 2000);
    assert_close(small_first.normal_rms_degrees, angle, 1e-4);
    assert_close(measure(&ground, &flipped(&tilted), 2000).normal_rms_degrees, 180.0 - angle, 1e-4);
}

#[test]
fn one_spike_counts_in_the_maximum() {
    let ground = plane(20, 20);
    let spiked = mapped(&ground, |p| if p.x == 10.0 && p.y == 10.0 { p.with_z(8.0) } else { p });
    let measured = measure(&ground, &spiked, 100);
    assert_eq!(measured.backward.max, 8.0);
    assert!(measured.forward.max < 4.0, "{measured:?}");
    assert_eq!(measured.max, 8.0);
}

#[test]
fn normals_that_tie_are_taken_kindly() {
    // Beside an edge of the smaller cube two of its faces are equally near.
    let (inner, outer) = (cube(3), mapped(&cube(4), |p| p * 1.5));
    let measured = measure(&inner, &outer, 20_000);
    assert_close(measured.normal_rms_degrees, 0.0, 1e-6);
    assert_close(measured.forward.mean, 0.5, 1e-9);
    // A sheet with two sides agrees with a sheet of one, but not the other way about.
    let sheet = plane(5, 5);
    let twofold = joined(&flipped(&sheet), &sheet);
    let measured = measure(&sheet, &twofold, 20_000);
    assert_close(measured.normal_rms_degrees, 180.0 * 0.5f64.sqrt(), 0.1);
    assert_eq!(measure(&twofold, &twofold, 1000).normal_rms_degrees, 0.0);
    assert_close(measure(&sheet, &flipped(&sheet), 1000).normal_rms_degrees, 180.0, 1e-9);
}

// Laws.

#[test]
fn a_mesh_is_no_distance_from_itself() {
    for offset in [0.0, 1e6] {
        let here = mapped(&blob(15), |p| p + offset);
        let measured = measure(&here, &here, 30_000);
        assert_eq!((measured.forward, measured.backward), (Directed::default(), Directed::default()));
        assert_eq!((measured.rms, measured.mean, measured.max, measured.max_rel()), (0.0, 0.0, 0.0, 0.0));
        assert_close(measured.normal_rms_degrees, 0.0, 1e-6);
    }
}

#[test]
fn exchanging_the_meshes_exchanges_the_directions() {
    let (a, b) = (blob(14), blob(5));
    let (there, back) = (measure(&a, &b, 9_000), measure(&b, &a, 9_000));
    assert_eq!((there.forward, there.backward), (back.backward, back.forward));
    assert_eq!((there.rms, there.mean, there.max), (back.rms, back.mean, back.max));
    assert_eq!(there.normal_rms_degrees, back.normal_rms_degrees);
    assert_ne!(there.forward, there.backward);
}

#[test]
fn scaling_and_moving_the_meshes_scales_the_distance() {
    // Few enough bits that moving them loses none.
    let rounded = |mesh: &Mesh| mapped(mesh, |p| (p * 1024.0).round() / 1024.0);
    let (a, b) = (rounded(&blob(12)), rounded(&blob(6)));
    let home = measure(&a, &b, 20_000);
    let placements = [
        (1.0, 1024.0, 1e-12),
        (2f32.powi(-20), 0.0, 0.0),
        (2f32.powi(60), 0.0, 0.0),
        (1e-6, 0.0, 1e-4),
        (1e6, 0.0, 1e-4),
    ];
    for (scale, offset, tolerance) in placements {
        let place = |mesh: &Mesh| mapped(mesh, |p| p * scale + offset);
        let away = measure(&place(&a), &place(&b), 20_000);
        for (away, home) in values(&away)[..10].iter().zip(values(&home)) {
            assert_close(away / f64::from(scale), home, tolerance);
        }
        assert_close(away.normal_rms_degrees, home.normal_rms_degrees, 0.1);
    }
}

#[test]
fn every_number_of_threads_gives_the_same_bits() {
    let (a, b) = (blob(30), blob(9));
    // More than one batch of blocks, and a last block that is not full.
    let of_threads = |threads| {
        values(&measure_with(&a, &b, &Sampling { samples: 70_001, seed: 7, threads })).map(f64::to_bits)
    };
    let one = of_threads(1);
    for threads in [2, 3, 0, usize::MAX] {
        assert_eq!(of_threads(threads), one, "{threads} threads");
    }
    let of_threads =
        |threads| of_vertices(&blob(40), &b, threads).into_iter().map(f32::to_bits).collect::<Vec<_>>();
    let one = of_threads(1);
    for threads in [2, 0] {
        assert_eq!(of_threads(threads), one, "{threads} threads");
    }
}

#[test]
fn the_seed_chooses_the_samples() {
    let (a, b) = (blob(20), blob(7));
    let of_seed = |seed| measure_with(&a, &b, &Sampling { samples: 20_000, seed, threads: 1 });
    assert_eq!(of_seed(1), of_seed(1));
    assert_ne!(of_seed(1).rms, of_seed(2).rms);
    assert_close(of_seed(1).rms / of_seed(2).rms, 1.0, 0.01);
}

// The monitor and errors.

#[test]
fn cancel_works_at_every_step() {
    let (a, b) = (blob(10), blob(5));
    let caller = std::thread::current().id();
    let sampling = Sampling { samples: 140_000, seed: 0, threads: 2 };
    let mut fractions = Vec::new();
    let mut listening = Monitor::new(|fraction| {
        assert_eq!(std::thread::current().id(), caller);
        fractions.push(fraction);
        ControlFlow::Continue(())
    });
    deviation(&a, &b, &sampling, &mut listening).expect("nobody cancels");
    drop(listening);
    assert!(fractions.is_sorted() && fractions[0] == 0.0, "{fractions:?}");
    assert_close(f64::from(fractions[fractions.len() - 1]), 1.0, 1e-6);
    assert!(fractions.len() >= 8, "{fractions:?}");

    for step in 1..=fractions.len() {
        let mut calls = 0;
        let mut ending = Monitor::new(|_| {
            calls += 1;
            if calls == step { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let ended = deviation(&a, &b, &sampling, &mut ending);
        drop(ending);
        assert!(matches!(ended, Err(DeviationError::Cancelled(_))), "step {step}: {ended:?}");
        assert_eq!(calls, step, "called again after the cancel");
    }
}

#[test]
fn vertex_distances_can_be_cancelled_at_every_step() {
    // Two batches of vertices.
    let (many, few) = (plane(400, 200), blob(5));
    let mut fractions = Vec::new();
    let mut listening = Monitor::new(|fraction| {
        fractions.push(fraction);
        ControlFlow::Continue(())
    });
    vertex_distances(&many, &few, 2, &mut listening).expect("nobody cancels");
    drop(listening);
    assert!(fractions.is_sorted() && fractions.len() == 4, "{fractions:?}");
    assert_eq!(fractions[3], 1.0);
    for step in 1..=fractions.len() {
        let mut calls = 0;
        let mut ending = Monitor::new(|_| {
            calls += 1;
            if calls == step { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let ended = vertex_distances(&many, &few, 2, &mut ending);
        drop(ending);
        assert!(matches!(ended, Err(DeviationError::Cancelled(_))), "step {step}");
        assert_eq!(calls, step, "called again after the cancel");
    }
}

#[test]
fn vertices_alone_have_distances_but_are_no_surface() {
    let vertices_only = mesh(vec![[1.0, 2.0, 3.0]; 4], vec![]);
    let floor = plane(4, 4);
    assert_eq!(of_vertices(&vertices_only, &floor, 1), [3.0; 4]);
    assert!(of_vertices(&Mesh::default(), &floor, 1).is_empty());
    let error =
        vertex_distances(&floor, &vertices_only, 1, &mut Monitor::silent()).expect_err("no triangles");
    assert!(matches!(error, DeviationError::Empty { mesh: "second" }), "{error}");
}

#[test]
fn a_vertex_far_out_leaves_the_distances_of_others_alone() {
    let mut positions = plane(3, 3).positions().to_vec();
    positions.iter_mut().for_each(|position| position[2] = 1e-3);
    positions.push([1e30, -1e30, 1e30]);
    let strayed = mesh(positions, plane(3, 3).triangles().to_vec());
    let distances = of_vertices(&strayed, &plane(3, 3), 1);
    assert_eq!(distances[..16], [1e-3; 16]);
    assert!(distances[16] > 1e30 && distances[16].is_finite());
}

#[test]
fn a_mesh_without_triangles_is_an_error() {
    let vertices_only = mesh(vec![[1.0, 2.0, 3.0]; 4], vec![]);
    let (nothing, full) = (Mesh::default(), plane(1, 1));
    let cases = [
        (&vertices_only, &full, "first"),
        (&full, &vertices_only, "second"),
        (&nothing, &full, "first"),
        (&nothing, &vertices_only, "first"),
    ];
    for (a, b, which) in cases {
        let error = deviation(a, b, &Sampling::default(), &mut Monitor::silent()).expect_err("no triangles");
        assert!(matches!(error, DeviationError::Empty { mesh } if mesh == which), "{error}");
        assert!(error.to_string().contains(which), "{error}");
    }
}

// Ill will.

#[test]
fn without_area_the_vertices_count() {
    let line = mesh(vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], vec![[0, 1, 2], [1, 1, 1]]);
    let lifted = mapped(&line, |p| p + Vec3::Z);
    let measured = measure(&line, &lifted, 1000);
    assert_eq!(measured.forward, Directed { rms: 1.0, mean: 1.0, max: 1.0 });
    assert_eq!(measured.normal_rms_degrees, 0.0);
    // Two vertices on the line, one off it by 1.
    let bent = mesh(vec![[0.0; 3], [1.0, 0.0, 1.0], [2.0, 0.0, 0.0]], vec![[0, 1, 1], [1, 2, 2]]);
    let measured = measure(&bent, &line, 1000);
    assert_eq!(measured.forward, Directed { rms: (1.0 / 3.0f64).sqrt(), mean: 1.0 / 3.0, max: 1.0 });
    // A point against a point.
    let point = |x: f32| mesh(vec![[x, 0.0, 0.0]; 3], vec![[0, 1, 2]]);
    let measured = measure(&point(1.0), &point(4.0), 1000);
    assert_eq!((measured.rms, measured.diagonal, measured.rms_rel()), (3.0, 0.0, f64::INFINITY));
    assert_eq!(measure(&point(1.0), &point(1.0), 1000).rms_rel(), 0.0);
}

#[test]
fn vertices_no_triangle_uses_do_not_count() {
    let used = plane(3, 3);
    let mut positions = used.positions().to_vec();
    positions.push([1e30, -1e30, 1e30]);
    let strayed = mesh(positions, used.triangles().to_vec());
    let lifted = mapped(&used, |p| p + Vec3::new(0.1, 0.2, 0.3));
    assert_eq!(measure(&strayed, &lifted, 5000), measure(&used, &lifted, 5000));
    assert_eq!(measure(&lifted, &strayed, 5000), measure(&lifted, &used, 5000));
}

#[test]
fn boxes_that_tie_or_crowd_do_not_stall_the_tree() {
    let ribbon = plane(30_000, 1);
    let heap = mesh(plane(1, 1).positions().to_vec(), vec![[0, 1, 3]; 5_000]);
    let line = mesh(ribbon.positions().to_vec(), (0..30_000).map(|i| [i, i + 1, i]).collect());
    let crowd = (0..3_000).flat_map(|i| {
        let halving = 0.995f32.powi(i);
        [[halving, 0.0, halving], [halving, 1.0, 0.0], [0.0, halving, 1.0]]
    });
    let crowd = mesh(crowd.collect(), (0..3_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect());
    for (name, hostile) in [("ribbon", &ribbon), ("heap", &heap), ("line", &line), ("crowd", &crowd)] {
        let lifted = mapped(hostile, |p| p + Vec3::Z * 3.0);
        let measured = measure(hostile, &lifted, 500);
        assert!(measured.max > 1.9 && measured.max <= 3.0 + 1e-6, "{name}: {measured:?}");
        assert!(values(&measured).iter().all(|value| value.is_finite()), "{name}: {measured:?}");
        // On top of itself everything ties.
        assert_eq!(measure(hostile, hostile, 500).max, 0.0, "{name}");
    }
}

#[test]
fn the_ends_of_f32_do_not_overflow() {
    for size in [f32::MAX, 1e30, 1e-30, f32::MIN_POSITIVE, f32::from_bits(8)] {
        let here = mapped(&cube(2), |p| p * size);
        let there = mapped(&here, |p| p * 0.5);
        let measured = measure(&here, &there, 2000);
        let half = 0.5 * f64::from(size);
        assert_close(measured.backward.max / half, 1.0, 1e-9);
        assert_close(measured.forward.max / half, 3f64.sqrt(), 1e-9);
        assert!(values(&measured).iter().all(|value| value.is_finite()), "{measured:?}");
        // The smallest thing there is beside the largest.
        let speck = mapped(&cube(1), |p| p * f32::from_bits(1));
        for measured in [measure(&here, &speck, 200), measure(&speck, &here, 200)] {
            assert!(values(&measured)[..11].iter().all(|value| value.is_finite()), "{measured:?}");
            assert!(measured.max >= f64::from(size) * 0.8, "{measured:?}");
        }
    }
}
