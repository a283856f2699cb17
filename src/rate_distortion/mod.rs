//! Rate-distortion decimation of 4-8 meshes.

mod decomposition;
mod distortion;
mod error;
mod extract;
#[cfg(feature = "io")]
mod file;
mod flow;
mod height_field;
mod lattice;
mod layout;
mod max_error;
mod raster;
#[cfg(feature = "io")]
mod read;
pub mod tiles;
pub mod vertical;

#[cfg(test)]
mod tests;

pub use decomposition::{Approximation, Decomposition, DecompositionOptions, Detail};
pub use error::Error;
pub use height_field::HeightField;
#[cfg(feature = "io")]
pub use read::HeightFileError;
pub use vertical::VerticalError;
