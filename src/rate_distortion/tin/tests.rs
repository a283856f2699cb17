//! What a reduction promises, on random fields with random voids; and every step against doing it naively.

use super::residual::Samples;
use super::surface::Surface;
use super::triangulation::{Fan, Triangulation, Vertex};
use super::{Tin, collapses, flips, moves, reduce};
use crate::monitor::Monitor;
use crate::random::SplitMix64;
use crate::rate_distortion::error::Error;
use crate::rate_distortion::height_field::HeightField;
use crate::rate_distortion::raster::{Place, twice_area};
use crate::rate_distortion::vertical::measure;
use proptest::prelude::*;
use std::collections::{HashMap, HashSet};
use std::ops::ControlFlow;

/// A field, and a triangulation of what is not void of it.
#[derive(Debug, Clone)]
struct Start {
    field: HeightField,
    vertices: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
}

impl Start {
    /// Quads of `step` samples with diagonals that take turns. `quads` says which there are; samples under none are
    /// void, and also every `holes`th one under the others that is no vertex. `height` is that of a sample.
    fn new(
        quads: [usize; 2],
        step: usize,
        is_there: impl Fn(usize, usize) -> bool,
        holes: Option<usize>,
        height: impl Fn(usize, usize) -> f32,
    ) -> Self {
        let size = quads.map(|count| count * step + 1);
        let mut heights = vec![f32::NAN; size[0] * size[1]];
        let mut names = HashMap::new();
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for (across, down) in (0..quads[1]).flat_map(|down| (0..quads[0]).map(move |across| (across, down))) {
            if !is_there(across, down) {
                continue;
            }
            for (x, y) in
                (0..=step).flat_map(|y| (0..=step).map(move |x| (across * step + x, down * step + y)))
            {
                heights[y * size[0] + x] = height(x, y);
            }
            // Counter-clockwise from above, rows running south.
            let corners = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(x, y)| {
                let place = [((across + x) * step) as u32, ((down + y) * step) as u32];
                *names.entry(place).or_insert_with(|| {
                    vertices.push(place);
                    vertices.len() as u32 - 1
                })
            });
            let [a, b, c, d] = corners;
            triangles.extend(match (across + down) % 2 {
                0 => [[a, b, c], [a, c, d]],
                _ => [[b, c, d], [d, a, b]],
            });
        }
        if let Some(holes) = holes {
            for sample in (0..heights.len()).step_by(holes) {
                if !names.contains_key(&[(sample % size[0]) as u32, (sample / size[0]) as u32]) {
                    heights[sample] = f32::NAN;
                }
            }
        }
        let field = HeightField::new(size[0], size[1], heights, Some(f32::NAN)).unwrap();
        Self { field, vertices, triangles }
    }

    fn reduce(&self, target: usize, least_squares: bool) -> Tin {
        let Self { field, vertices, triangles } = self;
        reduce(field, vertices, triangles, target, least_squares, &mut Monitor::silent()).unwrap()
    }

    fn surface(&self) -> Surface<'_> {
        let at = |&[x, y]: &[u32; 2]| {
            Vertex::new(
                [x as i32, y as i32],
                self.field.heights()[y as usize * self.field.columns() + x as usize],
            )
        };
        let mesh = Triangulation::new(self.vertices.iter().map(at).collect(), &self.triangles);
        Surface::new(mesh, Samples::new(&self.field))
    }
}

