//! Rate-distortion decimation of 4-8 meshes.

mod error;
mod height_field;
mod layout;

pub use error::Error;
pub use height_field::HeightField;
