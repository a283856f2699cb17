//! Files of heights over a grid: PNG, TIFF and GeoTIFF, NumPy and raw samples, read.
//!
//! | | samples | void where | distance of the samples |
//! |---|---|---|---|
//! | PNG | 8 or 16 bits of grey, or [`Pixels::TerrainRgb`] | - | - |
//! | TIFF | integers of 8 to 32 bits, floats of 32 and 64; strips and tiles; plain, PackBits, LZW, deflate | GDAL's no-data tag says | GeoTIFF's pixel scale says, on a projected map |
//! | NumPy | two dimensions of the same types, both byte orders, C order | - | - |
//! | raw | the same types, as [`RawLayout`] says | - | - |
//!
//! The first row is the northernmost and the first column the westernmost, as all these files have it. All
//! samples become `f32`: whole numbers above 16,777,216 and doubles are rounded. What is not in the file is
//! said by [`HeightOptions`].
//!
//! No file makes reading panic, or take more memory than in proportion to its size; compressed ones may grow
//! as much as their compression allows. A value that is neither a finite number nor declared to mean "void"
//! is refused, and its place named. That there are rows and columns enough to make a surface is for
//! [`HeightField`](crate::rate_distortion::HeightField) to ask.

mod npy;
mod png;
mod raw;
mod samples;
mod tiff;
mod tiff_directory;
mod windows;

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

pub use samples::{ByteOrder, SampleType};
pub use windows::HeightFile;

use super::source::Source;
use super::{FileError, ReadError};

/// Heights over a grid, as a file has them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Heights {
    /// How many samples a row has.
    pub columns: usize,
    /// How many rows there are.
    pub rows: usize,
    /// The heights, row by row from the north; not a number where void, finite elsewhere.
    pub heights: Vec<f32>,
    /// How far columns and rows are apart, where the file or the options say so.
    pub spacing: Option<[f32; 2]>,
}

/// A kind of file of heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum HeightFormat {
    /// Portable Network Graphics, `.png`.
    Png,
    /// Tagged Image File Format, `.tif` and `.tiff`, also the larger BigTIFF.
    Tiff,
    /// NumPy's array, `.npy`.
    Npy,
    /// Samples and nothing else: `.raw`, `.bin`, or by their type `.f32`, `.i16`, `.u16`.
    Raw,
}

impl HeightFormat {
    /// The format that the extension of `path` names, in upper or lower case.
    pub fn from_path(path: &Path) -> Result<Self, FileError> {
        match extension(path).as_str() {
            "png" => Ok(Self::Png),
            "tif" | "tiff" => Ok(Self::Tiff),
            "npy" => Ok(Self::Npy),
            "raw" | "bin" | "f32" | "i16" | "u16" => Ok(Self::Raw),
            _ => Err(FileError::UnknownHeightFormat { path: path.to_owned() }),
        }
    }
}

fn extension(path: &Path) -> String {
    path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_ascii_lowercase()
}

/// How the pixels of a PNG mean heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Pixels {
    /// As levels of grey.
    #[default]
    Grey,
    /// As Mapbox has them in red, green and blue of 8 bits: -10,000 + 0.1 (65,536 R + 256 G + B), in metres.
    /// Where there is alpha and it is 0, the sample is void.
    TerrainRgb,
}

/// How raw samples lie in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RawLayout {
    /// How many samples a row has.
    pub columns: usize,
    /// How many rows there are.
    pub rows: usize,
    /// Of which type they are; `None`: the one that the file's extension names.
    pub sample: Option<SampleType>,
    /// In which order their bytes come.
    pub byte_order: ByteOrder,
}

/// What to know about a file of heights that is not in it.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightOptions {
    /// The format; `None`: the one that the file's extension names.
    pub format: Option<HeightFormat>,
    /// How the pixels of a PNG mean heights.
    pub pixels: Pixels,
    /// The sample that means "void", as it stands in the file, before `scale` and `offset`; not a number: all
    /// that are not. What a file itself says is void is so too.
    pub no_data: Option<f32>,
    /// How far columns and rows are apart, in the unit of the heights, whatever the file says.
    pub spacing: Option<[f32; 2]>,
    /// What samples are multiplied by to make heights.
    pub scale: f32,
    /// What is added to them then.
    pub offset: f32,
    /// How raw samples lie. Other formats ignore it.
    pub raw: Option<RawLayout>,
}

