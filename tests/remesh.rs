//! Remeshing: whatever comes in, the result lies on it and is as whole as it is.
#![cfg(feature = "deviation")]

use std::ops::ControlFlow;

use decimesh::deviation::{Deviation, Sampling, deviation};
use decimesh::mesh::{shapes, verify};
use decimesh::rate_distortion::{
    DecompositionOptions, RemeshError, RemeshOptions, Remeshed, SemiRegularError, SurfaceDecomposition,
    remesh,
};
use decimesh::{Mesh, Monitor};

fn options(depth: u32, base_quads: usize) -> RemeshOptions {
    RemeshOptions { base_quads, ..RemeshOptions::new(depth) }
}

fn remeshed(mesh: &Mesh, depth: u32, base_quads: usize) -> Remeshed {
    remesh(mesh, &options(depth, base_quads), &mut Monitor::silent()).unwrap()
}

fn distance(mesh: &Mesh, other: &Mesh) -> Deviation {
    let sampling = Sampling { samples: 20_000, ..Sampling::default() };
    deviation(mesh, other, &sampling, &mut Monitor::silent()).unwrap()
}

/// That the vertices of `full` are points of `mesh`.
fn assert_on(mesh: &Mesh, full: &Mesh) {
    // Triangles that are but points, so that nothing is measured but the vertices.
    let points = (0..full.positions().len() as u32).map(|vertex| [vertex; 3]).collect();
    let points = Mesh::new(full.positions().to_vec(), points).unwrap();
    let away = distance(mesh, &points).backward.max;
    assert!(away <= 1e-6 * mesh.diagonal(), "a vertex is {away} away");
}

#[test]
fn a_stone_is_remeshed_closely_and_decimated_without_a_crack() {
    let stone = shapes::bumpy_sphere(24, 3);
    let result = remeshed(&stone, 4, 60);
    let quads = result.surface.complex().quads().len();
    assert!((60..=90).contains(&quads), "{quads}");
    let full = result.surface.to_mesh();
    assert_eq!(verify(&stone, &full, true), Ok(()));
    assert_eq!(result.folded, 0);
    assert_on(&stone, &full);
    let distance = distance(&stone, &full);
    assert!(distance.rms_rel() < 5e-4, "{}", distance.rms_rel());
    assert!(distance.normal_rms_degrees < 15.0, "{}", distance.normal_rms_degrees);

    let options = DecompositionOptions::default();
    let decomposition = SurfaceDecomposition::new(result.surface, &options, &mut Monitor::silent()).unwrap();
    for part in 1..=20 {
        let left = decomposition.at_vertices(full.positions().len() * part / 20).mesh;
        assert_eq!(verify(&full, &left, true), Ok(()), "{part}");
    }
}

#[test]
fn handles_borders_and_pieces_are_kept() {
    let waves = shapes::height_field(20, |x, y| 0.1 * (9.0 * x).sin() * (7.0 * y).cos()).unwrap();
    let torus = shapes::torus(32, 16);
    let far: Vec<_> = torus.positions().iter().map(|[x, y, z]| [x + 9.0, *y, *z]).collect();
    let names = torus.positions().len() as u32;
    let moved = torus.triangles().iter().map(|triangle| triangle.map(|corner| corner + names));
    let triangles = torus.triangles().iter().copied().chain(moved).collect();
    let pair = Mesh::new([torus.positions(), &far].concat(), triangles).unwrap();
    for (mesh, closest) in [(&torus, 1e-2), (&pair, 1e-2), (&waves, 1e-2), (&shapes::sphere(8), 1e-2)] {
        let result = remeshed(mesh, 3, 48);
        let full = result.surface.to_mesh();
        assert_eq!(verify(mesh, &full, true), Ok(()));
        assert_on(mesh, &full);
        assert!(distance(mesh, &full).rms_rel() < closest, "{}", distance(mesh, &full).rms_rel());
        assert!(result.folded * 100 <= full.triangles().len(), "{}", result.folded);
    }
}

#[test]
fn a_flat_sheet_stays_flat_and_whole() {
    let sheet = shapes::plane(9);
    let full = remeshed(&sheet, 3, 8).surface.to_mesh();
    assert_eq!(verify(&sheet, &full, true), Ok(()));
    assert!(full.positions().iter().all(|position| position[2] == 0.0));
    // Its corners are cut a little at most, and nothing lies over anything else.
    let area = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| full.positions()[corner as usize].map(f64::from));
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
    };
    let (sum, size) = full
        .triangles()
        .iter()
        .fold((0.0, 0.0), |(sum, size), &triangle| (sum + area(triangle), size + area(triangle).abs()));
    assert!(sum > 0.97 && size < 1.0 + 1e-6, "{sum} {size}");
}

