//! PLY, in its three encodings.
//!
//! A scan is a PLY file of up to some hundred million triangles, so nothing is allocated per
//! vertex or per face and the file is never in memory as a whole.

mod header;
mod write;

use std::io;
use std::ops::Range;

use super::source::{Source, check_vertex_count};
use super::text::{number, quoted};
use super::{Encoding, Fan, ReadError, Strip, finish};
use crate::mesh::{Attributes, Mesh};
use header::{Element, Kind, Property, Scalar, read_header};
pub(super) use write::write;
pub(crate) use write::write_header;

/// One row after the other, value by value. Every value of every PLY type fits an `f64`.
trait Values<'a> {
    fn source(&mut self) -> &mut Source<'a>;
    /// An error about what was read last.
    fn error(&self, problem: String) -> ReadError;
    fn begin_row(&mut self) -> Result<(), ReadError>;
    fn end_row(&mut self) -> Result<(), ReadError>;
    fn next(&mut self, scalar: Scalar) -> Result<f64, ReadError>;
    /// Refuses a list longer than what is left, where its values are yet to be read from the file.
    fn expect_items(&mut self, length: u64, item: Scalar) -> Result<(), ReadError>;
    /// The fewest bytes of one value.
    fn least_bytes(scalar: Scalar) -> u64;
}

struct Binary<'s, 'a, const BIG_ENDIAN: bool> {
    source: &'s mut Source<'a>,
}

impl<const BIG_ENDIAN: bool> Binary<'_, '_, BIG_ENDIAN> {
    #[inline]
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.source.take(N)?);
        if BIG_ENDIAN {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl<'a, const BIG_ENDIAN: bool> Values<'a> for Binary<'_, 'a, BIG_ENDIAN> {
    fn source(&mut self) -> &mut Source<'a> {
        self.source
    }

    fn error(&self, problem: String) -> ReadError {
        self.source.error_here(problem)
    }

    fn begin_row(&mut self) -> Result<(), ReadError> {
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), ReadError> {
        Ok(())
    }

    #[inline]
    fn next(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.bytes()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.bytes()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.bytes()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.bytes()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.bytes()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.bytes()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.bytes()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    fn expect_items(&mut self, length: u64, item: Scalar) -> Result<(), ReadError> {
        self.source.expect(length, Self::least_bytes(item), "values of a list")
    }

    fn least_bytes(scalar: Scalar) -> u64 {
        scalar.size() as u64
    }
}

struct Ascii<'s, 'a> {
    source: &'s mut Source<'a>,
    line: Vec<u8>,
    at: usize,
}

impl Ascii<'_, '_> {
    fn next_word(&mut self) -> Option<&[u8]> {
        let rest = &self.line[self.at..];
        let start = self.at + rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = &self.line[start..];
        let end = start + rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at = end;
        Some(&self.line[start..end])
    }
}

impl<'a> Values<'a> for Ascii<'_, 'a> {
    fn source(&mut self) -> &mut Source<'a> {
        self.source
    }

    fn error(&self, problem: String) -> ReadError {
        self.source.error_in_line(problem)
    }

    fn begin_row(&mut self) -> Result<(), ReadError> {
        self.line.clear();
        self.at = 0;
        while self.line.trim_ascii_start().is_empty() {
            self.line.clear();
            match self.source.next_line()? {
                Some(line) => self.line.extend_from_slice(line),
                None => return Err(self.source.error_in_line("the file ends here")),
            }
        }
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), ReadError> {
        match self.next_word().map(quoted) {
            Some(word) => Err(self.source.error_in_line(format!("{word} is more than the header declares"))),
            None => Ok(()),
        }
    }

    fn next(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        let value = match self.next_word() {
            None => Err("the line has fewer values than the header declares".to_owned()),
            Some(word) => match scalar {
                // Read as what it is: by way of `f64` it would be rounded twice.
                Scalar::F32 => number::<f32>(word).map(f64::from),
                Scalar::F64 => number::<f64>(word),
                _ => number::<i64>(word).map(|value| value as f64),
            },
        };
        value.map_err(|problem| self.source.error_in_line(problem))
    }

    fn expect_items(&mut self, _: u64, _: Scalar) -> Result<(), ReadError> {
        // The line is there already, and tells soon enough.
        Ok(())
    }

    fn least_bytes(_: Scalar) -> u64 {
        // A digit; what parts it from the next may be missing at the end of the file.
        1
    }
}

