//! A progressive mesh in memory: its levels are those of its collapses.

use std::sync::Arc;

use decimesh::hqms::HalfEdge;
use decimesh::lod::{Mark, Player, Progressive, ProgressiveError};
use decimesh::mesh::shapes;
use decimesh::{Mesh, Monitor, Options, Placement, Selection, Target, Topology, build_levels};
use proptest::prelude::*;

use crate::collapses::{Case, case, mesh, seamed};

fn progressive(case: &Case) -> Progressive {
    Progressive::new(&case.mesh, &case.collapses).unwrap()
}

/// The level in the names of the input, sorted.
fn named(progressive: &Progressive, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let order = progressive.order().unwrap();
    let mut named: Vec<_> =
        triangles.iter().map(|triangle| triangle.map(|vertex| order[vertex as usize])).collect();
    named.sort_unstable();
    named
}

/// What must be true of every progressive mesh, wherever it comes from.
pub(crate) fn check(progressive: &Progressive) {
    let mut player = Player::new(progressive);
    let mut levels = Vec::new();
    loop {
        let step = player.step();
        let triangles = progressive.triangles_at(step);
        assert_eq!(triangles.len(), progressive.triangle_count(step));
        assert_eq!(player.triangles(), triangles);
        assert_eq!(player.vertex_count(), progressive.vertex_count(step));
        let within = |&vertex: &u32| (vertex as usize) < player.vertex_count();
        assert!(triangles.as_flattened().iter().all(within), "a level leaves its prefix");
        levels.push(triangles);
        if !player.finer() {
            break;
        }
    }
    assert_eq!(levels.len(), progressive.steps() + 1);
    assert!(!player.finer() && player.step() == progressive.steps());
    for level in levels.iter().rev() {
        assert_eq!(player.triangles(), level);
        player.coarser();
    }
    assert!(!player.coarser() && player.step() == 0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn levels_are_those_of_the_collapses(case in case()) {
        let progressive = progressive(&case);
        check(&progressive);
        let expected = case.levels();
        prop_assert_eq!(progressive.steps() + 1, expected.len());
        for (step, expected) in expected.iter().enumerate() {
            prop_assert_eq!(&named(&progressive, &progressive.triangles_at(step)), expected);
        }
        let order = progressive.order().unwrap();
        for (vertex, &input) in order.iter().enumerate() {
            prop_assert_eq!(progressive.vertices().positions()[vertex], case.mesh.positions()[input as usize]);
        }
        if let Some(uvs) = &case.mesh.attributes().uvs {
            let own = progressive.vertices().attributes().uvs.as_ref().unwrap();
            prop_assert!(order.iter().zip(own).all(|(&input, uv)| uvs[input as usize] == *uv));
        }
    }

    #[test]
    fn levels_of_any_chain_are_marked(mesh in mesh(), paper in any::<bool>()) {
        let replacement = Selection::ReplacementSelection { records: 15 };
        let selection = if paper { replacement } else { Selection::SampledThreshold };
        let mut places: Vec<_> = mesh.positions().iter().map(|place| place.map(|x| (x + 0.0).to_bits())).collect();
        places.sort_unstable();
        check_chain(&mesh, selection, places.windows(2).all(|pair| pair[0] != pair[1]));
    }

    #[test]
    fn vertices_come_in_the_order_in_which_they_go(case in case()) {
        let progressive = progressive(&case);
        let order = progressive.order().unwrap();
        let sources: Vec<u32> = case.collapses.iter().map(|collapse| collapse.source).collect();
        let base = progressive.vertex_count(0);
        prop_assert_eq!(order.len(), base + sources.len());
        prop_assert!(order[..base].is_sorted());
        for (done, source) in sources.iter().enumerate() {
            let step = progressive.step_after(done + 1);
            // The step after it lacks the source; unless it is one of several, and the last is not done.
            let lacks = !order[..progressive.vertex_count(step)].contains(source);
            let inside = progressive.vertex_count(step) != order.len() - done - 1;
            prop_assert!(lacks || inside);
        }
        prop_assert_eq!(progressive.step_after(0), progressive.steps());
        prop_assert_eq!(progressive.step_after(sources.len()), 0);
    }

    #[test]
    fn the_level_within_a_count_is_the_finest(case in case(), count in 0usize..600) {
        let progressive = progressive(&case);
        let step = progressive.step_within(count);
        prop_assert!(step == 0 || progressive.triangle_count(step) <= count);
        prop_assert!(step == progressive.steps() || progressive.triangle_count(step + 1) > count);
    }

    #[test]
    fn a_player_goes_anywhere(case in case(), ways in prop::collection::vec(0.0f64..1.2, 1..8)) {
        let progressive = Arc::new(progressive(&case));
        let mut player = Player::new(Arc::clone(&progressive));
        for way in ways {
            let step = (way * progressive.steps() as f64) as usize;
            player.go_to(step);
            prop_assert_eq!(player.step(), step.min(progressive.steps()));
            prop_assert_eq!(player.triangles(), &progressive.triangles_at(step)[..]);
        }
    }
}

/// A chain's levels are there, and say where. Of a mesh that is not `clean` an engine may keep triangles with
/// two corners at one place, and move these apart: such triangles are missing.
fn check_chain(mesh: &Mesh, selection: Selection, clean: bool) {
    let targets = [0.5, 0.2, 0.05].map(Target::Ratio);
    let options = Options { selection, ..Options::new(targets[0]) };
    let progressive = Progressive::build(mesh, &targets, &options, &mut Monitor::silent()).unwrap();
    check(&progressive);
    let tracked = Options {
        placement: Placement::Existing,
        topology: Topology::Keep,
        track_sources: true,
        ..options.clone()
    };
    let levels = build_levels(mesh, &targets, &tracked, &mut Monitor::silent()).unwrap();
    assert_eq!(progressive.marks().len(), levels.len());
    for (mark, level) in progressive.marks().iter().zip(&levels) {
        assert_eq!(mark.error, level.error);
        let sources = level.sources.as_ref().unwrap();
        let corners = level.mesh.triangles().iter();
        let expected = corners.map(|triangle| triangle.map(|vertex| sources[vertex as usize])).collect();
        let triangles = surface(mesh, named(&progressive, &progressive.triangles_at(mark.step)));
        let expected = surface(mesh, expected);
        assert!(triangles.iter().all(|triangle| expected.binary_search(triangle).is_ok()));
        assert!(!clean || triangles == expected, "{triangles:?} should be {expected:?}");
    }
    let error = Progressive::from_levels(mesh, &levels).unwrap_err();
    assert_eq!(error, ProgressiveError::NotTracked);
}

/// The triangles in an order of their own, whatever corner they begin with, but for those with two corners
/// at one place: they are no part of the surface, and an engine need not drop them.
fn surface(mesh: &Mesh, mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    triangles.retain(|triangle| {
        let [a, b, c] = triangle.map(|vertex| mesh.positions()[vertex as usize]);
        a != b && b != c && c != a
    });
    triangles.iter_mut().for_each(|triangle| {
        let least = (0..3).min_by_key(|&corner| triangle[corner]).unwrap();
        triangle.rotate_left(least);
    });
    triangles.sort_unstable();
    triangles
}

#[test]
fn levels_of_a_chain_are_marked() {
    for mesh in [shapes::bumpy_sphere(20, 1), shapes::torus(30, 15), shapes::plane(20), seamed(20)] {
        check_chain(&mesh, Selection::SampledThreshold, true);
    }
}

fn collapse(source: u32, target: u32) -> HalfEdge {
    HalfEdge { source, target }
}

#[test]
fn a_seam_is_one_step() {
    let mesh = seamed(4);
    let row = 2 * 5;
    let copies = 25;
    let pair = [collapse(row + 1, row), collapse(copies + 1, copies)];
    let progressive = Progressive::new(&mesh, &pair).unwrap();
    assert_eq!(progressive.steps(), 1);
    let split = progressive.split(0).unwrap();
    let parents: Vec<u32> = split
        .vertex_splits()
        .map(|change| {
            assert!(!change.corners.is_empty() && change.corners.is_sorted());
            progressive.order().unwrap()[change.parent as usize]
        })
        .collect();
    assert_eq!(parents, [row, copies]);
    assert_eq!(progressive.triangle_count(0), mesh.triangles().len() - 2);
    assert!(progressive.split(1).is_none());
}

#[test]
fn a_vertex_may_go_by_way_of_another_at_its_place() {
    let mesh = seamed(4);
    let (side, copy, neighbour) = (10 + 1, 25 + 1, 25);
    let progressive = Progressive::new(&mesh, &[collapse(side, copy), collapse(copy, neighbour)]).unwrap();
    assert_eq!(progressive.steps(), 1);
    check(&progressive);
    let order = progressive.order().unwrap();
    let split = progressive.split(0).unwrap();
    assert!(split.vertex_splits().all(|change| order[change.parent as usize] == neighbour));
}

#[test]
fn what_is_unused_or_degenerate_is_left_out() {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-0.0; 3], [5.0; 3], [6.0; 3]];
    let mesh = Mesh::new(positions, vec![[0, 1, 2], [0, 3, 2], [3, 3, 5]]).unwrap();
    let progressive = Progressive::new(&mesh, &[]).unwrap();
    assert_eq!(progressive.order().unwrap(), [0, 1, 2]);
    assert_eq!(progressive.triangles_at(0), [[0, 1, 2]]);
    let empty = Progressive::new(&Mesh::default(), &[]).unwrap();
    assert_eq!((empty.steps(), empty.triangles_at(7).len()), (0, 0));
}

