//! Input made to break things: nothing, next to nothing, too much in one place, and numbers at the end
//! of their range.

use std::time::{Duration, Instant};

use decimesh::hqms::{SimplifyError, build_levels};
use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Selection, Simplified, StoppedBy, Target, Topology, simplify};

use crate::check::{check, clean_counts};
use crate::meshes::{fan, joined, moved, permutation, tetrahedron};

const SELECTIONS: [Selection; 2] =
    [Selection::SampledThreshold, Selection::ReplacementSelection { records: 15 }];

/// Far longer than any of these may take, and far less than a quadratic time would be.
const SECONDS: Duration = Duration::from_secs(20);

fn run(mesh: &Mesh, options: &Options) -> Simplified {
    let start = Instant::now();
    let result = simplify(mesh, options, &mut Monitor::silent()).unwrap();
    assert!(start.elapsed() < SECONDS, "{:?}", start.elapsed());
    check(mesh, options, &result);
    result
}

/// Runs with both selections, both topologies, borders locked or not, and targets of every kind.
fn run_all(mesh: &Mesh) {
    let triangles = mesh.triangles().len();
    let targets = [
        Target::Triangles(0),
        Target::Triangles(1),
        Target::Triangles(triangles / 2),
        Target::Triangles(usize::MAX),
        Target::Vertices(0),
        Target::Vertices(mesh.positions().len() / 2),
        Target::Vertices(usize::MAX),
        Target::Ratio(0.0),
        Target::Ratio(0.3),
        Target::Ratio(1.0),
        Target::MaxError(0.0),
        Target::MaxError(f32::MIN_POSITIVE),
        Target::MaxError(0.1),
        Target::MaxError(f32::MAX),
    ];
    for target in targets {
        for selection in SELECTIONS {
            for topology in [Topology::Keep, Topology::RelaxIfStuck] {
                for lock_boundary in [false, true] {
                    let track_origins = lock_boundary;
                    let options =
                        Options { selection, topology, lock_boundary, track_origins, ..Options::new(target) };
                    run(mesh, &options);
                }
            }
        }
    }
}

fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh::new(positions.to_vec(), triangles.to_vec()).unwrap()
}

#[test]
fn next_to_nothing() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5]];
    run_all(&Mesh::default());
    run_all(&mesh(&corners, &[]));
    run_all(&mesh(&corners, &[[0, 1, 2]]));
    run_all(&mesh(&corners, &[[0, 1, 2], [2, 1, 3]]));
    run_all(&mesh(&corners, &[[0, 1, 2], [0, 1, 2]]));
    run_all(&mesh(&corners, &[[0, 1, 2], [0, 2, 1]]));
    run_all(&mesh(&corners, &[[0, 0, 1], [1, 1, 1], [2, 3, 2]]));
    run_all(&tetrahedron([0.0; 3], 1.0));
}

#[test]
fn all_vertices_in_one_point_or_on_one_line() {
    let sphere = shapes::sphere(6);
    run_all(&moved(&sphere, |_| [0.0; 3]));
    run_all(&moved(&sphere, |_| [3.5, -1e6, 7.25]));
    run_all(&moved(&sphere, |[x, _, _]| [x, 0.0, 0.0]));
    run_all(&moved(&sphere, |[x, y, _]| [x + y, 2.0 * (x + y), -(x + y)]));
    run_all(&moved(&shapes::plane(9), |[x, _, _]| [x, 1.0, 1.0]));
}

#[test]
fn one_vertex_with_thousands_of_faces() {
    let wavy = |blades| moved(&fan(blades), |[x, y, _]| [x, y, (9.0 * x).sin() * (7.0 * y).cos()]);
    run_all(&fan(700));
    run_all(&wavy(700));
    for selection in SELECTIONS {
        for target in [Target::Triangles(0), Target::Triangles(1_000), Target::MaxError(0.1)] {
            run(&fan(5_000), &Options { selection, ..Options::new(target) });
            run(&wavy(5_000), &Options { selection, ..Options::new(target) });
        }
    }
}

/// All blades share the first edge.
fn book(pages: u32) -> Mesh {
    let leaf = |page: u32| {
        let angle = page as f32 * 0.12;
        [angle.cos(), angle.sin(), 0.4]
    };
    let positions = [[0.0; 3], [0.0, 0.0, 1.0]].into_iter().chain((0..pages).map(leaf)).collect();
    let triangles = (0..pages).map(|page| if page % 3 == 0 { [0, 1, page + 2] } else { [1, 0, page + 2] });
    Mesh::new(positions, triangles.collect()).unwrap()
}

#[test]
fn fifty_pages_on_one_edge() {
    run_all(&book(50));
}

