//! Rate-distortion approximation of polylines: the ideas of this room in one dimension.
//!
//! Balmelli, Vetterli and Liebling, "Mesh Optimization Using Global Error with Application to Geometry
//! Simplification", section 4.1 and Figures 13 and 14. A binary tree takes the place of the 4-8 hierarchy: the sample
//! in the middle goes after those in the middle of either half. The paper compares its generalized decimation of
//! that tree with greedy insertion and greedy decimation, which may choose any sample, and with the optimum, which
//! for polylines can be had by dynamic programming. All are here, and so are the greedy methods on the tree.
//!
//! In a tree, a set that holds all descendants of its members is a disjoint union of merging domains. So the set of
//! least slope is always one domain, and here, other than over a grid, generalized decimation finds the exact lower
//! convex hull of all sets: its curve is convex and never falls as vertices go.
//!
//! Where this departs from the paper: lines may have any number of samples, and halves then differ by one; the
//! greedy methods take the local error or the global one, at choice.

mod free;
mod optimum;
mod tree;

pub use super::baselines::Criterion;
pub use optimum::{Optimum, optimum};

use super::removals::Removals;
use super::{baselines, merging};
use std::convert::Infallible;
use tree::Tree;

/// What makes no polyline, or one that is too much.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolylineError {
    /// A line has two ends.
    #[error("a polyline of {samples} samples: two are the least")]
    TooShort {
        /// How many samples there are.
        samples: usize,
    },
    /// More samples than can be named, or than can be waited for.
    #[error("a polyline of {samples} samples: {limit} are the most")]
    TooLong {
        /// How many samples there are.
        samples: usize,
        /// How many there may be.
        limit: usize,
    },
    /// Infinite, or not a number.
    #[error("height {height} of sample {sample} is not finite")]
    NotFinite {
        /// What the height is.
        height: f32,
        /// Of which sample, from 0.
        sample: usize,
    },
}

/// Heights at equal distances, joined by straight segments.
///
/// An *approximation* joins some of the samples, both ends among them. Its distortion is the sum of the squared
/// vertical distances of all samples from it, its rate the number of its segments.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    heights: Vec<f32>,
}

impl Polyline {
    /// A line through two samples at least, all of them finite.
    pub fn new(heights: Vec<f32>) -> Result<Self, PolylineError> {
        let (samples, limit) = (heights.len(), u32::MAX as usize);
        if samples < 2 {
            return Err(PolylineError::TooShort { samples });
        }
        if samples > limit {
            return Err(PolylineError::TooLong { samples, limit });
        }
        match heights.iter().position(|height| !height.is_finite()) {
            Some(sample) => Err(PolylineError::NotFinite { height: heights[sample], sample }),
            None => Ok(Self { heights }),
        }
    }

    /// The heights of the samples, in order.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// How many segments join all samples.
    pub fn segments(&self) -> usize {
        self.heights.len() - 1
    }

    /// How far a sample between two others lies above the segment that joins these.
    fn residual(&self, [from, middle, to]: [usize; 3]) -> f64 {
        let [start, height, end] = [from, middle, to].map(|sample| f64::from(self.heights[sample]));
        let slope = (end - start) / (to - from) as f64;
        height - (start + slope * (middle - from) as f64)
    }

    /// The squared error of the segment that joins two samples.
    fn error(&self, from: usize, to: usize) -> f64 {
        (from + 1..to).map(|middle| self.residual([from, middle, to]).powi(2)).sum()
    }

    /// By how much the squared error grows when the sample between two others goes.
    fn growth(&self, [from, middle, to]: [usize; 3]) -> f64 {
        self.error(from, to) - self.error(from, middle) - self.error(middle, to)
    }

    /// The error that a sample between two others gets when it goes.
    fn cost(&self, span: [usize; 3], criterion: Criterion) -> f64 {
        match criterion {
            Criterion::Global => self.growth(span),
            Criterion::Local => self.residual(span).abs(),
        }
    }
}

