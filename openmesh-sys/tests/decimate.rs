//! The shim at work, what it refuses, and that it keeps quiet. Skipped, with a word on stderr, where
//! OpenMesh is not installed.

use std::collections::BTreeSet;
use std::io::{Write, stderr};
use std::process::Command;

use openmesh_sys::{AVAILABLE, Decimation, Error, Mesh, Method, decimate, version};

const METHODS: [Method; 2] = [Method::Quadric, Method::MultipleChoice];

/// Whether OpenMesh is missing; says so past the test harness, which swallows what passing tests print.
fn is_missing(test: &str) -> bool {
    if !AVAILABLE {
        let line = format!("{test} is SKIPPED: {}\n", Error::Unavailable);
        stderr().write_all(line.as_bytes()).expect("stderr takes a line");
    }
    !AVAILABLE
}

/// A hilly square of `n` by `n` cells: `2n²` triangles.
fn hills(n: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let share = |i: u32| i as f32 / n as f32;
    let positions = (0..=n).flat_map(|i| {
        let x = share(i);
        (0..=n).map(move |j| [x, share(j), 0.1 * (9.0 * x).sin() * (7.0 * share(j)).cos()])
    });
    let triangles = (0..n).flat_map(|i| {
        (0..n).flat_map(move |j| {
            let a = i * (n + 1) + j;
            let [b, c, d] = [a + n + 1, a + n + 2, a + 1];
            [[a, b, c], [a, c, d]]
        })
    });
    (positions.collect(), triangles.collect())
}

fn normal_z(positions: &[[f32; 3]], [a, b, c]: [u32; 3]) -> f32 {
    let [a, b, c] = [a, b, c].map(|vertex| positions[vertex as usize]);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[test]
fn the_count_is_reached_with_vertices_of_the_input() {
    if is_missing("the_count_is_reached_with_vertices_of_the_input") {
        return;
    }
    let (positions, triangles) = hills(40);
    let places: BTreeSet<[u32; 3]> = positions.iter().map(|position| position.map(f32::to_bits)).collect();
    for method in METHODS {
        for wanted in [1600, 320, 32] {
            let decimated = decimate(&positions, &triangles, &Decimation::new(method, wanted)).unwrap();
            let left = decimated.triangles.len();
            assert!(left == wanted || left + 1 == wanted, "{method:?}: {left} of {wanted} triangles");
            assert_eq!(decimated.left_out, 0);
            let used: BTreeSet<u32> = decimated.triangles.iter().flatten().copied().collect();
            assert!(used.into_iter().eq(0..decimated.positions.len() as u32), "{method:?}: unused vertices");
            let mut bits = decimated.positions.iter().map(|position| position.map(f32::to_bits));
            assert!(bits.all(|bits| places.contains(&bits)), "{method:?}: a vertex moved");
        }
    }
}

#[test]
fn the_steps_one_by_one_make_the_same() {
    if is_missing("the_steps_one_by_one_make_the_same") {
        return;
    }
    let (positions, triangles) = hills(30);
    for method in METHODS {
        let decimation = Decimation::new(method, 200);
        let whole = decimate(&positions, &triangles, &decimation).unwrap();
        let mesh = Mesh::build(&positions, &triangles).unwrap();
        assert_eq!((mesh.vertices(), mesh.triangles()), (positions.len(), triangles.len()));
        assert_eq!(mesh.buffers(), (positions.clone(), triangles.clone()));
        let mesh = mesh.decimate(&decimation).unwrap();
        assert_eq!(mesh.buffers(), (whole.positions, whole.triangles), "{method:?}");
    }
    assert!(version().is_some_and(|(major, _)| major >= 9));
}

#[test]
fn nothing_is_done_where_nothing_is_asked() {
    if is_missing("nothing_is_done_where_nothing_is_asked") {
        return;
    }
    let (positions, triangles) = hills(5);
    for method in METHODS {
        let decimated = decimate(&positions, &triangles, &Decimation::new(method, triangles.len())).unwrap();
        assert_eq!((decimated.positions, decimated.triangles), (positions.clone(), triangles.clone()));
        let nothing = decimate(&[], &[], &Decimation::new(method, 0)).unwrap();
        assert!(nothing.positions.is_empty() && nothing.triangles.is_empty());
    }
}

#[test]
fn an_impossible_count_ends_where_the_collapses_do() {
    if is_missing("an_impossible_count_ends_where_the_collapses_do") {
        return;
    }
    let (positions, triangles) = hills(10);
    for method in METHODS {
        for wanted in [0, 1] {
            let decimated = decimate(&positions, &triangles, &Decimation::new(method, wanted)).unwrap();
            assert!((1..=4).contains(&decimated.triangles.len()), "{method:?}: {:?}", decimated.triangles);
        }
    }
}

#[test]
fn forbidden_flips_do_not_happen() {
    if is_missing("forbidden_flips_do_not_happen") {
        return;
    }
    let (positions, triangles) = hills(40);
    for method in METHODS {
        let decimation = Decimation { prevent_flips: true, ..Decimation::new(method, 60) };
        let decimated = decimate(&positions, &triangles, &decimation).unwrap();
        let left = decimated.triangles.len();
        assert!(left == 60 || left == 59, "{method:?}: {left} triangles");
        let mut triangles = decimated.triangles.iter();
        assert!(triangles.all(|&triangle| normal_z(&decimated.positions, triangle) >= 0.0), "{method:?}");
    }
}

#[test]
fn a_smaller_distance_leaves_more_triangles() {
    if is_missing("a_smaller_distance_leaves_more_triangles") {
        return;
    }
    let (positions, triangles) = hills(40);
    for method in METHODS {
        let counts = [0.0, 0.001, 0.01, 0.1].map(|distance| {
            let decimation = Decimation { max_distance: Some(distance), ..Decimation::new(method, 0) };
            decimate(&positions, &triangles, &decimation).unwrap().triangles.len()
        });
        assert!(counts.is_sorted_by(|more, fewer| more > fewer), "{method:?}: {counts:?}");
    }
}

#[test]
fn triangles_that_openmesh_cannot_hold_are_counted() {
    if is_missing("triangles_that_openmesh_cannot_hold_are_counted") {
        return;
    }
    let (positions, _) = hills(2);
    let pages = [[0, 1, 2], [1, 0, 3]];
    let cases: [(&[[u32; 3]], usize); 5] = [
        (&[], 0),
        (&[[0, 1, 4], [0, 1, 5]], 2),
        (&[[0, 1, 2]], 1),
        (&[[5, 5, 6], [6, 5, 6], [5, 6, 5], [7, 7, 7]], 4),
        (&[[4, 5, 6]], 0),
    ];
    for (more, left_out) in cases {
        let triangles = [&pages[..], more].concat();
        let mesh = Mesh::build(&positions, &triangles).unwrap();
        assert_eq!(mesh.left_out(), left_out, "{more:?}");
        assert_eq!(mesh.triangles(), triangles.len() - left_out, "{more:?}");
        let vertices = if more == [[4, 5, 6]] { 7 } else { 4 };
        let mesh = mesh.decimate(&Decimation::new(Method::Quadric, 9)).unwrap();
        assert_eq!(mesh.vertices(), vertices, "{more:?}: what no triangle uses goes");
    }
}

/// Debian's library asserts what it believes: a soup that it believes wrongly of would end the process.
#[test]
fn no_soup_is_too_wild() {
    if is_missing("no_soup_is_too_wild") {
        return;
    }
    let positions: Vec<[f32; 3]> = (0..9).map(|i| [i as f32, (i * i) as f32, (i * i * i) as f32]).collect();
    let mut state: u64 = 1;
    let mut below = |bound: u64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 33) % bound) as u32
    };
    for soup in 0..2000 {
        let vertices = 3 + u64::from(below(7));
        let triangles: Vec<[u32; 3]> = (0..below(40)).map(|_| [(); 3].map(|()| below(vertices))).collect();
        let method = METHODS[soup % 2];
        let decimation = Decimation::new(method, below(20) as usize);
        let decimated = decimate(&positions, &triangles, &decimation).unwrap();
        assert!(decimated.triangles.len() + decimated.left_out <= triangles.len(), "{triangles:?}");
    }
}

