//! Rate-distortion decimation of 4-8 meshes.

mod baselines;
#[cfg(test)]
mod brute_force;
mod comparison;
mod decomposition;
mod distortion;
mod error;
mod extract;
mod flow;
mod graph;
mod height_field;
mod lattice;
mod layout;
mod max_error;
mod merging;
pub mod polyline;
mod priority;
mod raster;
mod removals;
pub mod tiles;
pub mod vertical;

#[cfg(test)]
mod tests;

pub use baselines::Criterion;
pub use comparison::Baseline;
pub use decomposition::{Approximation, Decomposition, DecompositionOptions, Detail};
pub use error::Error;
pub use height_field::HeightField;
pub use vertical::VerticalError;
