//! What has to be known of a hierarchy of vertices to take it down one by one, whatever it lies over: a grid, or a
//! polyline.
//!
//! Balmelli, Vetterli and Liebling, "Mesh Optimization Using Global Error with Application to Geometry
//! Simplification", section 1.4, Figure 4b: a directed acyclic graph, in which a vertex may go once its children
//! are gone. Children are one level below their parents, of which there are two at most.

use super::layout::Layout;

/// Vertices, numbered from 0, that go after their children.
pub(super) trait Graph {
    /// How many vertices may go.
    fn vertices(&self) -> usize;

    /// From 1, the coarsest, on.
    fn level(&self, vertex: usize) -> u32;

    fn children(&self, vertex: usize) -> impl Iterator<Item = usize>;

    fn parents(&self, vertex: usize) -> impl Iterator<Item = usize>;
}

impl Graph for Layout {
    fn vertices(&self) -> usize {
        self.vertices()
    }

    fn level(&self, vertex: usize) -> u32 {
        self.site(vertex).level
    }

    fn children(&self, vertex: usize) -> impl Iterator<Item = usize> {
        self.children(self.site(vertex)).map(|child| self.index(child))
    }

    fn parents(&self, vertex: usize) -> impl Iterator<Item = usize> {
        self.parents(self.site(vertex)).map(|parent| self.index(parent))
    }
}

const NONE: u32 = u32::MAX;

/// Finds the ancestors of vertices, of which one in the finest of twenty levels has about a hundred.
pub(super) struct Ancestors {
    parents: Vec<[u32; 2]>,
    /// Those on one level, which are few: all lie near.
    generation: Vec<u32>,
    older: Vec<u32>,
}

impl Ancestors {
    pub(super) fn new(graph: &impl Graph) -> Self {
        let parents = |vertex| {
            let mut parents = graph.parents(vertex).map(|parent| parent as u32);
            [parents.next().unwrap_or(NONE), parents.next().unwrap_or(NONE)]
        };
        let parents = (0..graph.vertices()).map(parents).collect();
        Self { parents, generation: Vec::new(), older: Vec::new() }
    }

    /// Calls `visitor` with each ancestor of a vertex once, level by level.
    #[inline]
    pub(super) fn visit(&mut self, vertex: usize, mut visitor: impl FnMut(usize)) {
        self.generation.clear();
        self.generation.push(vertex as u32);
        while !self.generation.is_empty() {
            self.older.clear();
            for &vertex in &self.generation {
                for parent in self.parents[vertex as usize] {
                    if parent != NONE && !self.older.contains(&parent) {
                        self.older.push(parent);
                        visitor(parent as usize);
                    }
                }
            }
            std::mem::swap(&mut self.generation, &mut self.older);
        }
    }
}

/// Which vertices never go: those whose error is infinite, and all of their ancestors.
pub(super) fn staying(graph: &impl Graph, errors: &[impl Copy + Into<f64>]) -> Vec<bool> {
    assert_eq!(errors.len(), graph.vertices());
    let mut stays = vec![false; errors.len()];
    let mut pending: Vec<_> =
        (0..errors.len()).filter(|&vertex| errors[vertex].into() == f64::INFINITY).collect();
    while let Some(vertex) = pending.pop() {
        if !std::mem::replace(&mut stays[vertex], true) {
            pending.extend(graph.parents(vertex));
        }
    }
    stays
}

#[cfg(test)]
mod tests {
    use super::{Ancestors, Graph, staying};
    use crate::rate_distortion::layout::Layout;

    #[test]
    fn ancestors_are_those_that_have_one_as_a_descendant() {
        for layout in [Layout::new([1, 1], 3), Layout::new([2, 3], 2)] {
            let vertices = layout.vertices();
            let mut descendants = vec![vec![false; vertices]; vertices];
            for vertex in (0..vertices).rev() {
                for child in Graph::children(&layout, vertex) {
                    let below = descendants[child].clone();
                    descendants[vertex].iter_mut().zip(below).for_each(|(own, child)| *own |= child);
                    descendants[vertex][child] = true;
                }
            }
            let mut ancestors = Ancestors::new(&layout);
            for vertex in 0..vertices {
                let mut found = vec![0; vertices];
                ancestors.visit(vertex, |ancestor| found[ancestor] += 1);
                let mut errors = vec![1.0; vertices];
                errors[vertex] = f64::INFINITY;
                let stays = staying(&layout, &errors);
                for other in 0..vertices {
                    let is_ancestor = descendants[other][vertex];
                    assert_eq!(found[other], usize::from(is_ancestor));
                    assert_eq!(stays[other], other == vertex || is_ancestor);
                }
            }
        }
    }
}
