//! The stars of a forest: which vertices can only go before which, for the flow that finds the slopes.

use super::super::flow::{Flow, Hierarchy, Operation};
use super::forest::Forest;
use crate::workers::Workers;

/// A child that is none: beside a border there are two.
const NONE: u32 = u32::MAX;

/// The children of all vertices that have any, by number from the first that may go.
///
/// Across the edges of the complex quads lie turned against each other, and to work out who is whose child costs more
/// than a sweep does; so it is noted once.
pub(super) struct Stars<'a> {
    forest: &'a Forest,
    /// Twice the child, plus the slot in which it gives to this parent.
    children: Vec<[u32; 4]>,
}

impl<'a> Stars<'a> {
    pub(super) fn new(forest: &'a Forest) -> Self {
        let corners = forest.complex().corners();
        let parents = corners..forest.level(forest.levels()).start;
        let children = parents.map(|parent| {
            let mut children = [NONE; 4];
            for (slot, (quad, triangle)) in forest.split(parent).into_iter().flatten().enumerate() {
                for (half, triangle) in triangle.halves().into_iter().enumerate() {
                    let child = forest.midpoint(quad, &triangle) - corners;
                    children[2 * slot + half] = (2 * child + forest.slot(quad, &triangle)) as u32;
                }
            }
            children
        });
        Self { forest, children: children.collect() }
    }
}

impl Hierarchy for Stars<'_> {
    fn levels(&self) -> u32 {
        self.forest.levels()
    }

    fn stars<O: Operation>(&self, level: u32, flow: &mut Flow, _workers: &Workers) {
        let corners = self.forest.complex().corners();
        for parent in self.forest.level(level) {
            let parent = parent - corners;
            match self.children[parent] {
                [first, second, NONE, NONE] => star::<O, 2>(flow, parent, [first, second]),
                children => star::<O, 4>(flow, parent, children),
            }
        }
    }
}

fn star<O: Operation, const N: usize>(flow: &mut Flow, parent: usize, children: [u32; N]) {
    let at = children.map(|child| ((child / 2) as usize, (child % 2) as usize));
    let slopes = at.map(|(child, _)| flow.slopes[child]);
    let given = at.map(|(child, slot)| flow.given[slot][child]);
    let (level, slopes, given) = O::on(flow.slopes[parent], slopes, given);
    flow.slopes[parent] = level;
    for (i, (child, slot)) in at.into_iter().enumerate() {
        flow.slopes[child] = slopes[i];
        flow.given[slot][child] = given[i];
    }
}
