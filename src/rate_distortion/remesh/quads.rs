//! Quads from the triangles of a base mesh.
//!
//! Triangles are paired where two make a good quad, best pairs first. What is left over has three corners, so all
//! are cut once more, from their middle to the middles of their sides: a pair into four quads, a triangle into three.
//! Their diagonals run from a middle to a corner, so that no two of them can be the same edge.

use std::cmp::Reverse;

use glam::DVec3;
use hashbrown::HashMap;

use super::chart::{Chart, Foot};

/// Pairs that score less stay triangles: bent by a right angle, or with a side nearly straight on.
const LEAST_SCORE: f64 = -0.9;

/// Quads over a chart, and where each of their corners is on it.
pub(super) struct BaseQuads {
    pub(super) quads: Vec<[u32; 4]>,
    pub(super) feet: Vec<Foot>,
}

/// A side of a face: from one vertex to the next, and the face.
type Side = ([u32; 2], u32);

impl BaseQuads {
    /// The quads of the faces that a chart has at the moment.
    pub(super) fn new(chart: &Chart) -> Self {
        let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
        for (face, [a, b, c]) in chart.faces() {
            sides.extend([([a, b], face), ([b, c], face), ([c, a], face)]);
        }
        let paired = pairs(chart, &sides);
        let mut quads = Self { quads: Vec::new(), feet: Vec::new() };
        let mut names = HashMap::new();
        for (face, corners) in chart.faces() {
            match paired.get(&face) {
                None => {
                    let middle = Foot { face, weights: [1.0 / 3.0; 3] };
                    quads.star(chart, &mut names, &corners.map(|corner| (corner, face)), middle);
                }
                // The pair is done with its first face.
                Some(&(_, first)) if first != face => {}
                Some(&([from, to], _)) => {
                    let other = sides[&[to, from]];
                    let across = |face: u32| {
                        let apex = chart.names(face).into_iter().find(|corner| *corner != from && *corner != to);
                        (apex.unwrap_or(from), face)
                    };
                    let polygon = [(from, other), across(other), (to, face), across(face)];
                    quads.star(chart, &mut names, &polygon, between(chart, face, [from, to]));
                }
            }
        }
        quads
    }

    /// The quads around `middle` of a polygon; with each of its vertices comes the face at the side that follows.
    fn star(
        &mut self,
        chart: &Chart,
        names: &mut HashMap<[u32; 2], u32>,
        polygon: &[(u32, u32)],
        middle: Foot,
    ) {
        let centre = self.corner(middle);
        let count = polygon.len();
        let corners: Vec<[u32; 2]> = (0..count)
            .map(|i| {
                let ((vertex, face), (next, _)) = (polygon[i], polygon[(i + 1) % count]);
                let side = [vertex.min(next), vertex.max(next)];
                // A vertex goes by the side from itself to itself.
                let mut named = |key: [u32; 2]| {
                    *names.entry(key).or_insert_with(|| self.corner(between(chart, face, key)))
                };
                [named([vertex; 2]), named(side)]
            })
            .collect();
        for i in 0..count {
            let [corner, side] = corners[i];
            let [_, side_before] = corners[(i + count - 1) % count];
            self.quads.push([corner, side, centre, side_before]);
        }
    }

    fn corner(&mut self, foot: Foot) -> u32 {
        self.feet.push(foot);
        self.feet.len() as u32 - 1
    }
}

/// The middle of a side of a face.
fn between(chart: &Chart, face: u32, ends: [u32; 2]) -> Foot {
    let half = |vertex: u32| 0.5 * ends.iter().filter(|&&end| end == vertex).count() as f64;
    Foot { face, weights: chart.names(face).map(half) }
}

/// For each face of a pair the side of the one of lower number along which it is paired.
fn pairs(chart: &Chart, sides: &HashMap<[u32; 2], u32>) -> HashMap<u32, Side> {
    let mut candidates = Vec::new();
    for (face, [a, b, c]) in chart.faces() {
        for (from, to, apex) in [(a, b, c), (b, c, a), (c, a, b)] {
            let Some(&other) = sides.get(&[to, from]) else { continue };
            let opposite = chart.names(other).into_iter().find(|&corner| corner != from && corner != to);
            let Some(opposite) = opposite.filter(|&opposite| face < other && opposite != apex) else { continue };
            let normals = chart.normal(face).angle_between(chart.normal(other)).cos();
            let score = normals - sharpest([from, opposite, to, apex].map(|vertex| chart.position(vertex)));
            if score > LEAST_SCORE {
                candidates.push((score, ([from, to], face), other));
            }
        }
    }
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then(Reverse(b.1).cmp(&Reverse(a.1))));
    let mut paired = HashMap::new();
    for (_, side, other) in candidates {
        if !paired.contains_key(&side.1) && !paired.contains_key(&other) {
            paired.insert(side.1, side);
            paired.insert(other, side);
        }
    }
    paired
}

/// The largest cosine, in size, of an angle of a quad: 0 for a rectangle.
fn sharpest(quad: [DVec3; 4]) -> f64 {
    let cosine = |i: usize| (quad[(i + 1) % 4] - quad[i]).angle_between(quad[(i + 3) % 4] - quad[i]).cos().abs();
    (0..4).map(cosine).fold(0.0, f64::max)
}
