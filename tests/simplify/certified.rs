//! A certified error holds, whatever the mesh, the options and the limit, and is made use of.

use decimesh::deviation::{BoundOptions, Sampling, bound, deviation};
use decimesh::mesh::shapes;
use decimesh::{
    Certified, Mesh, Monitor, Options, Placement, SimplifyError, StoppedBy, Target, simplify, simplify_within,
};
use proptest::prelude::*;

use crate::cancel::cancel_everywhere;
use crate::check::check;
use crate::invariants::{Case, with_options};
use crate::meshes::{attributed, dirty_mesh, moved, torn_mesh};

fn within(mesh: &Mesh, max_error: f64, options: &Options) -> Certified {
    simplify_within(mesh, max_error, options, &mut Monitor::silent()).expect("the options are valid")
}

/// The largest distance that is found, by two ways of looking: densely at points, and by bounds.
fn farthest(a: &Mesh, b: &Mesh) -> f64 {
    let quiet = &mut Monitor::silent();
    let sampling = Sampling { samples: 4_000, ..Sampling::default() };
    let sampled = deviation(a, b, &sampling, quiet).expect("both have triangles").max;
    let options = BoundOptions { pieces: 20_000, ..BoundOptions::default() };
    sampled.max(bound(a, b, &options, quiet).expect("both have triangles").lower)
}

/// Panics unless the result keeps what is promised of it.
fn hold(mesh: &Mesh, max_error: f64, options: &Options, result: &Certified) {
    let Certified { simplified, bound } = result;
    assert!(bound.lower <= bound.upper && bound.upper <= max_error, "{bound:?} for {max_error}");
    assert!(f64::from(simplified.error) >= bound.upper, "{} for {bound:?}", simplified.error);
    assert_eq!(simplified.stopped_by, StoppedBy::Error);
    assert!(simplified.mesh.triangles().len() <= mesh.triangles().len());
    if !mesh.triangles().is_empty() {
        let measured = farthest(mesh, &simplified.mesh);
        // What `f64` rounds.
        let room =
            1e-12 * mesh.positions().as_flattened().iter().fold(0.0f64, |most, &x| most.max(x.abs().into()));
        assert!(measured <= max_error + room, "{measured} for {max_error}, {bound:?}");
    }
    // The input itself, which may be dirtier than a result: nothing else is to be said of it.
    let (input, sources) = mesh.of_triangles(mesh.triangles()).expect("they are its own");
    if simplified.mesh == input {
        assert_eq!(bound.upper, 0.0);
        let kept = simplified.sources.as_ref().is_none_or(|kept| *kept == sources);
        assert!(kept, "{:?} are not {sources:?}", simplified.sources);
        let origins = simplified.origins.as_deref().unwrap_or_default();
        assert!((0..).zip(origins).all(|(vertex, &into)| match sources.binary_search(&vertex) {
            Ok(place) => into as usize == place,
            Err(_) => into == u32::MAX,
        }));
        return;
    }
    // The rest is what is promised of all results; there the limit is one of the estimate.
    let target = Target::MaxError(simplified.error);
    check(mesh, &Options { target, ..options.clone() }, simplified);
}

fn limit() -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => Just(0.0),
        1 => Just(1e-300),
        1 => Just(1e300),
        1 => Just(f64::MAX),
        2 => 1e-9f64..1e-3,
        4 => 1e-3f64..0.3,
        2 => 0.3f64..4.0,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_point_of_a_torn_mesh_is_beyond_the_limit(case in with_options(torn_mesh()), max_error in limit()) {
        let Case { mesh, options } = case;
        let options = Options { refine: false, ..options };
        hold(&mesh, max_error, &options, &within(&mesh, max_error, &options));
    }

    #[test]
    fn no_point_of_a_dirty_mesh_is_beyond_the_limit(case in with_options(dirty_mesh()), max_error in limit()) {
        let Case { mesh, options } = case;
        let options = Options { refine: false, ..options };
        hold(&mesh, max_error, &options, &within(&mesh, max_error, &options));
    }
}

/// A stone with a thorn, and a sheet with torn edges.
fn larger_meshes() -> [Mesh; 3] {
    let stone = shapes::bumpy_sphere(40, 3);
    let thorn = moved(&stone, |[x, y, z]| if z > 0.97 { [x, y, z + 4.0 * (z - 0.97)] } else { [x, y, z] });
    let sheet = shapes::height_field(60, |x, y| 0.1 * (9.0 * x).sin() * (7.0 * y + x).cos());
    let sheet = sheet.expect("heights are finite");
    let kept = |index: usize| index % 17 != 3 && index % 101 > 4;
    let triangles: Vec<_> =
        sheet.triangles().iter().copied().enumerate().filter(|(index, _)| kept(*index)).collect();
    let triangles: Vec<_> = triangles.into_iter().map(|(_, triangle)| triangle).collect();
    let (torn, _) = sheet.of_triangles(&triangles).expect("they are the sheet's");
    [stone, thorn, torn]
}

#[test]
fn larger_meshes_keep_the_limit_with_either_placement() {
    for mesh in larger_meshes() {
        for placement in [Placement::Optimal, Placement::Existing] {
            for share in [0.0005, 0.005, 0.03] {
                let options = Options { placement, track_origins: true, ..Options::new(Target::Ratio(0.0)) };
                let max_error = share * mesh.diagonal();
                hold(&mesh, max_error, &options, &within(&mesh, max_error, &options));
            }
        }
    }
}

