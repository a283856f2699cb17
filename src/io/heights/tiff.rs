//! Heights as a TIFF of one band, with what GeoTIFF and GDAL say in its tags.
//!
//! OGC GeoTIFF 1.1: the pixel scale (tag 33550) is in units of the model, which are lengths only where the
//! model is a projected one (key 1024 in the directory of keys, tag 34735). GDAL's no-data value is a text
//! (tag 42113). Files that leave out chunks, as GDAL's sparse ones do, are refused: that they hold nothing else
//! than no data would have to be believed.

use std::io::{ErrorKind, Read, Seek};

use tiff::TiffError;
use tiff::decoder::{ChunkType, Decoder, DecodingSampleType, Limits};
use tiff::tags::{CompressionMethod, PhotometricInterpretation, Tag};

use super::super::ReadError;
use super::samples::{ByteOrder, SampleType, append};
use super::tiff_directory::Checked;
use super::{Grid, out_of_memory, room};

const MODEL_TYPE_KEY: u16 = 1024;
const PROJECTED: u16 = 1;
/// GDAL writes a float with 17 digits at most.
const LONGEST_NO_DATA: usize = 64;

pub(super) fn read(reader: &mut (impl Read + Seek), length: Option<u64>) -> Result<Grid, ReadError> {
    let length = length.unwrap_or(u64::MAX);
    let reader = Checked::new(reader, length)?;
    let columns = reader.columns() as usize;
    let in_directory = |error| read_error("directory", error);
    let decoder = Decoder::new(reader).map_err(in_directory)?;
    // What a chunk needs is held against the file before it is read.
    let mut image = Image::new(decoder.with_limits(Limits::unlimited()), columns, length)?;
    let no_data = no_data(&mut image.decoder)?;
    let spacing = spacing(&mut image.decoder).map_err(in_directory)?;
    let samples = image.samples()?;
    Ok(Grid { no_data, spacing, ..Grid::new(image.columns, image.rows, samples) })
}

fn no_data<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<Option<f32>, ReadError> {
    let mut text = [0; LONGEST_NO_DATA];
    let found = decoder.image_ifd().find_tag_bytes(Tag::GdalNodata, &mut text, 0);
    let Some(length) = found.map_err(|error| read_error("no-data value", error))? else { return Ok(None) };
    let text = String::from_utf8_lossy(&text[..length.min(LONGEST_NO_DATA)]);
    let text = text.trim_matches(|c: char| c == '\0' || c.is_whitespace());
    match text.parse() {
        Ok(value) => Ok(Some(value)),
        Err(_) => Err(ReadError::in_object("no-data value", format!("'{text}' is not a number"))),
    }
}

/// The distance of columns and rows, where the file tells one that is a length.
fn spacing<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<Option<[f32; 2]>, TiffError> {
    let keys = decoder.find_tag_unsigned_vec::<u16>(Tag::GeoKeyDirectoryTag)?.unwrap_or_default();
    let (entries, _) = keys.as_chunks::<4>();
    let model =
        |&[key, location, _, value]: &[u16; 4]| (key == MODEL_TYPE_KEY && location == 0).then_some(value);
    // The first entry is the header.
    if entries.iter().skip(1).find_map(model) != Some(PROJECTED) {
        return Ok(None);
    }
    let scale = decoder.find_tag(Tag::ModelPixelScaleTag)?.map(|scale| scale.into_f64_vec()).transpose()?;
    Ok(match scale.as_deref() {
        Some(&[x, y, ..]) => Some([x as f32, y as f32]),
        _ => None,
    })
}

struct Image<R: Read + Seek> {
    decoder: Decoder<R>,
    columns: usize,
    rows: usize,
    /// The columns and rows of a strip or a tile.
    chunk: [usize; 2],
    chunk_type: ChunkType,
    sample: SampleType,
    compression: CompressionMethod,
    /// How many bytes each chunk has in the file.
    stored: Vec<u64>,
    length: u64,
}

impl<R: Read + Seek> Image<R> {
    fn new(mut decoder: Decoder<R>, columns: usize, length: u64) -> Result<Self, ReadError> {
        let in_directory = |error| read_error("directory", error);
        let (_, rows) = decoder.dimensions().map_err(in_directory)?;
        let (chunk_columns, chunk_rows) = decoder.chunk_dimensions();
        let chunk_type = decoder.get_chunk_type();
        let tag = match chunk_type {
            ChunkType::Strip => Tag::StripByteCounts,
            ChunkType::Tile => Tag::TileByteCounts,
        };
        let stored = decoder.find_tag_unsigned_vec(tag).map_err(in_directory)?.unwrap_or_default();
        let compression = decoder.find_tag_unsigned(Tag::Compression).map_err(in_directory)?;
        let compression = compression.map_or(CompressionMethod::None, CompressionMethod::from_u16_exhaustive);
        let photometric = decoder.find_tag_unsigned(Tag::PhotometricInterpretation).map_err(in_directory)?;
        if photometric.and_then(PhotometricInterpretation::from_u16)
            != Some(PhotometricInterpretation::BlackIsZero)
        {
            return Err(ReadError::Unsupported("a TIFF whose samples are not levels from black up".into()));
        }
        let layout = decoder.image_chunk_buffer_layout(0).map_err(in_directory)?;
        Ok(Self {
            columns,
            rows: rows as usize,
            chunk: [chunk_columns as usize, chunk_rows as usize],
            chunk_type,
            sample: sample_type(&mut decoder, layout.sample_type)?,
            compression,
            stored,
            length,
            decoder,
        })
    }

