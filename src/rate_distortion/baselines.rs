//! The simpler orders that the paper compares itself with: greedy insertion, and one vertex at a time.
//!
//! Balmelli, Vetterli and Liebling, "Mesh Optimization Using Global Error with Application to Geometry
//! Simplification". Insertion (section 4.2) is that of Lindstrom et al., "Real-time continuous level of detail
//! rendering of height fields" (SIGGRAPH 1996), and Pajarola, "Large scale terrain visualization using the
//! restricted quadtree triangulation" (Visualization 1998): from coarse to fine, the vertex with the largest
//! error next, with the parents that it cannot do without. Decimation of terminal vertices only is the "limited
//! version" of section 3.2 and Figure 12.
//!
//! Either takes any number for the error of a vertex, and since errors of vertices do not change here, neither
//! needs updates. [`interpolation_errors`] are the local ones that the paper's baselines use; the deltas of the
//! distortion are the global ones. The paper does not say which vertices may be inserted next: here it is the
//! children of those that are in, as in a refinement that looks at the triangles that it has.

use super::graph::{Graph, staying};
use super::layout::Layout;
use super::priority::rank;
use super::removals::Removals;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The error by which a vertex is chosen to go, or to come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Criterion {
    /// How far the vertex lies, vertically, from what takes its place.
    Local,
    /// By how much the distortion of the whole changes.
    Global,
}

/// The local error: how far each vertex of a layout lies above or below the middle of the edge that it splits, by
/// the finite `height` at an `x` and a `y`.
pub(super) fn interpolation_errors(layout: &Layout, height: impl Fn(usize, usize) -> f32) -> Vec<f64> {
    let height = |(x, y)| f64::from(height(x, y));
    let error = |vertex| {
        let site = layout.site(vertex);
        let [from, to] = layout.edge(site);
        (height((site.x, site.y)) - (height(from) + height(to)) / 2.0).abs()
    };
    (0..layout.vertices()).map(error).collect()
}

/// Greedy insertion: again and again the vertex of largest error (a tie goes to the smaller number) among the
/// children of what is in, with all ancestors that are not in yet. `errors` has one number a vertex; an infinite
/// one is that of a vertex that must stay: it and its ancestors are in from the start, and left out of the result.
/// The result is turned over: what came last goes first. O(n log n).
pub(super) fn insertion(graph: &impl Graph, errors: &[impl Copy + Into<f64>]) -> Removals {
    let vertices = graph.vertices();
    let mut inserted = staying(graph, errors);
    let entry = |vertex: usize| (rank(errors[vertex].into()), Reverse(vertex as u32));
    let is_next = |&vertex: &usize| {
        let mut parents = graph.parents(vertex).peekable();
        !inserted[vertex] && (parents.peek().is_none() || parents.any(|parent| inserted[parent]))
    };
    let mut candidates: BinaryHeap<_> = (0..vertices).filter(is_next).map(entry).collect();
    let mut order = Vec::with_capacity(vertices);
    let mut starts = Vec::new();
    while let Some((_, Reverse(vertex))) = candidates.pop() {
        // A child has two parents, and may have come in with another's forced ones.
        if inserted[vertex as usize] {
            continue;
        }
        starts.push(order.len());
        let mut pending = vec![vertex as usize];
        while let Some(&vertex) = pending.last() {
            if let Some(parent) = graph.parents(vertex).find(|&parent| !inserted[parent]) {
                pending.push(parent);
                continue;
            }
            pending.pop();
            inserted[vertex] = true;
            order.push(vertex as u32);
            candidates.extend(graph.children(vertex).filter(|&child| !inserted[child]).map(entry));
        }
    }
    order.reverse();
    let steps = starts.into_iter().rev().map(|start| order.len() - start).collect();
    Removals { order, steps }
}

/// One vertex at a time: again and again the one of least error whose children are gone; a tie goes to the
/// coarser level, then to the smaller number. `errors` has one number a vertex; an infinite one is that of a vertex
/// that must stay: it and its ancestors are left out. O(n log n).
pub(super) fn decimation(graph: &impl Graph, errors: &[impl Copy + Into<f64>]) -> Removals {
    let vertices = graph.vertices();
    let stays = staying(graph, errors);
    let entry = |vertex: usize| Reverse((rank(errors[vertex].into()), graph.level(vertex), vertex as u32));
    let mut children: Vec<_> = (0..vertices).map(|vertex| graph.children(vertex).count()).collect();
    let is_terminal = |&vertex: &usize| children[vertex] == 0 && !stays[vertex];
    let mut terminal: BinaryHeap<_> = (0..vertices).filter(is_terminal).map(entry).collect();
    let mut order = Vec::with_capacity(vertices);
    while let Some(Reverse((.., vertex))) = terminal.pop() {
        order.push(vertex);
        for parent in graph.parents(vertex as usize) {
            children[parent] -= 1;
            if children[parent] == 0 && !stays[parent] {
                terminal.push(entry(parent));
            }
        }
    }
    let steps = (1..=order.len()).collect();
    Removals { order, steps }
}

