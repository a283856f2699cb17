//! Whether two surfaces are within a limit of each other, and where they are not.
//!
//! The bounds are those of `bound.rs`. As the limit is known, most of a surface is settled at once: a part whose
//! bound is within the limit is done, and so is one with a point beyond it, which decides the whole. Cut is only
//! what lies between, and no part has to wait for a worse one.

use super::pieces::{Corner, Direction, Found, Part, ROUNDING, blocks};
use super::surface::Surface;
use super::triangle;
use crate::workers::Workers;
use crate::{Cancelled, Mesh, Monitor};

/// Parts that are cut before the monitor is told. Fixed, as the order of the cuts follows it.
const BATCH: usize = 4096;

/// Parts of a batch that one worker takes in one go.
const SHARE: usize = 128;

/// Parts that may be cut, for each triangle of both surfaces and in any case: what is not settled by then counts
/// as beyond the limit.
const PIECES_A_TRIANGLE: usize = 32;
const LEAST_PIECES: usize = 1 << 20;

/// A surface that others are held to.
pub(crate) struct Reference<'a>(Surface<'a>);

/// How far two surfaces are from each other, in units of the positions.
pub(crate) struct Apart {
    /// The largest distance found.
    pub(crate) lower: f64,
    /// No point is farther away than this.
    pub(crate) upper: f64,
    /// Parts that were looked at, other than the triangles themselves.
    pub(crate) pieces: usize,
    /// For each triangle of the reference, and of the other mesh, the largest distance found on it or, where that
    /// is not settled, the bound.
    pub(crate) farthest: [Vec<f32>; 2],
}

impl<'a> Reference<'a> {
    /// The surface of `mesh`, which has a triangle. O(n log n).
    pub(crate) fn new(mesh: &'a Mesh) -> Self {
        Self(Surface::new(mesh))
    }

    /// Diagonal of the box around the triangles.
    pub(crate) fn diagonal(&self) -> f64 {
        self.0.diagonal()
    }

    /// Below this, distances are lost in what `f64` rounds away: no surface can be shown to be so close.
    pub(crate) fn resolution(&self) -> f64 {
        ROUNDING * self.0.reach()
    }

    /// How far `other`, which has a triangle, is from the surface, as far as `limit` asks: `upper` is at most the
    /// limit if that can be shown. The same for any number of threads.
    pub(crate) fn apart(
        &self,
        other: &Mesh,
        limit: f64,
        workers: &Workers,
        monitor: &mut Monitor,
    ) -> Result<Apart, Cancelled> {
        let other = Surface::new(other);
        monitor.report(0.2)?;
        let rounding = ROUNDING * self.0.reach().max(other.reach());
        // A few units in the last place less, as roots and squares round.
        let enough = ((limit - rounding).max(0.0) * (1.0 - 1e-12)).powi(2);
        let directions = [Direction { from: &self.0, to: &other }, Direction { from: &other, to: &self.0 }];
        let most = LEAST_PIECES
            + PIECES_A_TRIANGLE * directions.iter().map(|way| way.from.triangles().len()).sum::<usize>();
        let mut apart = Apart { lower: 0.0, upper: 0.0, pieces: 0, farthest: Default::default() };
        for (index, direction) in directions.into_iter().enumerate() {
            let mut side = Side { direction, enough, lower: 0.0, upper: 0.0, farthest: Vec::new() };
            let open = side.begin(workers);
            let done = 0.5 + 0.3 * index as f32;
            monitor.report(done)?;
            side.settle(open, most, &mut apart.pieces, workers, &mut monitor.part(done..done + 0.2))?;
            apart.lower = apart.lower.max(side.lower);
            apart.upper = apart.upper.max(side.upper);
            apart.farthest[index] = side.farthest.iter().map(|squared| squared.sqrt() as f32).collect();
        }
        apart.lower = apart.lower.sqrt();
        apart.lower = if apart.lower > rounding { apart.lower } else { 0.0 };
        apart.upper = apart.upper.sqrt() + rounding;
        Ok(apart)
    }
}

/// A part that is not settled.
struct Open {
    part: Part,
    /// The triangle nearest to the centroid.
    middle: u32,
    /// The triangle it is a part of.
    of: u32,
}

