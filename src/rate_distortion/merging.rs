//! Generalized decimation: the paper's own algorithm, step by step.
//!
//! Balmelli, Vetterli and Liebling, "Mesh Optimization Using Global Error with Application to Geometry
//! Simplification", section 2.1 (slopes, the optimization algorithm) and 2.2 (the update algorithm,
//! equation 5). Removing a vertex `v` removes its *merging domain*, `v` and all descendants that are left.
//! Each step removes the domain whose slope `-ΔD / ΔR` is least: the distortion that it adds, for each vertex
//! that it saves. A tie goes to the coarser step `l`, then to the smaller number.
//!
//! How merging-domain intersections come out by themselves: removing a vertex `w` whose children are gone
//! merges four triangles (two at the rim) into two (one). What that costs depends on `w` alone, not on
//! what else is gone, for the triangles are the same each time. So each vertex has a static *delta*, the
//! distortion of a set of vertices is the sum of their deltas, and `ΔD` of a domain is that of the descendants
//! that are left. When a domain goes, finest vertices first, each `w` is alone in its own domain by
//! the time it is its turn, and equation 5 takes the one delta of `w` from each ancestor once; a vertex that
//! lies in several overlapping domains is counted in each of them, and never twice.
//!
//! Where this departs from the paper:
//! - Deltas are rounded to whole numbers of units, which are at most 2^-61 of the sum of all. So sums of them stay
//!   exact through any number of updates, and domains of equal slope are seen to be.
//! - The least slope is found by a queue, not by minima over the subtrees: slopes mostly rise (domains lose
//!   their cheapest part), so a vertex is queued by a bound from below, and again when it proves too low.
//! - `ΔD` here is what the distortion grows by; the paper's is negative.
//!
//! This is the baseline that faster methods are held against. Each removal visits all ancestors, about a
//! hundred on a grid of 1025 x 1025.

use super::graph::{Ancestors, Graph, staying};
use super::removals::Removals;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// The vertices in the order in which the paper's algorithm removes them, if `deltas`, one a vertex, is what each
/// adds to the distortion: finite, or infinite for vertices that must stay. They and their ancestors are left out.
/// O(n log n) visits of ancestors, about 90 bytes a vertex. `report` hears of the part that is done, and may end it.
pub(super) fn decimate<G: Graph, E>(
    graph: &G,
    deltas: &[impl Copy + Into<f64>],
    mut report: impl FnMut(f32) -> Result<(), E>,
) -> Result<Removals, E> {
    let mut domains = Domains::new(graph, deltas, |part| report(STARTING * part))?;
    let vertices = domains.decided.len();
    while domains.remove_least() {
        if domains.removals.steps.len().is_multiple_of(A_REPORT) {
            let gone = domains.removals.order.len() as f32 / vertices as f32;
            report(STARTING + (1.0 - STARTING) * gone)?;
        }
    }
    Ok(domains.removals)
}

/// Vertices or steps between two reports.
const A_REPORT: usize = 4096;
/// The part of the time, about, that summing up all domains takes.
const STARTING: f32 = 0.3;

/// What removing a domain changes.
#[derive(Debug, Clone, Copy)]
struct Change {
    /// By how much the distortion grows, in the unit of [`whole`].
    distortion: i64,
    /// By how much the rate falls: how many vertices go.
    rate: u32,
}

// Changes are ordered by slope, as the fractions that they are.
impl Ord for Change {
    fn cmp(&self, other: &Self) -> Ordering {
        let [own, others] = [(self, other), (other, self)]
            .map(|(above, below)| i128::from(above.distortion) * i128::from(below.rate));
        own.cmp(&others)
    }
}

