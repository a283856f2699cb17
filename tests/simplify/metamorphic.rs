//! What must not matter: where a mesh lies, how large it is, how it is numbered, its mirror image.

use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Selection, Simplified, Target, simplify};

use crate::check::check;
use crate::meshes::{moved, shuffled};

const SELECTIONS: [Selection; 2] =
    [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }];

fn run(mesh: &Mesh, selection: Selection, ratio: f64) -> Simplified {
    let options = Options { selection, ..Options::new(Target::Ratio(ratio)) };
    let result = simplify(mesh, &options, &mut Monitor::silent()).unwrap();
    check(mesh, &options, &result);
    result
}

/// The root mean square of the distances of the vertices of `stone`, a height over the unit sphere,
/// from `result`, along the ray from the origin: by brute force, over every `stride`th vertex.
fn radial_error(stone: &Mesh, result: &Mesh, stride: usize) -> f64 {
    let point = |vertex: u32| glam::DVec3::from(result.positions()[vertex as usize].map(f64::from));
    let faces: Vec<_> = result.triangles().iter().map(|triangle| triangle.map(point)).collect();
    let mut sum = 0.0;
    let mut count = 0;
    for position in stone.positions().iter().step_by(stride) {
        let ray = glam::DVec3::from(position.map(f64::from));
        let mut nearest = f64::INFINITY;
        for [a, b, c] in &faces {
            let normal = (b - a).cross(c - a);
            let along = a.dot(normal) / ray.dot(normal);
            let hit = ray * along;
            let inside = [(a, b), (b, c), (c, a)]
                .iter()
                .all(|(p, q)| (**q - **p).cross(hit - **p).dot(normal) >= -1e-12);
            if along > 0.0 && inside {
                nearest = nearest.min((along - 1.0).abs() * ray.length());
            }
        }
        if nearest.is_finite() {
            sum += nearest * nearest;
            count += 1;
        }
    }
    (sum / f64::from(count)).sqrt()
}

fn assert_close(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a / b - 1.0).abs() <= tolerance, "{what}: {a} and {b}");
}

/// Powers of two change no digit, so they may change nothing else.
#[test]
fn a_power_of_two_scales_the_result_exactly() {
    let stone = shapes::bumpy_sphere(30, 5);
    for selection in SELECTIONS {
        let expected = run(&stone, selection, 0.1);
        for exponent in [-100f32, -40.0, -1.0, 30.0, 100.0] {
            let factor = exponent.exp2();
            let scaled = run(&moved(&stone, |x| x.map(|x| x * factor)), selection, 0.1);
            assert_eq!(scaled.mesh, moved(&expected.mesh, |x| x.map(|x| x * factor)), "2^{exponent}");
            assert_eq!(scaled.error, expected.error * factor);
        }
    }
}

#[test]
fn any_factor_scales_the_result() {
    let stone = shapes::bumpy_sphere(30, 5);
    for selection in SELECTIONS {
        let expected = run(&stone, selection, 0.1);
        let error = radial_error(&stone, &expected.mesh, 7);
        for factor in [1e-6f32, 0.3, 1e6] {
            let scaled = run(&moved(&stone, |x| x.map(|x| x * factor)), selection, 0.1);
            assert_eq!(scaled.mesh.triangles().len(), expected.mesh.triangles().len());
            let back = moved(&scaled.mesh, |x| x.map(|x| x / factor));
            assert_close(radial_error(&stone, &back, 7), error, 0.05, "error");
        }
    }
}

/// A million units away from the origin a coordinate has sixteenths left.
#[test]
fn far_from_the_origin() {
    let sixteenths = |x: f32| (x * 16.0).round() / 16.0;
    let stone = moved(&shapes::bumpy_sphere(24, 5), |x| x.map(|x| sixteenths(x * 200.0)));
    let offset = [1e6, -1e6, 0.75e6];
    let far = moved(&stone, |x| std::array::from_fn(|axis| x[axis] + offset[axis]));
    for selection in SELECTIONS {
        let (near, far) = (run(&stone, selection, 0.1), run(&far, selection, 0.1));
        assert_eq!(near.mesh.triangles().len(), far.mesh.triangles().len());
        let back = moved(&far.mesh, |x| std::array::from_fn(|axis| x[axis] - offset[axis]));
        let (near_error, far_error) = (radial_error(&stone, &near.mesh, 5), radial_error(&stone, &back, 5));
        assert_close(far_error, near_error, 0.1, "error");
    }
}

#[test]
fn the_numbering_hardly_matters() {
    let stone = shapes::bumpy_sphere(40, 5);
    let expected = run(&stone, Selection::SampledThreshold, 0.05);
    let error = radial_error(&stone, &expected.mesh, 7);
    for seed in 0..3 {
        let result = run(&shuffled(&stone, seed), Selection::SampledThreshold, 0.05);
        assert_eq!(result.mesh.triangles().len(), expected.mesh.triangles().len());
        assert_close(radial_error(&stone, &result.mesh, 7), error, 0.15, "error");
    }
}

/// The mirror image, with its faces turned about so that they look outwards again.
#[test]
fn a_mirror_image_is_simplified_alike() {
    let stone = shapes::bumpy_sphere(40, 5);
    let mirror = |mesh: &Mesh| {
        let positions = mesh.positions().iter().map(|&[x, y, z]| [-x, y, z]).collect();
        let triangles = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
        Mesh::new(positions, triangles).unwrap()
    };
    for selection in SELECTIONS {
        let (result, mirrored) = (run(&stone, selection, 0.1), run(&mirror(&stone), selection, 0.1));
        assert_eq!(result.mesh.triangles().len(), mirrored.mesh.triangles().len());
        let errors = [&result.mesh, &mirror(&mirrored.mesh)].map(|result| radial_error(&stone, result, 7));
        assert_close(errors[1], errors[0], 0.05, "error");
    }
}