/// Two tetrahedra with this many vertices in common.
fn siamese(shared: u32) -> Mesh {
    let first = tetrahedron([0.0; 3], 1.0);
    let mut positions = first.positions().to_vec();
    let mut triangles = first.triangles().to_vec();
    positions.extend([[-1.0, -0.2, 0.1], [-1.2, 0.3, 0.2], [-0.9, 0.1, 0.9], [-1.5, 0.5, 0.4]]);
    let name = |vertex: u32| if vertex < shared { vertex } else { vertex + 4 };
    triangles.extend(first.triangles().iter().map(|triangle| triangle.map(name)));
    Mesh::new(positions, triangles).unwrap()
}

#[test]
fn solids_that_touch() {
    for shared in 0..5 {
        run_all(&siamese(shared));
    }
    // Twice the same surface, and a surface with its reverse.
    let sphere = shapes::sphere(3);
    let twice = |turn: bool| {
        let second = sphere.triangles().iter().map(|&[a, b, c]| if turn { [a, c, b] } else { [a, b, c] });
        mesh(sphere.positions(), &sphere.triangles().iter().copied().chain(second).collect::<Vec<_>>())
    };
    run_all(&twice(false));
    run_all(&twice(true));
}

#[test]
fn numbers_at_the_end_of_their_range() {
    let stone = shapes::bumpy_sphere(6, 3);
    for size in [1e37, 2e38, 1e19, 1e-19, 1e-30, 1e-37] {
        run_all(&moved(&stone, |x| x.map(|x| x * size)));
        run_all(&moved(&shapes::plane(8), |x| x.map(|x| x * size)));
    }
    // Subnormal: few digits are left of each coordinate.
    run_all(&moved(&stone, |x| x.map(|x| x * 1e-42)));
    // As wide as it gets: the extent itself is no f32.
    run_all(&moved(&stone, |x| x.map(|x| (x * f32::MAX).clamp(f32::MIN, f32::MAX))));
    run_all(&moved(&stone, |x| x.map(|x| x + 1e30)));
}

#[test]
fn mixed_scales() {
    let stone = shapes::bumpy_sphere(5, 3);
    let sizes = [1e-4, 1e-2, 1.0, 1e2, 1e4];
    run_all(&joined(&sizes.map(|size| moved(&stone, |x| x.map(|x| x * size)))));
    run_all(&moved(&stone, |[x, y, z]| [x * 1e3, y, z * 1e-3]));
    // A stray point that no triangle uses must not matter.
    let (mut positions, triangles, _) = stone.clone().into_parts();
    positions.push([3e38, -3e38, 1e30]);
    let with_stray = Mesh::new(positions, triangles).unwrap();
    let options = Options::new(Target::Triangles(100));
    let (with, without) = (run(&with_stray, &options), run(&stone, &options));
    assert_eq!(with.mesh.triangles().len(), without.mesh.triangles().len());
    assert!((with.error / without.error - 1.0).abs() < 0.1, "{} and {}", with.error, without.error);
}

/// Coordinates of all sizes at once, down to 2^-100 of an edge: what is locked, and what is not
/// touched, stays to the last bit.
#[test]
fn untouched_is_untouched_to_the_last_bit() {
    let positions = [[7e3, 0.0, -0.0], [0.0, 1e2, 1e-26], [1e-10, 3.0, 0.0], [1e-26, -2e-25, 7.0]];
    let mesh = mesh(&positions, &[[0, 1, 2], [2, 1, 3]]);
    let result = run(&mesh, &Options::new(Target::Ratio(1.0)));
    let bits = |mesh: &Mesh| mesh.positions().as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&result.mesh), bits(&mesh));
    run(&mesh, &Options { locked: vec![2, 3], ..Options::new(Target::Triangles(1)) });
}

#[test]
fn a_disc_of_a_hundred_thousand_blades_takes_no_quadratic_time() {
    let disc = fan(100_000);
    for selection in SELECTIONS {
        for target in [Target::Triangles(80_000), Target::Triangles(100), Target::MaxError(1e-3)] {
            let result = run(&disc, &Options { selection, ..Options::new(target) });
            assert!(result.stopped_by != StoppedBy::Stuck);
        }
    }
}

/// A drum: two hubs, each with faces to all of the rim.
#[test]
fn two_hubs_take_no_quadratic_time() {
    let blades = 30_000u32;
    let disc = fan(blades as usize);
    let (mut positions, mut triangles, _) = disc.into_parts();
    positions[0] = [0.0, 0.0, 1.0];
    positions.push([0.0, 0.0, -1.0]);
    triangles.extend((0..blades).map(|blade| [blades + 1, (blade + 1) % blades + 1, blade + 1]));
    let drum = Mesh::new(positions, triangles).unwrap();
    for selection in SELECTIONS {
        for target in [Target::Triangles(50_000), Target::Triangles(100)] {
            let result = run(&drum, &Options { selection, ..Options::new(target) });
            assert!(result.stopped_by == StoppedBy::Target);
        }
    }
}