impl PartialOrd for Change {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Change {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Change {}

/// Deltas as whole numbers, in the smallest power of two for a unit with which no sum of some of them overflows. Those
/// that are infinite count for nothing.
fn whole(deltas: &[impl Copy + Into<f64>]) -> Vec<i64> {
    let finite =
        deltas.iter().map(|&delta| delta.into()).map(|delta| if delta.is_finite() { delta } else { 0.0 });
    let total: f64 = finite.clone().map(f64::abs).sum();
    // The exponent, as it is stored: with it the power of two is exact, the same everywhere.
    let exponent = 2 * 1023 + 61 - (total.to_bits() >> 52);
    let units = f64::from_bits(exponent.min(2 * 1023) << 52);
    finite.map(|delta| (delta * units).round() as i64).collect()
}

/// The merging domains of all vertices that are left.
struct Domains<'a, G: Graph> {
    graph: &'a G,
    /// What removing the domain of each vertex changes now.
    changes: Vec<Change>,
    /// Vertices that are gone or have to stay.
    decided: Vec<bool>,
    /// The change that each vertex is queued with; its slope is never above the present one.
    queued: Vec<Change>,
    /// Changes, levels and vertices. Entries that are not as `queued` says are void.
    queue: BinaryHeap<Reverse<(Change, u32, u32)>>,
    /// The last step that came past each vertex.
    visited: Vec<u32>,
    ancestors: Ancestors,
    removals: Removals,
}

impl<'a, G: Graph> Domains<'a, G> {
    fn new<E>(
        graph: &'a G,
        deltas: &[impl Copy + Into<f64>],
        mut report: impl FnMut(f32) -> Result<(), E>,
    ) -> Result<Self, E> {
        let vertices = graph.vertices();
        let decided = staying(graph, deltas);
        let own = whole(deltas);
        let mut changes: Vec<_> = own.iter().map(|&distortion| Change { distortion, rate: 1 }).collect();
        let mut ancestors = Ancestors::new(graph);
        for (vertex, &distortion) in own.iter().enumerate() {
            ancestors.visit(vertex, |ancestor| {
                changes[ancestor].distortion += distortion;
                changes[ancestor].rate += 1;
            });
            if vertex.is_multiple_of(A_REPORT) {
                report(vertex as f32 / vertices as f32)?;
            }
        }
        let entry = |vertex| Reverse((changes[vertex], graph.level(vertex), vertex as u32));
        Ok(Self {
            graph,
            queue: (0..vertices).filter(|&vertex| !decided[vertex]).map(entry).collect(),
            queued: changes.clone(),
            changes,
            decided,
            visited: vec![0; vertices],
            ancestors,
            removals: Removals::default(),
        })
    }

    /// Removes the domain of least slope; `false` if nothing is left.
    fn remove_least(&mut self) -> bool {
        while let Some(Reverse((change, level, vertex))) = self.queue.pop() {
            let root = vertex as usize;
            if self.decided[root] || change != self.queued[root] {
                continue;
            }
            if change == self.changes[root] {
                self.remove(root);
                return true;
            }
            self.enqueue(root, level);
        }
        false
    }

    fn enqueue(&mut self, vertex: usize, level: u32) {
        self.queued[vertex] = self.changes[vertex];
        self.queue.push(Reverse((self.changes[vertex], level, vertex as u32)));
    }

