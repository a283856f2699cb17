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
pub(super) fn insertion<G: Graph>(graph: &G, errors: &[impl Copy + Into<f64>]) -> Removals {
    let vertices = graph.vertices();
    let mut inserted = staying(graph, errors);
    let entry = |vertex: usize| (rank(errors[vertex].into()), Reverse(vertex as u32));
    let is_next = |&vertex: &usize| {
        let parents = graph.parents(graph.site(vertex)).map(|parent| graph.vertex(parent));
        let mut parents = parents.peekable();
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
        let mut pending = vec![graph.site(vertex as usize)];
        while let Some(&site) = pending.last() {
            let vertex = graph.vertex(site);
            let missing = |&parent: &G::Site| !inserted[graph.vertex(parent)];
            if let Some(parent) = graph.parents(site).find(missing) {
                pending.push(parent);
                continue;
            }
            pending.pop();
            inserted[vertex] = true;
            order.push(vertex as u32);
            let children = graph.children(site).map(|child| graph.vertex(child));
            candidates.extend(children.filter(|&child| !inserted[child]).map(entry));
        }
    }
    order.reverse();
    let steps = starts.into_iter().rev().map(|start| order.len() - start).collect();
    Removals { order, steps }
}

/// One vertex at a time: again and again the one of least error whose children are gone; a tie goes to the
/// coarser level, then to the smaller number. `errors` has one number a vertex; an infinite one is that of a vertex
/// that must stay: it and its ancestors are left out. O(n log n).
pub(super) fn decimation<G: Graph>(graph: &G, errors: &[impl Copy + Into<f64>]) -> Removals {
    let vertices = graph.vertices();
    let stays = staying(graph, errors);
    let entry = |vertex: usize, site: G::Site| {
        Reverse((rank(errors[vertex].into()), graph.level(site), vertex as u32))
    };
    let mut children: Vec<u8> = Vec::with_capacity(vertices);
    let mut terminal = BinaryHeap::new();
    for vertex in 0..vertices {
        let site = graph.site(vertex);
        children.push(graph.children(site).count() as u8);
        if children[vertex] == 0 && !stays[vertex] {
            terminal.push(entry(vertex, site));
        }
    }
    let mut order = Vec::with_capacity(vertices);
    while let Some(Reverse((.., vertex))) = terminal.pop() {
        order.push(vertex);
        for parent in graph.parents(graph.site(vertex as usize)) {
            let vertex = graph.vertex(parent);
            children[vertex] -= 1;
            if children[vertex] == 0 && !stays[vertex] {
                terminal.push(entry(vertex, parent));
            }
        }
    }
    let steps = (1..=order.len()).collect();
    Removals { order, steps }
}
