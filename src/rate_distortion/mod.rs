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
mod remesh;
mod semi_regular;

pub use decomposition::{Approximation, Decomposition, DecompositionOptions, Detail};
pub use error::Error;
pub use height_field::HeightField;
pub use remesh::{RemeshError, RemeshOptions, Remeshed, remesh};
pub use semi_regular::{
    BaseComplex, SemiRegularError, SemiRegularMesh, SurfaceApproximation, SurfaceDecomposition,
};