/// Which attributes the vertices of a file carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Carried {
    pub(crate) normals: bool,
    pub(crate) colors: bool,
    pub(crate) uvs: bool,
}

impl Carried {
    /// Those of `attributes`.
    pub(crate) fn of(attributes: &Attributes) -> Self {
        let Attributes { normals, colors, uvs } = attributes;
        Self { normals: normals.is_some(), colors: colors.is_some(), uvs: uvs.is_some() }
    }
}

/// A vertex as a file has it; what the file does not carry says nothing.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Vertex {
    pub(crate) position: [f32; 3],
    /// Of any length.
    pub(crate) normal: [f32; 3],
    pub(crate) color: [u8; 4],
    pub(crate) uv: [f32; 2],
}

/// Takes in what a file holds, row by row: all vertices in one go, before, between or after triangles.
pub(crate) trait Sink {
    /// Vertices follow, which carry these; `room` is how many, or at least for how many it makes sense to
    /// make room.
    fn begin_vertices(&mut self, carried: Carried, room: usize) -> Result<(), ReadError>;
    fn vertex(&mut self, vertex: &Vertex) -> Result<(), ReadError>;
    /// Triangles follow, `room` of them or more: polygons have several.
    fn begin_triangles(&mut self, room: usize) -> Result<(), ReadError>;
    /// Three vertices that the file has.
    fn triangle(&mut self, corners: [u32; 3]) -> Result<(), ReadError>;
}

/// A mesh in memory.
#[derive(Default)]
struct Whole {
    positions: Vec<[f32; 3]>,
    attributes: Attributes,
    triangles: Vec<[u32; 3]>,
}

/// Makes room for so many more.
fn reserve<T>(list: &mut Vec<T>, room: usize) -> Result<(), ReadError> {
    list.try_reserve_exact(room).map_err(|_| ReadError::Io(io::ErrorKind::OutOfMemory.into()))
}

/// An empty list with room for so many, if they are `carried`.
fn list<T>(carried: bool, room: usize) -> Result<Option<Vec<T>>, ReadError> {
    let mut list = carried.then(Vec::new);
    list.iter_mut().try_for_each(|list| reserve(list, room))?;
    Ok(list)
}

impl Sink for Whole {
    fn begin_vertices(&mut self, carried: Carried, room: usize) -> Result<(), ReadError> {
        reserve(&mut self.positions, room)?;
        self.attributes = Attributes {
            normals: list(carried.normals, room)?,
            colors: list(carried.colors, room)?,
            uvs: list(carried.uvs, room)?,
        };
        Ok(())
    }

    #[inline]
    fn vertex(&mut self, vertex: &Vertex) -> Result<(), ReadError> {
        self.positions.push(vertex.position);
        if let Some(normals) = &mut self.attributes.normals {
            normals.push(vertex.normal);
        }
        if let Some(colors) = &mut self.attributes.colors {
            colors.push(vertex.color);
        }
        if let Some(uvs) = &mut self.attributes.uvs {
            uvs.push(vertex.uv);
        }
        Ok(())
    }

    fn begin_triangles(&mut self, room: usize) -> Result<(), ReadError> {
        reserve(&mut self.triangles, room)
    }

    #[inline]
    fn triangle(&mut self, corners: [u32; 3]) -> Result<(), ReadError> {
        self.triangles.push(corners);
        Ok(())
    }
}

pub(super) fn read(source: &mut Source) -> Result<Mesh, ReadError> {
    let mut whole = Whole::default();
    stream(source, &mut whole)?;
    let Whole { positions, attributes, triangles } = whole;
    finish(positions, triangles, attributes)
}

