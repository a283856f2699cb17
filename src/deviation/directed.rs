//! One direction of a deviation: from the points of one surface to another surface, in parallel.

use std::ops::Range;

use super::sampling::Strata;
use super::surface::Surface;
use super::{Directed, Sampling};
use crate::Cancelled;
use crate::workers::Workers;

/// Points that one worker measures in one go. Fixed, as the sums are rounded block by block.
pub(super) const BLOCK: usize = 1024;

/// Blocks between two reports to the monitor.
pub(super) const BATCH: usize = 64;

/// Distances below this share of the largest coordinate are rounding.
pub(super) const NOISE: f64 = 1.0 / (1u64 << 44) as f64;

/// What is measured from one surface to another.
pub(super) struct Direction<'a> {
    from: &'a Surface<'a>,
    to: &'a Surface<'a>,
    strata: Option<Strata<'a>>,
    samples: usize,
    /// The vertices in use, in the order in which the triangles name them: neighbours follow each
    /// other, and the nearest triangle to one is a good guess for the next.
    vertices: Vec<u32>,
    noise: f64,
}

impl<'a> Direction<'a> {
    pub(super) fn new(from: &'a Surface<'a>, to: &'a Surface<'a>, sampling: &Sampling) -> Self {
        let strata = Strata::new(from, sampling.samples, sampling.seed);
        let samples = if strata.is_some() { sampling.samples } else { 0 };
        let mut seen = vec![false; from.vertex_count()];
        let first_time = |&vertex: &u32| !std::mem::replace(&mut seen[vertex as usize], true);
        let vertices = from.triangles().as_flattened().iter().copied().filter(first_time).collect();
        let noise = NOISE * from.reach().max(to.reach());
        Self { from, to, strata, samples, vertices, noise }
    }

    /// Samples and vertices to measure; more than 0.
    pub(super) fn point_count(&self) -> usize {
        self.samples.saturating_add(self.vertices.len())
    }

    /// Measures all points, and tells `advance` of each batch how many it had.
    pub(super) fn measure(
        &self,
        workers: &Workers,
        mut advance: impl FnMut(usize) -> Result<(), Cancelled>,
    ) -> Result<Totals, Cancelled> {
        let mut totals = Totals::default();
        if let Some(strata) = &self.strata {
            for batch in pieces(0..self.samples, BLOCK * BATCH) {
                totals.add(in_blocks(workers, batch.clone(), |block| self.sampled(strata, block)));
                advance(batch.len())?;
            }
        }
        for batch in pieces(0..self.vertices.len(), BLOCK * BATCH) {
            let enough = totals.max_squared;
            totals.add(in_blocks(workers, batch.clone(), |block| match self.strata {
                Some(_) => self.farthest_vertex(block, enough),
                None => self.vertices_as_samples(block),
            }));
            advance(batch.len())?;
        }
        Ok(totals)
    }

    fn sampled(&self, strata: &Strata, block: Range<usize>) -> Totals {
        let mut totals = Totals::default();
        let mut ties = Vec::new();
        let mut guess = 0;
        for sample in strata.samples(block) {
            let (nearest, angle) =
                self.to.nearest_and_angle(sample.point, guess, sample.normal, self.noise, &mut ties);
            guess = nearest.triangle;
            totals.add_distance(self.squared(nearest.squared));
            if let Some(angle) = angle {
                totals.angles += 1;
                totals.angle_squared += angle * angle;
            }
        }
        totals
    }

    /// Vertices only matter where they raise the maximum: the search for the nearest triangle ends
    /// as soon as one is no farther than what is known already. Most end at the first guess.
    fn farthest_vertex(&self, block: Range<usize>, enough: f64) -> Totals {
        let mut max_squared = enough;
        let negligible = self.noise * self.noise;
        let mut guess = 0;
        for &vertex in &self.vertices[block] {
            let enough = max_squared.max(negligible);
            let nearest = self.to.nearest(self.from.position(vertex), guess, enough);
            guess = nearest.triangle;
            max_squared = max_squared.max(self.squared(nearest.squared));
        }
        Totals { max_squared, ..Totals::default() }
    }

    fn vertices_as_samples(&self, block: Range<usize>) -> Totals {
        let mut totals = Totals::default();
        let mut guess = 0;
        for &vertex in &self.vertices[block] {
            let nearest = self.to.nearest(self.from.position(vertex), guess, 0.0);
            guess = nearest.triangle;
            totals.add_distance(self.squared(nearest.squared));
        }
        totals
    }

    fn squared(&self, distance_squared: f64) -> f64 {
        if distance_squared > self.noise * self.noise { distance_squared } else { 0.0 }
    }
}

/// `range`, cut every `length` places.
pub(super) fn pieces(range: Range<usize>, length: usize) -> impl Iterator<Item = Range<usize>> {
    range.clone().step_by(length).map(move |start| start..start.saturating_add(length).min(range.end))
}

/// Sums over the blocks of a batch, added in their order whoever was first.
fn in_blocks(
    workers: &Workers,
    batch: Range<usize>,
    measure: impl Fn(Range<usize>) -> Totals + Sync + Send,
) -> Totals {
    let measured = workers.map(pieces(batch, BLOCK).collect(), measure);
    measured.into_iter().fold(Totals::default(), |mut totals, block| {
        totals.add(block);
        totals
    })
}

/// Sums over points.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Totals {
    distances: u64,
    distance: f64,
    distance_squared: f64,
    max_squared: f64,
    angles: u64,
    angle_squared: f64,
}

impl Totals {
    fn add(&mut self, other: Self) {
        self.distances += other.distances;
        self.distance += other.distance;
        self.distance_squared += other.distance_squared;
        self.max_squared = self.max_squared.max(other.max_squared);
        self.angles += other.angles;
        self.angle_squared += other.angle_squared;
    }

    fn add_distance(&mut self, squared: f64) {
        self.distances += 1;
        self.distance += squared.sqrt();
        self.distance_squared += squared;
        self.max_squared = self.max_squared.max(squared);
    }

    pub(super) fn directed(&self) -> Directed {
        Directed {
            rms: mean(self.distance_squared, self.distances).sqrt(),
            mean: mean(self.distance, self.distances),
            max: self.max_squared.sqrt(),
        }
    }

    /// In radians.
    pub(super) fn normal_rms(&self) -> f64 {
        mean(self.angle_squared, self.angles).sqrt()
    }
}

fn mean(sum: f64, count: u64) -> f64 {
    if count > 0 { sum / count as f64 } else { 0.0 }
}
