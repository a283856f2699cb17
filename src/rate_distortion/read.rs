//! Height fields from files.

use std::path::{Path, PathBuf};

use super::{Error, HeightField};
use crate::io::FileError;
use crate::io::heights::{self, HeightOptions, Heights};

/// Why a file holds no height field.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HeightFileError {
    /// It could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// What was read makes no field.
    #[error("{}: {source}", path.display())]
    Field {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Error,
    },
}

impl HeightField {
    /// The field in the file at `path`: PNG, TIFF, NumPy or raw samples, as [`io::heights`](heights) tells.
    pub fn read(path: &Path, options: &HeightOptions) -> Result<Self, HeightFileError> {
        let field = Self::try_from(heights::read(path, options)?);
        field.map_err(|source| HeightFileError::Field { path: path.to_owned(), source })
    }
}

impl TryFrom<Heights> for HeightField {
    type Error = Error;

    fn try_from(heights: Heights) -> Result<Self, Error> {
        let Heights { columns, rows, heights, spacing } = heights;
        let field = Self::new(columns, rows, heights, Some(f32::NAN))?;
        match spacing {
            Some(spacing) => field.with_spacing(spacing),
            None => Ok(field),
        }
    }
}
