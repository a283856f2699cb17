//! NumPy's array files: "NEP 1, A Simple File Format for NumPy Arrays", versions 1 to 3.
//!
//! Their header is a dictionary in Python's notation. What NumPy itself writes has three entries of one shape
//! each, so that no parser of Python is needed.

use super::super::ReadError;
use super::super::source::Source;
use super::samples::{ByteOrder, SampleType, read_rest};
use super::{Grid, RawLayout};

const MAGIC: &[u8] = b"\x93NUMPY";
/// NumPy itself refuses longer ones.
const LONGEST_HEADER: usize = 10_000;

pub(super) fn read(source: &mut Source) -> Result<Grid, ReadError> {
    let (layout, sample) = header(source)?;
    read_rest(source, [layout.columns, layout.rows], sample, layout.byte_order)
}

/// How the samples lie that follow, and their type.
pub(super) fn header(source: &mut Source) -> Result<(RawLayout, SampleType), ReadError> {
    if source.peek(MAGIC.len())? != MAGIC {
        return Err(source.error_here("this is no NumPy file"));
    }
    source.take(MAGIC.len())?;
    let version = source.take(2)?[0];
    let length = match version {
        1 => source.take(2)?.iter().rev().fold(0, |length, &byte| length << 8 | usize::from(byte)),
        2 | 3 => source.take(4)?.iter().rev().fold(0, |length, &byte| length << 8 | usize::from(byte)),
        _ => return Err(ReadError::Unsupported(format!("version {version} of NumPy's format"))),
    };
    if length > LONGEST_HEADER {
        return Err(source.error_here(format!("a header of {length} bytes is longer than NumPy makes any")));
    }
    let header = String::from_utf8_lossy(source.take(length)?).into_owned();
    let header = Header::parse(&header).map_err(|problem| match problem {
        Problem::Malformed(problem) => source.error_here(problem),
        Problem::Unsupported(what) => ReadError::Unsupported(what),
    })?;
    let Header { columns, rows, sample, order } = header;
    Ok((RawLayout { columns, rows, sample: Some(sample), byte_order: order }, sample))
}

struct Header {
    columns: usize,
    rows: usize,
    sample: SampleType,
    order: ByteOrder,
}

enum Problem {
    Malformed(String),
    Unsupported(String),
}

impl Header {
    fn parse(text: &str) -> Result<Self, Problem> {
        let mut tokens = Tokens(text);
        let (mut kind, mut fortran, mut shape) = (None, None, None);
        tokens.expect('{')?;
        while !tokens.skip('}') {
            let key = tokens.string()?;
            tokens.expect(':')?;
            match key {
                "descr" if tokens.next_is('[') => {
                    return Err(Problem::Unsupported("an array of records".into()));
                }
                "descr" => kind = Some(tokens.string()?),
                "fortran_order" => fortran = Some(tokens.boolean()?),
                "shape" => shape = Some(tokens.tuple()?),
                _ => return Err(Problem::Malformed(format!("the header has an unknown entry '{key}'"))),
            }
            if !tokens.skip(',') && !tokens.next_is('}') {
                return Err(tokens.unexpected("a comma"));
            }
        }
        let missing = |key: &str| Problem::Malformed(format!("the header has no entry '{key}'"));
        let shape: Vec<usize> = shape.ok_or_else(|| missing("shape"))?;
        let &[rows, columns] = shape.as_slice() else {
            return Err(Problem::Unsupported(format!("an array of {} dimensions, not two,", shape.len())));
        };
        if fortran.ok_or_else(|| missing("fortran_order"))? {
            return Err(Problem::Unsupported("an array stored column by column".into()));
        }
        let (sample, order) = sample_type(kind.ok_or_else(|| missing("descr"))?)?;
        Ok(Self { columns, rows, sample, order })
    }
}

fn sample_type(kind: &str) -> Result<(SampleType, ByteOrder), Problem> {
    let order = match kind.as_bytes().first() {
        Some(b'<' | b'|') => ByteOrder::Little,
        Some(b'>') => ByteOrder::Big,
        Some(b'=') => ByteOrder::NATIVE,
        _ => return Err(Problem::Malformed(format!("'{kind}' is no type of NumPy's"))),
    };
    let sample = match &kind[1..] {
        "u1" => SampleType::U8,
        "i1" => SampleType::I8,
        "u2" => SampleType::U16,
        "i2" => SampleType::I16,
        "u4" => SampleType::U32,
        "i4" => SampleType::I32,
        "f4" => SampleType::F32,
        "f8" => SampleType::F64,
        _ => return Err(Problem::Unsupported(format!("an array of the type '{kind}'"))),
    };
    Ok((sample, order))
}

/// What is left of a header.
struct Tokens<'a>(&'a str);

impl<'a> Tokens<'a> {
    fn next_is(&mut self, token: char) -> bool {
        self.0 = self.0.trim_start();
        self.0.starts_with(token)
    }

    /// Whether the next character is this one, which is then gone.
    fn skip(&mut self, token: char) -> bool {
        let there = self.next_is(token);
        if there {
            self.0 = &self.0[token.len_utf8()..];
        }
        there
    }

    fn expect(&mut self, token: char) -> Result<(), Problem> {
        if self.skip(token) { Ok(()) } else { Err(self.unexpected(&format!("'{token}'"))) }
    }

    fn unexpected(&self, expected: &str) -> Problem {
        let found: String = self.0.chars().take(20).collect();
        Problem::Malformed(format!("the header has '{found}' where {expected} should be"))
    }

    fn string(&mut self) -> Result<&'a str, Problem> {
        let quote = if self.next_is('"') { '"' } else { '\'' };
        self.expect(quote)?;
        let (string, rest) = self.0.split_once(quote).ok_or_else(|| self.unexpected("a string"))?;
        self.0 = rest;
        Ok(string)
    }

    fn boolean(&mut self) -> Result<bool, Problem> {
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = self.0.trim_start().strip_prefix(word) {
                self.0 = rest;
                return Ok(value);
            }
        }
        Err(self.unexpected("True or False"))
    }

    fn tuple(&mut self) -> Result<Vec<usize>, Problem> {
        let mut values = Vec::new();
        self.expect('(')?;
        while !self.skip(')') {
            let rest = self.0.trim_start_matches(|c: char| c.is_ascii_digit());
            let digits = &self.0[..self.0.len() - rest.len()];
            values.push(digits.parse().map_err(|_| self.unexpected("a whole number"))?);
            self.0 = rest;
            if !self.skip(',') && !self.next_is(')') {
                return Err(self.unexpected("a comma"));
            }
        }
        Ok(values)
    }
}
