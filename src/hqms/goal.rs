//! What is left to remove.

use super::Target;
use crate::collapse::Counts;

/// A target, in the units of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Goal {
    Faces(usize),
    Vertices(usize),
    /// As few as the rules' error limit allows.
    Fewest,
}

impl Goal {
    /// For an input of so many `triangles`.
    pub(crate) fn new(target: Target, triangles: usize) -> Self {
        match target {
            Target::Triangles(count) => Self::Faces(count),
            Target::Vertices(count) => Self::Vertices(count),
            Target::Ratio(ratio) => Self::Faces((triangles as f64 * ratio) as usize),
            Target::MaxError(_) => Self::Fewest,
        }
    }

    /// How many faces or vertices, as the goal has it, are left to remove.
    pub(crate) fn excess(self, counts: Counts) -> usize {
        match self {
            Self::Faces(count) => counts.faces.saturating_sub(count),
            Self::Vertices(count) => counts.vertices.saturating_sub(count),
            Self::Fewest => counts.faces,
        }
    }

    /// How many collapses that takes: one removes one vertex and mostly two faces.
    pub(crate) fn collapses(self, counts: Counts) -> usize {
        match self {
            Self::Faces(_) | Self::Fewest => self.excess(counts).div_ceil(2),
            Self::Vertices(_) => self.excess(counts),
        }
    }

    /// How many times larger than the goal the surface is, if that can be known.
    pub(crate) fn ratio(self, counts: Counts) -> Option<f32> {
        match self {
            Self::Faces(count) => Some(counts.faces as f32 / count.max(1) as f32),
            Self::Vertices(count) => Some(counts.vertices as f32 / count.max(1) as f32),
            Self::Fewest => None,
        }
    }

    /// `removed` in the unit of the goal.
    pub(crate) fn measure(self, removed: Counts) -> usize {
        match self {
            Self::Faces(_) | Self::Fewest => removed.faces,
            Self::Vertices(_) => removed.vertices,
        }
    }

    /// The most, in the unit of the goal, that a collapse has taken away which is known to have `removed` so
    /// much. Where vertices have several wedges (`has_wedges`), two more may be gone with each face: those at
    /// its corner away from the edge, and at the edge's target, if no other face has them.
    pub(crate) fn measure_at_most(self, removed: Counts, has_wedges: bool) -> usize {
        let unseen = if has_wedges { 2 * removed.faces } else { 0 };
        self.measure(Counts { vertices: removed.vertices + unseen, ..removed })
    }

    /// The most that one collapse inside the mesh takes away.
    pub(crate) fn step(self) -> usize {
        self.measure(Counts { faces: 2, vertices: 1 })
    }
}
