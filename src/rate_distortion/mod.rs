//! Rate-distortion decimation of 4-8 meshes: terrain, at every rate from one run.
//!
//! After Balmelli, Vetterli and Liebling, "Mesh Optimization Using Global Error with Application to Geometry
//! Simplification" (Graphical Models, 2002). Heights over a grid are connected by right triangles that are halved
//! again and again; each vertex hangs on two of the level above. A [`Decomposition`] finds in which order vertices
//! have to go so that whatever is left has the least squared error, over all samples, of all conforming meshes of as
//! many vertices, or nearly: how nearly is proven for each field ([`Approximation::certified_gap`]).
//!
//! ```
//! use decimesh::Monitor;
//! use decimesh::rate_distortion::{Decomposition, DecompositionOptions, Detail, HeightField};
//!
//! let heights = (0..65 * 65).map(|sample| ((sample % 65) as f32 * 0.2).sin()).collect();
//! let field = HeightField::new(65, 65, heights, None)?;
//! let decomposition = Decomposition::new(field, &DecompositionOptions::default(), &mut Monitor::silent())?;
//! let tenth = decomposition.at(Detail::Ratio(0.1))?;
//! let close = decomposition.at(Detail::MaxError(0.01))?;
//! println!("{} triangles, RMS {}", tenth.mesh.triangles().len(), tenth.rms);
//! # Ok::<(), decimesh::rate_distortion::Error>(())
//! ```
//!
//! The paper finds the order by removing the merging domain of least slope again and again, which is here too
//! ([`Baseline::GeneralizedDecimation`]), beside the methods that it compares with; `flow.rs` says what takes its place
//! and why. [`tiles`] does fields that are larger than memory, [`tin`] sets the mesh free from the hierarchy where that
//! is not needed, [`vertical`] measures, and [`polyline`] is all of it in one dimension.
//!
//! Surfaces have the same levels over a base of quads, a [`SemiRegularMesh`], which [`remesh`] makes of any oriented
//! manifold; a [`SurfaceDecomposition`] is to them what a [`Decomposition`] is to fields.

mod baselines;
#[cfg(test)]
mod brute_force;
mod comparison;
mod curve;
mod decomposition;
#[cfg(feature = "io")]
mod disk;
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
#[cfg(feature = "io")]
pub use disk::OnDisk;
pub use error::Error;
pub use height_field::HeightField;
#[cfg(feature = "io")]
pub use read::HeightFileError;
pub use remesh::{RemeshError, RemeshOptions, Remeshed, remesh};
pub use semi_regular::{
    BaseComplex, SemiRegularError, SemiRegularMesh, SurfaceApproximation, SurfaceDecomposition,
};
pub use vertical::VerticalError;
