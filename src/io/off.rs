//! OFF and its variants with normals, colours and texture coordinates (`NOFF`, `COFF`, `STOFF`).

use std::io::{self, Write};

use super::source::{Source, check_vertex_count};
use super::text::{TextColors, floats, number, quoted, words, write_elements};
use super::{Fan, ReadError, finish};
use crate::mesh::{Attributes, Mesh};

/// What a vertex has besides its position, in the order of its line.
#[derive(Default)]
struct Variant {
    normals: bool,
    colors: bool,
    uvs: bool,
}

pub(super) fn read(source: &mut Source) -> Result<Mesh, ReadError> {
    let mut line = Vec::new();
    let (variant, [vertices, faces]) = read_header(source, &mut line)?;
    check_vertex_count(vertices)?;
    // "0 0 0" and "0", each with the end of its line, which the last may lack.
    source.expect(vertices, 5, "vertices")?;
    source.expect(faces, 1, "faces")?;

    let mut positions: Vec<[f32; 3]> = source.list(vertices, 6)?;
    let mut normals = if variant.normals { Some(source.list(vertices, 12)?) } else { None };
    let mut uvs = if variant.uvs { Some(source.list(vertices, 10)?) } else { None };
    let mut colors = TextColors::default();
    for vertex in 0..vertices {
        next_line(source, &mut line).map_err(|error| within(error, "vertex", vertex, vertices))?;
        let mut words = words(&line);
        let mut read_vertex = || -> Result<(), String> {
            positions.push(floats(&mut words, "position")?);
            if let Some(normals) = &mut normals {
                normals.push(floats(&mut words, "normal")?);
            }
            let rest: Vec<&[u8]> = words.by_ref().collect();
            let (color, uv) = rest.split_at(rest.len().saturating_sub(if variant.uvs { 2 } else { 0 }));
            if let Some(uvs) = &mut uvs {
                uvs.push(floats(&mut uv.iter().copied(), "pair of texture coordinates")?);
            }
            match color.len() {
                3 | 4 if variant.colors => colors.set(vertex as usize, color),
                count if variant.colors => Err(format!("a colour needs 3 or 4 numbers, but has {count}")),
                _ => Ok(()),
            }
        };
        read_vertex().map_err(|problem| within(source.error_in_line(problem), "vertex", vertex, vertices))?;
    }

    let mut triangles = source.list(faces, 8)?;
    for face in 0..faces {
        next_line(source, &mut line).map_err(|error| within(error, "face", face, faces))?;
        let mut words = words(&line);
        let mut read_face = || -> Result<(), String> {
            let corners: u64 = number(words.next().unwrap_or_default())?;
            let mut fan = Fan::default();
            for corner in 0..corners {
                let word =
                    words.next().ok_or_else(|| format!("{corners} corners, but only {corner} indices"))?;
                let index: i64 = number(word)?;
                match u32::try_from(index) {
                    Ok(index) if u64::from(index) < vertices => triangles.extend(fan.push(index)),
                    _ => return Err(format!("index {index}, but there are {vertices} vertices")),
                }
            }
            Ok(())
        };
        read_face().map_err(|problem| within(source.error_in_line(problem), "face", face, faces))?;
    }
    let colors = colors.finish(positions.len());
    finish(positions, triangles, Attributes { normals, colors, uvs })
}

fn within(error: ReadError, what: &str, row: u64, count: u64) -> ReadError {
    error.within(format_args!("{what} {row} of {count}"))
}

/// The keyword, which may be missing, and the counts, which may stand behind it on its line.
fn read_header(source: &mut Source, line: &mut Vec<u8>) -> Result<(Variant, [u64; 2]), ReadError> {
    next_line(source, line)?;
    let keyword = words(line).next().unwrap_or_default();
    let mut variant = Variant::default();
    let mut skipped = 0;
    if let Some(mut prefix) = keyword.strip_suffix(b"OFF") {
        let mut strip = |flag: &[u8]| {
            let rest = prefix.strip_prefix(flag);
            prefix = rest.unwrap_or(prefix);
            rest.is_some()
        };
        // Geomview's order is ST, C, N; others exchange C and N.
        variant.uvs = strip(b"ST");
        variant.normals = strip(b"N");
        variant.colors = strip(b"C");
        variant.normals |= strip(b"N");
        if !prefix.is_empty() {
            return Err(ReadError::Unsupported(format!("the OFF variant {}", quoted(keyword))));
        }
        skipped = 1;
        if words(line).nth(1) == Some(b"BINARY") {
            return Err(ReadError::Unsupported("binary OFF".to_owned()));
        }
        if words(line).nth(1).is_none() {
            next_line(source, line)?;
            skipped = 0;
        }
    } else if number::<u64>(keyword).is_err() {
        let problem = format!("an OFF file starts with 'OFF', not with {}", quoted(keyword));
        return Err(source.error_in_line(problem));
    }
    let mut words = words(line).skip(skipped);
    let mut count = || number(words.next().unwrap_or_default());
    let counts = count().and_then(|vertices| Ok([vertices, count()?]));
    let counts = counts
        .map_err(|problem: String| source.error_in_line(format!("the counts of the header: {problem}")));
    Ok((variant, counts?))
}

/// Copies the next line that holds anything to `line`, without its comment.
fn next_line(source: &mut Source, line: &mut Vec<u8>) -> Result<(), ReadError> {
    loop {
        let Some(found) = source.next_line()? else {
            return Err(source.error_in_line("the file ends here"));
        };
        let content = found.split(|&byte| byte == b'#').next().unwrap_or_default().trim_ascii();
        if !content.is_empty() {
            line.clear();
            line.extend_from_slice(content);
            return Ok(());
        }
    }
}

pub(super) fn write(mesh: &Mesh, writer: &mut impl Write) -> io::Result<()> {
    let Attributes { normals, colors, uvs } = mesh.attributes();
    let flag = |present: bool, flag: &'static str| if present { flag } else { "" };
    let (st, c, n) = (flag(uvs.is_some(), "ST"), flag(colors.is_some(), "C"), flag(normals.is_some(), "N"));
    writeln!(writer, "{st}{c}{n}OFF\n{} {} 0", mesh.positions().len(), mesh.triangles().len())?;
    write_elements(mesh, writer, |writer, color| {
        let [red, green, blue, alpha] = color.map(|channel| f32::from(channel) / 255.0);
        write!(writer, " {red:?} {green:?} {blue:?} {alpha:?}")
    })
}
