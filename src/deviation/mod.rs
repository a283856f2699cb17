//! Measured distance between two surfaces: RMS, mean and maximum, in both directions, and how far
//! their normals turn away from each other; a bound on the maximum that is guaranteed ([`bound()`]); and
//! the distance of each vertex ([`vertex_distances`]).
//!
//! The measure is that of Metro (Cignoni, Rocchini and Scopigno, "Metro: measuring error on
//! simplified surfaces", Computer Graphics Forum 17(2), 1998): points on one surface, each to the
//! exactly nearest point of the other.

mod bound;
mod directed;
mod pieces;
mod sampling;
mod surface;
mod triangle;
mod vertices;
mod within;

pub use bound::{Bound, BoundOptions, bound};
pub use vertices::vertex_distances;
pub(crate) use within::{Apart, Reference};

use directed::{Direction, Totals};
use surface::Surface;

use crate::workers::{ThreadsError, Workers};
use crate::{Cancelled, Mesh, Monitor};

/// How densely to sample, and with how many threads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sampling {
    /// Points spread evenly over the area of each surface; twice as many in all. They make the mean
    /// and the RMS. The vertices are measured besides, for the maximum.
    pub samples: usize,
    /// Chooses the points. The same seed gives the same result.
    pub seed: u64,
    /// Threads to work with, or 0 for those of the global rayon pool. Never changes the result.
    pub threads: usize,
}

impl Default for Sampling {
    /// 500 000 samples a direction, seed 0, all threads.
    fn default() -> Self {
        Self { samples: 500_000, seed: 0, threads: 0 }
    }
}

/// Distance from one surface to another, in units of the positions.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Directed {
    /// Square root of the mean squared distance over the samples.
    pub rms: f64,
    /// Mean distance over the samples.
    pub mean: f64,
    /// Largest distance over the samples and all vertices that a triangle uses. This is at most the
    /// directed Hausdorff distance, and approaches it as the samples grow dense; [`bound()`] bounds it
    /// from above.
    pub max: f64,
}

/// Distance between two surfaces, in units of the positions. All values are finite and at least 0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Deviation {
    /// The larger RMS of the two directions.
    pub rms: f64,
    /// The larger mean of the two directions.
    pub mean: f64,
    /// The larger maximum of the two directions.
    pub max: f64,
    /// From the first surface to the second.
    pub forward: Directed,
    /// From the second surface to the first.
    pub backward: Directed,
    /// Diagonal of the box around the triangles of the first mesh.
    pub diagonal: f64,
    /// RMS angle between the normal at a sample and that of the nearest triangle, in degrees, 0 to
    /// 180; the larger of the two directions.
    ///
    /// Where several triangles are equally near, as beside a convex edge, the one that agrees best
    /// counts (of at most 32). Triangles without area are skipped; 0 where only those are left.
    pub normal_rms_degrees: f64,
}

impl Deviation {
    /// [`rms`](Self::rms) as a fraction of the diagonal.
    pub fn rms_rel(&self) -> f64 {
        relative(self.rms, self.diagonal)
    }

    /// [`mean`](Self::mean) as a fraction of the diagonal.
    pub fn mean_rel(&self) -> f64 {
        relative(self.mean, self.diagonal)
    }

    /// [`max`](Self::max) as a fraction of the diagonal.
    pub fn max_rel(&self) -> f64 {
        relative(self.max, self.diagonal)
    }
}

/// A first mesh shrunk to one point has no diagonal: then any distance is infinitely large, but none is
/// still none.
fn relative(distance: f64, diagonal: f64) -> f64 {
    if distance > 0.0 { distance / diagonal } else { 0.0 }
}

/// Why a deviation could not be measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DeviationError {
    /// A mesh has no triangles. Vertices alone are no surface.
    #[error("the {mesh} mesh has no triangles: there is no surface to measure")]
    Empty {
        /// `"first"` or `"second"`.
        mesh: &'static str,
    },
    /// A tolerance is negative, infinite or not a number.
    #[error("the tolerance of a bound must be finite and not negative, not {0}")]
    InvalidTolerance(f64),
    /// The threads asked for could not be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The monitor ended the measurement.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Measures the distance between the surfaces of `a` and `b`, in both directions.
///
/// Each direction takes [`Sampling::samples`] points, stratified over the area, and every vertex
/// that a triangle uses; each point is measured to the exactly nearest triangle, in `f64`. A surface
/// without area (all triangles degenerate) has no samples: then its vertices take their place in
/// mean and RMS, and likewise where [`Sampling::samples`] is 0. Distances below 2⁻⁴⁴ of the largest
/// coordinate, which is far below what `f32` positions can tell apart, are rounding and count as 0.
///
/// The result depends on the meshes, the samples and the seed alone, bit by bit. Exchanging the
/// meshes exchanges the directions.
///
/// Building takes O(n log n). A point costs about O(log n), less where the surfaces are close; only
/// where many triangles coincide does it look at all of them. The positions of both meshes and a
/// tree over each are held in memory: about 110 bytes a triangle, and more while building.
///
/// The monitor is told of progress on the calling thread, and may cancel.
pub fn deviation(
    a: &Mesh,
    b: &Mesh,
    sampling: &Sampling,
    monitor: &mut Monitor,
) -> Result<Deviation, DeviationError> {
    both_have_triangles(a, b)?;
    let workers = Workers::new(sampling.threads)?;
    monitor.report(0.0)?;
    let [a, b] = workers.both([a, b], Surface::new);
    monitor.report(BUILT)?;

    let [forward, backward] =
        workers.both([(&a, &b), (&b, &a)], |(from, to)| Direction::new(from, to, sampling));
    let points = (forward.point_count() + backward.point_count()) as f64;
    let mut done = 0;
    let mut advance = |measured: usize| {
        done += measured;
        monitor.report(BUILT + (1.0 - BUILT) * (done as f64 / points) as f32)
    };
    let forward = forward.measure(&workers, &mut advance)?;
    let backward = backward.measure(&workers, &mut advance)?;
    Ok(combine(a.diagonal(), forward, backward))
}

fn both_have_triangles(a: &Mesh, b: &Mesh) -> Result<(), DeviationError> {
    match [(a, "first"), (b, "second")].into_iter().find(|(mesh, _)| mesh.triangles().is_empty()) {
        Some((_, mesh)) => Err(DeviationError::Empty { mesh }),
        None => Ok(()),
    }
}

/// Share of the time that building the trees takes, roughly.
const BUILT: f32 = 0.2;

fn combine(diagonal: f64, forward: Totals, backward: Totals) -> Deviation {
    let normal_rms_degrees = forward.normal_rms().max(backward.normal_rms()).to_degrees();
    let (forward, backward) = (forward.directed(), backward.directed());
    Deviation {
        rms: forward.rms.max(backward.rms),
        mean: forward.mean.max(backward.mean),
        max: forward.max.max(backward.max),
        forward,
        backward,
        diagonal,
        normal_rms_degrees,
    }
}
