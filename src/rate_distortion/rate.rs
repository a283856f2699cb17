//! Vertices that do not cost the same: the rate is a functional of the user's.
//!
//! Balmelli, Vetterli and Liebling, sections 2.1 and 5, leave both functionals to the application; a coder, for one,
//! counts the bits that a vertex takes. The rate is additive as the distortion is, and what `flow.rs` does for one
//! vertex each holds for any cost: slopes are distortion over cost, and a star is levelled to the largest mean of
//! its parent and some of its children in which each counts as much as it costs.
//!
//! One star after the other, without the fast paths for equal costs: about a second for a million samples.

use super::flow::{Flow, NEVER};
use super::layout::{Layout, Site};

/// The slopes at which vertices of these costs, all positive, go: none less than that of a child.
pub(crate) fn solve<E>(
    layout: &Layout,
    deltas: &[f32],
    costs: &[f32],
    sweeps: u32,
    mut report: impl FnMut(f32) -> Result<(), E>,
) -> Result<Vec<f32>, E> {
    let per_cost = |(&delta, &cost): (&f32, &f32)| (delta / cost).clamp(-NEVER, NEVER);
    let mut flow = Flow {
        slopes: deltas.iter().zip(costs).map(per_cost).collect(),
        given: [vec![0.0; deltas.len()], vec![0.0; deltas.len()]],
    };
    raise(layout, &mut flow.slopes, |slope| slope >= NEVER);
    for sweep in 0..sweeps {
        for step in 1..layout.levels() {
            let level = if sweep % 2 == 0 { layout.levels() - step } else { step };
            layout.level(level).for_each(|vertex| relax(layout, costs, &mut flow, vertex));
        }
        report((sweep + 1) as f32 / sweeps as f32)?;
    }
    raise(layout, &mut flow.slopes, |_| true);
    Ok(flow.slopes)
}

/// Raises each vertex to those of its children that are to be looked at.
fn raise(layout: &Layout, slopes: &mut [f32], counts: impl Fn(f32) -> bool) {
    for vertex in (0..layout.vertices()).rev() {
        let children = layout.children(layout.site(vertex)).map(|child| slopes[layout.index(child)]);
        slopes[vertex] = children.filter(|&slope| counts(slope)).fold(slopes[vertex], f32::max);
    }
}

/// Levels the star of a vertex.
fn relax(layout: &Layout, costs: &[f32], flow: &mut Flow, vertex: usize) {
    let site = layout.site(vertex);
    if flow.slopes[vertex] >= NEVER {
        // Nothing flows to what has more than all.
        return;
    }
    let children: Vec<(usize, usize)> =
        layout.children(site).map(|child| (layout.index(child), slot(child, site))).collect();
    let amount = |flow: &Flow, vertex: usize| f64::from(flow.slopes[vertex]) * f64::from(costs[vertex]);
    // As if nothing were given yet.
    let given = |flow: &Flow, (child, slot): (usize, usize)| f64::from(flow.given[slot][child]);
    let mut sum = amount(flow, vertex) - children.iter().map(|&child| given(flow, child)).sum::<f64>();
    let mut cost = f64::from(costs[vertex]);
    let have: Vec<f64> = children.iter().map(|&child| amount(flow, child.0) + given(flow, child)).collect();
    let slope = |i: usize| have[i] / f64::from(costs[children[i].0]);
    let mut order: Vec<usize> = (0..children.len()).collect();
    order.sort_by(|&a, &b| slope(b).total_cmp(&slope(a)).then(a.cmp(&b)));
    let mut level = sum / cost;
    for &i in &order {
        sum += have[i];
        cost += f64::from(costs[children[i].0]);
        level = level.max(sum / cost);
    }
    flow.slopes[vertex] = level as f32;
    for (i, &(child, slot)) in children.iter().enumerate() {
        let keeps = slope(i).min(level);
        flow.slopes[child] = keeps as f32;
        flow.given[slot][child] = (have[i] - keeps * f64::from(costs[child])) as f32;
    }
}

/// Whether a parent is the first (0) or the second (1) of a child's: the first is above or on the left.
fn slot(child: Site, parent: Site) -> usize {
    usize::from((parent.y, parent.x) > (child.y, child.x))
}
