//! What can be wrong with quads that shall be the base of a surface, and with the vertices over them.

use crate::monitor::Cancelled;
use crate::workers::ThreadsError;

/// Why there is no semi-regular mesh, or no decomposition of one. Quads, corners and vertices count from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SemiRegularError {
    /// No quad: no surface.
    #[error("a base complex needs a quad")]
    Empty,
    /// A quad names a corner that does not exist.
    #[error("quad {quad} has corner {corner}, but there are {corners} corners")]
    CornerOutOfRange {
        /// Which quad.
        quad: usize,
        /// The corner it names.
        corner: u32,
        /// How many corners there are.
        corners: usize,
    },
    /// A quad names a corner twice.
    #[error("quad {quad} names corner {corner} twice")]
    RepeatedCorner {
        /// Which quad.
        quad: usize,
        /// The corner it names twice.
        corner: u32,
    },
    /// A corner that no quad names.
    #[error("no quad uses corner {corner}")]
    UnusedCorner {
        /// The first of them.
        corner: usize,
    },
    /// More than two quads on an edge.
    #[error("the edge from corner {} to {} has more than two quads", corners[0], corners[1])]
    NonManifoldEdge {
        /// Its ends.
        corners: [u32; 2],
    },
    /// Two quads that run the same way along their edge: one of them is inside out.
    #[error("the quads at the edge from corner {} to {} disagree in orientation", corners[0], corners[1])]
    InconsistentEdge {
        /// Its ends.
        corners: [u32; 2],
    },
    /// The quads at a corner form several fans.
    #[error("the quads at corner {corner} form several fans")]
    NonManifoldCorner {
        /// The first of them.
        corner: u32,
    },
    /// The coarsest mesh, in which each quad is two triangles that meet between its first and its third
    /// corner, would have two edges between the same corners.
    #[error(
        "the diagonal of quad {quad}, from corner {} to {}, is an edge or another quad's diagonal as well",
        corners[0], corners[1]
    )]
    RepeatedDiagonal {
        /// Which quad.
        quad: usize,
        /// The ends of its diagonal.
        corners: [u32; 2],
    },
    /// A depth at which nothing could go, or at which there are more vertices or triangles than can be held.
    #[error("{quads} quads cannot be subdivided {depth} times: 1 to {limit} times are possible")]
    Depth {
        /// How often they shall be halved.
        depth: u32,
        /// How many there are.
        quads: usize,
        /// How often they can be; 0 if there are too many quads for any.
        limit: u32,
    },
    /// Another number of positions than of vertices.
    #[error("{count} positions for {vertices} vertices")]
    PositionCount {
        /// How many there are.
        count: usize,
        /// How many there must be.
        vertices: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("the position of vertex {vertex} is not finite")]
    NotFinite {
        /// Which vertex.
        vertex: usize,
    },
    /// The monitor asked for the end.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No threads.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
}
