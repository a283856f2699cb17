//! Remeshing: a semi-regular surface from any manifold triangle mesh.
//!
//! Balmelli, Vetterli and Liebling, section 1.1 and Figure 2, start from a coarse mesh, subdivide, and add detail
//! vectors computed from the model; how is left to the literature. Here:
//!
//! 1. The mesh is decimated, topology kept, by half-edge collapses (`hqms`), and what is left made into quads
//!    (`quads.rs`), subdivided as they lie.
//! 2. The collapses are undone. The vertices of the subdivision ride on the surface as it is refined (`chart.rs`,
//!    after MAPS), so that they stay spread over all of it. Vertices brought in level by level, between those that are
//!    there, do not get to the tips of limbs: on the armadillo, over 212 quads, the RMS distance is five times as
//!    large.
//! 3. Each time that the surface has twice as many vertices, those of the subdivision are moved to where squares are
//!    alike (`relax.rs`).
//!
//! All vertices of the result are points of the mesh. What the base has nothing of, such as fingers, gets few of them,
//! as its part of the base is small: more base quads and less depth give more.

mod chart;
mod quads;
mod relax;
mod unfold;
mod walk;

use std::ops::ControlFlow;

use super::semi_regular::{BaseComplex, Forest, SemiRegularError, SemiRegularMesh};
use crate::hqms::{self, HalfEdge, Options, Placement, SimplifyError, Target, Topology};
use crate::mesh::topology::visit_edges;
use crate::mesh::{Mesh, Rings};
use crate::monitor::{Cancelled, Monitor};
use crate::workers::ThreadsError;
use chart::Chart;
use quads::BaseQuads;
use relax::Subdivision;

/// How to remesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RemeshOptions {
    /// How often each quad of the base is halved, at least once: 4^depth squares a quad.
    pub depth: u32,
    /// How many quads the base shall have, about: more where the topology or the shape does not allow so few.
    pub base_quads: usize,
    /// Threads to use; 0: all that the machine has. The result does not depend on it.
    pub threads: usize,
}

impl RemeshOptions {
    /// About 400 base quads, halved `depth` times.
    pub fn new(depth: u32) -> Self {
        Self { depth, base_quads: 400, threads: 0 }
    }
}

/// A remeshed surface.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Remeshed {
    /// The surface; all of its vertices are points of the mesh it was made from.
    pub surface: SemiRegularMesh,
    /// How many of its triangles, at full resolution, face away from the mesh at their corners.
    pub folded: usize,
}

/// Why there is no remeshed surface. Triangles and vertices count from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RemeshError {
    /// No triangle: no surface.
    #[error("a mesh without triangles cannot be remeshed")]
    Empty,
    /// A triangle names a vertex twice.
    #[error("triangle {triangle} names a vertex twice: it has no place in a surface")]
    DegenerateTriangle {
        /// The first of them.
        triangle: usize,
    },
    /// An edge has more than two triangles.
    #[error(
        "the edge from vertex {} to {} has more than two triangles: the mesh is no manifold",
        vertices[0], vertices[1]
    )]
    NonManifoldEdge {
        /// Its ends.
        vertices: [u32; 2],
    },
    /// Two triangles run the same way along their edge: one of them is inside out.
    #[error("the triangles at the edge from vertex {} to {} disagree in orientation", vertices[0], vertices[1])]
    InconsistentEdge {
        /// Its ends.
        vertices: [u32; 2],
    },
    /// The triangles at a vertex form several fans.
    #[error("the triangles at vertex {vertex} form several fans: the mesh is no manifold")]
    NonManifoldVertex {
        /// The first of them.
        vertex: u32,
    },
    /// No base.
    #[error("the base needs a quad at least")]
    NoBaseQuads,
    /// The base cannot be subdivided so often.
    #[error(transparent)]
    Surface(#[from] SemiRegularError),
    /// The base could not be made.
    #[error(transparent)]
    Simplify(SimplifyError),
    /// The monitor asked for the end.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No threads.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
}

impl From<SimplifyError> for RemeshError {
    fn from(error: SimplifyError) -> Self {
        match error {
            SimplifyError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            SimplifyError::Threads(threads) => Self::Threads(threads),
            other => Self::Simplify(other),
        }
    }
}