#[test]
fn wrong_lists_are_refused() {
    let mesh = shapes::cube(1);
    let refusal = |collapses: &[HalfEdge]| Progressive::new(&mesh, collapses).unwrap_err();
    assert_eq!(
        refusal(&[collapse(0, 1), collapse(2, 8)]),
        ProgressiveError::VertexOutOfRange { collapse: 1, vertex: 8, vertices: 8 }
    );
    let gone = ProgressiveError::VertexGone { collapse: 1, vertex: 0 };
    assert_eq!(refusal(&[collapse(0, 1), collapse(0, 2)]), gone);
    assert_eq!(refusal(&[collapse(0, 1), collapse(2, 0)]), gone);
    assert_eq!(refusal(&[collapse(3, 3)]), ProgressiveError::IntoItself { collapse: 0, vertex: 3 });
    let text = refusal(&[collapse(u32::MAX, 0)]).to_string();
    assert_eq!(text, "collapse 0 names vertex 4294967295, but there are 8 vertices");
}

#[test]
fn marks_go_from_fine_to_coarse() {
    let mesh = shapes::cube(1);
    let mut progressive = Progressive::new(&mesh, &[collapse(0, 1), collapse(2, 3)]).unwrap();
    let mark = |step, error| Mark { step, error };
    let good = vec![mark(2, 0.0), mark(1, 0.5), mark(1, 0.5), mark(0, 1.0)];
    progressive.set_marks(good.clone()).unwrap();
    assert_eq!(progressive.marks(), good);
    for (bad, part) in [
        (vec![mark(3, 0.0)], "no step 3"),
        (vec![mark(1, 0.0), mark(2, 1.0)], "finer"),
        (vec![mark(1, 1.0), mark(0, 0.5)], "less"),
        (vec![mark(0, f32::NAN)], "no error"),
        (vec![mark(0, -1.0)], "no error"),
    ] {
        let message = progressive.set_marks(bad).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
    assert_eq!(progressive.marks(), good);
}

/// A vertex of many triangles is not walked around at every step.
#[test]
fn a_hub_does_not_take_quadratic_time() {
    let hub = crate::meshes::fan(100_000);
    let collapses: Vec<HalfEdge> = (1..99_000).map(|vertex| collapse(vertex, vertex + 1)).collect();
    let progressive = Progressive::new(&hub, &collapses).unwrap();
    let mut player = Player::new(&progressive);
    player.go_to(usize::MAX);
    assert_eq!(player.triangles().len(), 100_000);
}
