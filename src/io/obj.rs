//! Wavefront OBJ: `v` (with the `r g b` extension), `vt`, `vn` and `f`; all else is skipped.

use std::hash::BuildHasher;
use std::io::{self, Write};

use hashbrown::hash_table::{Entry, HashTable};

use super::source::Source;
use super::text::{TextColors, floats, number, quoted, words};
use super::{ReadError, finish};
use crate::mesh::{Attributes, Mesh};

/// Stands for a normal or texture coordinate that a corner does not name.
const ABSENT: u32 = u32::MAX;

#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    colors: TextColors,
    uvs: Pool<2>,
    normals: Pool<3>,
    triangles: Vec<[u32; 3]>,
    /// The largest index so far that named a position not yet read, and its line: faces may stand
    /// before their vertices.
    ahead: Option<Ahead>,
}

struct Ahead {
    index: u32,
    error: ReadError,
}

/// The `vt` or `vn` of a file, and which of them the corners name.
#[derive(Default)]
struct Pool<const N: usize> {
    values: Vec<[f32; N]>,
    /// One entry a triangle up to the last that names any.
    triangles: Vec<[u32; 3]>,
    ahead: Option<Ahead>,
}

pub(super) fn read(source: &mut Source) -> Result<Mesh, ReadError> {
    let mut reader = Reader::default();
    let mut line = Vec::new();
    let mut corners = Vec::new();
    while next_line(source, &mut line)? {
        reader.take_line(&line, &mut corners, source).map_err(|problem| source.error_in_line(problem))?;
    }
    reader.finish()
}

/// Copies the next line to `line`, joined with those that a backslash at its end continues.
fn next_line(source: &mut Source, line: &mut Vec<u8>) -> Result<bool, ReadError> {
    line.clear();
    loop {
        let Some(part) = source.next_line()? else { return Ok(!line.is_empty()) };
        match part.strip_suffix(b"\\") {
            Some(part) => {
                line.extend_from_slice(part);
                line.push(b' ');
            }
            None => {
                line.extend_from_slice(part);
                // Kept non-empty, so that an empty line is not the end of the file.
                line.push(b'\n');
                return Ok(true);
            }
        }
    }
}