/// One direction; distances are squared.
struct Side<'a> {
    direction: Direction<'a>,
    /// What is no farther than this is settled.
    enough: f64,
    lower: f64,
    upper: f64,
    /// For each triangle.
    farthest: Vec<f64>,
}

/// What became of a triangle, or of the pieces of a part.
struct Outcome {
    /// The largest distance found.
    seen: f64,
    /// The largest bound of what is settled.
    settled: f64,
}

impl Side<'_> {
    /// Looks at all vertices and triangles; what is left to settle.
    fn begin(&mut self, workers: &Workers) -> Vec<Open> {
        let Self { direction, enough, .. } = *self;
        let from = direction.from;
        let (nearest, _) = direction.nearest_of_vertices(workers);
        let looked_at = workers.map(blocks(from.triangles().len()), |block| {
            let mut found = Found::default();
            let mut open = Vec::new();
            let outcomes: Vec<Outcome> = block
                .map(|of| {
                    let corners = from.triangles()[of].map(|vertex| Corner {
                        point: from.position(vertex),
                        nearest: nearest[vertex as usize],
                    });
                    let distance = |Corner { point, nearest }: Corner| {
                        triangle::distance_squared(point, direction.to.corners(nearest))
                    };
                    (found.lower, found.settled) =
                        (corners.map(distance).into_iter().fold(0.0, f64::max), 0.0);
                    if found.lower <= enough {
                        let part = Part { corners, upper: f64::INFINITY, prism_cuts: 0 };
                        direction.look_at(part, enough, &mut found);
                    }
                    finish(&mut found, of as u32, enough, &mut open)
                })
                .collect();
            (outcomes, open)
        });
        let mut all_open = Vec::new();
        self.farthest = Vec::with_capacity(from.triangles().len());
        for (outcomes, open) in looked_at {
            for outcome in outcomes {
                self.farthest.push(outcome.seen);
                self.take(&outcome);
            }
            all_open.extend(open);
        }
        all_open
    }

    /// Cuts what is open until all is settled, or `most` pieces have been looked at. The last ones come first, so
    /// that few are open at a time.
    fn settle(
        &mut self,
        mut open: Vec<Open>,
        most: usize,
        pieces: &mut usize,
        workers: &Workers,
        monitor: &mut Monitor,
    ) -> Result<(), Cancelled> {
        let Self { direction, enough, .. } = *self;
        while !open.is_empty() && *pieces < most {
            let mut batch = open.split_off(open.len().saturating_sub(BATCH));
            // Of a triangle that is known to be too far away nothing more needs to be known.
            batch.retain(|open| self.farthest[open.of as usize] <= enough);
            let cut = workers.map(batch.chunks(SHARE).collect(), |share| {
                let mut found = Found::default();
                let mut open = Vec::new();
                let cut = |&Open { part, middle, of }: &Open| {
                    (found.lower, found.settled) = (0.0, 0.0);
                    direction.cut((part, middle), enough, &mut found);
                    (of, finish(&mut found, of, enough, &mut open))
                };
                let outcomes: Vec<_> = share.iter().map(cut).collect();
                (outcomes, open, found.parts)
            });
            for (outcomes, more, parts) in cut {
                for (of, outcome) in outcomes {
                    let farthest = &mut self.farthest[of as usize];
                    *farthest = farthest.max(outcome.seen);
                    self.take(&outcome);
                }
                open.extend(more);
                *pieces += parts;
            }
            monitor.report((*pieces as f64 / most as f64) as f32)?;
        }
        for Open { part, of, .. } in open {
            let farthest = &mut self.farthest[of as usize];
            *farthest = farthest.max(part.upper);
            self.upper = self.upper.max(part.upper);
        }
        Ok(())
    }

    fn take(&mut self, outcome: &Outcome) {
        self.lower = self.lower.max(outcome.seen);
        self.upper = self.upper.max(outcome.seen).max(outcome.settled);
    }
}

/// What was `found` of a triangle; its open parts go to `open`, unless it is known to be beyond what is enough.
fn finish(found: &mut Found, of: u32, enough: f64, open: &mut Vec<Open>) -> Outcome {
    let parts = found.open.drain(..);
    if found.lower <= enough {
        open.extend(parts.map(|(part, middle)| Open { part, middle, of }));
    }
    Outcome { seen: found.lower, settled: found.settled }
}