/// Random starts: noise on a slope, with quads left out, single samples void, and weights, or without.
fn start() -> impl Strategy<Value = Start> {
    let shape = (prop::array::uniform2(1usize..6), 1usize..5, any::<u64>());
    (shape, prop::option::of(0usize..3), prop::option::of(2usize..9), any::<bool>()).prop_map(
        |((quads, step, seed), missing, holes, weighted)| {
            let mut random = SplitMix64::at(seed, 0);
            let mut draw = |below: usize| random.below(below);
            let there: Vec<bool> =
                (0..quads[0] * quads[1]).map(|_| missing.is_none_or(|missing| draw(5) >= missing)).collect();
            let columns = quads[0] * step + 1;
            let noise: Vec<f32> =
                (0..columns * (quads[1] * step + 1)).map(|_| draw(64) as f32 / 8.0).collect();
            let is_there =
                |across: usize, down: usize| (across, down) == (0, 0) || there[down * quads[0] + across];
            let height = |x: usize, y: usize| noise[y * columns + x] + 2.0 * x as f32 - y as f32;
            let mut start = Start::new(quads, step, is_there, holes, height);
            if weighted {
                let weights = noise.iter().map(|noise| (noise - 3.0).max(0.0)).collect();
                start.field = start.field.with_importance(weights).unwrap();
            }
            start
        },
    )
}

/// Twice the area of triangles, which must all be counter-clockwise.
fn covered(vertices: &[[u32; 2]], triangles: &[[u32; 3]]) -> i64 {
    let areas = triangles.iter().map(|triangle| {
        let area = twice_area(triangle.map(|vertex| vertices[vertex as usize].map(|part| part as i32)));
        assert!(area > 0, "{triangle:?} is turned or flat");
        area
    });
    areas.sum()
}

fn greatest_divisor(a: i32, b: i32) -> i32 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}

/// The rim, cut into steps between neighbouring lattice points; edges must be met by at most one other.
fn rim(vertices: &[[u32; 2]], triangles: &[[u32; 3]]) -> HashSet<[Place; 2]> {
    let mut edges = HashSet::new();
    for triangle in triangles {
        for k in 0..3 {
            assert!(edges.insert([triangle[k], triangle[(k + 1) % 3]]), "an edge has three triangles");
        }
    }
    let mut steps = HashSet::new();
    for &[from, to] in edges.iter().filter(|&&[from, to]| !edges.contains(&[to, from])) {
        let [from, to] = [from, to].map(|vertex| vertices[vertex as usize].map(|part| part as i32));
        let along = [to[0] - from[0], to[1] - from[1]];
        let count = greatest_divisor(along[0].abs(), along[1].abs());
        for step in 0..count {
            let at = |step: i32| [0, 1].map(|axis| from[axis] + along[axis] / count * step);
            assert!(steps.insert([at(step), at(step + 1)]));
        }
    }
    steps
}

fn check(start: &Start, tin: &Tin) {
    assert_eq!(covered(&tin.samples, &tin.triangles), covered(&start.vertices, &start.triangles));
    assert_eq!(rim(&tin.samples, &tin.triangles), rim(&start.vertices, &start.triangles));
    assert_eq!(tin.samples.iter().collect::<HashSet<_>>().len(), tin.samples.len());
    let used: HashSet<u32> = tin.triangles.as_flattened().iter().copied().collect();
    assert_eq!((used.len(), tin.heights.len()), (tin.samples.len(), tin.samples.len()));
    assert_eq!(tin.error, measure(&start.field, &tin.samples, &tin.heights, &tin.triangles));
    assert_eq!(tin.error.uncovered, 0);
}

/// Whether two sums of squares are one but for rounding.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + a.abs().max(b.abs()))
}

/// The error of a surface as it is tracked, and as it is measured.
fn errors(start: &Start, surface: &Surface) -> [f64; 2] {
    let tracked = surface.mesh.triangles().map(|triangle| surface.mesh.error(triangle)).sum();
    let (vertices, triangles) = surface.mesh.clone().into_parts();
    let samples: Vec<_> = vertices.iter().map(|vertex| vertex.place.map(|part| part as u32)).collect();
    let heights: Vec<_> = vertices.iter().map(|vertex| vertex.height).collect();
    [tracked, measure(&start.field, &samples, &heights, &triangles).squared]
}