/// Reads all of a file into `sink`, in little memory.
pub(crate) fn stream(source: &mut Source, sink: &mut impl Sink) -> Result<(), ReadError> {
    let (encoding, elements) = read_header(source)?;
    match encoding {
        Encoding::Ascii => read_elements(&mut Ascii { source, line: Vec::new(), at: 0 }, &elements, sink),
        Encoding::Binary => read_elements(&mut Binary::<false> { source }, &elements, sink),
        Encoding::BinaryBigEndian => read_elements(&mut Binary::<true> { source }, &elements, sink),
    }
}

fn read_elements<'a, V: Values<'a>>(
    values: &mut V,
    elements: &[Element],
    sink: &mut impl Sink,
) -> Result<(), ReadError> {
    let vertices = elements.iter().find(|element| element.name == b"vertex");
    let vertices = vertices.map_or(0, |element| element.count);
    check_vertex_count(vertices)?;
    for element in elements.iter().filter(|element| element.count > 0) {
        let least_bytes = element.properties.iter().map(|property| match property.kind {
            Kind::Scalar(scalar) => V::least_bytes(scalar),
            Kind::List { length, .. } => V::least_bytes(length),
        });
        let least_bytes = least_bytes.sum();
        values.source().expect(
            element.count,
            least_bytes,
            &format!("rows of element '{}'", shown(element)),
        )?;
        match element.name.as_slice() {
            b"vertex" => read_vertices(values, element, least_bytes, sink)?,
            b"face" => {
                sink.begin_triangles(values.source().room(element.count, least_bytes))?;
                read_lists(values, element, |rows, length, item| {
                    let mut fan = Fan::default();
                    for _ in 0..length {
                        if let Some(triangle) = fan.push(index(rows.next(item)?, vertices, rows)?) {
                            sink.triangle(triangle)?;
                        }
                    }
                    Ok(())
                })?;
            }
            b"tristrips" => read_lists(values, element, |rows, length, item| {
                let mut strip = Strip::default();
                for _ in 0..length {
                    match rows.next(item)? {
                        -1.0 => strip = Strip::default(),
                        corner => {
                            if let Some(triangle) = strip.push(index(corner, vertices, rows)?) {
                                sink.triangle(triangle)?;
                            }
                        }
                    }
                }
                Ok(())
            })?,
            // Rows without properties take no room in the file, however many there are.
            _ if element.properties.is_empty() => {}
            _ => read_rows(values, element, |rows| {
                element.properties.iter().try_for_each(|property| skip(rows, property.kind))
            })?,
        }
    }
    Ok(())
}

/// Calls `read_row` for every row of `element`, and says of an error which row it is in.
fn read_rows<'a, V: Values<'a>>(
    values: &mut V,
    element: &Element,
    mut read_row: impl FnMut(&mut V) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    for row in 0..element.count {
        values
            .begin_row()
            .and_then(|()| read_row(values))
            .and_then(|()| values.end_row())
            .map_err(|error| error.within(format_args!("{} {row} of {}", shown(element), element.count)))?;
    }
    Ok(())
}

/// Reads rows whose list of vertex indices goes to `polygon`; all else is skipped.
fn read_lists<'a, V: Values<'a>>(
    values: &mut V,
    element: &Element,
    mut polygon: impl FnMut(&mut V, u64, Scalar) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let is_indices = |property: &Property| {
        matches!(property.name.as_slice(), b"vertex_indices" | b"vertex_index")
            && matches!(property.kind, Kind::List { item, .. } if item.is_integer())
    };
    let Some(indices) = element.properties.iter().position(is_indices) else {
        return Err(values.error(format!(
            "element '{}' has no list of integers named 'vertex_indices' or 'vertex_index'",
            shown(element)
        )));
    };
    read_rows(values, element, |rows| {
        for (place, property) in element.properties.iter().enumerate() {
            match property.kind {
                Kind::List { length, item } if place == indices => {
                    let length = list_length(rows, length, item)?;
                    polygon(rows, length, item)?;
                }
                kind => skip(rows, kind)?,
            }
        }
        Ok(())
    })
}

