//! Rate-distortion decimation of 4-8 meshes.

mod baselines;
#[cfg(test)]
mod brute_force;
mod error;
mod graph;
mod height_field;
mod layout;
mod merging;
pub mod polyline;
mod priority;
mod removals;

pub use error::Error;
pub use height_field::HeightField;
