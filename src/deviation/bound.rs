//! A guaranteed bound on the Hausdorff distance between two surfaces, by branch and bound.
//!
//! The distance to a convex set is a convex function. So over a triangle the distance to *one* triangle of
//! the other surface is nowhere larger than at a corner, and that is at least the distance to the other
//! surface: the largest of the corners' distances to any one triangle bounds a piece from above. From below
//! the whole is bounded by every distance seen. Pieces whose bound is too far above that are cut, the worst
//! first: where the prisms over the other surface's triangles end, so that a flat part that is only meshed
//! anew is done once it is cut along the new edges (the idea of Tang, Lee and Kim, "Interactive Hausdorff
//! Distance Computation for General Polygonal Models", 2009), and in the middle of the longest edge.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

use glam::DVec3;

use super::surface::Surface;
use super::{DeviationError, relative, triangle};
use crate::workers::Workers;
use crate::{Cancelled, Mesh, Monitor};

/// Vertices or triangles that one worker takes in one go.
const BLOCK: usize = 1024;

/// Pieces that are cut before the bounds are looked at again. Fixed, as the order of the cuts follows it.
const BATCH: usize = 2048;

/// Pieces of a batch that one worker takes in one go.
const SHARE: usize = 64;

/// Bounds closer than this share of the larger diagonal need not come closer: a few steps of `f32`.
const NEGLIGIBLE: f64 = 1e-6;

/// What `f64` may have rounded away, as a share of the largest coordinate: a cut moves a corner by 2⁻⁵²,
/// and a piece is cut some dozens of times.
const ROUNDING: f64 = 1.0 / (1u64 << 42) as f64;

/// Cuts along prisms in a row. A piece then is halved, so that all pieces become small in the end.
const MOST_PRISM_CUTS: u8 = 3;

/// A corner closer to a plane than this share of the piece's size lies on it.
const ON_PLANE: f64 = 1e-9;

/// How close the bounds shall come to each other, and how much work that may be.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundOptions {
    /// How far above the lower bound the upper may be, as a share of it; finite, not negative. A
    /// millionth of the larger diagonal is allowed in any case.
    pub tolerance: f64,
    /// Pieces, other than the triangles themselves, to look at before giving up on the tolerance: some
    /// microseconds each, and at most about 120 bytes.
    pub pieces: usize,
    /// Threads to work with, or 0 for those of the global rayon pool. Never changes the result.
    pub threads: usize,
}

impl Default for BoundOptions {
    /// One percent, five million pieces, all threads.
    fn default() -> Self {
        Self { tolerance: 0.01, pieces: 5_000_000, threads: 0 }
    }
}

/// What the two-sided Hausdorff distance lies between, in units of the positions: finite, at least 0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Bound {
    /// The largest distance found, at corners and inside of triangles.
    pub lower: f64,
    /// No point of either surface is farther from the other than this.
    pub upper: f64,
    /// Diagonal of the box around the triangles of the first mesh.
    pub diagonal: f64,
    /// Pieces that were looked at, other than the triangles themselves.
    pub pieces: usize,
}

impl Bound {
    /// [`lower`](Self::lower) as a fraction of the diagonal.
    pub fn lower_rel(&self) -> f64 {
        relative(self.lower, self.diagonal)
    }

    /// [`upper`](Self::upper) as a fraction of the diagonal.
    pub fn upper_rel(&self) -> f64 {
        relative(self.upper, self.diagonal)
    }
}