/// The estimate alone, with its limit so chosen by bisection that its result is measured to be as good.
#[test]
fn no_fewer_triangles_are_found_by_bisection() {
    let quiet = &mut Monitor::silent();
    let stone = shapes::bumpy_sphere(40, 3);
    for share in [0.002, 0.01] {
        let max_error = share * stone.diagonal();
        let certified = within(&stone, max_error, &Options::new(Target::Ratio(0.0)));
        let (mut low, mut high, mut fewest) = (0.0f32, 4.0 * max_error as f32, stone.triangles().len());
        for _ in 0..8 {
            let middle = (low + high) / 2.0;
            let options = Options::new(Target::MaxError(middle));
            let mesh = simplify(&stone, &options, quiet).expect("the options are valid").mesh;
            let found = bound(&stone, &mesh, &BoundOptions::default(), quiet).expect("both have triangles");
            if found.upper <= max_error {
                low = middle;
                fewest = fewest.min(mesh.triangles().len());
            } else {
                high = middle;
            }
        }
        let found = certified.simplified.mesh.triangles().len();
        assert!(found as f64 <= 1.2 * fewest as f64, "{found} triangles, {fewest} by bisection");
    }
}

#[test]
fn what_cannot_get_smaller_comes_back() {
    let stone = shapes::bumpy_sphere(8, 3);
    let options = Options { track_origins: true, ..Options::new(Target::Ratio(0.0)) };
    for max_error in [0.0, f64::MIN_POSITIVE, 1e-13] {
        let result = within(&stone, max_error, &options);
        assert_eq!(result.bound.upper, 0.0);
        assert_eq!(result.simplified.error, 0.0);
        assert_eq!(result.simplified.mesh.triangles().len(), stone.triangles().len());
    }
    // A hair that no simplification keeps, as it is no face, and that would be missed.
    let mut triangles = stone.triangles().to_vec();
    let mut positions = stone.positions().to_vec();
    positions.extend([[9.0; 3], [3.0, 0.0, 0.0]]);
    let count = positions.len() as u32;
    triangles.push([0, count - 1, 0]);
    let hairy = Mesh::new(positions, triangles).expect("indices are in range");
    for placement in [Placement::Optimal, Placement::Existing] {
        let options = Options { placement, ..options.clone() };
        let result = within(&hairy, 0.1, &options);
        assert_eq!(result.bound.upper, 0.0);
        assert_eq!(result.simplified.mesh.triangles().len(), hairy.triangles().len());
        let origins = result.simplified.origins.expect("they are tracked");
        // The one vertex that no triangle uses is gone.
        assert_eq!(origins[count as usize - 2..], [u32::MAX, count - 2]);
        // With room for the hair, it goes.
        let result = within(&hairy, 3.0, &options);
        assert!(result.simplified.mesh.triangles().len() < 100);
    }
}

#[test]
fn a_plane_becomes_two_triangles() {
    let result = within(&shapes::plane(20), 1e-6, &Options::new(Target::Ratio(0.0)));
    assert_eq!(result.simplified.mesh.triangles().len(), 2);
}

#[test]
fn what_is_no_distance_or_no_option_is_an_error() {
    let cube = shapes::cube(2);
    let error_of = |max_error: f64, options: &Options| {
        let result = simplify_within(&cube, max_error, options, &mut Monitor::silent());
        let Err(SimplifyError::InvalidOption(message)) = result else { panic!("{result:?}") };
        message
    };
    let options = Options::new(Target::Ratio(0.5));
    for (max_error, words) in [(f64::NAN, "NaN"), (-0.5, "-0.5"), (f64::INFINITY, "inf")] {
        let message = error_of(max_error, &options);
        assert!(message.contains("maximum error") && message.contains(words), "{message}");
    }
    let message = error_of(0.1, &Options { refine: true, ..options.clone() });
    assert!(message.contains("refined"), "{message}");
    let message = error_of(0.1, &Options { locked: vec![7_000], ..options });
    assert!(message.contains("locked vertex 7000"), "{message}");
}

#[test]
fn no_triangles_are_none_in_the_end() {
    for mesh in [Mesh::default(), Mesh::new(vec![[1.0; 3]; 4], Vec::new()).expect("it is a mesh")] {
        let result = within(&mesh, 0.5, &Options::new(Target::Ratio(0.5)));
        assert!(result.simplified.mesh.triangles().is_empty() && result.bound.upper == 0.0);
    }
}

#[test]
fn threads_change_nothing() {
    for mesh in [shapes::bumpy_sphere(32, 3), attributed(shapes::torus(50, 20), 1)] {
        for placement in [Placement::Optimal, Placement::Existing] {
            let with = |threads| {
                let options =
                    Options { placement, threads, track_origins: true, ..Options::new(Target::Ratio(0.0)) };
                let Certified { simplified, bound } = within(&mesh, 0.003, &options);
                (simplified.mesh, simplified.origins, simplified.sources, simplified.error.to_bits(), bound)
            };
            let expected = with(1);
            assert_eq!(with(2), expected);
            assert_eq!(with(3), expected);
        }
    }
}

#[test]
fn it_ends_at_any_report() {
    let stone = shapes::bumpy_sphere(16, 3);
    let before = stone.clone();
    let options = Options { threads: 2, ..Options::new(Target::Ratio(0.0)) };
    cancel_everywhere(|monitor| simplify_within(&stone, 0.01, &options, monitor).map(drop));
    assert_eq!(stone, before);
}
