//! A file being read: buffered, and aware of where it is and of how much is left, so that every
//! error can say where and no header can ask for more memory than the file could fill.

use std::io::{ErrorKind, Read};

use super::{Place, ReadError};
use crate::mesh::MeshError;

const BUFFER: usize = 1 << 18;
/// No mesh has a longer line on purpose; a file without line ends shall not be read into memory.
const LONGEST_LINE: usize = 1 << 24;

pub(crate) struct Source<'a> {
    reader: &'a mut dyn Read,
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    offset: u64,
    length: Option<u64>,
    line: u64,
}

impl<'a> Source<'a> {
    /// `length` is that of the whole input where it is known; it is believed only as far as errors
    /// and reservations go.
    pub(crate) fn new(reader: &'a mut dyn Read, length: Option<u64>) -> Self {
        let size = length.and_then(|length| usize::try_from(length).ok()).unwrap_or(BUFFER).clamp(64, BUFFER);
        Self { reader, buffer: vec![0; size], start: 0, end: 0, offset: 0, length, line: 0 }
    }

    pub(crate) fn length(&self) -> Option<u64> {
        self.length
    }

    pub(crate) fn remaining(&self) -> Option<u64> {
        self.length.map(|length| length.saturating_sub(self.offset))
    }

    /// An error at the byte to be read next.
    pub(crate) fn error_here(&self, problem: impl Into<String>) -> ReadError {
        ReadError::Malformed { place: Place::Byte(self.offset), problem: problem.into() }
    }

    /// An error in the line read last.
    pub(crate) fn error_in_line(&self, problem: impl Into<String>) -> ReadError {
        ReadError::Malformed { place: Place::Line(self.line), problem: problem.into() }
    }

    /// Refuses a promise of `count` things of at least `bytes_each` bytes that the rest of the file
    /// is too short to keep.
    pub(crate) fn expect(&self, count: u64, bytes_each: u64, what: &str) -> Result<(), ReadError> {
        let needed = count.saturating_mul(bytes_each);
        match self.remaining() {
            Some(remaining) if remaining < needed => Err(self.error_here(format!(
                "{count} {what} are promised, which take at least {needed} bytes, but {remaining} are left"
            ))),
            _ => Ok(()),
        }
    }

    /// An empty list with room for `count` things of at least `bytes_each` bytes in the file, but
    /// for no more than the rest of the file can hold.
    pub(crate) fn list<T>(&self, count: u64, bytes_each: u64) -> Result<Vec<T>, ReadError> {
        let mut list = Vec::new();
        list.try_reserve_exact(self.room(count, bytes_each))
            .map_err(|_| ReadError::Io(ErrorKind::OutOfMemory.into()))?;
        Ok(list)
    }

    /// For how many of `count` things of at least `bytes_each` bytes it makes sense to make room.
    pub(crate) fn room(&self, count: u64, bytes_each: u64) -> usize {
        let most = self.remaining().unwrap_or(BUFFER as u64) / bytes_each.max(1) + 1;
        usize::try_from(count.min(most)).unwrap_or(usize::MAX)
    }

    /// The next bytes, up to `count` of them, without moving on.
    pub(crate) fn peek(&mut self, count: usize) -> Result<&[u8], ReadError> {
        self.fill(count)?;
        Ok(&self.buffer[self.start..self.end.min(self.start + count)])
    }

    /// The next `count` bytes. Meant for small counts: they are buffered whole.
    #[inline]
    pub(crate) fn take(&mut self, count: usize) -> Result<&[u8], ReadError> {
        if self.end - self.start < count {
            self.refill(count)?;
        }
        let start = self.start;
        self.start += count;
        self.offset += count as u64;
        Ok(&self.buffer[start..self.start])
    }

    /// Kept out of [`take`](Self::take), which is called for every number of a file.
    #[cold]
    #[inline(never)]
    fn refill(&mut self, count: usize) -> Result<(), ReadError> {
        if self.fill(count)? { Ok(()) } else { Err(self.error_here("the file ends here")) }
    }

    pub(crate) fn skip(&mut self, count: u64) -> Result<(), ReadError> {
        let mut left = count;
        while left > 0 {
            let step = left.min(BUFFER as u64) as usize;
            self.take(step)?;
            left -= step as u64;
        }
        Ok(())
    }

    /// The next `count` bytes, in memory of their own that grows only as they come.
    pub(crate) fn take_all(&mut self, count: u64) -> Result<Vec<u8>, ReadError> {
        let mut bytes = self.list(count, 1)?;
        let mut left = count;
        while left > 0 {
            let step = left.min(BUFFER as u64) as usize;
            bytes.extend_from_slice(self.take(step)?);
            left -= step as u64;
        }
        Ok(bytes)
    }

    /// All that is left.
    pub(crate) fn take_rest(&mut self) -> Result<Vec<u8>, ReadError> {
        let mut bytes = self.list(self.remaining().unwrap_or(0), 1)?;
        while self.fill(1)? {
            bytes.extend_from_slice(&self.buffer[self.start..self.end]);
            self.offset += (self.end - self.start) as u64;
            self.start = self.end;
        }
        Ok(bytes)
    }

    /// The next line, without its end; `None` at the end of the file.
    pub(crate) fn next_line(&mut self) -> Result<Option<&[u8]>, ReadError> {
        self.line += 1;
        let mut searched = 0;
        let length = loop {
            if let Some(found) = memchr::memchr(b'\n', &self.buffer[self.start + searched..self.end]) {
                break searched + found + 1;
            }
            searched = self.end - self.start;
            if searched > LONGEST_LINE {
                return Err(self.error_in_line(format!("the line is longer than {LONGEST_LINE} bytes")));
            }
            if !self.fill(searched + 1)? {
                break searched;
            }
        };
        if length == 0 {
            return Ok(None);
        }
        let line = &self.buffer[self.start..self.start + length];
        self.start += length;
        self.offset += length as u64;
        let line = line.strip_suffix(b"\n").unwrap_or(line);
        Ok(Some(line.strip_suffix(b"\r").unwrap_or(line)))
    }

    /// Whether `count` bytes could be buffered; `false` where the file ends before.
    fn fill(&mut self, count: usize) -> Result<bool, ReadError> {
        while self.end - self.start < count {
            if self.end == self.buffer.len() || self.start + count > self.buffer.len() {
                self.buffer.copy_within(self.start..self.end, 0);
                self.end -= self.start;
                self.start = 0;
                if count > self.buffer.len() {
                    self.buffer.resize(count.next_power_of_two(), 0);
                }
            }
            match self.reader.read(&mut self.buffer[self.end..]) {
                Ok(0) => return Ok(false),
                Ok(read) => self.end += read,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(true)
    }
}

/// Refuses more vertices than an index can name, before any is read.
pub(crate) fn check_vertex_count(count: u64) -> Result<(), ReadError> {
    let limit = u32::MAX as usize;
    match usize::try_from(count) {
        Ok(count) if count <= limit => Ok(()),
        _ => Err(MeshError::TooLarge { what: "vertices", count: count as usize, limit }.into()),
    }
}