/// Bounds the two-sided Hausdorff distance between the surfaces of `a` and `b`: over all points, not
/// only over samples.
///
/// [`Bound::upper`] holds whatever the options; it includes what `f64` may have rounded, less than 2⁻⁴¹ of
/// the largest coordinate. Whether it is as close to [`Bound::lower`] as asked for is for the caller to
/// see: if not, the pieces did not suffice.
///
/// Building the trees takes O(n log n), and each vertex and most triangles of both meshes about O(log n).
/// How many pieces are then needed depends on the surfaces: few, where the largest distance stands out; many,
/// where large parts are about as far apart and meshed differently. A scan beside its tenth takes about
/// seven a triangle. About 130 bytes a triangle are
/// held, and the pieces. The result is the same for any number of threads.
///
/// The monitor is told of progress on the calling thread, and may cancel.
///
/// ```
/// use decimesh::deviation::{BoundOptions, bound};
/// use decimesh::mesh::shapes;
/// use decimesh::{Monitor, Options, Target, simplify};
///
/// let quiet = &mut Monitor::silent();
/// let stone = shapes::bumpy_sphere(16, 1);
/// let small = simplify(&stone, &Options::new(Target::Ratio(0.2)), quiet)?.mesh;
/// let found = bound(&stone, &small, &BoundOptions::default(), quiet)?;
/// assert!(found.lower > 0.0 && found.upper >= found.lower && found.upper < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bound(
    a: &Mesh,
    b: &Mesh,
    options: &BoundOptions,
    monitor: &mut Monitor,
) -> Result<Bound, DeviationError> {
    if !(options.tolerance >= 0.0 && options.tolerance.is_finite()) {
        return Err(DeviationError::InvalidTolerance(options.tolerance));
    }
    super::both_have_triangles(a, b)?;
    let workers = Workers::new(options.threads)?;
    monitor.report(0.0)?;
    let [a, b] = workers.both([a, b], Surface::new);
    monitor.report(0.1)?;
    let directions = [Direction { from: &a, to: &b }, Direction { from: &b, to: &a }];
    let largest = a.reach().max(b.reach());
    let mut search = Search {
        directions,
        workers,
        lower: 0.0,
        settled: 0.0,
        open: BinaryHeap::new(),
        opened: 0,
        pieces: 0,
        slack: 1.0 + options.tolerance,
        negligible: NEGLIGIBLE * a.diagonal().max(b.diagonal()),
    };
    search.begin(monitor)?;
    search.close_in(options.pieces, monitor)?;
    let rounding = ROUNDING * largest;
    let (lower, upper) = (search.lower.sqrt(), search.upper().sqrt());
    Ok(Bound {
        lower: if lower > rounding { lower } else { 0.0 },
        upper: upper + rounding,
        diagonal: a.diagonal(),
        pieces: search.pieces,
    })
}

/// From the points of one surface to the nearest of the other.
#[derive(Clone, Copy)]
struct Direction<'a> {
    from: &'a Surface<'a>,
    to: &'a Surface<'a>,
}

/// A point, and the triangle of the other surface that is nearest to it.
#[derive(Debug, Clone, Copy)]
struct Corner {
    point: DVec3,
    nearest: u32,
}

/// A part of a triangle.
#[derive(Debug, Clone, Copy)]
struct Part {
    corners: [Corner; 3],
    /// No point of it is farther from the other surface, squared.
    upper: f64,
    prism_cuts: u8,
}

