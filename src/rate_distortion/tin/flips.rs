//! Edges flipped for as long as that makes the squared error less: Lawson's procedure, with the error over the
//! samples of the two triangles for a criterion (a *data-dependent* triangulation; Dyn, Levin and Rippa, "Data
//! dependent triangulations for piecewise linear interpolation", 1990).
//!
//! Each flip lowers the sum, and there are finitely many triangulations of the same vertices: it ends.

use super::surface::Surface;
use crate::monitor::{Cancelled, Monitor};

/// Edges to look at, each by either of its halves.
#[derive(Debug, Default)]
pub(super) struct Edges {
    waiting: Vec<u32>,
}

impl Edges {
    /// Looks at these next, the last first.
    pub(super) fn add(&mut self, edges: impl IntoIterator<Item = u32>) {
        self.waiting.extend(edges);
    }

    /// Flips what can be flipped with a gain, and then looks at the edges around it, until there is nothing left.
    /// Calls `flipped` with the vertices around each.
    pub(super) fn settle(&mut self, surface: &mut Surface, mut flipped: impl FnMut([u32; 4])) {
        while let Some(corner) = self.waiting.pop() {
            if surface.flip_if_better(corner) {
                let edges = surface.mesh.quad_edges(corner);
                flipped(edges.map(|edge| surface.mesh.name(edge)));
                self.waiting.extend(edges);
            }
        }
    }
}

/// How many triangles are looked at between two reports.
const STRIDE: u32 = 4096;

/// Flips all edges of a surface that can be flipped with a gain, those next to each other first; `report` is told
/// which part of the triangles has been looked at.
pub(super) fn settle_all(
    surface: &mut Surface,
    monitor: &mut Monitor,
    report: impl Fn(f32) -> f32,
) -> Result<(), Cancelled> {
    let mut edges = Edges::default();
    let slots = surface.mesh.triangle_slots();
    for triangle in 0..slots {
        if triangle.is_multiple_of(STRIDE) {
            monitor.report(report(triangle as f32 / slots as f32))?;
        }
        if surface.mesh.has_triangle(triangle) {
            edges.add(4 * triangle..4 * triangle + 3);
            edges.settle(surface, |_| ());
        }
    }
    Ok(())
}