    /// Removes the domain of a vertex: the paper's update algorithm.
    fn remove(&mut self, root: usize) {
        let step = self.removals.steps.len() as u32 + 1;
        let mut domain = vec![root];
        self.visited[root] = step;
        let mut next = 0;
        while next < domain.len() {
            for child in self.graph.children(domain[next]) {
                if !self.decided[child] && self.visited[child] != step {
                    self.visited[child] = step;
                    domain.push(child);
                }
            }
            next += 1;
        }
        let mut outside = Vec::new();
        // Breadth first, the finest came last.
        for &vertex in domain.iter().rev() {
            let own = self.changes[vertex];
            debug_assert_eq!(own.rate, 1, "its descendants are gone");
            self.ancestors.visit(vertex, |ancestor| {
                self.changes[ancestor].distortion -= own.distortion;
                self.changes[ancestor].rate -= own.rate;
                if self.visited[ancestor] != step {
                    self.visited[ancestor] = step;
                    outside.push(ancestor);
                }
            });
            self.decided[vertex] = true;
            self.removals.order.push(vertex as u32);
        }
        self.removals.steps.push(self.removals.order.len());
        for ancestor in outside {
            if !self.decided[ancestor] && self.changes[ancestor] < self.queued[ancestor] {
                self.enqueue(ancestor, self.graph.level(ancestor));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Change, Domains, Removals, whole};
    use crate::rate_distortion::baselines;
    use crate::rate_distortion::brute_force::{Terrain, above_hull, exhaustive, lower_hull};
    use crate::rate_distortion::graph::Graph;
    use crate::rate_distortion::layout::Layout;
    use std::convert::Infallible;

    fn decimate(layout: &Layout, deltas: &[f64]) -> Removals {
        let Ok(removals) = super::decimate(layout, deltas, |_| Ok::<_, Infallible>(()));
        removals
    }

    /// The algorithm as the paper words it: all domains and all sums anew before each step.
    fn naive(layout: &Layout, deltas: &[f64]) -> Removals {
        let own = whole(deltas);
        let mut gone = vec![false; own.len()];
        let mut removals = Removals::default();
        let domain = |gone: &[bool], root: usize| {
            let mut domain = vec![root];
            let mut next = 0;
            while next < domain.len() {
                let children = Graph::children(layout, domain[next]);
                let new: Vec<_> = children.filter(|child| !gone[*child] && !domain.contains(child)).collect();
                domain.extend(new);
                next += 1;
            }
            domain
        };
        while removals.order.len() < own.len() {
            let candidates = (0..own.len()).filter(|&vertex| !gone[vertex]).map(|vertex| {
                let domain = domain(&gone, vertex);
                let distortion = domain.iter().map(|&member| own[member]).sum();
                let change = Change { distortion, rate: domain.len() as u32 };
                (change, Graph::level(layout, vertex), vertex)
            });
            let (.., root) = candidates.min().unwrap();
            for vertex in domain(&gone, root).into_iter().rev() {
                gone[vertex] = true;
                removals.order.push(vertex as u32);
            }
            removals.steps.push(removals.order.len());
        }
        removals
    }

    #[test]
    fn steps_are_those_of_the_paper_done_naively() {
        let layouts = [([1, 1], 0), ([1, 1], 1), ([1, 1], 3), ([2, 1], 2), ([3, 2], 2), ([3, 1], 0)];
        for (seed, (base, depth)) in (1..).zip(layouts) {
            let fractal = Terrain::fractal(Layout::new(base, depth), seed);
            // Few heights, many ties.
            let steps = Terrain::of(Layout::new(base, depth), |x, y| f64::from(fractal.height(x, y) > 40.0));
            for terrain in [&fractal, &steps] {
                let deltas = terrain.deltas();
                assert_eq!(decimate(&terrain.layout, &deltas), naive(&terrain.layout, &deltas));
            }
        }
    }

    #[test]
    fn the_roots_change_is_the_global_distortion_at_each_step() {
        // Depth, and how many steps lie between two that are looked at.
        for (depth, every) in [(2, 1), (3, 1), (5, 37)] {
            let terrain = Terrain::fractal(Layout::new([1, 1], depth), 7);
            let deltas = terrain.deltas();
            let unit = whole(&deltas).iter().sum::<i64>() as f64 / deltas.iter().sum::<f64>();
            let Ok(mut domains) = Domains::new(&terrain.layout, &deltas, |_| Ok::<_, Infallible>(()));
            let all = domains.changes[0].distortion;
            for step in 1.. {
                if !domains.remove_least() {
                    break;
                }
                if step % every != 0 {
                    continue;
                }
                let rate_left = domains.changes[0].rate as usize;
                assert_eq!(
                    rate_left + domains.removals.order.len(),
                    deltas.len() + usize::from(domains.decided[0])
                );
                let surface = terrain.surface(&domains.decided);
                terrain.assert_conforming(&surface);
                // The root's own change remains as it was when it goes itself.
                let left = if domains.decided[0] { 0 } else { domains.changes[0].distortion };
                let tracked = (all - left) as f64 / unit;
                let recomputed = terrain.squared_error(&surface);
                assert!((tracked - recomputed).abs() <= 1e-12 * all as f64 / unit, "{tracked} {recomputed}");
            }
        }
    }

    #[test]
    fn a_plane_goes_at_once() {
        let terrain = Terrain::of(Layout::new([1, 1], 3), |x, y| 3.0 * x as f64 - 2.0 * y as f64);
        assert_eq!(decimate(&terrain.layout, &terrain.deltas()).steps, [77]);
    }

    #[test]
    fn nothing_that_must_stay_goes_and_the_rest_goes_all_the_same() {
        let terrain = Terrain::fractal(Layout::new([2, 1], 3), 3);
        let mut deltas = terrain.deltas();
        let layout = &terrain.layout;
        let rim = layout.level(6).start;
        deltas[rim] = f64::INFINITY;
        let stays = crate::rate_distortion::graph::staying(layout, &deltas);
        for removals in [
            decimate(layout, &deltas),
            baselines::insertion(layout, &deltas),
            baselines::decimation(layout, &deltas),
        ] {
            let mut went: Vec<_> = removals.order.iter().map(|&vertex| vertex as usize).collect();
            went.sort_unstable();
            assert!(went.into_iter().eq((0..deltas.len()).filter(|&vertex| !stays[vertex])));
        }
    }

    /// By how many decibels each step is above the best that there is at its rate.
    fn excess(removals: &Removals, deltas: &[f64], best: impl Fn(usize) -> f64) -> Vec<f64> {
        let distortions = removals.distortions(deltas);
        let steps = removals.steps.iter().map(|&gone| (distortions[gone], best(gone)));
        let above = steps.filter(|&(_, best)| best > 0.0).map(|(own, best)| 10.0 * (own / best).log10());
        above.inspect(|above| assert!(*above > -1e-9)).collect()
    }

    /// Deltas that are whole, so that hulls can be compared exactly.
    fn whole_deltas(terrain: &Terrain) -> (Vec<f64>, Vec<i64>) {
        let whole: Vec<_> = terrain.deltas().iter().map(|delta| (delta * 64.0).round()).collect();
        (whole.clone(), whole.iter().map(|&delta| delta as i64).collect())
    }

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    #[test]
    fn no_set_of_5_by_5_is_better_by_much() {
        let mut above = Vec::new();
        for seed in 0..12 {
            let terrain = Terrain::fractal(Layout::new([1, 1], 2), seed);
            let (deltas, exact) = whole_deltas(&terrain);
            let (least, sets) = exhaustive(&terrain.layout, &deltas);
            assert_eq!(sets, 5489, "of 2^21, as counted by trying each");
            let hull = lower_hull(&terrain.layout, &exact);
            for &(removed, distortion) in &hull {
                assert_eq!(least[removed], distortion as f64, "corners of the hull are optima");
            }
            for (removed, &least) in least.iter().enumerate() {
                assert!(above_hull(&hull, removed, least) >= 0.0, "nothing lies below the hull");
            }
            above.extend(excess(&decimate(&terrain.layout, &deltas), &deltas, |gone| least[gone]));
        }
        assert!(mean(&above) <= 0.01, "{} dB above the optimum on average", mean(&above));
    }

    #[test]
    fn the_exact_hull_of_9_by_9_is_better_by_little() {
        let mut above = Vec::new();
        for seed in 0..4 {
            let terrain = Terrain::fractal(Layout::new([1, 1], 3), seed);
            let (deltas, exact) = whole_deltas(&terrain);
            let hull = lower_hull(&terrain.layout, &exact);
            let removals = decimate(&terrain.layout, &deltas);
            let distortions = removals.distortions(&deltas);
            above.extend(excess(&removals, &deltas, |gone| {
                distortions[gone] - above_hull(&hull, gone, distortions[gone])
            }));
        }
        assert!(mean(&above) <= 0.02, "{} dB above the hull on average", mean(&above));
    }

    #[test]
    fn distortion_falls_at_far_fewer_steps_than_one_at_a_time() {
        let terrain = Terrain::fractal(Layout::new([1, 1], 5), 9);
        let deltas = terrain.deltas();
        let falls = |removals: &Removals| {
            let distortions = removals.distortions(&deltas);
            let curve: Vec<_> = removals.steps.iter().map(|&gone| distortions[gone]).collect();
            curve.windows(2).filter(|pair| pair[1] < pair[0] * (1.0 - 1e-12)).count()
        };
        let own = falls(&decimate(&terrain.layout, &deltas));
        let one_at_a_time = falls(&baselines::decimation(&terrain.layout, &deltas));
        assert!(own * 10 <= one_at_a_time, "{own} {one_at_a_time}");
    }
}
