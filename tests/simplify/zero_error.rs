//! What can be simplified without error is, down to its corners.

use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Selection, Target, simplify};

use crate::check::check;
use crate::meshes::shuffled;

const SELECTIONS: [Selection; 2] =
    [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }];

fn run(mesh: &Mesh, selection: Selection, target: Target) -> Mesh {
    let options = Options { selection, ..Options::new(target) };
    let result = simplify(mesh, &options, &mut Monitor::silent()).unwrap();
    check(mesh, &options, &result);
    result.mesh
}

fn area(mesh: &Mesh) -> f64 {
    mesh.statistics().surface_area
}

/// The largest distance from a corner to the nearest vertex.
fn corner_distance(mesh: &Mesh, corners: &[[f32; 3]]) -> f32 {
    let distance =
        |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f32>().sqrt();
    let nearest = |corner| mesh.positions().iter().map(|p| distance(p, corner)).fold(f32::INFINITY, f32::min);
    corners.iter().map(nearest).fold(0.0, f32::max)
}

#[test]
fn a_plane_becomes_its_four_corners() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let plane = shapes::plane(100);
    for mesh in [shuffled(&plane, 3), plane] {
        for selection in SELECTIONS {
            for count in [2, 10, 1000] {
                let flat = run(&mesh, selection, Target::Triangles(count));
                assert!(flat.positions().iter().all(|position| position[2] == 0.0));
                assert!(corner_distance(&flat, &corners) < 1e-5, "{} triangles", count);
                assert!((area(&flat) - 1.0).abs() < 1e-5, "area {}", area(&flat));
            }
        }
    }
}

#[test]
fn a_cube_becomes_its_eight_corners() {
    let corners: Vec<[f32; 3]> =
        (0..8).map(|corner| [corner & 1, corner >> 1 & 1, corner >> 2].map(|x| x as f32)).collect();
    let cube = shapes::cube(30);
    for mesh in [shuffled(&cube, 3), cube] {
        for selection in SELECTIONS {
            for count in [12, 40, 1000] {
                let solid = run(&mesh, selection, Target::Triangles(count));
                assert!(corner_distance(&solid, &corners) < 1e-5, "{} triangles", count);
                assert!((area(&solid) - 6.0).abs() < 1e-4, "area {}", area(&solid));
            }
        }
    }
}

/// With an error allowed that is next to nothing, flat is reduced to next to nothing too.
#[test]
fn a_hair_of_error_is_enough_for_what_is_flat() {
    for selection in SELECTIONS {
        let flat = run(&shapes::plane(60), selection, Target::MaxError(1e-5));
        assert_eq!(flat.triangles().len(), 2);
        let solid = run(&shapes::cube(20), selection, Target::MaxError(1e-5));
        assert_eq!(solid.triangles().len(), 12);
    }
}

/// A roof, turned at random, keeps its ridge.
#[test]
fn a_roof_keeps_its_ridge() {
    let turned = |[x, y, z]: [f32; 3]| {
        [0.36 * x + 0.48 * y - 0.8 * z, -0.8 * x + 0.6 * y, 0.48 * x + 0.64 * y + 0.6 * z]
    };
    let roof = shapes::height_field(40, |x, _| 0.5 - (x - 0.5).abs()).unwrap();
    let positions = roof.positions().iter().map(|&position| turned(position)).collect();
    let roof = Mesh::new(positions, roof.triangles().to_vec()).unwrap();
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.5, 0.0, 0.5],
        [0.5, 1.0, 0.5],
    ]
    .map(turned);
    for selection in SELECTIONS {
        let simple = run(&roof, selection, Target::Triangles(4));
        assert!(corner_distance(&simple, &corners) < 1e-4, "{:?}", simple.positions());
    }
}
