//! Rate-distortion decimation of 4-8 meshes.

mod error;
mod height_field;
mod layout;
mod raster;
pub mod tin;
pub mod vertical;

pub use error::Error;
pub use height_field::HeightField;
pub use vertical::VerticalError;
