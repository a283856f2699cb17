//! PLY, in its three encodings.
//!
//! A scan is a PLY file of up to some hundred million triangles, so nothing is allocated per
//! vertex or per face and the file is never in memory as a whole.

use std::io::{self, Write};
use std::ops::Range;

use super::source::{Source, check_vertex_count};
use super::text::{number, quoted, words, write_elements};
use super::{Encoding, Fan, ReadError, Strip, WriteError, finish};
use crate::mesh::{Attributes, Mesh};

#[derive(Clone, Copy)]
enum Scalar {
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
    fn named(name: &[u8]) -> Option<Self> {
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

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Scalar(Scalar),
    List { length: Scalar, item: Scalar },
}

struct Property {
    name: Vec<u8>,
    kind: Kind,
}

struct Element {
    name: Vec<u8>,
    count: u64,
    properties: Vec<Property>,
}

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

pub(super) fn read(source: &mut Source) -> Result<Mesh, ReadError> {
    let (encoding, elements) = read_header(source)?;
    match encoding {
        Encoding::Ascii => read_elements(&mut Ascii { source, line: Vec::new(), at: 0 }, &elements),
        Encoding::Binary => read_elements(&mut Binary::<false> { source }, &elements),
        Encoding::BinaryBigEndian => read_elements(&mut Binary::<true> { source }, &elements),
    }
}

fn read_header(source: &mut Source) -> Result<(Encoding, Vec<Element>), ReadError> {
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

fn read_elements<'a, V: Values<'a>>(values: &mut V, elements: &[Element]) -> Result<Mesh, ReadError> {
    let vertices = elements.iter().find(|element| element.name == b"vertex");
    let vertices = vertices.map_or(0, |element| element.count);
    check_vertex_count(vertices)?;
    let mut positions = Vec::new();
    let mut attributes = Attributes::default();
    let mut triangles = Vec::new();
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
            b"vertex" => (positions, attributes) = read_vertices(values, element, least_bytes)?,
            b"face" => {
                // A file may hold more than one list of triangles: faces, strips.
                let mut faces = values.source().list(element.count, least_bytes)?;
                read_lists(values, element, |rows, length, item| {
                    let mut fan = Fan::default();
                    for _ in 0..length {
                        if let Some(triangle) = fan.push(index(rows.next(item)?, vertices, rows)?) {
                            faces.push(triangle);
                        }
                    }
                    Ok(())
                })?;
                if triangles.is_empty() { triangles = faces } else { triangles.append(&mut faces) }
            }
            b"tristrips" => read_lists(values, element, |rows, length, item| {
                let mut strip = Strip::default();
                for _ in 0..length {
                    match rows.next(item)? {
                        -1.0 => strip = Strip::default(),
                        corner => triangles.extend(strip.push(index(corner, vertices, rows)?)),
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
    finish(positions, triangles, attributes)
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
) -> Result<(Vec<[f32; 3]>, Attributes), ReadError> {
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
    let source = values.source();
    let has = |slots: Range<usize>| present[slots].iter().all(|&present| present);
    let mut positions = source.list(element.count, least_bytes)?;
    let mut normals = has(NORMAL..COLOR).then(|| source.list(element.count, least_bytes)).transpose()?;
    let mut colors = has(COLOR..ALPHA).then(|| source.list(element.count, least_bytes)).transpose()?;
    let mut uvs = has(UV..SLOTS).then(|| source.list(element.count, least_bytes)).transpose()?;
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
        positions.push([x as f32, y as f32, z as f32]);
        if let Some(normals) = &mut normals {
            normals.push([nx as f32, ny as f32, nz as f32]);
        }
        if let Some(colors) = &mut colors {
            colors.push([red, green, blue, alpha].map(|value| value.round() as u8));
        }
        if let Some(uvs) = &mut uvs {
            uvs.push([u as f32, v as f32]);
        }
        Ok(())
    })?;
    Ok((positions, Attributes { normals, colors, uvs }))
}

pub(super) fn write(mesh: &Mesh, encoding: Encoding, writer: &mut impl Write) -> Result<(), WriteError> {
    let Attributes { normals, colors, uvs } = mesh.attributes();
    let name = match encoding {
        Encoding::Ascii => "ascii",
        Encoding::Binary => "binary_little_endian",
        Encoding::BinaryBigEndian => "binary_big_endian",
    };
    write!(writer, "ply\nformat {name} 1.0\nelement vertex {}\n", mesh.positions().len())?;
    writer.write_all(b"property float x\nproperty float y\nproperty float z\n")?;
    if normals.is_some() {
        writer.write_all(b"property float nx\nproperty float ny\nproperty float nz\n")?;
    }
    if colors.is_some() {
        for channel in ["red", "green", "blue", "alpha"] {
            writeln!(writer, "property uchar {channel}")?;
        }
    }
    if uvs.is_some() {
        writer.write_all(b"property float s\nproperty float t\n")?;
    }
    // Most readers expect `int`, which ends at half of what an index can be.
    let index = if mesh.positions().len() > i32::MAX as usize { "uint" } else { "int" };
    let faces = mesh.triangles().len();
    write!(writer, "element face {faces}\nproperty list uchar {index} vertex_indices\nend_header\n")?;
    match encoding {
        Encoding::Ascii => write_ascii(mesh, writer)?,
        Encoding::Binary => write_binary(mesh, writer, f32::to_le_bytes, u32::to_le_bytes)?,
        Encoding::BinaryBigEndian => write_binary(mesh, writer, f32::to_be_bytes, u32::to_be_bytes)?,
    }
    Ok(())
}

fn write_ascii(mesh: &Mesh, writer: &mut impl Write) -> io::Result<()> {
    write_elements(mesh, writer, |writer, [red, green, blue, alpha]| {
        write!(writer, " {red} {green} {blue} {alpha}")
    })
}

fn write_binary(
    mesh: &Mesh,
    writer: &mut impl Write,
    float: fn(f32) -> [u8; 4],
    index: fn(u32) -> [u8; 4],
) -> io::Result<()> {
    let Attributes { normals, colors, uvs } = mesh.attributes();
    for (vertex, position) in mesh.positions().iter().enumerate() {
        writer.write_all(position.map(float).as_flattened())?;
        if let Some(normals) = normals {
            writer.write_all(normals[vertex].map(float).as_flattened())?;
        }
        if let Some(colors) = colors {
            writer.write_all(&colors[vertex])?;
        }
        if let Some(uvs) = uvs {
            writer.write_all(uvs[vertex].map(float).as_flattened())?;
        }
    }
    for triangle in mesh.triangles() {
        let mut face = [3; 13];
        face[1..].copy_from_slice(triangle.map(index).as_flattened());
        writer.write_all(&face)?;
    }
    Ok(())
}