    fn samples(&mut self) -> Result<Vec<f32>, ReadError> {
        let across = self.columns.div_ceil(self.chunk[0]);
        let mut samples = room(self.columns as u64 * self.rows as u64, Some(self.length))?;
        let (mut bytes, mut chunk_samples) = (Vec::new(), Vec::new());
        for (band, first_row) in (0..self.rows).step_by(self.chunk[1]).enumerate() {
            let chunks = band * across..(band + 1) * across;
            chunks.clone().try_for_each(|chunk| self.check_size(chunk))?;
            let rows = self.chunk[1].min(self.rows - first_row);
            let start = samples.len();
            samples.try_reserve(rows * self.columns).map_err(|_| out_of_memory())?;
            samples.resize(start + rows * self.columns, 0.0);
            for (chunk, first_column) in chunks.zip((0..self.columns).step_by(self.chunk[0])) {
                let chunk_columns = self.read_chunk(chunk, &mut bytes)?;
                chunk_samples.clear();
                append(&mut chunk_samples, &bytes, self.sample, ByteOrder::NATIVE);
                // A tile may stick out of the image.
                let columns = chunk_columns.min(self.columns - first_column);
                let rows = samples[start..].chunks_exact_mut(self.columns);
                for (row, part) in rows.zip(chunk_samples.chunks_exact(chunk_columns)) {
                    row[first_column..first_column + columns].copy_from_slice(&part[..columns]);
                }
            }
        }
        Ok(samples)
    }

    /// Fills `bytes` with a chunk, and answers how many columns it has.
    fn read_chunk(&mut self, chunk: usize, bytes: &mut Vec<u8>) -> Result<usize, ReadError> {
        let (columns, rows) = self.decoder.chunk_data_dimensions(chunk as u32);
        bytes.clear();
        bytes.resize(columns as usize * rows as usize * self.sample.bytes(), 0);
        let read = self.decoder.read_chunk_bytes(chunk as u32, bytes);
        read.map_err(|error| read_error(&self.name(chunk), error))?;
        Ok(columns as usize)
    }

    /// Refuses a chunk that cannot have been made of the bytes that the file has for it.
    fn check_size(&self, chunk: usize) -> Result<(), ReadError> {
        let rows = match self.chunk_type {
            ChunkType::Tile => self.chunk[1],
            ChunkType::Strip => self.chunk[1].min(self.rows - chunk * self.chunk[1]),
        };
        let size =
            (self.chunk[0] as u64).saturating_mul(rows as u64).saturating_mul(self.sample.bytes() as u64);
        // The most that a byte of each can stand for: a run of 128, a string of 3,839 in 9 bits, 1,032.
        let growth = match self.compression {
            CompressionMethod::None => 1,
            CompressionMethod::PackBits => 64,
            CompressionMethod::LZW => 4096,
            _ => 1032,
        };
        let stored = self.stored[chunk];
        if size <= stored.min(self.length).saturating_mul(growth) {
            return Ok(());
        }
        let problem = format!("{size} bytes of samples cannot come from {stored} bytes of the file");
        Err(ReadError::in_object(self.name(chunk), problem))
    }

    fn name(&self, chunk: usize) -> String {
        match self.chunk_type {
            ChunkType::Strip => format!("strip {chunk}"),
            ChunkType::Tile => format!("tile {chunk}"),
        }
    }
}

fn sample_type<R: Read + Seek>(
    decoder: &mut Decoder<R>,
    found: Option<DecodingSampleType>,
) -> Result<SampleType, ReadError> {
    let bits: u8 = match decoder.colortype().map_err(|error| read_error("directory", error))? {
        tiff::ColorType::Gray(bits) => bits,
        other => return Err(ReadError::Unsupported(format!("a TIFF of {other:?}"))),
    };
    let sample = match found {
        Some(DecodingSampleType::U8) => SampleType::U8,
        Some(DecodingSampleType::I8) => SampleType::I8,
        Some(DecodingSampleType::U16) => SampleType::U16,
        Some(DecodingSampleType::I16) => SampleType::I16,
        Some(DecodingSampleType::U32) => SampleType::U32,
        Some(DecodingSampleType::I32) => SampleType::I32,
        Some(DecodingSampleType::F32) => SampleType::F32,
        Some(DecodingSampleType::F64) => SampleType::F64,
        other => return Err(ReadError::Unsupported(format!("a TIFF with samples of the type {other:?}"))),
    };
    // Types are rounded up to whole bytes; samples that share one would be taken for one.
    if usize::from(bits) != 8 * sample.bytes() {
        return Err(ReadError::Unsupported(format!("a TIFF with samples of {bits} bits")));
    }
    Ok(sample)
}

fn read_error(part: &str, error: TiffError) -> ReadError {
    match error {
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            ReadError::in_object(part, "the file ends here")
        }
        TiffError::IoError(error) if error.kind() != ErrorKind::InvalidData => ReadError::Io(error),
        TiffError::UnsupportedError(error) => ReadError::Unsupported(format!("a TIFF with {error}")),
        other => ReadError::in_object(part, other.to_string()),
    }
}
