//! Vertices go, one after another, to where the samples' heights are least.
//!
//! The sum of the squared heights after the vertices have moved by `x` is, to first order, that of `h - n·Σ
//! b x` over the samples of each face: a quadratic form, whose least is sought by the Gauss-Seidel
//! iteration, vertex by vertex. Each vertex solves three equations, made of the sums of its faces and of
//! how far their other vertices have moved.

use super::anchors::Anchor;
use super::fit::Sums;
use super::{is_rounding, places};
use crate::collapse::is_line;
use crate::collapse::surface::{Surface, neighbours};
use crate::quadric::Quadric;
use crate::workers::Workers;
use glam::{Vec3A, Vec4};

/// Vertices in a block of parallel work: one that has a neighbour outside its block stays until the blocks
/// lie elsewhere.
const BLOCK: usize = 1 << 12;

/// How much a vertex is drawn to where it is, as a share of the trace of its equations: no more than makes
/// them solvable.
const REGULARISATION: f32 = 1e-3;

/// How much area of samples a face should have, in units of its own: what is missing is filled with points
/// of its plane. Few samples, spread unevenly, are else fitted better than the surface that they are of.
const HOLD: f32 = 1.5;

/// How much an anchor weighs, in units of the samples of a vertex. From 0 to 0.05 the largest error falls
/// by a third, and where there are limbs the mean error by a tenth; from there to 0.5 the mean error rises
/// by a tenth.
const ANCHOR: f32 = 0.05;

/// How far a vertex may go: so many times the distance of the farthest sample of its faces, along their
/// normals...
const HEIGHT: f32 = 0.25;
/// ...and this share of its shortest edge.
const REACH: f32 = 0.5;

/// The cosine, squared, of the largest angle that a face may turn by (60 degrees).
const TURN: f32 = 0.25;

/// Tries to move a vertex, each half as far as the one before.
const TRIES: usize = 3;

/// What the vertices of a surface are moved by.
pub(super) struct Descent<'a> {
    /// As it was in the beginning.
    surface: &'a Surface,
    planes: Vec<Plane>,
    anchors: &'a [Anchor],
    fixed: &'a [bool],
    extent: [Vec3A; 2],
}

/// The plane of a face and what its samples say of it.
struct Plane {
    /// Of length 1, or 0 where the face has no area.
    normal: Vec3A,
    sums: Sums,
}

impl<'a> Descent<'a> {
    /// From where the vertices of `surface` are, with the `sums` of its faces; vertices that are `fixed`
    /// stay.
    pub(super) fn new(
        surface: &'a Surface,
        sums: &[Sums],
        anchors: &'a [Anchor],
        fixed: &'a [bool],
        extent: [Vec3A; 2],
        workers: &Workers,
    ) -> Self {
        let planes = workers.list(sums.len(), |face| {
            let [a, b, c] = places(surface, face as u32);
            let cross = (b - a).cross(c - a);
            let mut sums = sums[face];
            let missing = (HOLD * cross.length() / 2.0 - sums.weight).max(0.0);
            // The integrals of the products of barycentric coordinates over a triangle.
            sums.squares.iter_mut().for_each(|square| *square += missing / 6.0);
            sums.products.iter_mut().for_each(|product| *product += missing / 12.0);
            Plane { normal: cross.normalize_or_zero(), sums }
        });
        Self { surface, planes, anchors, fixed, extent }
    }

    /// Moves each vertex in turn, its neighbours staying, if they are in its block. `points` are the
    /// surface's, as they have been moved so far.
    pub(super) fn sweep(&self, points: &mut [Vec4], shifted: bool, workers: &Workers) {
        let (head, body) = points.split_at_mut(if shifted { (BLOCK / 2).min(points.len()) } else { 0 });
        let first = head.len();
        let mut blocks = vec![(0, head)];
        blocks
            .extend(body.chunks_mut(BLOCK).enumerate().map(|(index, block)| (first + index * BLOCK, block)));
        workers.map(blocks, |(first, block)| {
            for index in 0..block.len() {
                let vertex = (first + index) as u32;
                if let Some(place) = self.settle(vertex, first as u32, block) {
                    block[index] = place.extend(block[index].w);
                }
            }
        });
    }