#[cfg(test)]
mod tests {
    use super::{decimation, insertion, interpolation_errors};
    use crate::rate_distortion::brute_force::Terrain;
    use crate::rate_distortion::graph::Graph;
    use crate::rate_distortion::layout::Layout;
    use crate::rate_distortion::merging::decimate;
    use crate::rate_distortion::removals::Removals;
    use std::convert::Infallible;

    fn terrains() -> impl Iterator<Item = Terrain> {
        let layouts = [([1, 1], 0), ([1, 1], 2), ([1, 1], 3), ([3, 2], 2)];
        (1..).zip(layouts).map(|(seed, (base, depth))| Terrain::fractal(Layout::new(base, depth), seed))
    }

    fn local(terrain: &Terrain) -> Vec<f64> {
        interpolation_errors(&terrain.layout, |x, y| terrain.height(x, y))
    }

    /// What stands after each step of insertion, done naively, the coarsest first.
    fn insertion_naively(layout: &Layout, errors: &[f64]) -> Vec<Vec<bool>> {
        let mut stands = vec![false; errors.len()];
        let mut states = vec![stands.clone()];
        while stands.contains(&false) {
            let may_come = |&vertex: &usize| {
                let mut parents = Graph::parents(layout, vertex);
                !stands[vertex] && (Graph::level(layout, vertex) == 1 || parents.any(|parent| stands[parent]))
            };
            let candidates = (0..errors.len()).filter(may_come);
            let mut coming =
                vec![candidates.reduce(|a, b| if errors[b] > errors[a] { b } else { a }).unwrap()];
            while let Some(vertex) = coming.pop() {
                stands[vertex] = true;
                coming.extend(Graph::parents(layout, vertex).filter(|&parent| !stands[parent]));
            }
            states.push(stands.clone());
        }
        states.reverse();
        states
    }

    #[test]
    fn insertion_takes_the_largest_error_with_what_it_needs() {
        for terrain in terrains() {
            for errors in [terrain.deltas(), local(&terrain)] {
                let removals = insertion(&terrain.layout, &errors);
                let states = insertion_naively(&terrain.layout, &errors);
                let mut stands = vec![true; errors.len()];
                assert_eq!(removals.steps.len() + 1, states.len());
                assert_eq!(stands, states[0]);
                let mut gone = 0;
                for (&step, state) in removals.steps.iter().zip(&states[1..]) {
                    removals.order[gone..step].iter().for_each(|&vertex| stands[vertex as usize] = false);
                    gone = step;
                    assert_eq!(&stands, state);
                }
            }
        }
    }

    #[test]
    fn decimation_takes_the_least_error_that_has_no_children_left() {
        for terrain in terrains() {
            for errors in [terrain.deltas(), local(&terrain)] {
                let layout = &terrain.layout;
                let mut stands = vec![true; errors.len()];
                for &vertex in &decimation(layout, &errors).order {
                    let is_free = |&vertex: &usize| {
                        stands[vertex] && !Graph::children(layout, vertex).any(|child| stands[child])
                    };
                    let key = |vertex: usize| (Graph::level(layout, vertex), vertex);
                    let least = (0..errors.len()).filter(is_free).reduce(|a, b| {
                        let before = errors[b] < errors[a] || (errors[b] == errors[a] && key(b) < key(a));
                        if before { b } else { a }
                    });
                    assert_eq!(least, Some(vertex as usize));
                    stands[vertex as usize] = false;
                }
                assert!(!stands.contains(&true));
            }
        }
    }

    /// Invariant: the distortion that is tracked is that of the surface, which is conforming, at every step.
    #[test]
    fn what_is_tracked_is_what_is_measured() {
        // Without any vertex there is nothing to track.
        for terrain in terrains().skip(1) {
            let (deltas, local) = (terrain.deltas(), local(&terrain));
            let layout = &terrain.layout;
            let Ok(generalized) = decimate(layout, &deltas, |_| Ok::<_, Infallible>(()));
            let all: [Removals; 5] = [
                generalized,
                insertion(layout, &deltas),
                insertion(layout, &local),
                decimation(layout, &deltas),
                decimation(layout, &local),
            ];
            for removals in all {
                let distortions = removals.distortions(&deltas);
                let most = distortions.iter().copied().fold(1.0, f64::max);
                let mut gone = vec![false; deltas.len()];
                assert_eq!(removals.order.len(), deltas.len());
                for (removed, distortion) in distortions.into_iter().enumerate() {
                    let surface = terrain.surface(&gone);
                    terrain.assert_conforming(&surface);
                    let measured = terrain.squared_error(&surface);
                    assert!((distortion - measured).abs() <= 1e-10 * most);
                    if let Some(&vertex) = removals.order.get(removed) {
                        gone[vertex as usize] = true;
                    }
                }
            }
        }
    }
}
