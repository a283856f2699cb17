//! Levels of detail that share one vertex buffer, and which of them to draw.
//!
//! Two forms, both made of half-edge collapses, which make no vertex and move none:
//! - [`NestedLevels`]: a few levels, an index buffer each. The vertices are put in an order in which each
//!   level needs those up to some number only.
//! - [`Progressive`]: every level between the mesh and its coarsest one, as a list of splits that are
//!   played forward and back. After Hoppe, *Progressive Meshes*; but a split lists the corners that it
//!   changes instead of walking around a vertex, so that any surface will do, clean or not.

mod nested;
mod progressive;
mod view;

pub use nested::{Level, NestedLevels};
#[cfg(feature = "io")]
pub use progressive::Extent;
pub use progressive::{Mark, Player, Progressive, ProgressiveError, Split, VertexSplit};
pub use view::{View, coarsest_within};
