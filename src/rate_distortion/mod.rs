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
pub mod tin;
pub mod vertical;

#[cfg(test)]
mod tests;

pub use decomposition::{Approximation, Decomposition, DecompositionOptions, Detail};
pub use error::Error;
pub use height_field::HeightField;
pub use vertical::VerticalError;
