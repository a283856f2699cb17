//! How well a surface fits the samples.

use super::facet::{Facet, Foot};
use super::places;
use super::samples::Sample;
use crate::collapse::surface::{NONE, Surface};
use crate::workers::Workers;
use glam::Vec3A;

/// Samples in a block of parallel work.
const BLOCK: usize = 1 << 13;

/// The most faces that the search for the nearest one goes over.
const STEPS: usize = 16;

/// A face is the nearest for all we know if its distance, squared, is less than this share of that of the
/// vertex at which the search began.
const CLOSE: f32 = 0.01;

/// What the samples of a face say of it, each having a weight `w`, a height `h` above the face's plane and
/// a foot of which `b` are the weights of the corners.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    /// The sums of `w b b`: of each corner with itself, and of the two at the side opposite to each.
    pub(super) squares: [f32; 3],
    pub(super) products: [f32; 3],
    /// The sums of `w b h`.
    pub(super) moments: [f32; 3],
    /// The sum of `w`.
    pub(super) weight: f32,
    /// The sum of `w` times the squared distance.
    pub(super) error: f32,
    /// The largest squared distance.
    pub(super) farthest: f32,
}

impl Sums {
    #[inline(always)]
    pub(super) fn add(&mut self, foot: &Foot, weight: f32) {
        let [a, b, c] = foot.weights;
        let [x, y, z] = foot.weights.map(|share| share * weight);
        self.squares[0] += x * a;
        self.squares[1] += y * b;
        self.squares[2] += z * c;
        self.products[0] += y * c;
        self.products[1] += z * a;
        self.products[2] += x * b;
        self.moments[0] += x * foot.height;
        self.moments[1] += y * foot.height;
        self.moments[2] += z * foot.height;
        self.weight += weight;
        self.error += weight * foot.distance_squared;
        self.farthest = self.farthest.max(foot.distance_squared);
    }

    fn join(&mut self, other: &Self) {
        for corner in 0..3 {
            self.squares[corner] += other.squares[corner];
            self.products[corner] += other.products[corner];
            self.moments[corner] += other.moments[corner];
        }
        self.weight += other.weight;
        self.error += other.error;
        self.farthest = self.farthest.max(other.farthest);
    }
}

/// A surface to which samples are brought, and what lies across the sides of its faces.
#[derive(Clone, Copy)]
pub(super) struct Shape<'a> {
    pub(super) surface: &'a Surface,
    pub(super) opposites: &'a [[u32; 3]],
}

/// The nearest face that was found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    pub(super) face: u32,
    facet: Facet,
    foot: Foot,
}

impl Shape<'_> {
    /// A face as a triangle; `None` if it has no area.
    #[inline(always)]
    pub(super) fn facet(&self, face: u32) -> Option<Facet> {
        Facet::new(places(self.surface, face))
    }

    /// Brings each of the `samples` to the nearest face, from the one where it was; for each face what its
    /// samples say.
    pub(super) fn fit(&self, samples: &mut [Sample], workers: &Workers) -> Vec<Sums> {
        let of_block = |block: &mut [Sample]| {
            let mut runs: Vec<(u32, Sums)> = Vec::with_capacity(block.len() / 2);
            let mut last = (NONE, None);
            for sample in block {
                let point = sample.point();
                if last.0 != sample.face {
                    last = (sample.face, self.facet(sample.face));
                }
                let Some(facet) = last.1 else { continue };
                let Nearest { face, foot, .. } = self.descend(point, sample.face, facet);
                sample.face = face;
                match runs.last_mut() {
                    Some((last, sums)) if *last == face => sums.add(&foot, sample.weight),
                    _ => {
                        let mut sums = Sums::default();
                        sums.add(&foot, sample.weight);
                        runs.push((face, sums));
                    }
                }
            }
            runs
        };
        let runs = workers.map(samples.chunks_mut(BLOCK).collect(), of_block);
        let mut sums = vec![Sums::default(); self.surface.faces.len()];
        runs.iter().flatten().for_each(|(face, run)| sums[*face as usize].join(run));
        sums
    }

    /// The face nearest to `point` that is found from those around `vertex`, or from the `last` one if that
    /// is one of these. `None` if none has an area.
    pub(super) fn find(&self, point: Vec3A, vertex: u32, last: Option<Nearest>) -> Option<Nearest> {
        let faces = || self.surface.ring(vertex).map(|corner| corner >> 2);
        let from = |face: u32| Some((face, self.facet(face)?));
        let near = last.filter(|last| self.surface.corners(last.face).contains(&vertex));
        let first = match near {
            Some(last) => Some((last.face, last.facet)),
            None => faces().find_map(from),
        };
        let search = |(face, facet): (u32, Facet)| {
            let (face, facet) = self.walk(point, face, facet);
            self.descend(point, face, facet)
        };
        let mut best = search(first?);
        let distance_squared = point.distance_squared(Vec3A::from_vec4(self.surface.points[vertex as usize]));
        if best.foot.distance_squared > CLOSE * distance_squared {
            for found in faces().filter_map(from).map(search) {
                if found.foot.distance_squared < best.foot.distance_squared {
                    best = found;
                }
            }
        }
        Some(best)
    }

    /// From a face across the side beyond which the foot of `point` lies farthest out, until it lies
    /// inside, or beyond a side from both of its faces.
    #[inline(always)]
    fn walk(&self, point: Vec3A, face: u32, facet: Facet) -> (u32, Facet) {
        let mut current = (face, facet);
        let mut previous = face;
        for _ in 0..STEPS {
            let weights = current.1.weights(point);
            let opposites = self.opposites[current.0 as usize];
            let beyond = (0..3).filter(|&side| weights[side] < 0.0 && opposites[side] != NONE);
            let Some(side) = beyond.min_by(|&a, &b| weights[a].total_cmp(&weights[b])) else { break };
            let next = opposites[side] >> 2;
            let Some(facet) = self.facet(next).filter(|_| next != previous) else { break };
            previous = current.0;
            current = (next, facet);
        }
        current
    }

    /// From a face to neighbours that are nearer to `point`, and on, while there are any.
    #[inline(always)]
    fn descend(&self, point: Vec3A, face: u32, facet: Facet) -> Nearest {
        let weights = facet.weights(point);
        if facet.doubtful(point, weights) == [false; 3] {
            return Nearest { face, facet, foot: facet.inside(point, weights) };
        }
        self.descend_from(point, Nearest { face, facet, foot: facet.nearest(point, weights) })
    }

    fn descend_from(&self, point: Vec3A, start: Nearest) -> Nearest {
        let mut best = start;
        for _ in 0..STEPS {
            let Nearest { face, facet, foot } = best;
            let mut look = |face: u32| {
                let Some(facet) = self.facet(face) else { return };
                let foot = facet.nearest(point, facet.weights(point));
                if foot.distance_squared < best.foot.distance_squared {
                    best = Nearest { face, facet, foot };
                }
            };
            // A corner is as near on all of its faces: the nearer one may be any.
            if let Some(corner) = foot.weights.iter().position(|&weight| weight == 1.0) {
                self.surface.ring(self.surface.corners(face)[corner]).for_each(|corner| look(corner >> 2));
            } else {
                let doubtful = facet.doubtful(point, facet.weights(point));
                let across = doubtful.into_iter().zip(self.opposites[face as usize]);
                across
                    .filter(|&(doubtful, corner)| doubtful && corner != NONE)
                    .for_each(|(_, corner)| look(corner >> 2));
            }
            if best.face == face {
                break;
            }
        }
        best
    }
}
