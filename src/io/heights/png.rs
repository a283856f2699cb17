//! Heights as the pixels of a PNG.

use std::io::{BufRead, ErrorKind, Seek};

use png::{BitDepth, ColorType, Decoder, DecodingError, Reader};

use super::super::ReadError;
use super::samples::{ByteOrder, SampleType, append};
use super::{Grid, Pixels, room};

/// Deflate makes no more than this of a byte.
const LARGEST_GROWTH: u64 = 1032;

pub(super) fn read(
    reader: &mut (impl BufRead + Seek),
    length: Option<u64>,
    pixels: Pixels,
) -> Result<Grid, ReadError> {
    let mut decoder = Decoder::new(reader);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let in_header = |error| read_error("header", error);
    let info = decoder.read_header_info().map_err(in_header)?;
    let (columns, rows, interlaced) = (info.width as usize, info.height as usize, info.interlaced);
    let pixel = Pixel::new(pixels, info.color_type, info.bit_depth)?;
    let count = u64::from(info.width) * u64::from(info.height);
    if length
        .is_some_and(|length| count.saturating_mul(pixel.bytes()) > length.saturating_mul(LARGEST_GROWTH))
    {
        let problem = format!("the file is too short to hold {columns} columns times {rows} rows");
        return Err(ReadError::in_object("header", problem));
    }
    let mut samples = room(count, length)?;
    let mut reader = decoder.read_info().map_err(in_header)?;
    if interlaced {
        read_interlaced(&mut reader, pixel, &mut samples)?;
    } else {
        for row in 0..rows {
            let in_row = |error| read_error(&format!("row {row}"), error);
            let Some(bytes) = reader.next_row().map_err(in_row)? else { break };
            pixel.append(&mut samples, bytes.data());
        }
    }
    reader.finish().map_err(|error| read_error("end", error))?;
    let no_data = matches!(pixel, Pixel::Color { alpha: true }).then_some(f32::NAN);
    Ok(Grid { no_data, ..Grid::new(columns, rows, samples) })
}

/// The rows of such an image come in pieces, and are whole only when the last has come.
fn read_interlaced(
    reader: &mut Reader<impl BufRead + Seek>,
    pixel: Pixel,
    samples: &mut Vec<f32>,
) -> Result<(), ReadError> {
    let in_image = |error| read_error("interlaced image", error);
    let size = reader.output_buffer_size().ok_or_else(|| in_image(DecodingError::LimitsExceeded))?;
    let mut bytes = vec![0; size];
    reader.next_frame(&mut bytes).map_err(in_image)?;
    pixel.append(samples, &bytes);
    Ok(())
}

/// What a pixel is made of.
#[derive(Debug, Clone, Copy)]
enum Pixel {
    Grey(SampleType),
    /// Red, green, blue, and maybe alpha.
    Color {
        alpha: bool,
    },
}

impl Pixel {
    fn new(pixels: Pixels, color: ColorType, depth: BitDepth) -> Result<Self, ReadError> {
        match (pixels, color, depth) {
            (Pixels::Grey, ColorType::Grayscale, BitDepth::Eight) => Ok(Self::Grey(SampleType::U8)),
            (Pixels::Grey, ColorType::Grayscale, BitDepth::Sixteen) => Ok(Self::Grey(SampleType::U16)),
            (Pixels::TerrainRgb, ColorType::Rgb, BitDepth::Eight) => Ok(Self::Color { alpha: false }),
            (Pixels::TerrainRgb, ColorType::Rgba, BitDepth::Eight) => Ok(Self::Color { alpha: true }),
            _ => {
                let expected = match pixels {
                    Pixels::Grey => "heights are grey of 8 or 16 bits; RGB of 8 bits may be Terrain-RGB",
                    Pixels::TerrainRgb => "Terrain-RGB is RGB of 8 bits, with or without alpha",
                };
                let found = format!("a PNG of {color:?} with {} bits a channel ({expected})", depth as u8);
                Err(ReadError::Unsupported(found))
            }
        }
    }

    fn bytes(self) -> u64 {
        match self {
            Self::Grey(sample) => sample.bytes() as u64,
            Self::Color { alpha } => 3 + u64::from(alpha),
        }
    }

    fn append(self, samples: &mut Vec<f32>, bytes: &[u8]) {
        match self {
            Self::Grey(sample) => append(samples, bytes, sample, ByteOrder::Big),
            Self::Color { alpha: false } => {
                samples.extend(bytes.as_chunks().0.iter().map(|&color| terrain_rgb(color)));
            }
            Self::Color { alpha: true } => {
                let height = |&[r, g, b, alpha]: &[u8; 4]| match alpha {
                    0 => f32::NAN,
                    _ => terrain_rgb([r, g, b]),
                };
                samples.extend(bytes.as_chunks().0.iter().map(height));
            }
        }
    }
}

fn terrain_rgb([r, g, b]: [u8; 3]) -> f32 {
    (f64::from(u32::from_be_bytes([0, r, g, b])) / 10.0 - 10_000.0) as f32
}

fn read_error(part: &str, error: DecodingError) -> ReadError {
    match error {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            ReadError::in_object(part, "the file ends here")
        }
        DecodingError::IoError(error) => ReadError::Io(error),
        other => ReadError::in_object(part, other.to_string()),
    }
}
