//! The directory of a TIFF, looked at before the decoder sees it.
//!
//! TIFF 6.0, section 2; BigTIFF has the same shape with larger numbers. Two things are done about what stands
//! there:
//! - Entries say how many values they have, and the decoder makes room for them. Here each is held against
//!   the length of the file first. Images of several bands are refused, so that the decoder does no arithmetic
//!   with their number.
//! - An image that is not a whole number of tiles wide is shown as if it were. The decoder reads tiles that
//!   stick out row by row, and then loses the end of some that are compressed by LZW (tiff 0.11 with weezl 0.1:
//!   image-rs/image-tiff, issue 395); whole tiles it reads at once.

use std::io::{self, ErrorKind, Read, Seek, SeekFrom};

use super::super::{Place, ReadError};

const IMAGE_WIDTH: u64 = 256;
const SAMPLES_PER_PIXEL: u64 = 277;
const TILE_WIDTH: u64 = 322;

/// A TIFF whose directory was looked at.
pub(super) struct Checked<'a, R> {
    reader: &'a mut R,
    position: u64,
    /// Where the image's width stands in the file.
    width_at: u64,
    /// What the decoder shall see there, in the bytes and the order of the file.
    width_shown: Vec<u8>,
    columns: u64,
}

impl<'a, R: Read + Seek> Checked<'a, R> {
    /// Refuses a TIFF whose first directory has values that the file, of `length` bytes, cannot hold, or that
    /// has more than one sample a pixel.
    pub(super) fn new(reader: &'a mut R, length: u64) -> Result<Self, ReadError> {
        let mut numbers = Numbers { reader, big_endian: false, position: 0 };
        numbers.big_endian = match numbers.bytes::<2>()? {
            [b'I', b'I'] => false,
            [b'M', b'M'] => true,
            _ => return Err(malformed(0, "this is no TIFF")),
        };
        let (word, counter) = match numbers.number(2)? {
            42 => (4, 2),
            43 => {
                numbers.number(4)?;
                (8, 8)
            }
            version => return Err(malformed(2, format!("{version} is no version of TIFF"))),
        };
        let directory = numbers.number(word)?;
        numbers.seek(directory)?;
        let (mut width, mut tile_width) = (None, 0);
        for _ in 0..numbers.number(counter)? {
            let entry = numbers.entry(word)?;
            let Entry { tag, count, size, .. } = entry;
            if count.checked_mul(size).is_none_or(|bytes| bytes > length) {
                let problem =
                    format!("tag {tag} has {count} values of {size} bytes, more than the file can hold");
                return Err(malformed(entry.at, problem));
            }
            match tag {
                IMAGE_WIDTH if width.is_some() => return Err(malformed(entry.at, "a second width")),
                IMAGE_WIDTH => width = Some(entry),
                TILE_WIDTH => tile_width = entry.value,
                SAMPLES_PER_PIXEL if entry.value > 1 => {
                    return Err(ReadError::Unsupported(format!("a TIFF of {} bands, not one,", entry.value)));
                }
                _ => {}
            }
        }
        let width = width.ok_or_else(|| malformed(directory, "there is no width"))?;
        let shown = width.value.checked_next_multiple_of(tile_width).unwrap_or(width.value);
        let fits = width.size >= 8 || shown >> (8 * width.size) == 0;
        let shown = if fits { shown } else { width.value };
        let mut width_shown = shown.to_le_bytes()[..width.size as usize].to_vec();
        if numbers.big_endian {
            width_shown.reverse();
        }
        reader.seek(SeekFrom::Start(0))?;
        Ok(Self { reader, position: 0, width_at: width.value_at, width_shown, columns: width.value })
    }

    /// How many columns the image has, whatever the decoder sees.
    pub(super) fn columns(&self) -> u64 {
        self.columns
    }
}

impl<R: Read> Read for Checked<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(buffer)?;
        for (at, &byte) in (self.width_at..).zip(&self.width_shown) {
            let place = at.checked_sub(self.position).and_then(|place| usize::try_from(place).ok());
            if let Some(place) = place.filter(|&place| place < count) {
                buffer[place] = byte;
            }
        }
        self.position += count as u64;
        Ok(count)
    }
}

impl<R: Seek> Seek for Checked<'_, R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.reader.seek(to)?;
        Ok(self.position)
    }
}

struct Entry {
    /// Where in the file it stands, and its value.
    at: u64,
    value_at: u64,
    tag: u64,
    count: u64,
    /// Of a value, in bytes.
    size: u64,
    /// If there is one that fits in here; else 0.
    value: u64,
}

struct Numbers<'a, R> {
    reader: &'a mut R,
    big_endian: bool,
    position: u64,
}

impl<R: Read + Seek> Numbers<'_, R> {
    fn seek(&mut self, to: u64) -> Result<(), ReadError> {
        self.position = self.reader.seek(SeekFrom::Start(to))?;
        Ok(())
    }

    /// An entry of a directory whose fields are `word` bytes long.
    fn entry(&mut self, word: usize) -> Result<Entry, ReadError> {
        let at = self.position;
        let tag = self.number(2)?;
        let size = value_bytes(self.number(2)?);
        let count = self.number(word)?;
        let value_at = self.position;
        // A value that fits stands in the first bytes of the field.
        let inside = if count == 1 && size <= word as u64 { size as usize } else { 0 };
        let value = self.number(inside)?;
        self.number(word - inside)?;
        Ok(Entry { at, value_at, tag, count, size, value })
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let mut bytes = [0; N];
        self.fill(&mut bytes)?;
        Ok(bytes)
    }

    fn fill(&mut self, bytes: &mut [u8]) -> Result<(), ReadError> {
        self.reader.read_exact(bytes).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => malformed(self.position, "the file ends here"),
            _ => error.into(),
        })?;
        self.position += bytes.len() as u64;
        Ok(())
    }

    /// The next `size` bytes, at most 8, as a number.
    fn number(&mut self, size: usize) -> Result<u64, ReadError> {
        let mut bytes = [0; 8];
        self.fill(&mut bytes[..size])?;
        if self.big_endian {
            bytes[..size].reverse();
        }
        Ok(u64::from_le_bytes(bytes))
    }
}

/// How long a value of a type is. The decoder knows no others, and reads none of them.
fn value_bytes(kind: u64) -> u64 {
    match kind {
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16 | 17 | 18 => 8,
        _ => 1,
    }
}

fn malformed(byte: u64, problem: impl Into<String>) -> ReadError {
    ReadError::Malformed { place: Place::Byte(byte), problem: problem.into() }
}
