//! HQMS: linear-time, high-quality simplification by passes of quadric edge collapses.
//!
//! Follows Chen, Fahn, Tsai, Chen and Lin, *A Linear Time Algorithm for High Quality Mesh
//! Simplification*, section 3: passes over the mesh, each of which builds the rings anew, collapses
//! up to half of the vertices in one sweep without a global queue, and leaves a level behind; quadrics
//! from the faces of the pass, not accumulated; the cost taken at the neighbour, the placement solved
//! only for what is executed. Both selections of collapses share all of that: see [`Selection`].
//!
//! Departures, each said where it is: the default selection, legality, weights, the exact count, and
//! the finish.

mod finish;
mod goal;
mod order;
mod pass;
mod refine;
mod replacement;
mod run;
#[cfg(feature = "bench-internals")]
pub(crate) mod stages;
#[cfg(feature = "deviation")]
pub(crate) mod steps;

pub use crate::collapse::HalfEdge;
pub use crate::collapse::attributes::AttributeWeights;
use crate::mesh::{Mesh, MeshError};
use crate::monitor::{Cancelled, Monitor};
use crate::workers::ThreadsError;
use run::Run;
use std::borrow::Cow;

/// What a simplification shall arrive at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// At most this many triangles (this many, or one fewer).
    Triangles(usize),
    /// At most this many vertices that a triangle uses.
    Vertices(usize),
    /// This fraction of the input's triangles, `0.0..=1.0`, rounded down.
    Ratio(f64),
    /// As few triangles as an estimated distance of this much, in units of the positions, allows.
    ///
    /// What is measured then is mostly 0.4 to 1.2 times as much (from 0.09 to 2.32 on 28 meshes, from 0.02 to 2 %
    /// of the diagonal).
    /// `simplify_within` (feature `deviation`) proves it, and leaves fewer triangles.
    MaxError(f32),
}

/// Which collapses a pass takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Selection {
    /// All that cost less than a sampled quantile: the best and fastest.
    #[default]
    SampledThreshold,
    /// The paper's: a replacement-selection heap of this many records.
    ReplacementSelection {
        /// The size of the heap; the paper's is 15.
        records: usize,
    },
}

/// What may happen to holes, handles and components.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Topology {
    /// Kept as long as the target can be reached so; given up where it cannot.
    #[default]
    RelaxIfStuck,
    /// Kept, even if the target is missed.
    Keep,
}

/// Where the vertex of a collapsed edge goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Placement {
    /// Where the error is least: a new vertex, at most a quarter of the input's diagonal outside its bounds.
    #[default]
    Optimal,
    /// To one of the edge's ends: a half-edge collapse. Every vertex of the result is then a vertex of
    /// the input, attributes included, bit for bit, and its index there is in [`Simplified::sources`].
    /// The error is larger: on scans 1.3 to 1.4 times at half of the triangles, 1.5 to 1.7 times at a tenth,
    /// up to twice at a hundredth.
    Existing,
}

