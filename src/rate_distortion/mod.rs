//! Rate-distortion decimation of 4-8 meshes.

mod decomposition;
mod distortion;
mod error;
mod extract;
mod flow;
mod height_field;
mod lattice;
mod layout;
mod max_error;
mod raster;
pub mod tiles;
#[cfg_attr(not(test), expect(dead_code, reason = "decompositions are to call it"))]
mod tin;
pub mod vertical;

#[cfg(test)]
mod tests;

pub use decomposition::{Approximation, Decomposition, DecompositionOptions, Detail};
pub use error::Error;
pub use height_field::HeightField;
pub use tin::Tin;
pub use vertical::VerticalError;
