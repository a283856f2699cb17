//! decimesh simplifies triangle meshes: many triangles in, few out, with the error that was made.
//!
//! ```
//! use decimesh::mesh::shapes;
//! use decimesh::{Monitor, Options, Target, simplify};
//!
//! let stone = shapes::bumpy_sphere(64, 1);
//! let result = simplify(&stone, &Options::new(Target::Ratio(0.1)), &mut Monitor::silent())?;
//! assert!(result.mesh.triangles().len() <= stone.triangles().len() / 10);
//! println!("{} triangles, within about {}", result.mesh.triangles().len(), result.error);
//! # Ok::<(), decimesh::SimplifyError>(())
//! ```
//!
//! # The house
//!
//! Modules stand on floors, and import from floors below only.
//!
//! | floor | room | what it is for |
//! | --- | --- | --- |
//! | 5 | [`capi`] | the C ABI that `include/decimesh.h` declares (feature `capi`) |
//! | 4 | `certified` | simplification within a guaranteed error: [`simplify_within`] (feature `deviation`) |
//! | 4 | [`lod`] | levels of detail on one vertex buffer: nested levels, progressive meshes |
//! | 4 | `out_of_core` | PLY files larger than memory, simplified by way of blocks on disk (feature `io`) |
//! | 4 | [`rate_distortion`] | terrain and semi-regular surfaces: every rate from one run, TINs, tiles |
//! | 3 | [`hqms`] | linear-time simplification by passes of quadric edge collapses: [`simplify`], [`build_levels`] |
//! | 3 | [`multiple_choice`] | half-edge collapse in an order drawn at random, after the paper: no vertex is made |
//! | 2 | `collapse` | the edge-collapse operator: which collapses are legal, and what they do |
//! | 2 | `deviation` | the measured and the bounded distance between two surfaces (feature `deviation`) |
//! | 2 | `io` | PLY, OBJ, STL, OFF and glTF files; heights in PNG, TIFF, NumPy and raw files (feature `io`) |
//! | 1 | [`mesh`] | the triangle mesh, its topology, statistics, welding, checking, and shapes to try things on |
//! | 1 | `quadric` | sums of squared distances to planes, and their minimum |
//! | 1 | `random` | numbers that look random and are the same everywhere |
//!
//! Every computation is a pure function of its input and options: no global state, no environment
//! variable changes a result, and the number of threads changes nothing but the time.

#![deny(unsafe_code)]

#[cfg(feature = "capi")]
pub mod capi;
#[cfg(feature = "deviation")]
pub mod certified;
mod collapse;
#[cfg(feature = "deviation")]
pub mod deviation;
pub mod hqms;
#[cfg(feature = "bench-internals")]
#[doc(hidden)]
pub mod internals {
    pub use crate::hqms::stages::Stages;
}
#[cfg(feature = "io")]
pub mod io;
mod lanes;
pub mod lod;
pub mod mesh;
mod monitor;
pub mod multiple_choice;
#[cfg(feature = "io")]
pub mod out_of_core;
mod quadric;
mod random;
pub mod rate_distortion;
mod workers;

#[cfg(feature = "deviation")]
pub use certified::{Certified, simplify_within};
pub use hqms::{
    AttributeWeights, HalfEdge, Options, Placement, Selection, Simplified, SimplifyError, StoppedBy, Target,
    Topology, build_levels, simplify, simplify_owned,
};
pub use lod::coarsest_within;
pub use mesh::{Attributes, Mesh, MeshError};
pub use monitor::{Cancelled, Monitor};
pub use workers::ThreadsError;