/// How to simplify.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// What to arrive at.
    pub target: Target,
    /// Which collapses a pass takes.
    pub selection: Selection,
    /// What may happen to the topology.
    pub topology: Topology,
    /// Where the vertex of a collapsed edge goes.
    pub placement: Placement,
    /// Vertices of the border stay, bit for bit.
    pub lock_boundary: bool,
    /// Seams of textures and creases of normals, at which several vertices are at one place, open no
    /// crack. Without this their sides are borders, and part.
    ///
    /// With [`Placement::Existing`], vertices of one surface are known by their places, with attributes or
    /// without, and go along seams. With [`Placement::Optimal`], where the mesh has attributes, vertices
    /// at one place stay, bit for bit; a mesh that is all seams, such as a faceted one, gets stuck: weld it.
    pub keep_seams: bool,
    /// Indices of vertices that stay, bit for bit.
    pub locked: Vec<u32>,
    /// What attributes count beside the distance: for [`Placement::Existing`] only.
    pub attribute_weights: AttributeWeights,
    /// The group of each triangle, such as its material: where groups meet, their border stays a border,
    /// and [`Simplified::groups`] says of which group each triangle of the result is. For
    /// [`Placement::Existing`] only.
    pub groups: Option<Vec<u32>>,
    /// Where no vertex moves, vertices may go across seams too, at the cost of the attributes by their
    /// weights: what was on one side then takes the nearest attributes of the other. The surface stays
    /// closed, and groups keep their borders. Without this a mesh of many small charts, or a faceted one,
    /// gets stuck at their corners; [`Topology::RelaxIfStuck`] then lets them go across, before it gives up
    /// holes, handles and components.
    pub cross_seams: bool,
    /// Indices of vertices that go along seams only, whatever `cross_seams` says.
    pub protected: Vec<u32>,
    /// Indices of vertices that are kept as long as others can go: they cost a hundred times as much. For
    /// [`Placement::Existing`] only.
    pub prioritized: Vec<u32>,
    /// Moves vertices and turns edges in the end, so that the surface is nearer to the input's: its RMS distance
    /// falls by 6 to 10 %; the largest one may rise. All takes 1.2 times as long at a hundredth of the
    /// triangles, 1.6 at a tenth, and up to 4 at a half. Vertices that are locked or on a border stay. For
    /// [`Placement::Optimal`] only.
    pub refine: bool,
    /// Threads to use; 0: all that the machine has. The result does not depend on it.
    pub threads: usize,
    /// Fill [`Simplified::origins`].
    pub track_origins: bool,
    /// Fill [`Simplified::sources`], whatever the placement.
    pub track_sources: bool,
    /// Fill [`Simplified::collapses`]: for [`Placement::Existing`] only.
    pub track_collapses: bool,
}

impl Options {
    /// The defaults, with `target`.
    pub fn new(target: Target) -> Self {
        Self {
            target,
            selection: Selection::default(),
            topology: Topology::default(),
            placement: Placement::default(),
            lock_boundary: false,
            keep_seams: true,
            locked: Vec::new(),
            attribute_weights: AttributeWeights::default(),
            groups: None,
            cross_seams: false,
            protected: Vec::new(),
            prioritized: Vec::new(),
            refine: false,
            threads: 0,
            track_origins: false,
            track_sources: false,
            track_collapses: false,
        }
    }
}

/// Why a simplification ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum StoppedBy {
    /// The target is met (or was already met by the input).
    Target,
    /// Every further collapse would exceed the error asked for.
    Error,
    /// Every further collapse would change the topology, fold a face over, or move a locked vertex.
    Stuck,
}

/// A simplified mesh, and how it came about.
#[derive(Debug, Clone)]
pub struct Simplified {
    /// The mesh.
    pub mesh: Mesh,
    /// Why it is as large as it is.
    pub stopped_by: StoppedBy,
    /// Estimated largest distance from the input, in units of the positions: a sum over collapses, of which
    /// what is measured is mostly 0.2 to 0.6 times as much (from 0.05 to 1.02 on 28 meshes, to 50, 10 and 1 %
    /// of the triangles).
    /// What [`Options::refine`] has done since does not count.
    pub error: f32,
    /// Estimated largest difference of the attributes from the input's, weighted: in units of the positions,
    /// a difference of 1 being the weight times the longest side of the bounding box. 0 where no attribute
    /// has a weight.
    pub attribute_error: f32,
    /// How many vertices of the input were locked: by index, as borders, or as seams.
    pub locked: usize,
    /// Whether holes, handles or components had to be given up to meet the target.
    pub topology_changed: bool,
    /// For each input vertex the output vertex it went into, `u32::MAX` where it vanished.
    pub origins: Option<Vec<u32>>,
    /// For each output vertex the input vertex that it was before others went into it. A vertex at which
    /// the surface was parted (see [`Topology::RelaxIfStuck`]) has several output vertices.
    pub sources: Option<Vec<u32>>,
    /// The group of each triangle, if groups were given.
    pub groups: Option<Vec<u32>>,
    /// For each output vertex the first that is the same vertex of the surface, of which there are several along
    /// seams: see [`Mesh::surface_vertices`]. None where vertices move, or the input has no such vertices.
    pub surface_vertices: Option<Vec<u32>>,
    /// What was collapsed, in an order in which it can be done again: at each, all corners of triangles that
    /// are the source become the target, and the triangles vanish that then have two corners at one place.
    /// From the input's triangles, those with two corners at one place left out, this leads to the
    /// result's. A collapse along a seam is several of these in a row, whose sources are at one place. None
    /// where the topology had to be given up.
    pub collapses: Option<Vec<HalfEdge>>,
    /// Passes over the mesh.
    pub passes: usize,
}

