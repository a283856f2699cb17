//! decimesh: triangle-mesh simplification.

mod collapse;
#[cfg(feature = "deviation")]
pub mod deviation;
pub mod hqms;
#[cfg(feature = "io")]
pub mod io;
pub mod mesh;
mod monitor;
mod quadric;
mod workers;

/// For benches/stages.rs alone.
#[cfg(feature = "bench-internals")]
#[doc(hidden)]
pub mod internals {
    pub use crate::hqms::stages::Stages;
}

pub use hqms::{Options, Selection, Simplified, StoppedBy, Target, Topology, simplify};
pub use mesh::{Attributes, Mesh, MeshError};
pub use monitor::{Cancelled, Monitor};
