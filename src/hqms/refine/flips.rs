//! Edges that are turned, where that brings two faces nearer to their samples.
//!
//! After Hoppe, DeRose, Duchamp, McDonald and Stuetzle, *Mesh optimization* (1993), section 4.2.1: an edge
//! swap is judged by the distances of the samples of its two faces alone. Here the vertices stay meanwhile.

use super::facet::Facet;
use super::fit::{Shape, Sums};
use super::is_rounding;
use super::samples::Sample;
use crate::collapse::is_line;
use crate::collapse::surface::{NONE, next_corner, previous_corner};
use crate::workers::Workers;
use glam::Vec3A;
use hashbrown::HashSet;

/// Faces in a block of parallel work.
const BLOCK: usize = 1 << 12;

/// An edge is turned if the squared distances then are smaller than this share of what they were.
const GAIN: f32 = 0.9;

/// The cosine of the largest angle between a new face and an old one (60 degrees).
const TURN: f32 = 0.5;

/// An edge to turn, by one of the two corners opposite to it, and the new faces in place of that corner's and
/// the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flip {
    corner: u32,
    gain: f32,
    pub(super) faces: [u32; 2],
    pub(super) triangles: [[u32; 3]; 2],
    /// What the samples of the two say of them.
    pub(super) sums: [Sums; 2],
}

/// Edges to turn, no two of them at one face. `samples` are in the order of their faces, those of each
/// beginning at its of `starts`; `sums` are what they say. An edge between two vertices that are `fixed`
/// may be a feature, and stays.
pub(super) fn flips(
    shape: Shape,
    samples: &[Sample],
    starts: &[u32],
    sums: &[Sums],
    fixed: &[bool],
    workers: &Workers,
) -> Vec<Flip> {
    let faces = sums.len();
    let mean = sums.iter().map(|sums| f64::from(sums.error)).sum::<f64>() / faces.max(1) as f64;
    let scene = Scene { shape, samples, starts, sums, fixed, least: mean as f32 };
    let of_block = |block: usize| -> Vec<Flip> {
        let faces = (block * BLOCK) as u32..faces.min((block + 1) * BLOCK) as u32;
        faces
            .flat_map(|face| [0, 1, 2].map(|corner| face << 2 | corner))
            .filter_map(|at| scene.flip(at))
            .collect()
    };
    let mut flips = workers.map((0..faces.div_ceil(BLOCK)).collect(), of_block).concat();
    flips.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.corner.cmp(&b.corner)));
    let mut taken = vec![false; faces];
    let mut lost = vec![false; fixed.len()];
    let mut made = HashSet::new();
    flips.retain(|flip| {
        let [[top, from, bottom], [_, to, _]] = flip.triangles;
        let free = flip.faces.iter().all(|&face| !taken[face as usize])
            && !lost[from as usize]
            && !lost[to as usize]
            && made.insert((top.min(bottom), top.max(bottom)));
        if free {
            flip.faces.iter().for_each(|&face| taken[face as usize] = true);
            (lost[from as usize], lost[to as usize]) = (true, true);
        }
        free
    });
    flips
}

struct Scene<'a> {
    shape: Shape<'a>,
    samples: &'a [Sample],
    starts: &'a [u32],
    sums: &'a [Sums],
    fixed: &'a [bool],
    /// Two faces with less error than one has in the mean are left as they are.
    least: f32,
}

impl Scene<'_> {
    /// The flip of the edge opposite to a corner, if it pays.
    fn flip(&self, corner: u32) -> Option<Flip> {
        let surface = self.shape.surface;
        let face = corner >> 2;
        let opposite = self.shape.opposites[face as usize][(corner & 3) as usize];
        // Each edge is looked at from its first face.
        if opposite == NONE || opposite >> 2 <= face {
            return None;
        }
        let faces = [face, opposite >> 2];
        let error: f32 = faces.iter().map(|&face| self.sums[face as usize].error).sum();
        if error.is_nan() || error <= self.least {
            return None;
        }
        let (top, bottom) = (surface.vertex(corner), surface.vertex(opposite));
        let (from, to) = (surface.vertex(next_corner(corner)), surface.vertex(previous_corner(corner)));
        if top == bottom || self.fixed[from as usize] && self.fixed[to as usize] {
            return None;
        }
        let [start, end] = [from, to].map(|vertex| Vec3A::from_vec4(surface.points[vertex as usize]));
        let farthest = faces.map(|face| self.sums[face as usize].farthest);
        if is_rounding(farthest[0].max(farthest[1]), start, start.distance(end)) {
            return None;
        }
        let triangles = [[top, from, bottom], [bottom, to, top]];
        let [first, second] = triangles.map(|triangle| self.facet(triangle));
        let new = [first?, second?];
        let old = [self.shape.facet(faces[0])?, self.shape.facet(faces[1])?];
        if new.iter().any(|new| old.iter().any(|old| new.normal.dot(old.normal) < TURN)) {
            return None;
        }
        let mut sums = [Sums::default(); 2];
        for face in faces {
            let range = self.starts[face as usize] as usize..self.starts[face as usize + 1] as usize;
            for sample in self.samples[range].iter().filter(|sample| faces.contains(&sample.face)) {
                let point = sample.point();
                let feet = new.map(|new| new.nearest(point, new.weights(point)));
                let nearer = usize::from(feet[1].distance_squared < feet[0].distance_squared);
                sums[nearer].add(&feet[nearer], sample.weight);
                let pays = sums[0].error + sums[1].error < GAIN * error;
                if !pays {
                    return None;
                }
            }
        }
        let sum = sums[0].error + sums[1].error;
        // The degree of a vertex stays at least 3, and two vertices are joined by one edge only.
        let degree = |vertex: u32| surface.ring(vertex).count();
        let joined = surface.ring(top).any(|corner| {
            [next_corner(corner), previous_corner(corner)]
                .map(|corner| surface.vertex(corner))
                .contains(&bottom)
        });
        if joined || degree(from) <= 3 || degree(to) <= 3 {
            return None;
        }
        Some(Flip { corner, gain: error - sum, faces, triangles, sums })
    }

    /// A triangle, if it is more than a line.
    fn facet(&self, triangle: [u32; 3]) -> Option<Facet> {
        let [a, b, c] = triangle.map(|vertex| Vec3A::from_vec4(self.shape.surface.points[vertex as usize]));
        let (side, other) = (b - a, c - a);
        let is_thin = is_line(side.cross(other).length_squared(), side, other, other);
        Facet::new([a, b, c]).filter(|_| !is_thin)
    }
}
