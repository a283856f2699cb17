//! A guaranteed bound on the Hausdorff distance between two surfaces, by branch and bound.
//!
//! From above each piece is bounded by its corners' distances to one triangle (`pieces.rs`), from below the
//! whole by every distance seen. Pieces whose bound is too far above that are cut, the worst first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::pieces::{Corner, Direction, Found, Part, ROUNDING, blocks};
use super::surface::Surface;
use super::{DeviationError, relative};
use crate::workers::Workers;
use crate::{Cancelled, Mesh, Monitor};

/// Pieces that are cut before the bounds are looked at again. Fixed, as the order of the cuts follows it.
const BATCH: usize = 2048;

/// Pieces of a batch that one worker takes in one go.
const SHARE: usize = 64;

/// Bounds closer than this share of the larger diagonal need not come closer: a few steps of `f32`.
const NEGLIGIBLE: f64 = 1e-6;

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
    /// The least `f32` that no point is farther away than, or the largest there is.
    pub(crate) fn not_above(&self) -> f32 {
        let near = self.upper as f32;
        if f64::from(near) < self.upper { near.next_up() } else { near }.min(f32::MAX)
    }

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
                        direction.cut((piece.part, piece.middle), enough, &mut found);
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
