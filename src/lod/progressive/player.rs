//! Going from level to level, one split at a time.

use std::ops::Deref;

use super::Progressive;

/// A level of a [`Progressive`], and the way to those next to it.
///
/// A step costs as much as it changes, so that a program that follows a camera need not make a level anew.
/// `P` is `&Progressive`, or an `Arc<Progressive>` where the player shall own its share.
#[derive(Debug, Clone)]
pub struct Player<P> {
    progressive: P,
    step: usize,
    triangles: Vec<[u32; 3]>,
}

impl<P: Deref<Target = Progressive>> Player<P> {
    /// A player at the coarsest level.
    pub fn new(progressive: P) -> Self {
        let triangles = progressive.triangles_at(0);
        Self { progressive, step: 0, triangles }
    }

    /// The progressive mesh that is played.
    pub fn progressive(&self) -> &Progressive {
        &self.progressive
    }

    /// How many splits are done.
    pub fn step(&self) -> usize {
        self.step
    }

    /// How many vertices the level has: its triangles name none beyond.
    pub fn vertex_count(&self) -> usize {
        self.progressive.vertex_count(self.step)
    }

    /// The triangles of the level: what [`Progressive::triangles_at`] gives for this step.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Does the next split; `false` if this was the finest level.
    pub fn finer(&mut self) -> bool {
        let Some(split) = self.progressive.split(self.step) else {
            return false;
        };
        let corners = self.triangles.as_flattened_mut();
        for change in split.vertex_splits() {
            change.corners.iter().for_each(|&corner| corners[corner as usize] = change.vertex);
        }
        self.triangles.extend_from_slice(split.triangles);
        self.step += 1;
        true
    }

    /// Undoes the last split; `false` if this was the coarsest level.
    pub fn coarser(&mut self) -> bool {
        let Some(split) = self.step.checked_sub(1).and_then(|step| self.progressive.split(step)) else {
            return false;
        };
        self.triangles.truncate(split.first_triangle);
        let corners = self.triangles.as_flattened_mut();
        for change in split.vertex_splits() {
            change.corners.iter().for_each(|&corner| corners[corner as usize] = change.parent);
        }
        self.step -= 1;
        true
    }

    /// Goes to `step`, or to the finest level where `step` is beyond that; costs as much as the splits in
    /// between.
    pub fn go_to(&mut self, step: usize) {
        while self.step < step && self.finer() {}
        while self.step > step && self.coarser() {}
    }
}