/// How to choose the sample that goes next, or comes next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// The paper's: the subtree that adds the least distortion for each of its samples goes. The best that can
    /// be had with a tree wherever a step ends, O(n log n).
    RateDistortion,
    /// Greedy decimation: from all samples down, the one of least error goes. O(n log n) steps as long as what
    /// is left is spread evenly, O(n²) in the worst case.
    Decimation(Choice, Criterion),
    /// Greedy insertion: from the two ends up, the sample of largest error comes. O(n log n) steps as long as
    /// segments are cut near their middle, O(n²) in the worst case; a power of n more for [`Choice::Free`] with
    /// [`Criterion::Global`], which tries all cuts.
    Insertion(Choice, Criterion),
}

/// Which samples a greedy method may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// Those that the binary tree allows: each goes after its descendants, and comes after its ancestors.
    Tree,
    /// Any.
    Free,
}

/// Approximations of a polyline for all rates, each of them a part of the next finer.
///
/// ```
/// use decimesh::rate_distortion::polyline::{Method, Polyline, approximate};
///
/// let roof = Polyline::new(vec![0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.5])?;
/// let approximations = approximate(&roof, Method::RateDistortion);
/// assert_eq!(approximations.samples(2), Some(vec![0, 3, 6]));
/// assert!(approximations.distortion(2) < approximations.distortion(1));
/// # Ok::<(), decimesh::rate_distortion::polyline::PolylineError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Approximations {
    /// Samples, the first to go first.
    order: Vec<u32>,
    /// How many are gone after each step.
    steps: Vec<usize>,
    /// After 0, 1, 2, ... samples are gone.
    distortions: Vec<f64>,
}

impl Approximations {
    fn of_tree(removals: Removals, deltas: &[f64]) -> Self {
        let distortions = removals.distortions(deltas);
        let Removals { order, steps } = removals;
        Self { order: order.into_iter().map(Tree::sample).collect(), steps, distortions }
    }

    /// The samples between the ends in the order in which they go, counted from 0.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The distortion with `segments` segments, from 1 to those of the polyline; `None` for others.
    pub fn distortion(&self, segments: usize) -> Option<f64> {
        // Sums of differences may end a little below nothing.
        self.distortions.get(self.gone(segments)?).map(|distortion| distortion.max(0.0))
    }

    /// The samples that `segments` segments join, ascending; `None` unless there are 1 to those of the
    /// polyline. O(n log n).
    pub fn samples(&self, segments: usize) -> Option<Vec<u32>> {
        let last = self.order.len() as u32 + 1;
        let mut samples = self.order[self.gone(segments)?..].to_vec();
        samples.extend([0, last]);
        samples.sort_unstable();
        Some(samples)
    }

    /// The numbers of segments at which a step of the method ends, descending, all segments first. A greedy
    /// method steps by single samples but for ancestors that have to come along, [`Method::RateDistortion`] by
    /// subtrees. Between its steps, parts of these subtrees are gone, and more segments may be worse than fewer.
    pub fn steps(&self) -> impl Iterator<Item = usize> {
        let segments = self.order.len() + 1;
        std::iter::once(0).chain(self.steps.iter().copied()).map(move |gone| segments - gone)
    }

    fn gone(&self, segments: usize) -> Option<usize> {
        (segments > 0).then(|| (self.order.len() + 1).checked_sub(segments)).flatten()
    }
}

/// Approximates a polyline at all rates. Ties go to the coarser level of the tree, or where there is none to the
/// smaller sample.
pub fn approximate(polyline: &Polyline, method: Method) -> Approximations {
    let criterion = match method {
        Method::RateDistortion => Criterion::Global,
        Method::Decimation(Choice::Free, criterion) => return free::decimation(polyline, criterion),
        Method::Insertion(Choice::Free, criterion) => return free::insertion(polyline, criterion),
        Method::Decimation(Choice::Tree, criterion) | Method::Insertion(Choice::Tree, criterion) => criterion,
    };
    let tree = Tree::new(polyline.heights.len());
    let costs = |criterion| -> Vec<f64> { tree.spans().map(|span| polyline.cost(span, criterion)).collect() };
    let deltas = costs(Criterion::Global);
    let removals = match method {
        Method::RateDistortion => {
            let Ok(removals) = merging::decimate(&tree, &deltas, |_| Ok::<_, Infallible>(()));
            removals
        }
        Method::Decimation(..) => baselines::decimation(&tree, &costs(criterion)),
        Method::Insertion(..) => baselines::insertion(&tree, &costs(criterion)),
    };
    Approximations::of_tree(removals, &deltas)
}

#[cfg(test)]
mod tests;