/// How many times as many vertices the surface gets before those of the subdivision are moved again.
const GROWTH: usize = 2;

/// Moves of all vertices at the end.
const SWEEPS: usize = 4;
/// The share of the time that decimation takes, about.
const DECIMATED: f32 = 0.2;

/// A semi-regular surface on the surface of `mesh`, which must be an oriented manifold, closed or with borders, of
/// any number of pieces. Vertices that no triangle uses are not looked at, attributes neither; vertices at one place
/// are several (see [`Mesh::weld`]).
///
/// Linear in the vertices of the result, each of which is moved as often as the mesh has to be halved to become the
/// base, and four times more: some 20 µs each. Memory: about 120 bytes a vertex of the result and 100 a triangle of
/// the mesh.
pub fn remesh(mesh: &Mesh, options: &RemeshOptions, monitor: &mut Monitor) -> Result<Remeshed, RemeshError> {
    let RemeshOptions { depth, base_quads, threads } = *options;
    if base_quads == 0 {
        return Err(RemeshError::NoBaseQuads);
    }
    check(mesh)?;
    let (mesh, names) = mesh.of_triangles(mesh.triangles()).map_err(SimplifyError::Mesh)?;
    let mut chart = Chart::new(&mesh)
        .map_err(|vertex| RemeshError::NonManifoldVertex { vertex: names[vertex as usize] })?;
    for collapse in collapses(&mesh, base_quads, threads, monitor)? {
        chart.collapse(collapse);
    }
    let base = BaseQuads::new(&chart);
    let forest = Forest::new(BaseComplex::new(base.corners, base.quads.clone())?, depth)?;
    let mut subdivision = Subdivision::new(&forest, &base);
    let stages: Vec<usize> =
        std::iter::successors(Some(chart.vertices()), |vertices| Some(vertices * GROWTH))
            .take_while(|&vertices| vertices < mesh.positions().len())
            .collect();
    let sweeps = (stages.len() + SWEEPS) as f32;
    let mut done = 0.0;
    let mut relax = |subdivision: &mut Subdivision, chart: &Chart| {
        subdivision.relax(chart);
        done += 1.0;
        monitor.report(DECIMATED + (1.0 - DECIMATED) * done / sweeps)
    };
    for vertices in stages {
        chart.refine(vertices * GROWTH, &mut subdivision.feet);
        subdivision.locate(&chart);
        relax(&mut subdivision, &chart)?;
    }
    subdivision.locate(&chart);
    for _ in 0..SWEEPS {
        relax(&mut subdivision, &chart)?;
    }
    let folded = subdivision.folded();
    let positions = subdivision.positions();
    Ok(Remeshed { surface: SemiRegularMesh::over(forest, positions)?, folded })
}

/// The collapses that leave a base for about so many quads.
fn collapses(
    mesh: &Mesh,
    base_quads: usize,
    threads: usize,
    monitor: &mut Monitor,
) -> Result<Vec<HalfEdge>, RemeshError> {
    let options = Options {
        placement: Placement::Existing,
        topology: Topology::Keep,
        keep_seams: false,
        track_collapses: true,
        threads,
        // Most triangles are paired, and a pair becomes four quads.
        ..Options::new(Target::Triangles(base_quads.div_ceil(2)))
    };
    let mut part = Monitor::new(|fraction| match monitor.report(DECIMATED * fraction) {
        Ok(()) => ControlFlow::Continue(()),
        Err(Cancelled) => ControlFlow::Break(()),
    });
    Ok(hqms::simplify(mesh, &options, &mut part)?.collapses.unwrap_or_default())
}

fn check(mesh: &Mesh) -> Result<(), RemeshError> {
    if mesh.triangles().is_empty() {
        return Err(RemeshError::Empty);
    }
    let is_degenerate = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    if let Some(triangle) = mesh.triangles().iter().position(is_degenerate) {
        return Err(RemeshError::DegenerateTriangle { triangle });
    }
    let mut found = Ok(());
    visit_edges(mesh, &Rings::new(mesh), |edge| {
        if found.is_ok() {
            let vertices = edge.vertices;
            if edge.is_non_manifold() {
                found = Err(RemeshError::NonManifoldEdge { vertices });
            } else if edge.is_inconsistent() {
                found = Err(RemeshError::InconsistentEdge { vertices });
            }
        }
    });
    found
}
