//! decimesh: triangle-mesh simplification.

pub mod deviation;
pub mod hqms;
#[cfg(feature = "io")]
pub mod io;
pub mod mesh;
mod monitor;

pub use hqms::{Options, Selection, Simplified, StoppedBy, Target, Topology, simplify};
pub use mesh::{Attributes, Mesh, MeshError};
pub use monitor::{Cancelled, Monitor};
