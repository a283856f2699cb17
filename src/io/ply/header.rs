//! What a PLY file says of itself: its elements, and how their properties are stored.

use crate::io::source::Source;
use crate::io::text::{number, quoted, words};
use crate::io::{Encoding, ReadError};

#[derive(Clone, Copy)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    pub(super) fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

#[derive(Clone, Copy)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { length: Scalar, item: Scalar },
}

pub(super) struct Property {
    pub(super) name: Vec<u8>,
    pub(super) kind: Kind,
}

pub(super) struct Element {
    pub(super) name: Vec<u8>,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

pub(super) fn read_header(source: &mut Source) -> Result<(Encoding, Vec<Element>), ReadError> {
    if source.peek(3)? != b"ply" || source.next_line()?.is_none_or(|line| line.trim_ascii() != b"ply") {
        return Err(source.error_here("a PLY file starts with a line 'ply', and this one does not"));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let Some(line) = source.next_line()? else {
            return Err(source.error_in_line("the file ends within the header, before 'end_header'"));
        };
        match header_line(line, &mut encoding, &mut elements) {
            Ok(true) => break,
            Ok(false) => {}
            Err(problem) => return Err(source.error_in_line(problem)),
        }
    }
    match encoding {
        Some(encoding) => Ok((encoding, elements)),
        None => Err(source.error_in_line("the header ends without a 'format' line")),
    }
}

/// Takes in one line; `true` if it is the last.
fn header_line(
    line: &[u8],
    encoding: &mut Option<Encoding>,
    elements: &mut Vec<Element>,
) -> Result<bool, String> {
    let mut words = words(line);
    match words.next().unwrap_or_default() {
        b"" | b"comment" | b"obj_info" => {}
        b"end_header" => return Ok(true),
        b"format" => {
            *encoding = Some(match words.next().unwrap_or_default() {
                b"ascii" => Encoding::Ascii,
                b"binary_little_endian" => Encoding::Binary,
                b"binary_big_endian" => Encoding::BinaryBigEndian,
                other => return Err(format!("{} is no PLY format", quoted(other))),
            });
        }
        b"element" => {
            let name = words.next().unwrap_or_default().to_vec();
            let count = number(words.next().unwrap_or_default())?;
            if elements.iter().any(|element| element.name == name) {
                return Err(format!("there is a second element {}", quoted(&name)));
            }
            elements.push(Element { name, count, properties: Vec::new() });
        }
        b"property" => {
            let element = elements.last_mut().ok_or("a property stands before any element")?;
            let scalar = |word: Option<&[u8]>| {
                let word = word.unwrap_or_default();
                Scalar::named(word).ok_or_else(|| format!("{} is no PLY type", quoted(word)))
            };
            let kind = match words.next() {
                Some(b"list") => {
                    let (length, item) = (scalar(words.next())?, scalar(words.next())?);
                    if !length.is_integer() {
                        return Err("the length of a list is no integer type".to_owned());
                    }
                    Kind::List { length, item }
                }
                word => Kind::Scalar(scalar(word)?),
            };
            let name = words.next().ok_or("a property has no name")?.to_vec();
            element.properties.push(Property { name, kind });
        }
        other => return Err(format!("{} does not belong into a PLY header", quoted(other))),
    }
    Ok(false)
}
