//! Vertices taken away one by one, that which costs least first.
//!
//! The cost of a vertex is by how much the squared error over the samples grows, exactly, when it goes to the best
//! of its neighbours (Hoppe's half-edge collapse, with a cost that is measured in place of a quadric). The edges
//! around are flipped then. Costs around change; they are worked out again only when the vertex comes up, which
//! is where an old one that was too high costs quality.

use super::flips::Edges;
use super::surface::Surface;
use super::triangulation::{Fan, next, previous};
use crate::monitor::{Cancelled, Monitor};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How many vertices go between two reports.
const STRIDE: usize = 1024;

/// What is known of a vertex's cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// In the queue with its cost.
    Known,
    /// In the queue with a cost that was true before something around it changed.
    Outdated,
    /// Not in the queue: it cannot go, or is gone.
    Out,
}

/// Takes vertices away until `target` are left or none can go. `report` is told which part is done.
pub(super) fn collapse_to(
    surface: &mut Surface,
    target: usize,
    monitor: &mut Monitor,
    report: impl Fn(f32) -> f32,
) -> Result<(), Cancelled> {
    let slots = surface.mesh.vertices.len();
    let left = (0..slots as u32).filter(|&vertex| surface.mesh.has_vertex(vertex)).count();
    let excess = left.saturating_sub(target);
    if excess == 0 {
        return Ok(());
    }
    let mut collapses = Collapses {
        surface,
        queue: BinaryHeap::new(),
        states: vec![State::Out; slots],
        targets: vec![0; slots],
        fan: Fan::default(),
        edges: Edges::default(),
        changed: Vec::new(),
    };
    for vertex in 0..slots as u32 {
        if (vertex as usize).is_multiple_of(STRIDE) {
            monitor.report(report(0.0))?;
        }
        collapses.look_at(vertex);
    }
    for taken in 0..excess {
        if taken.is_multiple_of(STRIDE) {
            monitor.report(report(taken as f32 / excess as f32))?;
        }
        if !collapses.take_cheapest() {
            break;
        }
    }
    Ok(())
}

struct Collapses<'a, 'b> {
    surface: &'a mut Surface<'b>,
    /// Costs, as whole numbers in the same order, and vertices.
    queue: BinaryHeap<Reverse<u64>>,
    states: Vec<State>,
    /// Where each vertex goes, by the index in its fan, while its cost is known.
    targets: Vec<u32>,
    fan: Fan,
    edges: Edges,
    changed: Vec<u32>,
}

impl Collapses<'_, '_> {
    /// Works out what a vertex costs and puts it into the queue, if it can go.
    fn look_at(&mut self, vertex: u32) {
        self.states[vertex as usize] = State::Out;
        if !self.surface.mesh.has_vertex(vertex) {
            return;
        }
        self.surface.mesh.gather(vertex, &mut self.fan);
        if let Some((cost, target)) = self.surface.cheapest_collapse(vertex, &self.fan) {
            self.targets[vertex as usize] = target as u32;
            self.states[vertex as usize] = State::Known;
            self.queue.push(Reverse(key(cost, vertex)));
        }
    }

    /// Takes the cheapest vertex away; `false` if none can go.
    fn take_cheapest(&mut self) -> bool {
        while let Some(Reverse(key)) = self.queue.pop() {
            let vertex = key as u32;
            match self.states[vertex as usize] {
                State::Out => {}
                State::Outdated => self.look_at(vertex),
                State::Known => {
                    self.take(vertex);
                    return true;
                }
            }
        }
        false
    }

    fn take(&mut self, vertex: u32) {
        let Self { surface, fan, edges, changed, targets, .. } = self;
        let target = targets[vertex as usize] as usize;
        surface.mesh.gather(vertex, fan);
        surface.collapse(vertex, fan, target);
        self.states[vertex as usize] = State::Out;
        changed.clear();
        changed.extend_from_slice(&fan.ring);
        let staying = fan.staying(target).map(|spoke| fan.spokes[spoke]);
        edges.add(staying.flat_map(|spoke| [spoke, next(spoke), previous(spoke)]));
        edges.settle(surface, |quad| changed.extend(quad));
        let changed = std::mem::take(&mut self.changed);
        for &vertex in &changed {
            match self.states[vertex as usize] {
                // It may have become able to go; there is no cost to wait for.
                State::Out => self.look_at(vertex),
                State::Known | State::Outdated => self.states[vertex as usize] = State::Outdated,
            }
        }
        self.changed = changed;
    }
}

/// A number that orders by cost, ties by vertex, whose lower half it is. Costs may be negative.
fn key(cost: f64, vertex: u32) -> u64 {
    let bits = (cost as f32).to_bits();
    let ordered = if bits >> 31 == 1 { !bits } else { bits | 1 << 31 };
    u64::from(ordered) << 32 | u64::from(vertex)
}