fn list_length<'a, V: Values<'a>>(values: &mut V, length: Scalar, item: Scalar) -> Result<u64, ReadError> {
    let length = values.next(length)?;
    if length < 0.0 {
        return Err(values.error(format!("a list of {length} values")));
    }
    values.expect_items(length as u64, item)?;
    Ok(length as u64)
}

fn skip<'a, V: Values<'a>>(values: &mut V, kind: Kind) -> Result<(), ReadError> {
    match kind {
        Kind::Scalar(scalar) => values.next(scalar).map(|_| ()),
        Kind::List { length, item } => {
            let length = list_length(values, length, item)?;
            (0..length).try_for_each(|_| values.next(item).map(|_| ()))
        }
    }
}

fn shown(element: &Element) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(&element.name)
}

#[inline]
fn index<'a, V: Values<'a>>(value: f64, vertices: u64, values: &mut V) -> Result<u32, ReadError> {
    if value >= 0.0 && value < vertices as f64 {
        Ok(value as u32)
    } else {
        Err(values.error(format!("index {value}, but there are {vertices} vertices")))
    }
}

const NORMAL: usize = 3;
const COLOR: usize = 6;
const ALPHA: usize = 9;
const UV: usize = 10;
const SLOTS: usize = 12;

/// Where a property goes in a vertex.
fn slot(name: &[u8]) -> Option<usize> {
    Some(match name {
        b"x" => 0,
        b"y" => 1,
        b"z" => 2,
        b"nx" => NORMAL,
        b"ny" => NORMAL + 1,
        b"nz" => NORMAL + 2,
        b"red" => COLOR,
        b"green" => COLOR + 1,
        b"blue" => COLOR + 2,
        b"alpha" => ALPHA,
        b"s" | b"u" | b"texture_u" => UV,
        b"t" | b"v" | b"texture_v" => UV + 1,
        _ => return None,
    })
}

fn read_vertices<'a, V: Values<'a>>(
    values: &mut V,
    element: &Element,
    least_bytes: u64,
    sink: &mut impl Sink,
) -> Result<(), ReadError> {
    let mut present = [false; SLOTS];
    // For each property where it goes, and the factor: integer colours count to 255, others to 1.
    let targets: Vec<Option<(usize, f64)>> = element
        .properties
        .iter()
        .map(|property| {
            let (Some(slot), Kind::Scalar(scalar)) = (slot(&property.name), property.kind) else {
                return None;
            };
            present[slot] = true;
            let is_fraction = (COLOR..UV).contains(&slot) && !scalar.is_integer();
            Some((slot, if is_fraction { 255.0 } else { 1.0 }))
        })
        .collect();
    if let Some(missing) = (0..NORMAL).find(|&slot| !present[slot]) {
        let name = ["x", "y", "z"][missing];
        return Err(values.error(format!("the vertices have no property '{name}'")));
    }
    let has = |slots: Range<usize>| present[slots].iter().all(|&present| present);
    let carried = Carried { normals: has(NORMAL..COLOR), colors: has(COLOR..ALPHA), uvs: has(UV..SLOTS) };
    sink.begin_vertices(carried, values.source().room(element.count, least_bytes))?;
    let mut vertex = [0.0; SLOTS];
    vertex[ALPHA] = 255.0;
    read_rows(values, element, |rows| {
        for (property, target) in element.properties.iter().zip(&targets) {
            match (property.kind, *target) {
                (Kind::Scalar(scalar), Some((slot, factor))) => vertex[slot] = rows.next(scalar)? * factor,
                (kind, _) => skip(rows, kind)?,
            }
        }
        let [x, y, z, nx, ny, nz, red, green, blue, alpha, u, v] = vertex;
        sink.vertex(&Vertex {
            position: [x as f32, y as f32, z as f32],
            normal: [nx as f32, ny as f32, nz as f32],
            color: [red, green, blue, alpha].map(|value| value.round() as u8),
            uv: [u as f32, v as f32],
        })
    })
}