/// Why there is no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimplifyError {
    /// The monitor said so.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// An option has a value it cannot have.
    #[error("{0}")]
    InvalidOption(String),
    /// The threads asked for could not be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The result does not make a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Simplifies `mesh`.
///
/// Time is linear in the triangles. The peak of memory, copy of the input and result included, is about
/// 24 bytes a triangle of a closed mesh that is reduced to a tenth (`12 * triangles + 25 * vertices` bytes), and
/// 37 of one that is reduced by less than a tenth, or below fifty thousand triangles; with [`Options::refine`]
/// 4 more, and about 500 a triangle of the result. `mesh` is untouched: see [`simplify_owned`] for a mesh that is not needed any more. The result is the same, byte for byte, for any
/// number of threads.
///
/// A target that cannot be met is not an error: the result is then as small as the options allow,
/// and [`Simplified::stopped_by`] says why.
pub fn simplify(mesh: &Mesh, options: &Options, monitor: &mut Monitor) -> Result<Simplified, SimplifyError> {
    reach(Run::new(Cow::Borrowed(mesh), options)?, options, monitor)
}

/// Simplifies a `mesh` that is not needed any more: as [`simplify`], in the memory of its triangles.
///
/// What this takes beyond the mesh itself is, at the peak, 9 bytes a triangle of a closed one, and 15 to 18 where
/// its vertices or triangles are in an order in which neighbours do not lie near each other. With
/// [`Placement::Existing`] the mesh is needed to the end, and nothing is saved. On an error it is gone.
pub fn simplify_owned(
    mesh: Mesh,
    options: &Options,
    monitor: &mut Monitor,
) -> Result<Simplified, SimplifyError> {
    reach(Run::new(Cow::Owned(mesh), options)?, options, monitor)
}

fn reach(mut run: Run, options: &Options, monitor: &mut Monitor) -> Result<Simplified, SimplifyError> {
    let stopped_by = run.reach(options.target, 0.0..run.reached(), monitor)?;
    run.refine(run.reached()..1.0, monitor)?;
    run.result(stopped_by)
}

/// Simplifies `mesh` to each of `targets` in turn, from fine to coarse: each level goes on from
/// the one before, so that a chain costs little more than its coarsest level.
///
/// [`Options::target`] is not looked at, and each level is the same share of what the monitor is told,
/// though the first ones take longest. Levels that cannot be met are the same mesh as the one
/// before, and say so. With [`Options::refine`] each goes on from the refined one before.
pub fn build_levels(
    mesh: &Mesh,
    targets: &[Target],
    options: &Options,
    monitor: &mut Monitor,
) -> Result<Vec<Simplified>, SimplifyError> {
    let mut run = Run::new(Cow::Borrowed(mesh), options)?;
    let mut levels = Vec::with_capacity(targets.len());
    let share = |level: usize| level as f32 / targets.len() as f32;
    for (level, &target) in targets.iter().enumerate() {
        let reached = share(level) + run.reached() * (share(level + 1) - share(level));
        let stopped_by = run.reach(target, share(level)..reached, monitor)?;
        run.refine(reached..share(level + 1), monitor)?;
        levels.push(run.result(stopped_by)?);
    }
    Ok(levels)
}

/// What a simplification of `mesh` comes to pay on its way: at the start and at each of `counts` of triangles,
/// which fall, how many are left and the binary logarithm of what the next collapses cost there, which can be
/// compared between parts of a surface. Infinity where nothing more can go.
///
/// [`Options::target`] is not looked at. Time and memory are those of [`simplify`] to the last of `counts`.
#[cfg(feature = "io")]
pub(crate) fn prices(
    mesh: &Mesh,
    options: &Options,
    counts: &[usize],
    monitor: &mut Monitor,
) -> Result<Vec<(usize, f32)>, SimplifyError> {
    let mut run = Run::new(Cow::Borrowed(mesh), options)?;
    let mut prices = vec![run.price()];
    let share = |level: usize| level as f32 / counts.len() as f32;
    for (level, &count) in counts.iter().enumerate() {
        run.reach(Target::Triangles(count), share(level)..share(level + 1), monitor)?;
        prices.push(run.price());
    }
    Ok(prices)
}