impl Reader {
    fn take_line(&mut self, line: &[u8], corners: &mut Vec<[u32; 3]>, source: &Source) -> Result<(), String> {
        let mut words = words(line);
        match words.next() {
            Some(b"v") => {
                let vertex = self.positions.len();
                self.positions.push(floats(&mut words, "position")?);
                // One more number is a weight, which only curves have a use for.
                let mut rest = [&b""[..]; 4];
                let count = rest.iter_mut().zip(words).map(|(slot, word)| *slot = word).count();
                if count >= 3 {
                    self.colors.set(vertex, &rest[..count])?;
                }
            }
            Some(b"vt") => {
                // A texture of one dimension has no v.
                let u = floats::<1>(&mut words, "texture coordinate")?[0];
                let v = words
                    .next()
                    .map_or(Ok(0.0), |word| floats::<1>(&mut [word].into_iter(), "v").map(|[v]| v))?;
                self.uvs.values.push([u, v]);
            }
            Some(b"vn") => self.normals.values.push(floats(&mut words, "normal")?),
            Some(b"f") => {
                corners.clear();
                for word in words {
                    corners.push(self.corner(word, source)?);
                }
                let first = corners.first().copied().unwrap_or_default();
                for pair in corners.get(1..).unwrap_or_default().windows(2) {
                    self.push([first, pair[0], pair[1]]);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Position, texture coordinate and normal of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, word: &[u8], source: &Source) -> Result<[u32; 3], String> {
        let mut parts = word.split(|&byte| byte == b'/');
        let mut resolve = |count: usize, what, ahead: &mut Option<Ahead>| match parts.next() {
            None | Some(b"") => Ok(ABSENT),
            Some(part) => resolve(part, count, what, ahead, source),
        };
        let position = resolve(self.positions.len(), "v", &mut self.ahead)?;
        let uv = resolve(self.uvs.values.len(), "vt", &mut self.uvs.ahead)?;
        let normal = resolve(self.normals.values.len(), "vn", &mut self.normals.ahead)?;
        if position == ABSENT || parts.next().is_some() {
            return Err(format!("{} is no corner of a face", quoted(word)));
        }
        Ok([position, uv, normal])
    }

    fn push(&mut self, corners: [[u32; 3]; 3]) {
        self.uvs.push(self.triangles.len(), corners.map(|[_, uv, _]| uv));
        self.normals.push(self.triangles.len(), corners.map(|[_, _, normal]| normal));
        self.triangles.push(corners.map(|[position, _, _]| position));
    }

    fn finish(mut self) -> Result<Mesh, ReadError> {
        check(self.ahead.take(), self.positions.len())?;
        check(self.uvs.ahead.take(), self.uvs.values.len())?;
        check(self.normals.ahead.take(), self.normals.values.len())?;
        let colors = self.colors.finish(self.positions.len());
        let count = self.triangles.len();
        let uvs = self.uvs.corners(count);
        let normals = self.normals.corners(count).filter(|corners| !corners.as_flattened().contains(&ABSENT));
        let mut splitter = Splitter::new(self.positions, self.triangles, colors);
        if uvs.is_some() || normals.is_some() {
            splitter.split(uvs.as_deref(), normals.as_deref());
        }
        let Splitter { positions, triangles, colors, pairs, .. } = splitter;
        // What no corner names has no value of its own.
        let uv = |[uv, _]: &[u32; 2]| self.uvs.values.get(*uv as usize).copied().unwrap_or_default();
        let normal = |[_, normal]: &[u32; 2]| {
            self.normals.values.get(*normal as usize).copied().unwrap_or([0.0, 0.0, 1.0])
        };
        let attributes = Attributes {
            colors,
            uvs: uvs.map(|_| pairs.iter().map(uv).collect()),
            normals: normals.map(|_| pairs.iter().map(normal).collect()),
        };
        finish(positions, triangles, attributes)
    }
}

impl<const N: usize> Pool<N> {
    fn push(&mut self, triangle: usize, corners: [u32; 3]) {
        if corners != [ABSENT; 3] {
            self.triangles.resize(triangle, [ABSENT; 3]);
            self.triangles.push(corners);
        }
    }

    /// What each corner of `count` triangles names, if any names anything.
    fn corners(&mut self, count: usize) -> Option<Vec<[u32; 3]>> {
        let mut corners = std::mem::take(&mut self.triangles);
        (!corners.is_empty()).then(|| {
            corners.resize(count, [ABSENT; 3]);
            corners
        })
    }
}

/// The index, from 0, that `word` names: from 1 upwards, or from -1 downwards from the last of the
/// `count` so far.
fn resolve(
    word: &[u8],
    count: usize,
    what: &str,
    ahead: &mut Option<Ahead>,
    source: &Source,
) -> Result<u32, String> {
    let named: i64 = number(word)?;
    let index = if named > 0 { named - 1 } else { named.saturating_add(count as i64) };
    match u32::try_from(index) {
        Ok(index) if named != 0 && index != ABSENT => {
            if index as usize >= count && ahead.as_ref().is_none_or(|ahead| ahead.index < index) {
                let error =
                    source.error_in_line(format!("a face names {what} {named}, which does not exist"));
                *ahead = Some(Ahead { index, error });
            }
            Ok(index)
        }
        _ => Err(format!("a face names {what} {named}, which does not exist")),
    }
}

fn check(ahead: Option<Ahead>, count: usize) -> Result<(), ReadError> {
    match ahead {
        Some(ahead) if ahead.index as usize >= count => Err(ahead.error),
        _ => Ok(()),
    }
}

/// Gives each vertex one texture coordinate and one normal, at the price of more vertices.
struct Splitter {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    colors: Option<Vec<[u8; 4]>>,
    /// The texture coordinate and the normal of each vertex.
    pairs: Vec<[u32; 2]>,
    taken: Vec<bool>,
}

impl Splitter {
    fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>, colors: Option<Vec<[u8; 4]>>) -> Self {
        Self { positions, triangles, colors, pairs: Vec::new(), taken: Vec::new() }
    }

    /// The first pair at a position stays there; each other becomes a vertex at the end.
    fn split(&mut self, uvs: Option<&[[u32; 3]]>, normals: Option<&[[u32; 3]]>) {
        self.pairs = vec![[ABSENT; 2]; self.positions.len()];
        self.taken = vec![false; self.positions.len()];
        let mut sources: Vec<u32> = Vec::new();
        let originals = self.positions.len();
        let mut table: HashTable<u32> = HashTable::new();
        let hasher = hashbrown::DefaultHashBuilder::default();
        for (triangle, corners) in self.triangles.iter_mut().enumerate() {
            for (corner, vertex) in corners.iter_mut().enumerate() {
                let named =
                    |corners: Option<&[[u32; 3]]>| corners.map_or(ABSENT, |all| all[triangle][corner]);
                let pair = [named(uvs), named(normals)];
                let original = *vertex;
                if !std::mem::replace(&mut self.taken[original as usize], true) {
                    self.pairs[original as usize] = pair;
                }
                if self.pairs[original as usize] == pair {
                    continue;
                }
                let key = |vertex: u32| (sources[vertex as usize - originals], self.pairs[vertex as usize]);
                let entry = table.entry(
                    hasher.hash_one((original, pair)),
                    |&other| key(other) == (original, pair),
                    |&other| hasher.hash_one(key(other)),
                );
                *vertex = match entry {
                    Entry::Occupied(entry) => *entry.get(),
                    Entry::Vacant(entry) => {
                        let new = self.positions.len() as u32;
                        entry.insert(new);
                        self.positions.push(self.positions[original as usize]);
                        self.pairs.push(pair);
                        sources.push(original);
                        if let Some(colors) = &mut self.colors {
                            colors.push(colors[original as usize]);
                        }
                        new
                    }
                };
            }
        }
    }
}

pub(super) fn write(mesh: &Mesh, writer: &mut impl Write) -> io::Result<()> {
    let Attributes { normals, colors, uvs } = mesh.attributes();
    for (vertex, [x, y, z]) in mesh.positions().iter().enumerate() {
        write!(writer, "v {x:?} {y:?} {z:?}")?;
        if let Some(color) = colors.as_ref().map(|colors| colors[vertex]) {
            let [red, green, blue, _] = color.map(|channel| f32::from(channel) / 255.0);
            write!(writer, " {red:?} {green:?} {blue:?}")?;
        }
        writer.write_all(b"\n")?;
    }
    for [u, v] in uvs.iter().flatten() {
        writeln!(writer, "vt {u:?} {v:?}")?;
    }
    for [x, y, z] in normals.iter().flatten() {
        writeln!(writer, "vn {x:?} {y:?} {z:?}")?;
    }
    for triangle in mesh.triangles() {
        writer.write_all(b"f")?;
        for index in triangle.map(|index| u64::from(index) + 1) {
            match (uvs, normals) {
                (None, None) => write!(writer, " {index}")?,
                (Some(_), None) => write!(writer, " {index}/{index}")?,
                (None, Some(_)) => write!(writer, " {index}//{index}")?,
                (Some(_), Some(_)) => write!(writer, " {index}/{index}/{index}")?,
            }
        }
        writer.write_all(b"\n")?;
    }
    Ok(())
}
