//! OpenMesh's decimaters, as Debian's `libopenmesh-dev` has them, for decimesh's tests and benches to
//! compare with.
//!
//! ```
//! use openmesh_sys::{AVAILABLE, Decimation, Error, Method, decimate};
//!
//! let octahedron = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
//! let corners =
//!     [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
//! match decimate(&corners, &octahedron, &Decimation::new(Method::Quadric, 6)) {
//!     Ok(decimated) => assert_eq!(decimated.triangles.len(), 6),
//!     Err(error) => assert_eq!((error, AVAILABLE), (Error::Unavailable, false)),
//! }
//! ```
//!
//! Where the package is missing, the crate builds all the same: [`AVAILABLE`] is false and no [`Mesh`]
//! can be built. `DECIMESH_REQUIRE_OPENMESH=1` in the environment makes its absence an error of the
//! build.
//!
//! # Times
//!
//! Decimaters are templates, compiled here without assertions, but Debian compiles the library below them
//! with: it compares the names of types whenever it looks at an element's status. Without them, OpenMesh
//! 9.0 decimates four to five times as fast (69 192 triangles to a tenth in 0.25 s instead of 1.3 s by
//! [`Method::Quadric`], in 0.11 s instead of 0.44 s by [`Method::MultipleChoice`], on one machine). Who
//! compares times puts a `libOpenMeshCore.so.9.0` compiled with `-O3 -DNDEBUG` into `LD_LIBRARY_PATH`.
//!
//! # The process
//!
//! OpenMesh reports to streams of the process and draws from the C library's `rand`. Calls therefore
//! take turns, each seeds `rand` with 1, and OpenMesh's streams are silent: results depend on the
//! arguments alone, as long as nothing else in the process draws meanwhile.

use std::error;
use std::fmt;

#[cfg_attr(not(openmesh), path = "absent.rs")]
mod handle;

use handle::Handle;

/// Whether OpenMesh was installed when this crate was built.
pub const AVAILABLE: bool = cfg!(openmesh);

/// Major and minor version of the OpenMesh in this program, if it is [`AVAILABLE`].
pub fn version() -> Option<(u32, u32)> {
    handle::version()
}

/// How OpenMesh chooses what to collapse. Both weigh halfedge collapses, into vertices of the input, by
/// `ModQuadricT`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// `DecimaterT`: the cheapest of all, from a heap.
    Quadric,
    /// `McDecimaterT`: the cheapest of ten drawn at random, each time. Halfedges that are gone are
    /// collected at each halving, without which it gives up long before a hundredth is left.
    MultipleChoice,
}

/// What a decimation shall do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decimation {
    /// How to choose.
    pub method: Method,
    /// How many triangles to leave: the first count that is not above it, unless the collapses run out
    /// before.
    pub triangles: usize,
    /// Whether `ModNormalFlippingT` forbids collapses that turn a face by more than 90 degrees.
    pub prevent_flips: bool,
    /// How far a vertex of the input may come to lie from the faces around the place it went into
    /// (`ModHausdorffT`), in units of the positions. Slow, as each face keeps a list of such vertices.
    pub max_distance: Option<f32>,
}

impl Decimation {
    /// Down to `triangles` by the quadrics alone.
    pub fn new(method: Method, triangles: usize) -> Self {
        Self { method, triangles, prevent_flips: false, max_distance: None }
    }
}

/// Why there is no decimated mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// This program was built without OpenMesh.
    Unavailable,
    /// A triangle names a vertex that does not exist.
    IndexOutOfRange {
        /// The first such triangle.
        triangle: usize,
        /// What it names.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A coordinate is infinite or not a number.
    NotFinite {
        /// The first such vertex.
        vertex: usize,
    },
    /// OpenMesh counts in `int`: more than 2³¹ - 1 vertices or a sixth as many triangles are too many.
    TooLarge,
    /// [`Decimation::max_distance`] is negative or not a number.
    InvalidDistance,
    /// OpenMesh ran out of memory.
    OutOfMemory,
    /// OpenMesh threw an exception that is not about memory.
    Exception,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unavailable => f.write_str(
                "this program was built without OpenMesh: install Debian's packages libopenmesh-dev and \
                 g++, and build again",
            ),
            Self::IndexOutOfRange { triangle, index, vertices } => {
                write!(f, "triangle {triangle} names vertex {index}, of {vertices}")
            }
            Self::NotFinite { vertex } => write!(f, "vertex {vertex} has a coordinate that is not finite"),
            Self::TooLarge => f.write_str("the mesh has more vertices or triangles than OpenMesh can count"),
            Self::InvalidDistance => f.write_str("the distance allowed is negative or not a number"),
            Self::OutOfMemory => f.write_str("OpenMesh ran out of memory"),
            Self::Exception => f.write_str("OpenMesh threw an exception"),
        }
    }
}

impl error::Error for Error {}

/// A mesh as OpenMesh has it. Building, decimating and copying out are steps of their own, so that each
/// can be timed by itself.
#[derive(Debug)]
pub struct Mesh {
    handle: Handle,
}

impl Mesh {
    /// OpenMesh's mesh of these triangles, without those that it cannot hold ([`left_out`](Self::left_out)).
    pub fn build(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        check(positions, triangles)?;
        Handle::build(positions, triangles).map(|handle| Self { handle })
    }

    /// The decimated mesh: of consecutive vertices, each in use.
    pub fn decimate(self, decimation: &Decimation) -> Result<Self, Error> {
        if decimation.max_distance.is_some_and(|distance| distance.is_nan() || distance < 0.0) {
            return Err(Error::InvalidDistance);
        }
        self.handle.decimate(decimation).map(|handle| Self { handle })
    }

    /// How many vertices it has.
    pub fn vertices(&self) -> usize {
        self.handle.vertices()
    }

    /// How many triangles it has.
    pub fn triangles(&self) -> usize {
        self.handle.triangles()
    }

    /// How many triangles were left out when it was built: those that name a vertex twice, and those
    /// that would have made an edge or a vertex non-manifold or two neighbours disagree in orientation,
    /// which OpenMesh refuses one by one, in the order of the input.
    pub fn left_out(&self) -> usize {
        self.handle.left_out()
    }

    /// Positions and triangles, copied out.
    pub fn buffers(&self) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        self.handle.buffers()
    }
}

/// What [`decimate`] made.
#[derive(Debug, Clone, PartialEq)]
pub struct Decimated {
    /// Positions, each in use.
    pub positions: Vec<[f32; 3]>,
    /// Triangles, as indices into the positions.
    pub triangles: Vec<[u32; 3]>,
    /// As [`Mesh::left_out`].
    pub left_out: usize,
}

/// Builds, decimates and copies out, in one.
pub fn decimate(
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    decimation: &Decimation,
) -> Result<Decimated, Error> {
    let mesh = Mesh::build(positions, triangles)?.decimate(decimation)?;
    let left_out = mesh.left_out();
    let (positions, triangles) = mesh.buffers();
    Ok(Decimated { positions, triangles, left_out })
}

/// OpenMesh would take any of these at its word.
fn check(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<(), Error> {
    /// A triangle on its own has six halfedges.
    const HALFEDGES: usize = 6;
    let largest = i32::MAX as usize;
    if positions.len() > largest || triangles.len() > largest / HALFEDGES {
        return Err(Error::TooLarge);
    }
    if let Some(vertex) = positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
        return Err(Error::NotFinite { vertex });
    }
    let vertices = positions.len();
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&index| index as usize >= vertices) {
            return Err(Error::IndexOutOfRange { triangle, index, vertices });
        }
    }
    Ok(())
}
