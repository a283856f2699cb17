//! Parts of the triangles of one surface, and how far no point of them is from another surface.
//!
//! The distance to a convex set is a convex function. So over a triangle the distance to *one* triangle of
//! the other surface is nowhere larger than at a corner, and that is at least the distance to the other
//! surface: the largest of the corners' distances to any one triangle bounds a part from above. Parts whose
//! bound is too far above are cut: where the prisms over the other surface's triangles end, so that a flat part
//! that is only meshed anew is done once it is cut along the new edges (the idea of Tang, Lee and Kim,
//! "Interactive Hausdorff Distance Computation for General Polygonal Models", 2009), and in the middle of the
//! longest edge.

use std::ops::Range;

use glam::DVec3;

use super::surface::Surface;
use super::triangle;
use crate::workers::Workers;

/// Vertices or triangles that one worker takes in one go.
const BLOCK: usize = 1024;

/// What `f64` may have rounded away, as a share of the largest coordinate: a cut moves a corner by 2⁻⁵²,
/// and a piece is cut some dozens of times.
pub(super) const ROUNDING: f64 = 1.0 / (1u64 << 42) as f64;

/// Cuts along prisms in a row. A piece then is halved, so that all pieces become small in the end.
const MOST_PRISM_CUTS: u8 = 3;

/// A corner closer to a plane than this share of the piece's size lies on it.
const ON_PLANE: f64 = 1e-9;

/// From the points of one surface to the nearest of the other.
#[derive(Clone, Copy)]
pub(super) struct Direction<'a> {
    pub(super) from: &'a Surface<'a>,
    pub(super) to: &'a Surface<'a>,
}

/// A point, and the triangle of the other surface that is nearest to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) point: DVec3,
    pub(super) nearest: u32,
}

/// A part of a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub(super) corners: [Corner; 3],
    /// No point of it is farther from the other surface, squared.
    pub(super) upper: f64,
    pub(super) prism_cuts: u8,
}

/// What looking at parts of a surface came to; distances are squared.
#[derive(Default)]
pub(super) struct Found {
    /// The largest distance of a point.
    pub(super) lower: f64,
    /// The largest bound of the parts that are done.
    pub(super) settled: f64,
    /// The others, and the triangles nearest to their centroids.
    pub(super) open: Vec<(Part, u32)>,
    /// How many parts were looked at.
    pub(super) parts: usize,
}

impl Direction<'_> {
    /// For each vertex that a triangle uses the nearest triangle, and the largest distance, squared.
    pub(super) fn nearest_of_vertices(&self, workers: &Workers) -> (Vec<u32>, f64) {
        let mut used = vec![false; self.from.vertex_count()];
        for &vertex in self.from.triangles().as_flattened() {
            used[vertex as usize] = true;
        }
        let of_blocks = workers.map(blocks(used.len()), |block| {
            let (mut guess, mut farthest) = (0, 0f64);
            let nearest: Vec<u32> = block
                .map(|vertex| {
                    if used[vertex] {
                        let nearest = self.to.nearest(self.from.position(vertex as u32), guess, 0.0);
                        farthest = farthest.max(nearest.squared);
                        guess = nearest.triangle;
                    }
                    guess
                })
                .collect();
            (nearest, farthest)
        });
        let farthest = of_blocks.iter().map(|(_, farthest)| *farthest).fold(0.0, f64::max);
        (of_blocks.into_iter().flat_map(|(nearest, _)| nearest).collect(), farthest)
    }

    /// Bounds `part`, by what its corners are nearest to and, if that is not `enough`, its centroid.
    pub(super) fn look_at(&self, mut part: Part, enough: f64, found: &mut Found) {
        found.parts += 1;
        let corners = part.corners.map(|corner| corner.point);
        let [a, b, c] = part.corners.map(|corner| corner.nearest);
        part.upper = part.upper.min(self.farthest_squared(corners, a));
        for other in [b, c] {
            if part.upper > enough && other != a {
                part.upper = part.upper.min(self.farthest_squared(corners, other));
            }
        }
        if part.upper > enough {
            let nearest = self.to.nearest((corners[0] + corners[1] + corners[2]) / 3.0, a, 0.0);
            found.lower = found.lower.max(nearest.squared);
            part.upper = part.upper.min(self.farthest_squared(corners, nearest.triangle));
            if part.upper > enough {
                found.open.push((part, nearest.triangle));
                return;
            }
        }
        found.settled = found.settled.max(part.upper);
    }

    /// No point of the part with these corners is farther from `triangle` than this, squared.
    ///
    /// Measured to points *of* the triangle, of which whatever mixes the corners has one at hand that is
    /// mixed alike: a needle whose nearest point is not quite found still gives a bound.
    fn farthest_squared(&self, corners: [DVec3; 3], triangle: u32) -> f64 {
        let triangle = self.to.corners(triangle);
        let squared = |corner: DVec3| corner.distance_squared(triangle::nearest_point(corner, triangle));
        corners.map(squared).into_iter().fold(0.0, f64::max)
    }

    /// Cuts `part`, whose centroid is nearest to the triangle `middle`, and looks at what it falls into.
    pub(super) fn cut(&self, (part, middle): (Part, u32), enough: f64, found: &mut Found) {
        let points = part.corners.map(|corner| corner.point);
        let along_prism = || Cut::along_prism(points, self.to.corners(middle));
        let (cut, prism_cuts) = match along_prism().filter(|_| part.prism_cuts < MOST_PRISM_CUTS) {
            Some(cut) => (cut, part.prism_cuts + 1),
            None => (Cut::in_half(points), 0),
        };
        let mut on_edge = |from: Corner, to: Corner, at: f64| {
            let point = from.point.lerp(to.point, at);
            let nearest = self.to.nearest(point, middle, 0.0);
            found.lower = found.lower.max(nearest.squared);
            Corner { point, nearest: nearest.triangle }
        };
        let corners_from = |first: usize| [0, 1, 2].map(|step| part.corners[(first + step) % 3]);
        let look_at = |corners, found: &mut Found| {
            self.look_at(Part { corners, prism_cuts, ..part }, enough, found);
        };
        match cut {
            Cut::Through { apex, at } => {
                let [a, b, c] = corners_from(apex);
                let middle = on_edge(b, c, at);
                look_at([a, b, middle], found);
                look_at([a, middle, c], found);
            }
            Cut::Off { corner, at } => {
                let [a, b, c] = corners_from(corner);
                let [beside_b, beside_c] = [on_edge(a, b, at[0]), on_edge(a, c, at[1])];
                look_at([a, beside_b, beside_c], found);
                look_at([beside_b, b, c], found);
                look_at([beside_b, c, beside_c], found);
            }
        }
    }
}

