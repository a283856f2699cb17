//! A simplification step by step: from each it can go on, with errors as they were found to be, or back.

use super::run::Run;
use super::{Options, Simplified, SimplifyError, Target};
use crate::collapse::Counts;
use crate::collapse::surface::Snapshot;
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use std::borrow::Cow;

/// See the [module](self).
pub(crate) struct Steps<'a> {
    run: Run<'a>,
    /// Where [`try_within`](Self::try_within) starts from.
    kept: (Snapshot, Counts),
}

impl<'a> Steps<'a> {
    /// Takes over `mesh`. The target of the `options` is not looked at.
    pub(crate) fn new(mesh: &'a Mesh, options: &'a Options) -> Result<Self, SimplifyError> {
        let mut run = Run::new(Cow::Borrowed(mesh), options)?;
        let kept = run.checkpoint();
        Ok(Self { run, kept })
    }

    /// The surface as it is now.
    pub(crate) fn result(&self) -> Result<Simplified, SimplifyError> {
        self.run.result(super::StoppedBy::Error)
    }

    /// From the kept surface, which is `mesh` and at whose vertices so much is `spent` of the error already, as few
    /// triangles as the estimate allows.
    pub(crate) fn try_within(
        &mut self,
        max_error: f32,
        (mesh, spent): (&Mesh, &[f32]),
        monitor: &mut Monitor,
    ) -> Result<Simplified, SimplifyError> {
        self.run.go_back(self.kept.clone());
        self.run.spend(mesh, spent);
        let stopped_by = self.run.reach(Target::MaxError(max_error), 0.0..1.0, monitor)?;
        self.run.result(stopped_by)
    }

    /// Keeps the surface as it is now.
    pub(crate) fn keep(&mut self) {
        self.kept = self.run.checkpoint();
    }
}
