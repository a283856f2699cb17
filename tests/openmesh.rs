//! Beside OpenMesh's decimaters at the same count of triangles: less error, and no more damage. Skipped,
//! with a word on stderr, where OpenMesh is not installed.

#![cfg(feature = "deviation")]

use std::io::{Write, stderr};

use decimesh::deviation::{Sampling, deviation};
use decimesh::mesh::topology::visit_edges;
use decimesh::mesh::{Rings, shapes, verify};
use decimesh::{Mesh, Monitor, Options, StoppedBy, Target, simplify};
use glam::DVec3;
use openmesh_sys::{AVAILABLE, Decimation, Error, Method, decimate};

const SHARES: [f64; 3] = [0.5, 0.1, 0.01];

/// Two faces at an edge are a fold if their normals are further apart than this, in degrees: one of them
/// lies on its back.
const FOLD: f64 = 150.0;

/// What is wrong with a mesh, and how far it is from the one that it was made from.
#[derive(Debug, Clone, Copy)]
struct Findings {
    triangles: usize,
    rms: f64,
    folds: usize,
    non_manifold_edges: usize,
    non_manifold_vertices: usize,
}

impl Findings {
    fn new(input: &Mesh, output: &Mesh) -> Self {
        let sampling = Sampling { samples: 100_000, ..Sampling::default() };
        let deviation = deviation(input, output, &sampling, &mut Monitor::silent());
        let topology = output.topology();
        Self {
            triangles: output.triangles().len(),
            rms: deviation.expect("there are triangles").rms,
            folds: folds(output),
            non_manifold_edges: topology.non_manifold_edges,
            non_manifold_vertices: topology.non_manifold_vertices,
        }
    }
}

fn folds(mesh: &Mesh) -> usize {
    let normal = |face: usize| {
        let [a, b, c] = mesh.triangles()[face]
            .map(|vertex| DVec3::from_array(mesh.positions()[vertex as usize].map(f64::from)));
        (b - a).cross(c - a).normalize_or_zero()
    };
    let limit = FOLD.to_radians().cos();
    let mut folds = 0;
    visit_edges(mesh, &Rings::new(mesh), |edge| {
        if let [one, other] = edge.sides {
            folds += usize::from(normal(one.face).dot(normal(other.face)) < limit);
        }
    });
    folds
}

/// Whether OpenMesh is missing; says so past the test harness, which swallows what passing tests print.
fn is_missing(test: &str) -> bool {
    if !AVAILABLE {
        let line = format!("{test} is SKIPPED: {}\n", Error::Unavailable);
        stderr().write_all(line.as_bytes()).expect("stderr takes a line");
    }
    !AVAILABLE
}

fn by_decimesh(input: &Mesh, triangles: usize) -> Mesh {
    let options = Options::new(Target::Triangles(triangles));
    let result = simplify(input, &options, &mut Monitor::silent()).expect("nothing cancels");
    assert_eq!(result.stopped_by, StoppedBy::Target);
    if let Err(violation) = verify(input, &result.mesh, !result.topology_changed) {
        panic!("{violation}");
    }
    result.mesh
}

fn by_openmesh(input: &Mesh, decimation: &Decimation) -> Mesh {
    let decimated = decimate(input.positions(), input.triangles(), decimation).expect("the mesh is clean");
    assert_eq!(decimated.left_out, 0);
    Mesh::new(decimated.positions, decimated.triangles).expect("OpenMesh's meshes are valid")
}

/// decimesh is better at every share than each of OpenMesh's ways. The figures are there to be read:
/// `cargo test --test openmesh -- --nocapture`.
fn compare(name: &str, input: &Mesh) {
    if is_missing(name) {
        return;
    }
    for share in SHARES {
        let wanted = (input.triangles().len() as f64 * share) as usize;
        let own = Findings::new(input, &by_decimesh(input, wanted));
        println!("{name} to {share}: {own:?}");
        for method in [Method::Quadric, Method::MultipleChoice] {
            for prevent_flips in [false, true] {
                let decimation = Decimation { prevent_flips, ..Decimation::new(method, wanted) };
                let peer = Findings::new(input, &by_openmesh(input, &decimation));
                let ratio = own.rms / peer.rms;
                println!("{name} to {share}: {ratio:.3} of the RMS of {decimation:?}: {peer:?}");
                for count in [own.triangles, peer.triangles] {
                    assert!(count == wanted || count + 1 == wanted, "{count} of {wanted} triangles");
                }
                let both = format!("{name} to {share}: {own:?}, {decimation:?}: {peer:?}");
                assert!(ratio < 1.0, "{both}");
                assert!(own.folds <= peer.folds, "{both}");
                assert!(own.non_manifold_edges <= peer.non_manifold_edges, "{both}");
                assert!(own.non_manifold_vertices <= peer.non_manifold_vertices, "{both}");
            }
        }
    }
}

#[test]
fn a_stone() {
    compare("a_stone", &shapes::bumpy_sphere(50, 1));
}

#[test]
fn a_statue() {
    compare("a_statue", &shapes::statue(30_000));
}

#[test]
fn a_torus() {
    compare("a_torus", &shapes::torus(160, 80));
}

/// The one with a border.
#[test]
fn hills() {
    let height = |x: f32, y: f32| 0.1 * (9.0 * x).sin() * (7.0 * y).cos() + 0.01 * (50.0 * x * y).sin();
    compare("hills", &shapes::height_field(110, height).expect("heights are finite"));
}