/// What OpenMesh complains about most, in a process of its own whose output can be read.
#[test]
fn nothing_is_printed() {
    let noisy = "triangles_that_openmesh_cannot_hold_are_counted";
    if is_missing("nothing_is_printed") {
        return;
    }
    let program = std::env::current_exe().expect("a test knows its program");
    let output = Command::new(program).args([noisy, "--exact", "--nocapture"]).output().expect("it runs");
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && out.contains("1 passed"), "{out}{err}");
    assert_eq!(err, "");
    assert!(!out.contains("complex") && !out.contains("OpenMesh"), "{out}");
}

#[test]
fn threads_take_turns() {
    if is_missing("threads_take_turns") {
        return;
    }
    let (positions, triangles) = hills(20);
    let decimation = Decimation::new(Method::MultipleChoice, 80);
    let alone = decimate(&positions, &triangles, &decimation).unwrap();
    std::thread::scope(|scope| {
        let others = [(); 4].map(|()| scope.spawn(|| decimate(&positions, &triangles, &decimation)));
        for other in others {
            assert_eq!(other.join().expect("the shim never panics"), Ok(alone.clone()));
        }
    });
}

#[test]
fn bad_input_is_refused_before_openmesh_sees_it() {
    let (positions, triangles) = hills(2);
    let decimation = Decimation::new(Method::Quadric, 1);
    let refused = |positions: &[[f32; 3]], triangles: &[[u32; 3]]| {
        decimate(positions, triangles, &decimation).expect_err("the input is bad")
    };
    let index = Error::IndexOutOfRange { triangle: 8, index: 9, vertices: 9 };
    assert_eq!(refused(&positions, &[&triangles[..], &[[0, 9, 1]]].concat()), index);
    assert_eq!(index.to_string(), "triangle 8 names vertex 9, of 9");
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut positions = positions.clone();
        positions[4][2] = bad;
        assert_eq!(refused(&positions, &triangles), Error::NotFinite { vertex: 4 });
    }
}

#[test]
fn a_bad_distance_is_refused() {
    if is_missing("a_bad_distance_is_refused") {
        return;
    }
    let (positions, triangles) = hills(2);
    for distance in [f32::NAN, -1.0] {
        let decimation = Decimation { max_distance: Some(distance), ..Decimation::new(Method::Quadric, 1) };
        assert_eq!(decimate(&positions, &triangles, &decimation), Err(Error::InvalidDistance));
    }
}

#[test]
fn its_absence_says_what_to_install() {
    assert_eq!(AVAILABLE, version().is_some());
    assert!(Error::Unavailable.to_string().contains("libopenmesh-dev"));
    let (positions, triangles) = hills(2);
    let built = Mesh::build(&positions, &triangles);
    assert_eq!(built.err(), (!AVAILABLE).then_some(Error::Unavailable));
}
