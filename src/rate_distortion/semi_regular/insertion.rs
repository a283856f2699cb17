//! Greedy insertion: the baseline that decimation by global distortion is measured against.
//!
//! Balmelli, Vetterli and Liebling, section 4.2, compare with the refinement of Lindstrom et al. and Pajarola on
//! terrain, which goes by local error; here on a surface. From the corners on, the vertex comes next that is farthest
//! from the middle of the edge that it splits, after the vertices without which it cannot be.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::forest::Forest;

/// The vertices that may go, by number from the first of them, in the order in which they come.
pub(super) fn insertion_order(forest: &Forest, point: impl Fn(usize) -> DVec3) -> Vec<u32> {
    let corners = forest.complex().corners();
    let count = forest.vertices() - corners;
    // Not negative, so that they are ordered as their bits are.
    let error = |vertex: usize| {
        let [Some((quad, triangle)), _] = forest.split(vertex) else { return 0 };
        let [from, to] =
            [triangle.from, triangle.to].map(|place| point(forest.vertex(super::Spot { quad, place })));
        point(vertex).distance_squared((from + to) * 0.5).to_bits()
    };
    let mut is_in = vec![false; count];
    let mut order = Vec::with_capacity(count);
    let mut waiting: BinaryHeap<(u64, Reverse<usize>)> =
        forest.level(1).map(|vertex| (error(vertex), Reverse(vertex))).collect();
    let mut missing = Vec::new();
    while let Some((_, Reverse(vertex))) = waiting.pop() {
        missing.push(vertex);
        while let Some(&vertex) = missing.last() {
            if is_in[vertex - corners] {
                missing.pop();
                continue;
            }
            let triangles = forest.split(vertex);
            let before = missing.len();
            let apexes = triangles
                .iter()
                .flatten()
                .map(|(quad, triangle)| forest.vertex(super::Spot { quad: *quad, place: triangle.apex }));
            missing.extend(apexes.filter(|&apex| apex >= corners && !is_in[apex - corners]));
            if missing.len() > before {
                continue;
            }
            missing.pop();
            is_in[vertex - corners] = true;
            order.push((vertex - corners) as u32);
            for (quad, triangle) in
                triangles.into_iter().flatten().filter(|(_, at)| at.level < forest.levels())
            {
                let children = triangle.halves().map(|half| forest.midpoint(quad, &half));
                waiting.extend(children.map(|child| (error(child), Reverse(child))));
            }
        }
    }
    order
}
