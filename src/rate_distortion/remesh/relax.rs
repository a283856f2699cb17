//! The vertices of a subdivision on the surface, spread evenly over it.
//!
//! Vertices move, on the surface, to the centre of the squares around them, by area, so that large squares shrink and
//! small ones grow; but never so that a triangle folds over that did not, or that narrow ones become narrower.

use glam::DVec3;

use super::super::semi_regular::{Forest, Spot};
use super::chart::{Chart, Foot};
use super::quads::BaseQuads;

/// Triangles may become as narrow as this: the area of the parallelogram over the sum of the squared sides, 0.25 for
/// half of a square.
const NARROW: f64 = 0.12;

/// How far vertices go of the way that they would: all of it, or if that is too far, less.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// The vertices of a subdivision on a chart, as far as it has gone.
pub(super) struct Subdivision<'a> {
    forest: &'a Forest,
    /// Where each corner of the complex is in the quads that have it.
    corners: Vec<Vec<Spot>>,
    pub(super) feet: Vec<Foot>,
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
}

impl<'a> Subdivision<'a> {
    /// With each vertex where it is in its quad of the base.
    pub(super) fn new(forest: &'a Forest, base: &BaseQuads) -> Self {
        let side = forest.side();
        let mut corners = vec![Vec::new(); base.corners];
        for (quad, names) in (0..).zip(forest.complex().quads()) {
            for (&corner, place) in names.iter().zip([[0, 0], [side, 0], [side, side], [0, side]]) {
                corners[corner as usize].push(Spot { quad, place });
            }
        }
        let spots = corners.iter().map(|spots| spots[0]);
        let spots = spots.chain((base.corners..forest.vertices()).map(|vertex| forest.spot(vertex)));
        let feet = spots.map(|Spot { quad, place }| base.foot(quad, place, side)).collect();
        Self { forest, corners, feet, points: Vec::new(), normals: Vec::new() }
    }

    /// Looks up where the feet are, after the chart has changed.
    pub(super) fn locate(&mut self, chart: &Chart) {
        self.points = self.feet.iter().map(|foot| chart.point(foot)).collect();
        self.normals = self.feet.iter().map(|foot| chart.normal(foot.face).normalize_or_zero()).collect();
    }

    /// Moves each vertex once.
    pub(super) fn relax(&mut self, chart: &Chart) {
        let mut squares = Vec::new();
        for vertex in 0..self.points.len() {
            let is_open = self.squares_around(vertex, &mut squares);
            let worst = self.worst(self.points[vertex], self.normals[vertex], &squares);
            let Some(goal) = self.goal(vertex, &squares, is_open) else { continue };
            for part in PARTS {
                let goal = self.points[vertex].lerp(goal, part);
                let foot = match is_open {
                    true => chart.walk_on_border(&self.feet[vertex], goal),
                    false => chart.walk(&self.feet[vertex], goal),
                };
                let (point, normal) = (chart.point(&foot), chart.normal(foot.face).normalize_or_zero());
                if self.worst(point, normal, &squares) >= worst.min(NARROW) {
                    self.feet[vertex] = foot;
                    (self.points[vertex], self.normals[vertex]) = (point, normal);
                    break;
                }
            }
        }
    }

    /// Where a vertex would go: the centre of the squares around it, by area; on a border, of the edges.
    fn goal(&self, vertex: usize, squares: &[[usize; 3]], is_open: bool) -> Option<DVec3> {
        let here = self.points[vertex];
        let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
        if is_open {
            // Corners of the complex on a border keep its shape.
            if vertex < self.corners.len() {
                return None;
            }
            for &[before, _, after] in squares {
                let is_inner =
                    |other: usize| squares.iter().filter(|square| square.contains(&other)).count() > 1;
                for end in [before, after].into_iter().filter(|&end| !is_inner(end)) {
                    let length = self.points[end].distance(here);
                    sum += (self.points[end] + here) * (0.5 * length);
                    weight += length;
                }
            }
        } else {
            for &square in squares {
                let [a, b, c] = square.map(|other| self.points[other]);
                for [first, second] in [[a, b], [b, c]] {
                    let area = (first - here).cross(second - here).length();
                    sum += (here + first + second) * (area / 3.0);
                    weight += area;
                }
            }
        }
        (weight > 0.0).then(|| sum / weight)
    }

    /// How well the narrowest triangle of the squares around a vertex stands, were the vertex at `point`: negative if
    /// one is folded over.
    fn worst(&self, point: DVec3, normal: DVec3, squares: &[[usize; 3]]) -> f64 {
        let mut worst = f64::INFINITY;
        for &square in squares {
            let [a, b, c] = square.map(|other| (self.points[other], self.normals[other]));
            for (first, second) in [(a, b), (b, c), (a, c)] {
                let (to_first, to_second) = (first.0 - point, second.0 - point);
                let up = (normal + first.1 + second.1).normalize_or_zero();
                let sides = to_first.length_squared()
                    + to_second.length_squared()
                    + first.0.distance_squared(second.0);
                worst = worst.min(to_first.cross(to_second).dot(up) / sides.max(f64::MIN_POSITIVE));
            }
        }
        worst
    }

    /// The other vertices of the squares around a vertex, counter-clockwise each; and whether it is on a border.
    fn squares_around(&self, vertex: usize, squares: &mut Vec<[usize; 3]>) -> bool {
        squares.clear();
        if vertex < self.corners.len() {
            let spots = &self.corners[vertex];
            spots.iter().for_each(|&spot| self.squares_in_quad(spot, squares));
            // In a closed fan each side is one of two squares.
            return squares.iter().any(|&[first, _, _]| squares.iter().all(|&[_, _, last]| last != first));
        }
        let triangles = self.forest.split(vertex);
        let spot = self.forest.spot(vertex);
        self.squares_in_quad(spot, squares);
        if let [_, Some((quad, triangle))] = triangles
            && quad != spot.quad
        {
            let place = [0, 1].map(|axis| (triangle.from[axis] + triangle.to[axis]) / 2);
            self.squares_in_quad(Spot { quad, place }, squares);
        }
        triangles[1].is_none()
    }

    fn squares_in_quad(&self, Spot { quad, place }: Spot, squares: &mut Vec<[usize; 3]>) {
        let side = self.forest.side();
        let at = |across: i32, up: i32| {
            let place = [place[0].checked_add_signed(across)?, place[1].checked_add_signed(up)?];
            place.iter().all(|&at| at <= side).then(|| self.forest.vertex(Spot { quad, place }))
        };
        for [first, last] in [[[1, 0], [0, 1]], [[0, 1], [-1, 0]], [[-1, 0], [0, -1]], [[0, -1], [1, 0]]] {
            let beyond = at(first[0] + last[0], first[1] + last[1]);
            if let (Some(first), Some(beyond), Some(last)) =
                (at(first[0], first[1]), beyond, at(last[0], last[1]))
            {
                squares.push([first, beyond, last]);
            }
        }
    }

    /// How many triangles of the squares face away from the surface at their corners.
    pub(super) fn folded(&self) -> usize {
        let mut folded = 0;
        self.forest.visit_triangles(
            |_| true,
            |corners| {
                let [a, b, c] = corners.map(|vertex| self.points[vertex]);
                let up: DVec3 = corners.iter().map(|&vertex| self.normals[vertex]).sum();
                folded += usize::from((b - a).cross(c - a).dot(up) <= 0.0);
            },
        );
        folded
    }

    /// The positions of the vertices.
    pub(super) fn positions(&self) -> Vec<[f32; 3]> {
        self.points.iter().map(|point| point.as_vec3().to_array()).collect()
    }
}