impl Default for HeightOptions {
    /// All as the file has it.
    fn default() -> Self {
        Self {
            format: None,
            pixels: Pixels::default(),
            no_data: None,
            spacing: None,
            scale: 1.0,
            offset: 0.0,
            raw: None,
        }
    }
}

/// What the readers of the formats find.
struct Grid {
    columns: usize,
    rows: usize,
    samples: Vec<f32>,
    no_data: Option<f32>,
    spacing: Option<[f32; 2]>,
}

impl Grid {
    fn new(columns: usize, rows: usize, samples: Vec<f32>) -> Self {
        Self { columns, rows, samples, no_data: None, spacing: None }
    }
}

/// The heights in the file at `path`.
pub fn read(path: &Path, options: &HeightOptions) -> Result<Heights, FileError> {
    let format = options.format.map_or_else(|| HeightFormat::from_path(path), Ok)?;
    let sample = SampleType::from_extension(&extension(path));
    let open_and_read = || {
        let file = File::open(path)?;
        let metadata = file.metadata()?;
        let length = metadata.is_file().then_some(metadata.len());
        read_from(&mut BufReader::new(file), length, format, sample, options)
    };
    open_and_read().map_err(|source| FileError::Read { path: path.to_owned(), source })
}

/// The heights in `bytes`, which are of `format`; that of the options is not looked at.
pub fn read_from_slice(
    bytes: &[u8],
    format: HeightFormat,
    options: &HeightOptions,
) -> Result<Heights, ReadError> {
    read_from(&mut Cursor::new(bytes), Some(bytes.len() as u64), format, None, options)
}

fn read_from(
    reader: &mut (impl BufRead + Seek),
    length: Option<u64>,
    format: HeightFormat,
    sample: Option<SampleType>,
    options: &HeightOptions,
) -> Result<Heights, ReadError> {
    let grid = match format {
        HeightFormat::Png => png::read(reader, length, options.pixels),
        HeightFormat::Tiff => tiff::read(reader, length),
        HeightFormat::Npy => npy::read(&mut Source::new(reader, length)),
        HeightFormat::Raw => raw::read(&mut Source::new(reader, length), options.raw, sample),
    }?;
    heights(grid, options, [0, 0])
}

/// Turns samples, the first of which lies at `start`, into heights.
fn heights(grid: Grid, options: &HeightOptions, start: [usize; 2]) -> Result<Heights, ReadError> {
    let Grid { columns, rows, samples: mut heights, no_data, spacing } = grid;
    let voids = [options.no_data, no_data];
    let is_void = |sample: f32| {
        voids.iter().flatten().any(|void| sample == *void || (void.is_nan() && sample.is_nan()))
    };
    let (scale, offset) = (f64::from(options.scale), f64::from(options.offset));
    for (index, height) in heights.iter_mut().enumerate() {
        let sample = *height;
        if is_void(sample) {
            *height = f32::NAN;
            continue;
        }
        *height = (f64::from(sample) * scale + offset) as f32;
        if !height.is_finite() {
            let place = format!("column {}, row {}", start[0] + index % columns, start[1] + index / columns);
            let problem = if sample.is_finite() {
                format!("{sample} times {scale} plus {offset} is no height")
            } else {
                format!("{sample} is no height, and not what stands for void")
            };
            return Err(ReadError::in_object(place, problem));
        }
    }
    Ok(Heights { columns, rows, heights, spacing: options.spacing.or(spacing) })
}

/// An empty list for `count` samples of a file of `length` bytes, with room for as many as there are bytes:
/// files that are compressed harder make it grow.
fn room(count: u64, length: Option<u64>) -> Result<Vec<f32>, ReadError> {
    let count = usize::try_from(count.min(length.unwrap_or(0))).unwrap_or(usize::MAX);
    let mut list = Vec::new();
    list.try_reserve_exact(count).map_err(|_| out_of_memory())?;
    Ok(list)
}

fn out_of_memory() -> ReadError {
    ReadError::Io(std::io::ErrorKind::OutOfMemory.into())
}