/// A part that may be farther from the other surface than is known so far.
struct Piece {
    part: Part,
    /// The triangle nearest to the centroid.
    middle: u32,
    /// Which direction's.
    direction: usize,
    /// How many pieces came up before, to break ties.
    number: usize,
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> Ordering {
        self.part.upper.total_cmp(&other.part.upper).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Piece {}

/// What looking at parts of a surface came to; distances are squared.
#[derive(Default)]
struct Found {
    /// The largest distance of a point.
    lower: f64,
    /// The largest bound of the parts that are done.
    settled: f64,
    /// The others, and the triangles nearest to their centroids.
    open: Vec<(Part, u32)>,
    /// How many parts were looked at.
    parts: usize,
}

struct Search<'a> {
    directions: [Direction<'a>; 2],
    workers: Workers,
    /// The largest distance seen, squared.
    lower: f64,
    /// The largest bound of the pieces that are done, squared.
    settled: f64,
    open: BinaryHeap<Piece>,
    /// How many pieces have ever been open.
    opened: usize,
    pieces: usize,
    slack: f64,
    negligible: f64,
}

impl Search<'_> {
    /// No point is farther away than this, squared.
    fn upper(&self) -> f64 {
        self.open.peek().map_or(0.0, |worst| worst.part.upper).max(self.settled).max(self.lower)
    }

    /// A piece is done if its bound is at most this, squared.
    fn enough(&self) -> f64 {
        (self.lower.sqrt() * self.slack + self.negligible).powi(2)
    }

    /// Looks at all vertices, which say most of how far the surfaces are apart, and then at all triangles.
    fn begin(&mut self, monitor: &mut Monitor) -> Result<(), Cancelled> {
        let mut nearest = Vec::with_capacity(2);
        for direction in self.directions {
            let (of_vertices, farthest) = direction.nearest_of_vertices(&self.workers);
            self.lower = self.lower.max(farthest);
            nearest.push(of_vertices);
            monitor.report(0.1 + 0.2 * nearest.len() as f32)?;
        }
        for (index, nearest) in nearest.into_iter().enumerate() {
            let direction = self.directions[index];
            let enough = self.enough();
            let found = self.workers.map(blocks(direction.from.triangles().len()), |block| {
                let mut found = Found::default();
                for corners in &direction.from.triangles()[block] {
                    let corners = corners.map(|vertex| Corner {
                        point: direction.from.position(vertex),
                        nearest: nearest[vertex as usize],
                    });
                    let part = Part { corners, upper: f64::INFINITY, prism_cuts: 0 };
                    direction.look_at(part, enough, &mut found);
                }
                found
            });
            self.take(index, found);
            monitor.report(0.5 + 0.1 * (index + 1) as f32)?;
        }
        self.pieces = 0;
        Ok(())
    }

    /// Cuts the worst pieces until the bounds are close, or `most` pieces have been looked at.
    fn close_in(&mut self, most: usize, monitor: &mut Monitor) -> Result<(), Cancelled> {
        while self.pieces < most {
            let enough = self.enough();
            let mut worst: [Vec<Piece>; 2] = Default::default();
            while worst.iter().map(Vec::len).sum::<usize>() < BATCH
                && self.open.peek().is_some_and(|piece| piece.part.upper > enough)
                && let Some(piece) = self.open.pop()
            {
                worst[piece.direction].push(piece);
            }
            if worst.iter().all(Vec::is_empty) {
                break;
            }
            for (index, pieces) in worst.iter().enumerate() {
                let direction = self.directions[index];
                let found = self.workers.map(pieces.chunks(SHARE).collect(), |share| {
                    let mut found = Found::default();
                    for piece in share {
                        direction.cut(piece, enough, &mut found);
                    }
                    found
                });
                self.take(index, found);
            }
            monitor.report(0.7 + 0.3 * (self.pieces as f64 / most as f64) as f32)?;
        }
        Ok(())
    }

    /// Takes in what was found in a direction, part by part.
    fn take(&mut self, direction: usize, found: Vec<Found>) {
        for found in found {
            self.lower = self.lower.max(found.lower);
            self.settled = self.settled.max(found.settled);
            self.pieces += found.parts;
            for (part, middle) in found.open {
                self.open.push(Piece { part, middle, direction, number: self.opened });
                self.opened += 1;
            }
        }
    }
}

impl Direction<'_> {
    /// For each vertex that a triangle uses the nearest triangle, and the largest distance, squared.
    fn nearest_of_vertices(&self, workers: &Workers) -> (Vec<u32>, f64) {
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
    fn look_at(&self, mut part: Part, enough: f64, found: &mut Found) {
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

    /// Cuts `piece`, and looks at what it falls into.
    fn cut(&self, piece: &Piece, enough: f64, found: &mut Found) {
        let Piece { part, middle, .. } = *piece;
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

fn blocks(count: usize) -> Vec<Range<usize>> {
    (0..count).step_by(BLOCK).map(|start| start..(start + BLOCK).min(count)).collect()
}