/// What there is to choose from for a vertex, naively: each neighbour to which it may go, with the error then.
fn naive_collapses(start: &Start, vertex: u32) -> Vec<(f64, u32)> {
    let Start { field, vertices, triangles } = start;
    let heights: Vec<f32> =
        vertices.iter().map(|&[x, y]| field.heights()[y as usize * field.columns() + x as usize]).collect();
    let before = measure(field, vertices, &heights, triangles).squared;
    let around = || triangles.iter().filter(|triangle| triangle.contains(&vertex));
    let neighbours: HashSet<u32> = around().flatten().copied().filter(|&other| other != vertex).collect();
    let mut allowed = Vec::new();
    for target in neighbours {
        let renamed =
            triangles.iter().map(|triangle| triangle.map(|name| if name == vertex { target } else { name }));
        let left: Vec<[u32; 3]> = renamed.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        let place = |vertex: u32| vertices[vertex as usize].map(|part| part as i32);
        let is_valid = left.iter().all(|triangle| twice_area(triangle.map(place)) > 0);
        if is_valid
            && covered(vertices, &left) == covered(vertices, triangles)
            && rim(vertices, &left) == rim(vertices, triangles)
        {
            allowed.push((measure(field, vertices, &heights, &left).squared - before, target));
        }
    }
    allowed
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn what_was_covered_is_covered(start in start(), part in 0.0f64..1.2, least_squares: bool) {
        let target = (part * start.vertices.len() as f64) as usize;
        let tin = start.reduce(target, least_squares);
        check(&start, &tin);
        prop_assert!(tin.samples.len() >= target.min(start.vertices.len()));
        if !least_squares {
            for (&[x, y], &height) in tin.samples.iter().zip(&tin.heights) {
                prop_assert_eq!(height, start.field.heights()[y as usize * start.field.columns() + x as usize]);
            }
        }
    }

    /// With as many vertices, an input is never made worse; nor is a result.
    #[test]
    fn nothing_gets_worse(start in start(), part in 0.0f64..1.0) {
        let count = start.vertices.len();
        let [_, before] = errors(&start, &start.surface());
        let free = start.reduce(count, false);
        prop_assert_eq!(free.samples.len(), count);
        prop_assert!(free.error.squared <= before + 1e-9 * (1.0 + before));
        let target = (part * count as f64) as usize;
        let (sampled, fitted) = (start.reduce(target, false), start.reduce(target, true));
        prop_assert!(fitted.error.squared <= sampled.error.squared);
        prop_assert_eq!((fitted.samples, fitted.triangles), (sampled.samples, sampled.triangles));
        let again = Start { field: start.field, vertices: free.samples, triangles: free.triangles };
        let twice = again.reduce(count, false).error.squared;
        prop_assert!(twice <= free.error.squared + 1e-9 * (1.0 + twice));
    }

    #[test]
    fn the_error_that_is_tracked_is_the_one_there_is(start in start(), part in 0.0f64..1.0) {
        let mut surface = start.surface();
        let mut monitor = Monitor::silent();
        let [tracked, measured] = errors(&start, &surface);
        prop_assert!(close(tracked, measured), "{} {}", tracked, measured);
        flips::settle_all(&mut surface, &mut monitor, |part| part).unwrap();
        let [tracked, flipped] = errors(&start, &surface);
        prop_assert!(close(tracked, flipped) && flipped <= measured, "{} {}", tracked, flipped);
        let target = (part * start.vertices.len() as f64) as usize;
        collapses::collapse_to(&mut surface, target, &mut monitor, |part| part).unwrap();
        let [tracked, collapsed] = errors(&start, &surface);
        prop_assert!(close(tracked, collapsed), "{} {}", tracked, collapsed);
        moves::improve(&mut surface, &mut monitor, |part| part).unwrap();
        let [tracked, moved] = errors(&start, &surface);
        prop_assert!(close(tracked, moved) && moved <= collapsed, "{} {} {}", tracked, moved, collapsed);
        // Every edge that changed was looked at again: there is none left that is worth a flip.
        for triangle in surface.mesh.triangles().collect::<Vec<_>>() {
            for corner in 4 * triangle..4 * triangle + 3 {
                prop_assert!(!surface.flip_if_better(corner), "an edge was left");
            }
        }
    }

    #[test]
    fn the_cheapest_collapse_is_the_cheapest(start in start()) {
        let surface = start.surface();
        let mut fan = Fan::default();
        for vertex in 0..start.vertices.len() as u32 {
            surface.mesh.gather(vertex, &mut fan);
            let naive = naive_collapses(&start, vertex);
            match surface.cheapest_collapse(vertex, &fan) {
                Some((cost, target)) => {
                    let least = naive.iter().map(|&(cost, _)| cost).fold(f64::INFINITY, f64::min);
                    prop_assert!(close(cost, least), "{} {}", cost, least);
                    let same = naive.iter().find(|&&(_, name)| name == fan.ring[target]);
                    prop_assert!(same.is_some_and(|&(other, _)| close(cost, other)));
                    let mut after = start.surface();
                    after.collapse(vertex, &fan, target);
                    let [[before, _], [after, measured]] = [errors(&start, &surface), errors(&start, &after)];
                    prop_assert!(close(after, before + cost) && close(after, measured));
                }
                // A vertex where fans meet stays, though one of them alone could do without it.
                None => prop_assert!(naive.is_empty() || is_pinched(&start, vertex)),
            }
        }
    }

    /// No height can be changed to any good, up or down, by little or by much.
    #[test]
    fn fitted_heights_are_the_best(start in start(), part in 0.0f64..1.0) {
        let target = (part * start.vertices.len() as f64) as usize;
        let (sampled, fitted) = (start.reduce(target, false), start.reduce(target, true));
        let least = fitted.error.squared - 2e-5 * (1.0 + sampled.error.squared);
        for vertex in 0..fitted.heights.len() {
            for change in [-1.0, -0.03, 0.03, 1.0] {
                let mut heights = fitted.heights.clone();
                heights[vertex] += change;
                let error = measure(&start.field, &fitted.samples, &heights, &fitted.triangles);
                prop_assert!(error.squared >= least, "{:?} {:?}", error, fitted.error);
            }
        }
    }

    /// However a triangulation is listed, what comes of it is the same, to the bit.
    #[test]
    fn the_order_of_the_input_does_not_matter(start in start(), part in 0.0f64..1.0, seed: u64) {
        let target = (part * start.vertices.len() as f64) as usize;
        let mut random = SplitMix64::at(seed, 0);
        let mut shuffled = |count: usize| {
            let mut order: Vec<usize> = (0..count).collect();
            (1..count).for_each(|last| order.swap(last, random.below(last + 1)));
            order
        };
        let mut other = start.clone();
        let places = shuffled(start.vertices.len());
        places.iter().zip(&start.vertices).for_each(|(&place, &vertex)| other.vertices[place] = vertex);
        for (slot, &triangle) in shuffled(start.triangles.len()).into_iter().zip(&start.triangles) {
            other.triangles[slot] = triangle.map(|vertex| places[vertex as usize] as u32);
            other.triangles[slot].rotate_left(slot % 3);
        }
        prop_assert_eq!(start.reduce(target, true), other.reduce(target, true));
    }

    #[test]
    fn a_plane_keeps_its_corners_only(
        quads in prop::array::uniform2(1usize..6),
        step in 1usize..5,
        slope in prop::array::uniform2(-9i32..9),
        least_squares: bool,
    ) {
        let height = |x: usize, y: usize| (slope[0] * x as i32 + slope[1] * y as i32) as f32;
        // A quarter is missing where there are quads enough: six corners.
        let is_whole = quads[0] == 1 || quads[1] == 1;
        let is_there = |across: usize, down: usize| is_whole || across > 0 || down > 0;
        let start = Start::new(quads, step, is_there, None, height);
        let tin = start.reduce(0, least_squares);
        check(&start, &tin);
        prop_assert_eq!(tin.samples.len(), if is_whole { 4 } else { 6 });
        prop_assert!(tin.error.squared < 1e-12);
    }
}

