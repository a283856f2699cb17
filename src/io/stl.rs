//! STL, binary and ASCII. A file of loose triangles: corners are welded at equal positions.

use std::hash::BuildHasher;
use std::io::{self, Write};

use hashbrown::hash_table::{Entry, HashTable};

use super::source::Source;
use super::text::{floats, quoted, words};
use super::{Encoding, ReadError, WriteError, finish};
use crate::mesh::{Attributes, Mesh};

const HEADER: usize = 80;
const TRIANGLE: u64 = 50;

/// Welds corners as they come, so that the loose triangles are never in memory.
#[derive(Default)]
struct Welder {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Vertices by position. Seeded anew in each process, as files may come from anyone; the
    /// order of vertices does not depend on it.
    vertices: HashTable<u32>,
    hasher: hashbrown::DefaultHashBuilder,
}

impl Welder {
    fn push(&mut self, corners: [[f32; 3]; 3]) {
        let triangle = corners.map(|position| self.vertex(position));
        self.triangles.push(triangle);
    }

    fn vertex(&mut self, position: [f32; 3]) -> u32 {
        // Adding zero makes -0 equal to 0 in its bits, too.
        let hash = |position: &[f32; 3]| self.hasher.hash_one(position.map(|x| (x + 0.0).to_bits()));
        let positions = &mut self.positions;
        match self.vertices.entry(
            hash(&position),
            |&vertex| positions[vertex as usize] == position,
            |&vertex| hash(&positions[vertex as usize]),
        ) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                // What does not fit 32 bits is refused when the mesh is built: no mesh has as many.
                let vertex = positions.len() as u32;
                entry.insert(vertex);
                positions.push(position);
                vertex
            }
        }
    }

    fn finish(self) -> Result<Mesh, ReadError> {
        finish(self.positions, self.triangles, Attributes::default())
    }
}

pub(super) fn read(source: &mut Source) -> Result<Mesh, ReadError> {
    let length = source.length();
    let head = source.peek(1024)?;
    let count = head.get(HEADER..HEADER + 4).and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes);
    let binary_length = count.map(|count| HEADER as u64 + 4 + TRIANGLE * u64::from(count));
    // Binary files that start with "solid" are common, text that holds a zero byte is not: the
    // count of a binary file and the unused bytes after each of its triangles nearly always do.
    let solid = head.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let is_text = solid && !head.contains(&0) && (binary_length.is_none() || binary_length != length);
    match count {
        _ if is_text => read_ascii(source),
        Some(count) => read_binary(source, count),
        None => Err(source.error_here(
            "neither a text that starts with 'solid' nor long enough for the 84 bytes of a binary header",
        )),
    }
}

fn read_binary(source: &mut Source, count: u32) -> Result<Mesh, ReadError> {
    source.take(HEADER + 4)?;
    source.expect(count.into(), TRIANGLE, "triangles")?;
    let mut welder = Welder { triangles: source.list(count.into(), TRIANGLE)?, ..Welder::default() };
    for triangle in 0..count {
        let bytes = source
            .take(TRIANGLE as usize)
            .map_err(|error| error.within(format_args!("triangle {triangle} of {count}")))?;
        let (floats, _) = bytes.as_chunks::<4>();
        let float = |at: usize| f32::from_le_bytes(floats[at]);
        // The first three are the normal, which the corners tell better.
        let corners = [3, 6, 9].map(|at| [float(at), float(at + 1), float(at + 2)]);
        if !corners.as_flattened().iter().all(|x| x.is_finite()) {
            return Err(source.error_here(format!("triangle {triangle} has a corner that is not finite")));
        }
        welder.push(corners);
    }
    if !source.peek(1)?.is_empty() {
        return Err(source.error_here(format!("the header counts {count} triangles, but the file goes on")));
    }
    welder.finish()
}

