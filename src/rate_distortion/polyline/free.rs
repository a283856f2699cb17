//! Greedy methods that may take any sample. Insertion by the local error is that of Douglas and Peucker, in the
//! order of the errors.

use super::{Approximations, Criterion, Polyline};
use crate::rate_distortion::priority::rank;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// All samples from the first to go to the last: always the one of least error.
pub(super) fn decimation(polyline: &Polyline, criterion: Criterion) -> Approximations {
    let samples = polyline.heights.len();
    // The samples left of each that is left, and right of it.
    let mut left: Vec<_> = (0..samples).map(|sample| sample.saturating_sub(1)).collect();
    let mut right: Vec<_> = (1..=samples).collect();
    let mut versions = vec![0u32; samples];
    let entry =
        |span: [usize; 3], version: u32| Reverse((rank(polyline.cost(span, criterion)), span[1], version));
    let mut queue: BinaryHeap<_> =
        (1..samples - 1).map(|sample| entry([sample - 1, sample, sample + 1], 0)).collect();
    let mut order = Vec::with_capacity(samples - 2);
    let mut distortions = vec![0.0];
    let mut distortion = 0.0;
    while let Some(Reverse((_, sample, version))) = queue.pop() {
        if version != versions[sample] {
            continue;
        }
        let (before, after) = (left[sample], right[sample]);
        distortion += polyline.growth([before, sample, after]);
        distortions.push(distortion);
        order.push(sample as u32);
        (right[before], left[after]) = (after, before);
        for neighbour in [before, after] {
            if neighbour > 0 && neighbour < samples - 1 {
                versions[neighbour] += 1;
                queue.push(entry([left[neighbour], neighbour, right[neighbour]], versions[neighbour]));
            }
        }
    }
    Approximations { steps: (1..=order.len()).collect(), order, distortions }
}

/// All samples from the last to come to the first: always the one of largest error. Those that segments come to pass
/// through exactly never have to come, so they go first.
pub(super) fn insertion(polyline: &Polyline, criterion: Criterion) -> Approximations {
    let samples = polyline.heights.len();
    let entry = |from: usize, to: usize| {
        let (middle, error) = best_cut(polyline, from, to, criterion)?;
        Some((rank(error), Reverse([from, middle, to])))
    };
    let mut queue: BinaryHeap<_> = entry(0, samples - 1).into_iter().collect();
    let mut inserted = vec![false; samples];
    let mut order = Vec::with_capacity(samples - 2);
    let mut distortions = vec![polyline.error(0, samples - 1)];
    while let Some((_, Reverse(span))) = queue.pop() {
        let [from, middle, to] = span;
        inserted[middle] = true;
        order.push(middle as u32);
        distortions.push(distortions[distortions.len() - 1] - polyline.growth(span));
        queue.extend([entry(from, middle), entry(middle, to)].into_iter().flatten());
    }
    let remaining = (1..samples - 1).rev().filter(|&sample| !inserted[sample]);
    order.extend(remaining.map(|sample| sample as u32));
    distortions.resize(samples - 1, 0.0);
    order.reverse();
    distortions.reverse();
    Approximations { steps: (1..=order.len()).collect(), order, distortions }
}

/// Where a segment is cut, and the error of the sample there; `None` if it passes through all.
fn best_cut(polyline: &Polyline, from: usize, to: usize, criterion: Criterion) -> Option<(usize, f64)> {
    if (from + 1..to).all(|middle| polyline.residual([from, middle, to]) == 0.0) {
        return None;
    }
    let costs = (from + 1..to).map(|middle| (middle, polyline.cost([from, middle, to], criterion)));
    costs.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
}
