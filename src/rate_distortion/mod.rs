//! Rate-distortion decimation of 4-8 meshes.

mod error;
mod height_field;
mod layout;
#[cfg(feature = "io")]
mod read;

pub use error::Error;
pub use height_field::HeightField;
#[cfg(feature = "io")]
pub use read::HeightFileError;
