//! A mesh as its coarsest level and the splits that refine it, one after the other.

mod build;
#[cfg(feature = "io")]
mod file;
mod player;

use std::ops::Range;

#[cfg(feature = "io")]
pub use file::Extent;
pub use player::Player;

use crate::hqms::{Options, Placement, Simplified, SimplifyError, Target, Topology, build_levels};
use crate::mesh::{Mesh, MeshError};
use crate::monitor::Monitor;

/// All levels of a mesh between the finest and the coarsest, each one *split* finer than the one before.
///
/// A *step* is the number of splits done: 0 is the coarsest level, [`steps`](Self::steps) the finest. The
/// level at a step uses a prefix of the vertices and a prefix of the triangles; which vertex a corner of a
/// triangle names depends on the step. The order of the triangles is the same at every step.
///
/// Any mesh will do, however unclean. Triangles with two corners at one place and vertices that are in no
/// other triangle are left out of all levels.
///
/// Memory for n triangles of a closed mesh: about 34 bytes each, and the vertices.
///
/// ```
/// use decimesh::lod::Progressive;
/// use decimesh::mesh::shapes;
/// use decimesh::multiple_choice::{Cost, Decimation, Selection};
/// use decimesh::Monitor;
///
/// let stone = shapes::bumpy_sphere(32, 1);
/// let mut decimation = Decimation::new(&stone, Cost::Quadric, Selection::default());
/// decimation.reduce_to(100, &mut Monitor::silent())?;
/// let progressive = Progressive::new(&stone, decimation.collapses())?;
/// let step = progressive.step_within(1000);
/// let indices = progressive.triangles_at(step);
/// assert!(indices.len() == 1000 || indices.len() == 999);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Progressive {
    /// Those of all levels, without triangles.
    vertices: Mesh,
    /// As they are on the first level that has them.
    triangles: Vec<[u32; 3]>,
    /// Where the vertices of each split begin, and where the last ends.
    vertex_starts: Vec<u32>,
    /// Where the triangles of each split begin, and where the last ends.
    triangle_starts: Vec<u32>,
    /// For each vertex that a split makes, the one that it comes from.
    parents: Vec<u32>,
    /// Where the corners of each vertex that a split makes begin, and where the last end.
    corner_starts: Vec<usize>,
    corners: Vec<u32>,
    marks: Vec<Mark>,
    order: Option<Vec<u32>>,
}

/// A level that has a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// At which step it is.
    pub step: usize,
    /// Its error, in units of the positions.
    pub error: f32,
}

/// What a step changes: new vertices, all at one place, the corners that go over to them, new triangles.
#[derive(Debug, Clone)]
pub struct Split<'a> {
    /// The new vertices.
    pub vertices: Range<u32>,
    /// Where the new triangles go.
    pub first_triangle: usize,
    /// The new triangles.
    pub triangles: &'a [[u32; 3]],
    progressive: &'a Progressive,
}

/// A new vertex of a [`Split`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VertexSplit<'a> {
    /// It.
    pub vertex: u32,
    /// The vertex that it comes from, which has a smaller index and is older than the split.
    pub parent: u32,
    /// The corners that named the parent and now name this vertex: places in the flat list of indices,
    /// ascending, all in triangles that are older than the split.
    pub corners: &'a [u32],
}

impl<'a> Split<'a> {
    /// Each of the new vertices.
    pub fn vertex_splits(&self) -> impl ExactSizeIterator<Item = VertexSplit<'a>> + use<'a> {
        let progressive = self.progressive;
        let base = progressive.vertex_starts[0];
        self.vertices.clone().map(move |vertex| {
            let index = (vertex - base) as usize;
            VertexSplit {
                vertex,
                parent: progressive.parents[index],
                corners: &progressive.corners
                    [progressive.corner_starts[index]..progressive.corner_starts[index + 1]],
            }
        })
    }
}