#[test]
fn the_smallest_meshes_can_be_remeshed() {
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let triangle = Mesh::new(corners[..3].to_vec(), vec![[0, 1, 2]]).unwrap();
    let tetrahedron = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let tetrahedron = Mesh::new(corners, tetrahedron).unwrap();
    for mesh in [triangle, tetrahedron] {
        for depth in 1..=3 {
            let full = remeshed(&mesh, depth, 1).surface.to_mesh();
            assert_eq!(verify(&mesh, &full, true), Ok(()));
            assert_on(&mesh, &full);
        }
    }
}

#[test]
fn size_and_place_do_not_matter() {
    let stone = shapes::bumpy_sphere(12, 1);
    let scaled = |scale: f32| {
        let positions = stone.positions().iter().map(|position| position.map(|x| x * scale)).collect();
        Mesh::new(positions, stone.triangles().to_vec()).unwrap()
    };
    let plain = remeshed(&stone, 3, 40).surface;
    for scale in [1.0 / 1024.0 / 1024.0, 1024.0] {
        let other = remeshed(&scaled(scale), 3, 40).surface;
        assert_eq!(other.complex(), plain.complex());
        let pairs = plain.positions().as_flattened().iter().zip(other.positions().as_flattened());
        for (a, b) in pairs {
            assert!((a * scale - b).abs() <= 1e-5 * scale, "{a} {b}");
        }
    }
}

#[test]
fn threads_change_nothing_and_unused_vertices_neither() {
    let stone = shapes::bumpy_sphere(20, 2);
    let with = |threads: usize| {
        let options = RemeshOptions { threads, ..options(3, 40) };
        remesh(&stone, &options, &mut Monitor::silent()).unwrap()
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(3));
    let positions = [stone.positions(), &[[9.0; 3]]].concat();
    let more = Mesh::new(positions, stone.triangles().to_vec()).unwrap();
    assert_eq!(one, remeshed(&more, 3, 40));
}

#[test]
fn what_is_wrong_with_a_mesh_is_named() {
    let error = |triangles: &[[u32; 3]]| {
        let positions = (0..8).map(|i| [i as f32, (i * i) as f32, (i * i * i) as f32]).collect();
        let mesh = Mesh::new(positions, triangles.to_vec()).unwrap();
        remesh(&mesh, &options(2, 4), &mut Monitor::silent()).unwrap_err()
    };
    assert_eq!(error(&[]), RemeshError::Empty);
    assert_eq!(error(&[[0, 1, 2], [2, 1, 1]]), RemeshError::DegenerateTriangle { triangle: 1 });
    let pages = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
    assert_eq!(error(&pages), RemeshError::NonManifoldEdge { vertices: [0, 1] });
    assert_eq!(error(&[[0, 1, 2], [0, 1, 3]]), RemeshError::InconsistentEdge { vertices: [0, 1] });
    // Vertex 1 is used by none: names are those of the input all the same.
    assert_eq!(error(&[[0, 2, 3], [3, 4, 5]]), RemeshError::NonManifoldVertex { vertex: 3 });
    let stone = shapes::bumpy_sphere(6, 1);
    let error = |options: &RemeshOptions| remesh(&stone, options, &mut Monitor::silent()).unwrap_err();
    assert_eq!(error(&options(3, 0)), RemeshError::NoBaseQuads);
    for depth in [0, 16, u32::MAX] {
        let error = error(&options(depth, 20));
        assert!(matches!(error, RemeshError::Surface(SemiRegularError::Depth { .. })), "{error}");
    }
}

#[test]
fn remeshing_can_be_cancelled_at_any_time() {
    let stone = shapes::bumpy_sphere(10, 1);
    let mut reports = 0;
    let mut count = Monitor::new(|_| {
        reports += 1;
        ControlFlow::Continue(())
    });
    remesh(&stone, &options(2, 20), &mut count).unwrap();
    drop(count);
    for stop in 1..=reports {
        let mut heard = 0;
        let mut monitor = Monitor::new(|_| {
            heard += 1;
            if heard == stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let result = remesh(&stone, &options(2, 20), &mut monitor);
        assert!(matches!(result, Err(RemeshError::Cancelled(_))), "{stop} of {reports}");
    }
}
