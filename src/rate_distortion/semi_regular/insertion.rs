//! Greedy insertion: the baseline that decimation by global distortion is measured against.
//!
//! Balmelli, Vetterli and Liebling, section 4.2, compare with the refinement of Lindstrom et al. and Pajarola on
//! terrain, which goes by local error; here on a surface: how far a vertex is from the middle of the edge that it
//! splits. The order is that of `baselines.rs`, over the vertices of a forest that may go.

use glam::DVec3;

use super::super::baselines::insertion;
use super::super::graph::Graph;
use super::Spot;
use super::forest::Forest;

impl Graph for Forest {
    fn vertices(&self) -> usize {
        self.vertices() - self.complex().corners()
    }

    fn level(&self, vertex: usize) -> u32 {
        self.level_of(vertex + self.complex().corners())
    }

    fn children(&self, vertex: usize) -> impl Iterator<Item = usize> {
        let corners = self.complex().corners();
        let split = self.split(vertex + corners).into_iter().flatten();
        let parents = split.filter(|(_, triangle)| triangle.level < self.levels());
        parents.flat_map(move |(quad, triangle)| {
            triangle.halves().map(|half| self.midpoint(quad, &half) - corners)
        })
    }

    fn parents(&self, vertex: usize) -> impl Iterator<Item = usize> {
        let corners = self.complex().corners();
        let split = self.split(vertex + corners).into_iter().flatten();
        split.filter_map(move |(quad, triangle)| {
            self.vertex(Spot { quad, place: triangle.apex }).checked_sub(corners)
        })
    }
}

/// The vertices that may go, by number from the first of them, in the order in which they come.
pub(super) fn insertion_order(forest: &Forest, point: impl Fn(usize) -> DVec3) -> Vec<u32> {
    let error = |vertex: usize| {
        let [Some((quad, triangle)), _] = forest.split(vertex) else { return 0.0 };
        let [from, to] = [triangle.from, triangle.to].map(|place| point(forest.vertex(Spot { quad, place })));
        point(vertex).distance_squared((from + to) * 0.5)
    };
    let errors: Vec<f64> = (forest.complex().corners()..forest.vertices()).map(error).collect();
    let mut order = insertion(forest, &errors).order;
    order.reverse();
    order
}