/// Why there is no progressive mesh. Collapses count from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProgressiveError {
    /// A collapse names a vertex that the mesh does not have.
    #[error("collapse {collapse} names vertex {vertex}, but there are {vertices} vertices")]
    VertexOutOfRange {
        /// Which collapse.
        collapse: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A collapse moves a vertex into itself.
    #[error("collapse {collapse} moves vertex {vertex} into itself")]
    IntoItself {
        /// Which collapse.
        collapse: usize,
        /// The vertex.
        vertex: u32,
    },
    /// A collapse names a vertex that an earlier one has removed.
    #[error("collapse {collapse} names vertex {vertex}, which is gone already")]
    VertexGone {
        /// Which collapse.
        collapse: usize,
        /// The vertex.
        vertex: u32,
    },
    /// A mark has no step or no error, or marks do not go from fine to coarse.
    #[error("mark {mark} is wrong: {problem}")]
    Mark {
        /// Which mark.
        mark: usize,
        /// What is wrong.
        problem: String,
    },
    /// Levels were made without [`Options::track_collapses`].
    #[error("a progressive mesh needs the collapses of its levels, which were not asked for")]
    NotTracked,
    /// There are no levels.
    #[error(transparent)]
    Simplify(#[from] SimplifyError),
    /// The vertices do not make a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl Progressive {
    /// Simplifies `mesh` to each of `targets` in turn, from fine to coarse, as [`build_levels`] does with
    /// [`Placement::Existing`], and marks where each is met.
    ///
    /// [`Options::target`], [`Options::placement`] and [`Options::topology`] are not looked at: the topology is
    /// kept, so that a level may be larger than asked for.
    pub fn build(
        mesh: &Mesh,
        targets: &[Target],
        options: &Options,
        monitor: &mut Monitor,
    ) -> Result<Self, ProgressiveError> {
        let options = Options {
            placement: Placement::Existing,
            topology: Topology::Keep,
            track_collapses: true,
            ..options.clone()
        };
        Self::from_levels(mesh, &build_levels(mesh, targets, &options, monitor)?)
    }

    /// The same of levels that [`build_levels`] has made of `mesh`, from fine to coarse. It must have been
    /// asked for [`Placement::Existing`] and collapses. Levels for which the topology had to be given up are
    /// left out: collapses alone do not lead there. So are triangles with two corners at one place, even where
    /// a coarser level has moved these apart.
    pub fn from_levels(mesh: &Mesh, levels: &[Simplified]) -> Result<Self, ProgressiveError> {
        let kept: Vec<_> =
            levels.iter().map_while(|level| Some((level.collapses.as_ref()?, level.error))).collect();
        if kept.len() < levels.len() && !levels[kept.len()].topology_changed {
            return Err(ProgressiveError::NotTracked);
        }
        let ends: Vec<usize> = kept.iter().map(|(collapses, _)| collapses.len()).collect();
        let collapses = kept.last().map_or(&[][..], |(collapses, _)| collapses);
        let mut progressive = Self::with_ends(mesh, collapses, &ends)?;
        let mut largest = 0.0f32;
        let marks = kept.iter().map(|(collapses, error)| {
            largest = largest.max(*error);
            Mark { step: progressive.step_after(collapses.len()), error: largest }
        });
        progressive.marks = marks.collect();
        Ok(progressive)
    }

    /// How many splits lead from the coarsest level to the finest.
    pub fn steps(&self) -> usize {
        self.vertex_starts.len() - 1
    }

    /// The vertices of all levels, the last to go first; a mesh without triangles.
    pub fn vertices(&self) -> &Mesh {
        &self.vertices
    }

    /// For each vertex the one of the input that it is; `None` where the progressive mesh comes from a file.
    pub fn order(&self) -> Option<&[u32]> {
        self.order.as_deref()
    }

    /// How many vertices the level at `step` has, or the finest where `step` is beyond that.
    pub fn vertex_count(&self, step: usize) -> usize {
        self.vertex_starts[step.min(self.steps())] as usize
    }

    /// How many triangles the level at `step` has, or the finest where `step` is beyond that.
    pub fn triangle_count(&self, step: usize) -> usize {
        self.triangle_starts[step.min(self.steps())] as usize
    }

    /// The step of the finest level with at most so many triangles: 0, the coarsest, if none has so few.
    /// Logarithmic time.
    pub fn step_within(&self, triangles: usize) -> usize {
        self.triangle_starts.partition_point(|&count| count as usize <= triangles).saturating_sub(1)
    }

    /// The triangles of the level at `step`, or of the finest where `step` is beyond that. Linear in the
    /// triangles of the level and the corners changed on the way.
    pub fn triangles_at(&self, step: usize) -> Vec<[u32; 3]> {
        let step = step.min(self.steps());
        let mut triangles = self.triangles[..self.triangle_count(step)].to_vec();
        // All triangles are there from the start: the corners of a split are in older ones.
        let corners = triangles.as_flattened_mut();
        let vertices = self.vertex_starts[0]..self.vertex_starts[step];
        for (vertex, range) in vertices.zip(self.corner_starts.windows(2)) {
            for &corner in &self.corners[range[0]..range[1]] {
                corners[corner as usize] = vertex;
            }
        }
        triangles
    }

    /// The level at `step` as a mesh of its own, or the finest where `step` is beyond that.
    pub fn mesh_at(&self, step: usize) -> Mesh {
        self.vertices.prefix(self.vertex_count(step), self.triangles_at(step))
    }

    /// What leads from `step` to the next finer one; `None` from the finest on.
    pub fn split(&self, step: usize) -> Option<Split<'_>> {
        let vertices = *self.vertex_starts.get(step)?..*self.vertex_starts.get(step + 1)?;
        let triangles = self.triangle_starts[step] as usize..self.triangle_starts[step + 1] as usize;
        Some(Split {
            vertices,
            first_triangle: triangles.start,
            triangles: &self.triangles[triangles],
            progressive: self,
        })
    }

    /// The levels that have a number, from fine to coarse.
    pub fn marks(&self) -> &[Mark] {
        &self.marks
    }

    /// Numbers some levels, in place of those that were numbered. They must go from fine to coarse, no error
    /// may be less than the one before, and steps must exist.
    pub fn set_marks(&mut self, marks: Vec<Mark>) -> Result<(), ProgressiveError> {
        check_marks(&marks, self.steps())?;
        self.marks = marks;
        Ok(())
    }

    /// At which step the first `collapses` of the list that [`new`](Self::new) was given have been done.
    /// Inside a step that is several collapses, it is the step before they are done.
    pub fn step_after(&self, collapses: usize) -> usize {
        let removed = self.vertex_starts.last().copied().unwrap_or(0) as usize;
        let left = removed.saturating_sub(collapses) as u32;
        self.vertex_starts.partition_point(|&count| count < left).min(self.steps())
    }
}

fn check_marks(marks: &[Mark], steps: usize) -> Result<(), ProgressiveError> {
    for (index, mark) in marks.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| marks[before]);
        let problem = if mark.step > steps {
            format!("there is no step {}, but {steps}", mark.step)
        } else if !(mark.error.is_finite() && mark.error >= 0.0) {
            format!("{} is no error", mark.error)
        } else if before.is_some_and(|before| before.step < mark.step) {
            "it is finer than the one before".to_owned()
        } else if before.is_some_and(|before| before.error > mark.error) {
            "its error is less than that of the one before".to_owned()
        } else {
            continue;
        };
        return Err(ProgressiveError::Mark { mark: index, problem });
    }
    Ok(())
}