#[test]
fn ten_thousand_tetrahedra_to_twenty_five() {
    let grid = |index: usize| [index % 22, index / 22 % 22, index / 484].map(|x| x as f32);
    let swarm: Vec<Mesh> =
        (0..10_000).map(|index| tetrahedron(grid(index), 0.2 + 0.5 * (index % 97) as f32 / 97.0)).collect();
    let swarm = joined(&swarm);
    for selection in SELECTIONS {
        let options = Options { selection, track_origins: true, ..Options::new(Target::Triangles(100)) };
        let result = run(&swarm, &options);
        assert_eq!((result.mesh.triangles().len(), result.stopped_by), (100, StoppedBy::Target));
        assert!(result.topology_changed);
        let options = Options { topology: Topology::Keep, ..options };
        let result = run(&swarm, &options);
        assert_eq!((result.mesh.triangles().len(), result.stopped_by), (40_000, StoppedBy::Stuck));
    }
}

/// Triangles that share no vertex at all, as STL files have them.
#[test]
fn a_soup_of_loose_triangles() {
    let sphere = shapes::sphere(20);
    let positions: Vec<[f32; 3]> =
        sphere.triangles().as_flattened().iter().map(|&vertex| sphere.positions()[vertex as usize]).collect();
    let triangles: Vec<[u32; 3]> =
        (0..sphere.triangles().len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    let soup = mesh(&positions, &triangles);
    let result = run(&soup, &Options::new(Target::Ratio(0.1)));
    assert_eq!(result.stopped_by, StoppedBy::Target);
    let result = run(&soup, &Options { topology: Topology::Keep, ..Options::new(Target::Ratio(0.1)) });
    assert_eq!(result.mesh.triangles().len(), triangles.len());
}

/// Triangles between vertices drawn at random: every edge leads across the whole mesh.
#[test]
fn a_large_random_tangle() {
    let stone = shapes::bumpy_sphere(40, 9);
    let place = permutation(stone.positions().len(), 4);
    let turn =
        |(face, [a, b, c]): (usize, &[u32; 3])| [*a, place[*b as usize], if face % 3 == 0 { *a } else { *c }];
    let tangle = mesh(stone.positions(), &stone.triangles().iter().enumerate().map(turn).collect::<Vec<_>>());
    let (faces, _) = clean_counts(&tangle);
    for selection in SELECTIONS {
        run(&tangle, &Options { selection, ..Options::new(Target::Triangles(faces / 10)) });
        run(
            &tangle,
            &Options { selection, topology: Topology::Keep, ..Options::new(Target::Triangles(faces / 2)) },
        );
    }
}

#[test]
fn what_is_locked_altogether_is_stuck() {
    let stone = shapes::bumpy_sphere(8, 1);
    let locked = (0..stone.positions().len() as u32).collect();
    for selection in SELECTIONS {
        let options =
            Options { selection, locked: Vec::clone(&locked), ..Options::new(Target::Triangles(10)) };
        let result = run(&stone, &options);
        assert_eq!(result.stopped_by, StoppedBy::Stuck);
        assert_eq!(result.mesh, stone);
    }
}

#[test]
fn options_that_make_no_sense_are_errors() {
    let stone = shapes::bumpy_sphere(4, 1);
    let vertices = stone.positions().len() as u32;
    let of_target = |target| Options::new(target);
    let cases = [
        of_target(Target::Ratio(f64::NAN)),
        of_target(Target::Ratio(-1.0)),
        of_target(Target::Ratio(2.0)),
        of_target(Target::MaxError(f32::NAN)),
        of_target(Target::MaxError(-1e-9)),
        of_target(Target::MaxError(f32::INFINITY)),
        Options { locked: vec![0, vertices], ..of_target(Target::Triangles(9)) },
        Options {
            selection: Selection::ReplacementSelection { records: 0 },
            ..of_target(Target::Triangles(9))
        },
    ];
    for options in cases {
        let error = simplify(&stone, &options, &mut Monitor::silent()).unwrap_err();
        let SimplifyError::InvalidOption(message) = &error else { panic!("{error:?}") };
        assert!(message.len() > 10, "{message}");
        let error = build_levels(&stone, &[options.target], &options, &mut Monitor::silent()).unwrap_err();
        assert!(matches!(error, SimplifyError::InvalidOption(_)));
    }
}