/// Whether the triangles of a vertex hang together in more than one fan: more neighbours on the rim than two.
fn is_pinched(start: &Start, vertex: u32) -> bool {
    let place = start.vertices[vertex as usize].map(|part| part as i32);
    rim(&start.vertices, &start.triangles).iter().filter(|step| step.contains(&place)).count() > 2
}

/// Hills that are everywhere worth a vertex.
fn hills(quads: usize, step: usize) -> Start {
    let height =
        |x: usize, y: usize| (x as f32 * 0.7).sin() * 9.0 + (y as f32 * 0.45 + x as f32 * 0.2).cos() * 6.0;
    Start::new([quads; 2], step, |_, _| true, None, height)
}

#[test]
fn targets_are_met_exactly() {
    let start = hills(20, 2);
    for target in [300, 120, 50, 10, 4] {
        assert_eq!(start.reduce(target, false).samples.len(), target);
    }
}

/// What the whole is for: far less error than the same number of vertices set regularly.
#[test]
fn a_free_triangulation_is_much_better_than_a_regular_one() {
    let (fine, coarse) = (hills(24, 2), hills(12, 4));
    let [_, regular] = errors(&coarse, &coarse.surface());
    let free = fine.reduce(coarse.vertices.len(), false).error.squared;
    let fitted = fine.reduce(coarse.vertices.len(), true).error.squared;
    assert!(free < 0.2 * regular, "{free} {regular}");
    assert!(fitted < 0.8 * free, "{fitted} {free}");
}