    /// Where a vertex of a block, which begins with the `first`, goes. `None` if it stays.
    fn settle(&self, vertex: u32, first: u32, block: &[Vec4]) -> Option<Vec3A> {
        if self.fixed[vertex as usize] {
            return None;
        }
        let here =
            |vertex: u32| block.get(vertex.wrapping_sub(first) as usize).copied().map(Vec3A::from_vec4);
        let start = |vertex: u32| Vec3A::from_vec4(self.surface.points[vertex as usize]);
        let own = here(vertex)?;
        let offset = own - start(vertex);
        let mut equations = Quadric::default();
        let mut right = Vec3A::ZERO;
        let (mut weight, mut farthest, mut shortest) = (0f32, 0f32, f32::INFINITY);
        for corner in self.surface.ring(vertex) {
            let (next, previous) = neighbours(&self.surface.faces, corner);
            let (to_next, to_previous) = (here(next)?, here(previous)?);
            let Plane { normal, sums } = &self.planes[(corner >> 2) as usize];
            let corner = (corner & 3) as usize;
            let square = sums.squares[corner];
            let moment = sums.moments[corner]
                - square * normal.dot(offset)
                - sums.products[(corner + 2) % 3] * normal.dot(to_next - start(next))
                - sums.products[(corner + 1) % 3] * normal.dot(to_previous - start(previous));
            equations.add_plane(*normal, square);
            right += moment * *normal;
            weight += sums.weight;
            farthest = farthest.max(sums.farthest);
            shortest = shortest.min(start(next).distance_squared(start(vertex)));
        }
        if is_rounding(farthest, own, shortest.sqrt()) {
            return None;
        }
        let anchor = &self.anchors[vertex as usize];
        let weight = ANCHOR / 3.0 * weight;
        equations.add_plane(anchor.normal, weight);
        right += weight * anchor.normal.dot(anchor.point - own) * anchor.normal;
        let step = Vec3A::from(equations.solve(REGULARISATION * equations.trace(), right));
        let normals = self.surface.ring(vertex).map(|corner| self.planes[(corner >> 2) as usize].normal);
        let height = normals.map(|normal| normal.dot(step).abs()).fold(0.0, f32::max);
        let (lowest, nearest) = (HEIGHT * farthest.sqrt(), REACH * shortest.sqrt());
        let mut step = step * (lowest / height).min(nearest / step.length()).min(1.0);
        for _ in 0..TRIES {
            let moved = own + step;
            let place = moved.max(self.extent[0]).min(self.extent[1]);
            if moved.is_finite() && place != own && self.keeps_sides(vertex, place, own, here) {
                return Some(place);
            }
            step *= 0.5;
        }
        None
    }

    /// Whether no face around `vertex` turns away from what it was or becomes a line when the vertex goes
    /// from `own` to `place`.
    fn keeps_sides(
        &self,
        vertex: u32,
        place: Vec3A,
        own: Vec3A,
        here: impl Fn(u32) -> Option<Vec3A>,
    ) -> bool {
        self.surface.ring(vertex).all(|corner| {
            let normal = self.planes[(corner >> 2) as usize].normal;
            let (next, previous) = neighbours(&self.surface.faces, corner);
            let (Some(next), Some(previous)) = (here(next), here(previous)) else { return false };
            let (to_next, to_previous) = (next - place, previous - place);
            let cross = to_next.cross(to_previous);
            let area = cross.length_squared();
            let along = cross.dot(normal);
            normal == Vec3A::ZERO
                || along > 0.0
                    && along * along >= TURN * area
                    && !is_line(area, to_next, to_previous, place - own)
        })
    }
}