fn read_ascii(source: &mut Source) -> Result<Mesh, ReadError> {
    let mut welder = Welder::default();
    let mut corners: Vec<[f32; 3]> = Vec::with_capacity(3);
    // What has begun and must end, the innermost last.
    let mut open: Vec<&str> = Vec::with_capacity(3);
    while let Some(line) = source.next_line()? {
        read_words(line, &mut open, &mut corners, &mut welder)
            .map_err(|problem| source.error_in_line(problem))?;
    }
    match open.last() {
        Some(open) => Err(source.error_in_line(format!("the file ends before 'end{open}'"))),
        None => welder.finish(),
    }
}

fn read_words(
    line: &[u8],
    open: &mut Vec<&'static str>,
    corners: &mut Vec<[f32; 3]>,
    welder: &mut Welder,
) -> Result<(), String> {
    let mut words = words(line);
    while let Some(word) = words.next() {
        let keyword = word.to_ascii_lowercase();
        match (keyword.as_slice(), open.as_slice()) {
            // The rest of the line is a name.
            (b"solid", []) => {
                open.push("solid");
                return Ok(());
            }
            (b"facet", ["solid"]) => {
                open.push("facet");
                // "normal" and its numbers, which the corners tell better and files get wrong.
                words.by_ref().take(4).for_each(drop);
            }
            (b"outer", ["solid", "facet"]) => {
                open.push("loop");
                corners.clear();
                words.next();
            }
            (b"vertex", ["solid", "facet", "loop"]) => corners.push(floats(&mut words, "vertex")?),
            (b"endloop", ["solid", "facet", "loop"]) => {
                open.pop();
                let [a, b, c] = corners[..] else {
                    return Err(format!("a loop of {} vertices, where only 3 can be", corners.len()));
                };
                welder.push([a, b, c]);
            }
            (b"endfacet", ["solid", "facet"]) => drop(open.pop()),
            (b"endsolid", ["solid"]) => {
                open.pop();
                return Ok(());
            }
            _ => {
                let place =
                    open.last().map_or("outside of any solid".to_owned(), |open| format!("in a {open}"));
                return Err(format!("{} cannot stand here, {place}", quoted(word)));
            }
        }
    }
    Ok(())
}

pub(super) fn write(mesh: &Mesh, encoding: Encoding, writer: &mut impl Write) -> Result<(), WriteError> {
    let positions = mesh.positions();
    let facets = mesh.triangles().iter().map(|triangle| {
        let corners = triangle.map(|index| positions[index as usize]);
        (normal(corners), corners)
    });
    match encoding {
        Encoding::Ascii => write_ascii(facets, writer)?,
        Encoding::Binary | Encoding::BinaryBigEndian => {
            // No "solid" in front: simple readers would take it for text.
            let mut header = [0; HEADER];
            header[..21].copy_from_slice(b"binary STL, decimesh ");
            writer.write_all(&header)?;
            writer.write_all(&(mesh.triangles().len() as u32).to_le_bytes())?;
            for (normal, corners) in facets {
                writer.write_all(normal.map(f32::to_le_bytes).as_flattened())?;
                for corner in corners {
                    writer.write_all(corner.map(f32::to_le_bytes).as_flattened())?;
                }
                writer.write_all(&[0; 2])?;
            }
        }
    }
    Ok(())
}

fn write_ascii(
    facets: impl Iterator<Item = ([f32; 3], [[f32; 3]; 3])>,
    writer: &mut impl Write,
) -> io::Result<()> {
    writeln!(writer, "solid decimesh")?;
    for ([x, y, z], corners) in facets {
        writeln!(writer, "facet normal {x:?} {y:?} {z:?}\nouter loop")?;
        for [x, y, z] in corners {
            writeln!(writer, "vertex {x:?} {y:?} {z:?}")?;
        }
        writeln!(writer, "endloop\nendfacet")?;
    }
    writeln!(writer, "endsolid decimesh")
}

/// Zero for a triangle without area.
fn normal(corners: [[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(|corner| glam::Vec3::from(corner).as_dvec3());
    (b - a).cross(c - a).normalize_or_zero().as_vec3().into()
}