#[test]
fn samples_without_weight_do_not_matter() {
    // A plane with a tower on it that nobody cares for, in a field with a void.
    let is_tower = |x: usize, y: usize| (5..8).contains(&x) && (5..8).contains(&y);
    let height = |x: usize, y: usize| if is_tower(x, y) { 50.0 } else { x as f32 };
    let start = Start::new([8, 8], 2, |across, down| (across, down) != (6, 6), None, height);
    let field = start.field.clone();
    let weights =
        (0..17 * 17).map(|sample| if is_tower(sample % 17, sample / 17) { 0.0 } else { 1.0 }).collect();
    let start = Start { field: field.with_importance(weights).unwrap(), ..start };
    let tin = start.reduce(8, false);
    check(&start, &tin);
    assert_eq!(tin.samples.len(), 8, "four corners of the field and four of the void");
    assert!(tin.error.squared < 1e-12 && tin.error.maximum > 40.0);
}

#[test]
fn heights_as_great_as_they_can_be_are_no_trouble() {
    let height = |x: usize, y: usize| if (x + y).is_multiple_of(2) { f32::MAX } else { -f32::MAX };
    let start = Start::new([6, 6], 2, |_, _| true, None, height);
    let tin = start.reduce(12, true);
    check(&start, &tin);
    assert!(tin.heights.iter().all(|height| height.is_finite()) && tin.error.squared.is_finite());
}

#[test]
fn it_ends_whenever_the_monitor_wishes() {
    let start = hills(12, 2);
    let run = |allowed: usize| {
        let (mut reports, mut last) = (0, 0.0);
        let mut monitor = Monitor::new(|part| {
            assert!((last..=1.0).contains(&part));
            last = part;
            reports += 1;
            if reports > allowed { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let tin = reduce(&start.field, &start.vertices, &start.triangles, 20, true, &mut monitor);
        drop(monitor);
        (tin, reports)
    };
    let (whole, reports) = run(usize::MAX);
    assert_eq!(whole.unwrap(), start.reduce(20, true));
    assert!(reports > 8);
    for allowed in 0..reports {
        assert!(matches!(run(allowed).0, Err(Error::Cancelled(_))));
    }
}
