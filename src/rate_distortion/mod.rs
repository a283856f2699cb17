//! Rate-distortion decimation of 4-8 meshes.

mod baselines;
#[cfg(test)]
mod brute_force;
mod comparison;
mod curve;
mod decomposition;
mod distortion;
mod error;
mod extract;
#[cfg(feature = "io")]
mod file;
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
mod rate;
#[cfg(feature = "io")]
mod read;
mod remesh;
mod removals;
mod semi_regular;
pub mod tiles;
pub mod tin;
pub mod vertical;

#[cfg(test)]
mod tests;

pub use baselines::Criterion;
pub use comparison::Baseline;
pub use curve::RatePoint;
pub use decomposition::{Approximation, Decomposition, DecompositionOptions, Detail};
pub use error::Error;
pub use height_field::HeightField;
#[cfg(feature = "io")]
pub use read::HeightFileError;
pub use remesh::{RemeshError, RemeshOptions, Remeshed, remesh};
pub use semi_regular::{
    BaseComplex, SemiRegularError, SemiRegularMesh, SurfaceApproximation, SurfaceDecomposition,
};
pub use vertical::VerticalError;
