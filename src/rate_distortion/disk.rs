//! Tiles from disk and on disk, so that a field may be larger than memory.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::Error;
use super::tiles::{Source, Store};
use crate::io::heights::HeightFile;

/// Rows are looked through so many samples at a time.
const AT_A_TIME: usize = 1 << 20;

impl Source for HeightFile {
    fn size(&self) -> [usize; 2] {
        HeightFile::size(self)
    }

    fn spacing(&self) -> [f32; 2] {
        HeightFile::spacing(self).unwrap_or([1.0; 2])
    }

    /// Reads all of the file.
    fn range(&self) -> Result<(f32, f32), Error> {
        let [columns, rows] = HeightFile::size(self);
        let step = (AT_A_TIME / columns.max(1)).max(1);
        let mut range = (f32::INFINITY, f32::NEG_INFINITY);
        for row in (0..rows).step_by(step) {
            let heights = Source::window(self, [0, row], [columns, step.min(rows - row)])?;
            for height in heights.into_iter().filter(|height| !height.is_nan()) {
                range = (range.0.min(height), range.1.max(height));
            }
        }
        Ok(range)
    }

    fn window(&self, start: [usize; 2], size: [usize; 2]) -> Result<Vec<f32>, Error> {
        let [column, row] = start;
        HeightFile::window(self, start, size).map_err(|error| Error::Tile {
            column,
            row,
            reason: error.to_string(),
        })
    }
}

/// Slopes in a file without a name, which is gone with the store: 4 bytes a sample of disk.
#[derive(Debug)]
pub struct OnDisk {
    inner: Mutex<Slots>,
}

#[derive(Debug)]
struct Slots {
    file: File,
    /// How many slopes each tile has: none, or as many as the others.
    lengths: Vec<usize>,
}

impl OnDisk {
    /// A store in a directory that is there.
    pub fn new(directory: &Path) -> std::io::Result<Self> {
        let file = tempfile::tempfile_in(directory)?;
        Ok(Self { inner: Mutex::new(Slots { file, lengths: Vec::new() }) })
    }
}

const SLOPE: usize = size_of::<f32>();

impl Store for OnDisk {
    fn put(&self, tile: usize, slopes: &[f32]) -> std::io::Result<()> {
        let bytes: Vec<u8> = slopes.iter().flat_map(|slope| slope.to_le_bytes()).collect();
        let mut slots = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
        slots.file.seek(SeekFrom::Start(tile as u64 * bytes.len() as u64))?;
        slots.file.write_all(&bytes)?;
        let lengths = &mut slots.lengths;
        lengths.resize(lengths.len().max(tile + 1), 0);
        lengths[tile] = slopes.len();
        Ok(())
    }

    fn get(&self, tile: usize) -> std::io::Result<Vec<f32>> {
        let mut slots = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
        let length = slots.lengths.get(tile).copied().unwrap_or(0);
        let mut bytes = vec![0; length * SLOPE];
        slots.file.seek(SeekFrom::Start((tile * bytes.len()) as u64))?;
        slots.file.read_exact(&mut bytes)?;
        drop(slots);
        Ok(bytes.as_chunks::<SLOPE>().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect())
    }
}
