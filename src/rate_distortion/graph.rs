//! What has to be known of a hierarchy of vertices to take it down one by one, whatever it lies over: a grid, or a
//! polyline.
//!
//! Balmelli, Vetterli and Liebling, "Mesh Optimization Using Global Error with Application to Geometry
//! Simplification", section 1.4, Figure 4b: a directed acyclic graph, in which a vertex may go once its children
//! are gone. Children are one level below their parents.

use super::layout::{Layout, Site};

/// Vertices that go after their children.
pub(super) trait Graph {
    /// A vertex, in the form that finds its relatives fastest.
    type Site: Copy + PartialEq;

    /// How many vertices may go. They are numbered from 0.
    fn vertices(&self) -> usize;

    fn site(&self, vertex: usize) -> Self::Site;

    fn vertex(&self, site: Self::Site) -> usize;

    /// From 1, the coarsest, on.
    fn level(&self, site: Self::Site) -> u32;

    fn children(&self, site: Self::Site) -> impl Iterator<Item = Self::Site>;

    fn parents(&self, site: Self::Site) -> impl Iterator<Item = Self::Site>;
}

impl Graph for Layout {
    type Site = Site;

    fn vertices(&self) -> usize {
        Layout::vertices(self)
    }

    fn site(&self, vertex: usize) -> Site {
        Layout::site(self, vertex)
    }

    fn vertex(&self, site: Site) -> usize {
        self.index(site)
    }

    fn level(&self, site: Site) -> u32 {
        site.level
    }

    fn children(&self, site: Site) -> impl Iterator<Item = Site> {
        Layout::children(self, site)
    }

    fn parents(&self, site: Site) -> impl Iterator<Item = Site> {
        Layout::parents(self, site)
    }
}

/// Finds all ancestors of a vertex, each once, level by level. On each level they are few: all lie near.
pub(super) struct Ancestors<S> {
    generation: Vec<S>,
    older: Vec<S>,
}

impl<S> Default for Ancestors<S> {
    fn default() -> Self {
        Self { generation: Vec::new(), older: Vec::new() }
    }
}

impl<S: Copy + PartialEq> Ancestors<S> {
    pub(super) fn visit(&mut self, graph: &impl Graph<Site = S>, site: S, mut visitor: impl FnMut(usize, S)) {
        self.generation.clear();
        self.generation.push(site);
        while !self.generation.is_empty() {
            self.older.clear();
            for &site in &self.generation {
                for parent in graph.parents(site) {
                    if !self.older.contains(&parent) {
                        self.older.push(parent);
                        visitor(graph.vertex(parent), parent);
                    }
                }
            }
            std::mem::swap(&mut self.generation, &mut self.older);
        }
    }
}

/// Which vertices never go: those whose error is infinite, and all of their ancestors.
pub(super) fn staying<G: Graph>(graph: &G, errors: &[impl Copy + Into<f64>]) -> Vec<bool> {
    assert_eq!(errors.len(), graph.vertices());
    let mut stays = vec![false; errors.len()];
    let mut ancestors = Ancestors::default();
    for (vertex, &error) in errors.iter().enumerate() {
        if error.into() == f64::INFINITY {
            stays[vertex] = true;
            ancestors.visit(graph, graph.site(vertex), |ancestor, _| stays[ancestor] = true);
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
            let vertices = Layout::vertices(&layout);
            let mut descendants = vec![vec![false; vertices]; vertices];
            for vertex in (0..vertices).rev() {
                let children: Vec<_> =
                    layout.children(layout.site(vertex)).map(|site| layout.index(site)).collect();
                for child in children {
                    let below = descendants[child].clone();
                    descendants[vertex].iter_mut().zip(below).for_each(|(own, child)| *own |= child);
                    descendants[vertex][child] = true;
                }
            }
            let mut ancestors = Ancestors::default();
            for vertex in 0..vertices {
                let mut found = vec![0; vertices];
                ancestors.visit(&layout, layout.site(vertex), |ancestor, site| {
                    assert_eq!(Graph::vertex(&layout, site), ancestor);
                    found[ancestor] += 1;
                });
                for other in 0..vertices {
                    assert_eq!(found[other], usize::from(descendants[other][vertex]));
                }
                let mut errors = vec![1.0; vertices];
                errors[vertex] = f64::INFINITY;
                let stays = staying(&layout, &errors);
                for other in 0..vertices {
                    assert_eq!(stays[other], other == vertex || descendants[other][vertex]);
                }
            }
        }
    }
}
