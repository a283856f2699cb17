//! Quads from the triangles of a base mesh.
//!
//! Triangles are paired where two make a good quad, best pairs first. What is left over has three corners, so all
//! are cut once more, from their middle to the middles of their sides: a pair into four quads, a triangle into three.
//! Their diagonals run from a middle to a corner, so that no two of them can be the same edge.

use glam::DVec3;
use hashbrown::HashMap;

use super::chart::{Chart, Foot};

/// Pairs that score less stay triangles: those bent by a right angle or more, unless they are nearly rectangles.
const LEAST_SCORE: f64 = -0.9;

/// Quads over a chart, each half of which lies in a face.
pub(super) struct BaseQuads {
    pub(super) corners: usize,
    pub(super) quads: Vec<[u32; 4]>,
    /// For each quad the half of its first three corners and that of its third, fourth and first.
    halves: Vec<[HalfQuad; 2]>,
}

/// A face, and its weights at three corners of a quad.
struct HalfQuad {
    face: u32,
    weights: [[f64; 3]; 3],
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
        let mut quads = Self { corners: 0, quads: Vec::new(), halves: Vec::new() };
        let mut names = HashMap::new();
        for (face, corners) in chart.faces() {
            match paired.get(&face) {
                None => {
                    quads.star(chart, &mut names, &corners.map(|corner| (corner, face)), &corners);
                }
                // The pair is done with its first face.
                Some(&(_, first)) if first != face => {}
                Some(&([from, to], _)) => {
                    let other = sides[&[to, from]];
                    let across = |face: u32| {
                        let apex =
                            chart.names(face).into_iter().find(|corner| *corner != from && *corner != to);
                        (apex.unwrap_or(from), face)
                    };
                    let polygon = [(from, other), across(other), (to, face), across(face)];
                    quads.star(chart, &mut names, &polygon, &[from, to]);
                }
            }
        }
        quads
    }

    /// The quads around the middle of `middle` in a polygon; with each of its vertices comes the face at the side that
    /// follows.
    fn star(
        &mut self,
        chart: &Chart,
        names: &mut HashMap<[u32; 2], u32>,
        polygon: &[(u32, u32)],
        middle: &[u32],
    ) {
        let centre = self.corner();
        let count = polygon.len();
        // A vertex goes by the side from itself to itself.
        let sides: Vec<[u32; 2]> = (0..count).map(|i| [polygon[i].0, polygon[(i + 1) % count].0]).collect();
        let mut name = |[a, b]: [u32; 2]| *names.entry([a.min(b), a.max(b)]).or_insert_with(|| self.corner());
        let corners: Vec<[u32; 2]> = sides.iter().map(|&side| [name([side[0]; 2]), name(side)]).collect();
        for i in 0..count {
            let before = (i + count - 1) % count;
            self.quads.push([corners[i][0], corners[i][1], centre, corners[before][1]]);
            let (vertex, face) = polygon[i];
            let face_before = polygon[before].1;
            let half = |face, parts: [&[u32]; 3]| HalfQuad {
                face,
                weights: parts.map(|part| middle_of(chart, face, part)),
            };
            self.halves.push([
                half(face, [&[vertex], &sides[i], middle]),
                half(face_before, [middle, &sides[before], &[vertex]]),
            ]);
        }
    }

    fn corner(&mut self) -> u32 {
        self.corners += 1;
        self.corners as u32 - 1
    }

    /// The point at a place in a quad, whose sides are `side` long.
    pub(super) fn foot(&self, quad: u32, [x, y]: [u32; 2], side: u32) -> Foot {
        let [lower, upper] = &self.halves[quad as usize];
        let part = |length: u32| f64::from(length) / f64::from(side);
        let (half, parts) = match x >= y {
            true => (lower, [part(side - x), part(x - y), part(y)]),
            false => (upper, [part(x), part(y - x), part(side - y)]),
        };
        let weight = |corner: usize| (0..3).map(|k| parts[k] * half.weights[k][corner]).sum();
        Foot { face: half.face, weights: [weight(0), weight(1), weight(2)] }
    }
}

/// The weights of the middle of some of the vertices of a face.
fn middle_of(chart: &Chart, face: u32, vertices: &[u32]) -> [f64; 3] {
    chart.names(face).map(|name| f64::from(u8::from(vertices.contains(&name))) / vertices.len() as f64)
}

/// For each face of a pair the side of the one of lower number along which it is paired.
fn pairs(chart: &Chart, sides: &HashMap<[u32; 2], u32>) -> HashMap<u32, Side> {
    let mut candidates = Vec::new();
    for (face, [a, b, c]) in chart.faces() {
        for (from, to, apex) in [(a, b, c), (b, c, a), (c, a, b)] {
            let Some(&other) = sides.get(&[to, from]) else { continue };
            let opposite = chart.names(other).into_iter().find(|&corner| corner != from && corner != to);
            let Some(opposite) = opposite.filter(|&opposite| face < other && opposite != apex) else {
                continue;
            };
            let normals = chart.normal(face).angle_between(chart.normal(other)).cos();
            let score = normals - sharpest([from, opposite, to, apex].map(|vertex| chart.position(vertex)));
            if score > LEAST_SCORE {
                candidates.push((score, ([from, to], face), other));
            }
        }
    }
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
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
    let cosine =
        |i: usize| (quad[(i + 1) % 4] - quad[i]).angle_between(quad[(i + 3) % 4] - quad[i]).cos().abs();
    (0..4).map(cosine).fold(0.0, f64::max)
}