/// How a triangle is cut in two or three.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Cut {
    /// From a corner to the opposite edge, at this share of it.
    Through { apex: usize, at: f64 },
    /// Across the edges from a corner to the next one and to the one after, at these shares of them.
    Off { corner: usize, at: [f64; 2] },
}

impl Cut {
    /// In the middle of the longest edge.
    fn in_half(corners: [DVec3; 3]) -> Self {
        let opposite = |corner: usize| corners[(corner + 1) % 3].distance_squared(corners[(corner + 2) % 3]);
        let mut apex = 0;
        for corner in [1, 2] {
            if opposite(corner) > opposite(apex) {
                apex = corner;
            }
        }
        Self::Through { apex, at: 0.5 }
    }

    /// Along the side of the prism over `triangle` that cuts deepest; `None` if none cuts.
    fn along_prism(corners: [DVec3; 3], triangle: [DVec3; 3]) -> Option<Self> {
        let normal = triangle::normal(triangle)?;
        let size = corners[0].distance(corners[1]).max(corners[0].distance(corners[2]));
        let mut deepest = ON_PLANE * size;
        let mut heights = None;
        for side in 0..3 {
            let (start, end) = (triangle[side], triangle[(side + 1) % 3]);
            let outwards = (end - start).cross(normal).normalize_or_zero();
            let over = corners.map(|corner| (corner - start).dot(outwards));
            let depth = over.into_iter().fold(0.0, f64::max).min(-over.into_iter().fold(0.0, f64::min));
            if depth > deepest {
                deepest = depth;
                heights = Some(over);
            }
        }
        Some(Self::at_zero(heights?, ON_PLANE * size))
    }

    /// Where what has these heights at the corners, some above `margin` and some below, is zero.
    fn at_zero(heights: [f64; 3], margin: f64) -> Self {
        let share = |from: usize, to: usize| heights[from] / (heights[from] - heights[to]);
        let others = |corner: usize| [(corner + 1) % 3, (corner + 2) % 3];
        match (0..3).find(|&corner| heights[corner].abs() <= margin) {
            Some(apex) => {
                let [from, to] = others(apex);
                Self::Through { apex, at: share(from, to) }
            }
            None => {
                let above = heights.map(|height| height > 0.0);
                let alone =
                    |corner: usize| others(corner).into_iter().all(|other| above[other] != above[corner]);
                let corner = (0..3).find(|&corner| alone(corner)).unwrap_or_default();
                Self::Off { corner, at: others(corner).map(|other| share(corner, other)) }
            }
        }
    }
}

pub(super) fn blocks(count: usize) -> Vec<Range<usize>> {
    (0..count).step_by(BLOCK).map(|start| start..(start + BLOCK).min(count)).collect()
}
