//! Wedges in the finish: which vertices of the input the faces name, and what of that a collapse changes.

use super::Finish;
use crate::collapse::HalfEdge;
use crate::collapse::half_edge;
use crate::collapse::ring::Ring;
use crate::collapse::surface::{NONE, is_alive};
use std::sync::atomic::Ordering::Relaxed;

impl Finish<'_> {
    /// The vertices at which a collapse may take the last corner of a vertex of the input away: the ends of
    /// the edge, and the corners of what vanishes. A hub is passed over.
    pub(super) fn losing_names(&self, [source, target]: [u32; 2], ring: &Ring, doomed: &[u32]) -> Vec<u32> {
        let mut vertices = vec![source, target];
        for (next, previous) in ring.names().filter(|&(next, previous)| next == target || previous == target)
        {
            vertices.extend([next, previous]);
        }
        let corners = doomed.iter().flat_map(|&face| &self.surface.faces[face as usize]);
        vertices.extend(corners.map(|corner| corner.load(Relaxed)));
        vertices.sort_unstable();
        vertices.dedup();
        vertices.retain(|&vertex| !self.is_hub(vertex));
        vertices
    }

    /// How many vertices of the input the corners name that are at these vertices, each counted on its own; 0
    /// where each vertex has one wedge.
    pub(super) fn count_names(&self, vertices: &[u32]) -> usize {
        if self.surface.wedges.is_empty() {
            return 0;
        }
        let wedges = self.surface.terms().wedges;
        let mut names = Vec::new();
        for &vertex in vertices {
            let mut corner = self.first[vertex as usize];
            while corner != NONE {
                if is_alive(&self.surface.faces[(corner >> 2) as usize]) {
                    names.push((vertex, wedges.names.vertex(wedges.at(corner))));
                }
                corner = self.next[corner as usize];
            }
        }
        names.sort_unstable();
        names.dedup();
        names.len()
    }

    /// What a half-edge collapse does to wedges and attributes, these by `error`.
    pub(super) fn execute_wedges(&mut self, source: u32, target: u32, error: f32, done: &half_edge::Scratch) {
        let (from, into) = (source as usize, target as usize);
        let surface = &mut *self.surface;
        if !surface.attribute_errors.is_empty() {
            let errors = &mut surface.attribute_errors;
            errors[into] = errors[into].max(errors[from]) + error;
        }
        if !surface.wedges.is_empty() {
            let collapses: Vec<HalfEdge> = done.moves.collapses(surface.terms().wedges.names).collect();
            done.moves.apply(&surface.faces, &surface.wedges, &done.wedges.corners);
            surface.remember(collapses);
        }
    }
}
