//! A triangulation over the samples, with the squared error of each of its triangles.

use super::residual::Samples;
use super::triangulation::{Fan, Triangulation, Vertex, next};
use crate::rate_distortion::raster::Place;

/// A triangulation that knows its error.
pub(super) struct Surface<'a> {
    pub(super) mesh: Triangulation,
    pub(super) samples: Samples<'a>,
}

/// By which part an error must fall for a change to be made: by more than sums of it may be off, or it would be made
/// and unmade for ever.
const LEAST_GAIN: f64 = 1e-9;

impl<'a> Surface<'a> {
    pub(super) fn new(mesh: Triangulation, samples: Samples<'a>) -> Self {
        let mut surface = Self { mesh, samples };
        (0..surface.mesh.triangle_slots()).for_each(|triangle| surface.update(triangle));
        surface
    }

    fn update(&mut self, triangle: u32) {
        let (corners, rim) = self.mesh.triangle(triangle);
        self.mesh.set_error(triangle, self.samples.squared_error(corners, rim));
    }

    /// By how much the error grows if the vertex of a fan goes to a neighbour, and to which: the one where it
    /// grows least, the first of equals. `None` if the vertex cannot go.
    pub(super) fn cheapest_collapse(&self, vertex: u32, fan: &Fan) -> Option<(f64, usize)> {
        let mut best: Option<(f64, usize)> = None;
        self.mesh.targets(vertex, fan, |target| {
            let limit = best.map_or(f64::INFINITY, |(error, _)| error);
            let mut error = 0.0;
            for spoke in fan.staying(target) {
                let (corners, rim) = self.moved(fan, spoke, target);
                error += self.samples.squared_error(corners, rim);
                if error >= limit {
                    return;
                }
            }
            best = Some((error, target));
        });
        best.map(|(error, target)| (error - self.error_around(fan), target))
    }

    /// The error of the triangles of a fan.
    fn error_around(&self, fan: &Fan) -> f64 {
        fan.spokes.iter().map(|&spoke| self.mesh.error(spoke / 4)).sum()
    }

    /// The triangle that one of a fan becomes when the vertex goes to a neighbour, and which of its edges are on
    /// the rim.
    fn moved(&self, fan: &Fan, spoke: usize, target: usize) -> ([Vertex; 3], [bool; 3]) {
        let vertices = [target, spoke, fan.after(spoke)].map(|index| self.mesh.vertex(fan.ring[index]));
        let is_rim = |spoke: usize| self.mesh.is_rim(next(fan.spokes[spoke]));
        // The new edges are inner ones, but for those to the target's neighbours on the ring, which stood before,
        // and for the one that takes the place of the rim in an open fan.
        let on_rim =
            |from: usize, to: usize| fan.after(from) == to && (from == fan.spokes.len() || is_rim(from));
        (vertices, [on_rim(target, spoke), is_rim(spoke), on_rim(fan.after(spoke), target)])
    }

    /// Lets the vertex of a fan go to a neighbour.
    pub(super) fn collapse(&mut self, vertex: u32, fan: &Fan, target: usize) {
        self.mesh.collapse(vertex, fan, target);
        fan.staying(target).for_each(|spoke| self.update(fan.spokes[spoke] / 4));
    }

    /// The sample next to that of the vertex of a fan to which it had better move: the one where the error over its
    /// triangles is least, the first of equals. `None` if it is best where it is or cannot move. It moves to no
    /// sample of weight 0, which may be void.
    pub(super) fn better_sample(&self, vertex: u32, fan: &Fan) -> Option<Place> {
        if !self.mesh.may_move(vertex, fan) {
            return None;
        }
        let mut limit = self.error_around(fan) * (1.0 - LEAST_GAIN);
        let [column, row] = self.mesh.vertex(vertex).place;
        let mut best = None;
        for (across, down) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
            let place = [column + across, row + down];
            if !self.mesh.sees(place, fan, 0..fan.spokes.len()) || self.samples.at(place).1 == 0.0 {
                continue;
            }
            let moved = Vertex::new(place, self.samples.height(place));
            let mut error = 0.0;
            for (spoke, &corner) in fan.spokes.iter().enumerate() {
                let [from, to] = fan.edge(spoke).map(|name| self.mesh.vertex(name));
                let rim = [false, self.mesh.is_rim(next(corner)), false];
                error += self.samples.squared_error([moved, from, to], rim);
                if error >= limit {
                    break;
                }
            }
            if error < limit {
                (limit, best) = (error, Some(place));
            }
        }
        best
    }

    /// Moves the vertex of a fan to another sample.
    pub(super) fn move_to(&mut self, vertex: u32, fan: &Fan, place: Place) {
        self.mesh.move_to(vertex, place, self.samples.height(place));
        fan.spokes.iter().for_each(|spoke| self.update(spoke / 4));
    }

    /// Flips an edge if that makes the error less; says whether it did.
    pub(super) fn flip_if_better(&mut self, corner: u32) -> bool {
        let Some(twin) = self.mesh.twin(corner) else { return false };
        let (one, other) = (corner / 4, twin / 4);
        let limit = (self.mesh.error(one) + self.mesh.error(other)) * (1.0 - LEAST_GAIN);
        if limit <= 0.0 {
            return false;
        }
        let Some(quad) = self.mesh.quad(corner) else { return false };
        let [a, b, c, d] = quad.map(|vertex| self.mesh.vertex(vertex));
        let [ab, bc, cd, da] = self.mesh.quad_edges(corner).map(|edge| self.mesh.is_rim(edge));
        let first = self.samples.squared_error([a, c, d], [false, cd, da]);
        if first >= limit {
            return false;
        }
        let second = self.samples.squared_error([a, b, c], [ab, bc, false]);
        if first + second >= limit {
            return false;
        }
        self.mesh.flip(corner);
        self.mesh.set_error(one, first);
        self.mesh.set_error(other, second);
        true
    }
}
