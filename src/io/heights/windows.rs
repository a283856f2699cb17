//! Files of heights that are larger than memory: read in part, where samples lie open in them.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::samples::{SampleType, append};
use super::{Grid, HeightFormat, HeightOptions, RawLayout, extension, heights, npy, raw};
use crate::io::source::Source;
use crate::io::{FileError, ReadError};

/// A file of heights, NumPy or raw samples, from which windows are read.
///
/// Any number of threads may do so; they take turns at the file.
#[derive(Debug)]
pub struct HeightFile {
    file: Mutex<File>,
    /// Where the first sample lies.
    start: u64,
    columns: usize,
    rows: usize,
    sample: SampleType,
    layout: RawLayout,
    options: HeightOptions,
}

impl HeightFile {
    /// Opens the file at `path`, which must be as long as it says.
    pub fn open(path: &Path, options: &HeightOptions) -> Result<Self, FileError> {
        let format = options.format.map_or_else(|| HeightFormat::from_path(path), Ok)?;
        let named = SampleType::from_extension(&extension(path));
        let open = || {
            let mut file = File::open(path)?;
            let length = file.metadata()?.len();
            let mut source = Source::new(&mut file, Some(length));
            let (layout, sample) = match format {
                HeightFormat::Npy => npy::header(&mut source)?,
                HeightFormat::Raw => raw::layout(options.raw, named)?,
                HeightFormat::Png | HeightFormat::Tiff => {
                    return Err(ReadError::Unsupported("a part of an image".into()));
                }
            };
            let RawLayout { columns, rows, .. } = layout;
            let start = length - source.remaining().unwrap_or(0);
            let bytes =
                (columns as u64).checked_mul(rows as u64).and_then(|n| n.checked_mul(sample.bytes() as u64));
            if bytes != Some(length - start) {
                let problem = format!(
                    "{} bytes are not those of {columns} columns times {rows} rows of {} bytes each",
                    length - start,
                    sample.bytes()
                );
                return Err(source.error_here(problem));
            }
            Ok(Self {
                file: Mutex::new(file),
                start,
                columns,
                rows,
                sample,
                layout,
                options: options.clone(),
            })
        };
        open().map_err(|source| FileError::Read { path: path.to_owned(), source })
    }

    /// How many columns and rows there are.
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// How far columns and rows are apart, where the options say so.
    pub fn spacing(&self) -> Option<[f32; 2]> {
        self.options.spacing
    }

    /// The heights of a window within the field: row by row, not a number where void.
    ///
    /// # Panics
    /// If the window reaches beyond the field.
    pub fn window(&self, start: [usize; 2], [columns, rows]: [usize; 2]) -> Result<Vec<f32>, ReadError> {
        assert!(
            start[0] + columns <= self.columns && start[1] + rows <= self.rows,
            "a window beyond the field"
        );
        let size = self.sample.bytes();
        let mut samples = Vec::with_capacity(columns * rows);
        let mut bytes = vec![0; columns * size];
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        for row in start[1]..start[1] + rows {
            let first = (row * self.columns + start[0]) as u64 * size as u64;
            file.seek(SeekFrom::Start(self.start + first))?;
            file.read_exact(&mut bytes)?;
            append(&mut samples, &bytes, self.sample, self.layout.byte_order);
        }
        drop(file);
        Ok(heights(Grid::new(columns, rows, samples), &self.options, start)?.heights)
    }
}
