//! The stages of a run, one at a time, so that benches can tell where the time goes.
//!
//! Not part of the API: only with the feature `bench-internals`, and free to change with the engine.

use super::finish::Finish;
use super::goal::Goal;
use super::order::rank;
use super::pass::{TILE, Threshold, ranked_pass};
use super::{Target, replacement};
use crate::collapse::surface::{Setting, Surface};
use crate::collapse::{Counts, Rules};
use crate::mesh::Mesh;
use crate::monitor::Cancelled;
use crate::workers::{ThreadsError, Workers};
use glam::Vec3A;
use std::borrow::Cow;

const RULES: Rules = Rules {
    any_topology: false,
    may_relax: false,
    error_limit: f32::INFINITY,
    half_edge: false,
    extent: [Vec3A::NEG_INFINITY, Vec3A::INFINITY],
};

/// A surface on its way to a goal, stage by stage, in the order of a run: [`Stages::load`],
/// [`Stages::classify`], then for each pass one of the passes and [`Stages::compact`]; in the end [`Stages::finish`] and [`Stages::to_mesh`].
pub struct Stages {
    surface: Surface,
    counts: Counts,
    goal: Goal,
    workers: Workers,
    threshold: Threshold,
}

impl Stages {
    /// Copies `mesh` into working form, in a coherent order, on its way to `ratio` of its triangles.
    pub fn load(mesh: &Mesh, ratio: f64, threads: usize) -> Result<Self, ThreadsError> {
        let rank = rank(mesh, None, TILE / 8);
        let workers = Workers::new(threads)?;
        let setting = Setting { rank: rank.as_deref(), ..Setting::default() };
        let surface = Surface::new(Cow::Borrowed(mesh), &setting, &workers);
        Ok(Self {
            counts: Counts { faces: surface.faces.len(), vertices: surface.points.len() },
            surface,
            goal: Goal::new(Target::Ratio(ratio), mesh.triangles().len()),
            workers,
            threshold: Threshold::new(),
        })
    }

    /// Triangles that are left.
    pub fn triangles(&self) -> usize {
        self.counts.faces
    }

    /// Finds the border.
    pub fn classify(&mut self) {
        self.surface.classify(false, &self.workers);
        self.counts.vertices = self.surface.vertex_count();
    }

    /// One pass of the default selection.
    pub fn threshold_pass(&mut self) -> Result<(), Cancelled> {
        let Self { surface, counts, goal, workers, threshold } = self;
        let removed = threshold.pass(surface, *counts, *goal, &RULES, workers, &mut |_| Ok(()))?;
        counts.remove(removed);
        Ok(())
    }

    /// One pass that takes the cheapest collapses in their order.
    pub fn ranked_pass(&mut self) {
        let removed = ranked_pass(&mut self.surface, self.counts, self.goal, &RULES, &self.workers);
        self.counts.remove(removed);
    }

    /// One pass of the paper's replacement selection.
    pub fn replacement_pass(&mut self, records: usize) -> Result<(), Cancelled> {
        let Self { surface, counts, goal, .. } = self;
        let removed = replacement::pass(surface, records, *counts, *goal, &RULES, &mut |_| Ok(()))?;
        counts.remove(removed);
        Ok(())
    }

    /// Drops what a pass has removed.
    pub fn compact(&mut self) {
        self.surface.compact(&self.workers);
    }

    /// The heap, down to the goal.
    pub fn finish(&mut self) -> Result<(), Cancelled> {
        let Self { surface, counts, goal, .. } = self;
        *counts = Finish::new(surface, *counts, &RULES).run(*goal, &mut |_| Ok(()))?;
        Ok(())
    }

    /// The mesh as it is now.
    pub fn to_mesh(&self) -> Result<Mesh, crate::MeshError> {
        self.surface.to_mesh(None).map(|remains| remains.mesh)
    }
}
