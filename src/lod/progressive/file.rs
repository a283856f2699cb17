//! The progressive file, as `docs/progressive-format.md` describes it.

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

use super::{Mark, Progressive, Split, check_marks};
use crate::io::source::{Source, check_vertex_count};
use crate::io::{FileError, ReadError, WriteError, replace};
use crate::mesh::{Attributes, Mesh, MeshError};

const MAGIC: &[u8; 8] = b"\x89DPM\r\n\x1a\n";
const VERSION: u32 = 1;

mod flag {
    pub(super) const NORMALS: u32 = 1;
    pub(super) const COLORS: u32 = 2;
    pub(super) const UVS: u32 = 4;
    pub(super) const ALL: u32 = 7;
}

/// How much of a progressive file to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Extent {
    /// All of it.
    #[default]
    Whole,
    /// Up to the finest level with at most so many triangles, or the coarsest if even that has more. What
    /// follows in the file is not looked at, and need not be there.
    Triangles(usize),
}

impl Progressive {
    /// Writes the file at `path`, whole or not at all, as [`io::write`](crate::io::write) does. The usual
    /// extension is `.dpm`.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        replace(path, |file| self.write_to(file))
    }

    /// Writes what is in such a file to `writer` and flushes it. `writer` need not be buffered.
    pub fn write_to(&self, writer: impl Write) -> Result<(), WriteError> {
        let mut writer =
            Writer { to: BufWriter::with_capacity(1 << 18, writer), attributes: self.attributes() };
        writer.header(self)?;
        let base = self.vertex_starts[0];
        (0..base).try_for_each(|vertex| writer.vertex(self.vertices.positions(), vertex))?;
        let mut previous = 0;
        for &corner in self.triangles[..self.triangle_count(0)].as_flattened() {
            writer.varint(zigzag(corner, previous))?;
            previous = corner;
        }
        for split in (0..self.steps()).filter_map(|step| self.split(step)) {
            writer.split(self.vertices.positions(), &split)?;
        }
        Ok(writer.to.flush()?)
    }

    /// The progressive mesh in the file at `path`, or the coarse part of it.
    pub fn read(path: &Path, extent: Extent) -> Result<Self, FileError> {
        let open_and_read = || {
            let mut file = File::open(path)?;
            let metadata = file.metadata()?;
            let length = metadata.is_file().then_some(metadata.len());
            read(&mut Source::new(&mut file, length), extent)
        };
        open_and_read().map_err(|source| FileError::Read { path: path.to_owned(), source })
    }

    /// The progressive mesh in the bytes of such a file, or the coarse part of it.
    pub fn read_from_slice(mut bytes: &[u8], extent: Extent) -> Result<Self, ReadError> {
        let length = bytes.len() as u64;
        read(&mut Source::new(&mut bytes, Some(length)), extent)
    }

    /// The progressive mesh that comes from `reader`, or the coarse part of it. `reader` need not be
    /// buffered; some bytes beyond the part asked for may have been taken from it.
    pub fn read_from(mut reader: impl Read, extent: Extent) -> Result<Self, ReadError> {
        read(&mut Source::new(&mut reader, None), extent)
    }

    fn attributes(&self) -> &Attributes {
        self.vertices.attributes()
    }
}

/// A number that is small where `value` is near `to`, above or below.
fn zigzag(value: u32, to: u32) -> u64 {
    let difference = i64::from(value) - i64::from(to);
    ((difference << 1) ^ (difference >> 63)) as u64
}

/// The number that is away from `to` by what [`zigzag`] says; `None` if no `u32` is.
fn unzigzag(code: u64, to: u32) -> Option<u32> {
    let difference = (code >> 1) as i64 ^ -((code & 1) as i64);
    u32::try_from(i64::from(to).checked_add(difference)?).ok()
}

struct Writer<'a, W: Write> {
    to: BufWriter<W>,
    attributes: &'a Attributes,
}

impl<W: Write> Writer<'_, W> {
    fn header(&mut self, progressive: &Progressive) -> io::Result<()> {
        let Attributes { normals, colors, uvs } = self.attributes;
        let flags = [
            (normals.is_some(), flag::NORMALS),
            (colors.is_some(), flag::COLORS),
            (uvs.is_some(), flag::UVS),
        ];
        let steps = progressive.steps();
        let marks = u32::try_from(progressive.marks.len())
            .map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, "too many marks"))?;
        self.to.write_all(MAGIC)?;
        for number in [
            VERSION,
            flags.iter().filter(|(there, _)| *there).map(|(_, flag)| flag).sum(),
            progressive.vertex_starts[steps],
            progressive.triangle_starts[steps],
            progressive.vertex_starts[0],
            progressive.triangle_starts[0],
            steps as u32,
            marks,
        ] {
            self.to.write_all(&number.to_le_bytes())?;
        }
        for mark in &progressive.marks {
            self.to.write_all(&(mark.step as u32).to_le_bytes())?;
            self.to.write_all(&mark.error.to_le_bytes())?;
        }
        Ok(())
    }

    fn split(&mut self, positions: &[[f32; 3]], split: &Split) -> io::Result<()> {
        let first = split.vertices.start;
        let changes: Vec<_> = split.vertex_splits().collect();
        let several = changes.len() > 1;
        self.varint((split.triangles.len() as u64) << 1 | u64::from(several))?;
        if several {
            self.varint(changes.len() as u64 - 2)?;
        }
        for change in &changes {
            self.vertex(positions, change.vertex)?;
            self.varint(u64::from(first - 1 - change.parent))?;
            self.varint(change.corners.len() as u64)?;
            let mut least = 0;
            for &corner in change.corners {
                self.varint(u64::from(corner - least))?;
                least = corner + 1;
            }
        }
        for &corner in split.triangles.as_flattened() {
            let code = match changes.iter().position(|change| change.parent == corner) {
                _ if corner >= first => 2 * u64::from(corner - first),
                Some(index) => 2 * index as u64 + 1,
                None => 2 * changes.len() as u64 + u64::from(first - 1 - corner),
            };
            self.varint(code)?;
        }
        Ok(())
    }

    fn vertex(&mut self, positions: &[[f32; 3]], vertex: u32) -> io::Result<()> {
        let vertex = vertex as usize;
        self.floats(&positions[vertex])?;
        let Attributes { normals, colors, uvs } = self.attributes;
        normals.as_ref().map_or(Ok(()), |normals| self.floats(&normals[vertex]))?;
        uvs.as_ref().map_or(Ok(()), |uvs| self.floats(&uvs[vertex]))?;
        colors.as_ref().map_or(Ok(()), |colors| self.to.write_all(&colors[vertex]))
    }

    fn floats(&mut self, values: &[f32]) -> io::Result<()> {
        values.iter().try_for_each(|value| self.to.write_all(&value.to_le_bytes()))
    }

    /// Seven bits a byte, the lowest first; the eighth says that more follow.
    fn varint(&mut self, mut value: u64) -> io::Result<()> {
        while value >= 0x80 {
            self.to.write_all(&[value as u8 | 0x80])?;
            value >>= 7;
        }
        self.to.write_all(&[value as u8])
    }
}

fn read(source: &mut Source, extent: Extent) -> Result<Progressive, ReadError> {
    let header = Header::read(source)?;
    let mut reader = Reader::new(source, header, extent)?;
    reader.base(source)?;
    let limit = match extent {
        Extent::Whole => usize::MAX,
        Extent::Triangles(limit) => limit,
    };
    while reader.steps() < reader.header.steps && reader.split(source, limit)? {}
    if extent == Extent::Whole {
        reader.check_end(source)?;
    }
    reader.finish()
}

struct Header {
    flags: u32,
    vertices: u32,
    triangles: u32,
    base_vertices: u32,
    base_triangles: u32,
    steps: u32,
    marks: Vec<Mark>,
}

impl Header {
    fn read(source: &mut Source) -> Result<Self, ReadError> {
        if source.peek(MAGIC.len())? != MAGIC {
            return Err(source.error_here("this is no progressive mesh: it does not begin like one"));
        }
        source.take(MAGIC.len())?;
        let version = number(source)?;
        if version != VERSION {
            return Err(ReadError::Unsupported(format!("version {version} of the progressive format")));
        }
        let flags = number(source)?;
        if flags & !flag::ALL != 0 {
            return Err(ReadError::Unsupported(format!("a progressive mesh with the attributes {flags:#x}")));
        }
        let [vertices, triangles, base_vertices, base_triangles, steps, marks] = [
            number(source)?,
            number(source)?,
            number(source)?,
            number(source)?,
            number(source)?,
            number(source)?,
        ];
        check_vertex_count(vertices.into())?;
        if triangles as usize > Mesh::MAX_TRIANGLES {
            let limit = Mesh::MAX_TRIANGLES;
            return Err(MeshError::TooLarge { what: "triangles", count: triangles as usize, limit }.into());
        }
        if base_vertices > vertices || base_triangles > triangles {
            return Err(source.error_here("the coarsest level is larger than the finest"));
        }
        if steps > vertices - base_vertices {
            return Err(source.error_here(format!(
                "{steps} steps cannot each make a vertex: from {base_vertices} they lead to {vertices}"
            )));
        }
        source.expect(marks.into(), 8, "marks")?;
        let mut list = source.list(marks.into(), 8)?;
        for _ in 0..marks {
            list.push(Mark { step: number(source)? as usize, error: float(source)? });
        }
        check_marks(&list, steps as usize).map_err(|error| source.error_here(error.to_string()))?;
        Ok(Self { flags, vertices, triangles, base_vertices, base_triangles, steps, marks: list })
    }

    fn vertex_bytes(&self) -> u64 {
        let size = |flag, bytes| if self.flags & flag == 0 { 0 } else { bytes };
        12 + size(flag::NORMALS, 12) + size(flag::COLORS, 4) + size(flag::UVS, 8)
    }
}

/// A progressive mesh that grows as its file is read.
struct Reader {
    header: Header,
    positions: Vec<[f32; 3]>,
    attributes: Attributes,
    triangles: Vec<[u32; 3]>,
    /// The triangles of the level reached: what a split changes must be there.
    now: Vec<u32>,
    vertex_starts: Vec<u32>,
    triangle_starts: Vec<u32>,
    parents: Vec<u32>,
    corner_starts: Vec<usize>,
    corners: Vec<u32>,
}

impl Reader {
    /// Lists get room for what the header promises, as far as the file is long enough to keep it.
    fn new(source: &Source, header: Header, extent: Extent) -> Result<Self, ReadError> {
        let bytes = header.vertex_bytes();
        source.expect(header.base_vertices.into(), bytes, "vertices of the coarsest level")?;
        source.expect(header.base_triangles.into(), 3, "triangles of the coarsest level")?;
        // How much of it a part of the file needs is not known before.
        let share = |whole: u32, base: u32| u64::from(if extent == Extent::Whole { whole } else { base });
        let vertices = share(header.vertices, header.base_vertices);
        let triangles = share(header.triangles, header.base_triangles);
        source.expect(vertices, bytes, "vertices")?;
        source.expect(triangles, 3, "triangles")?;
        let attributes = Attributes {
            normals: (header.flags & flag::NORMALS != 0).then(|| source.list(vertices, bytes)).transpose()?,
            colors: (header.flags & flag::COLORS != 0).then(|| source.list(vertices, bytes)).transpose()?,
            uvs: (header.flags & flag::UVS != 0).then(|| source.list(vertices, bytes)).transpose()?,
        };
        Ok(Self {
            positions: source.list(vertices, bytes)?,
            attributes,
            triangles: source.list(triangles, 3)?,
            now: source.list(3 * triangles, 1)?,
            vertex_starts: vec![header.base_vertices],
            triangle_starts: vec![header.base_triangles],
            parents: Vec::new(),
            corner_starts: vec![0],
            corners: Vec::new(),
            header,
        })
    }

    fn steps(&self) -> u32 {
        self.vertex_starts.len() as u32 - 1
    }

    fn base(&mut self, source: &mut Source) -> Result<(), ReadError> {
        for _ in 0..self.header.base_vertices {
            self.vertex(source)?;
        }
        let mut previous = 0;
        for _ in 0..self.header.base_triangles {
            let mut triangle = [0; 3];
            for corner in &mut triangle {
                let code = varint(source)?;
                previous = unzigzag(code, previous)
                    .filter(|&vertex| vertex < self.header.base_vertices)
                    .ok_or_else(|| source.error_here("a corner names no vertex of the coarsest level"))?;
                *corner = previous;
            }
            self.add(triangle);
        }
        Ok(())
    }

    fn add(&mut self, triangle: [u32; 3]) {
        self.triangles.push(triangle);
        self.now.extend(triangle);
    }

    fn vertex(&mut self, source: &mut Source) -> Result<(), ReadError> {
        self.positions.push(floats(source)?);
        if let Some(normals) = &mut self.attributes.normals {
            normals.push(floats(source)?);
        }
        if let Some(uvs) = &mut self.attributes.uvs {
            uvs.push(floats(source)?);
        }
        if let Some(colors) = &mut self.attributes.colors {
            let mut color = [0; 4];
            color.copy_from_slice(source.take(4)?);
            colors.push(color);
        }
        Ok(())
    }

    /// Reads a split; `false`, and nothing is read, if it would lead beyond `limit` triangles.
    fn split(&mut self, source: &mut Source, limit: usize) -> Result<bool, ReadError> {
        let head = varint(source)?;
        let triangles = head >> 1;
        let left = u64::from(self.header.triangles) - self.triangles.len() as u64;
        if triangles > left {
            return Err(source.error_here(format!("a split adds {triangles} triangles, but {left} are left")));
        }
        if self.triangles.len() + triangles as usize > limit {
            return Ok(false);
        }
        let vertices = if head & 1 == 0 { 1 } else { varint(source)?.saturating_add(2) };
        let first = self.positions.len() as u32;
        let left = u64::from(self.header.vertices - first);
        if vertices > left {
            return Err(source.error_here(format!("a split adds {vertices} vertices, but {left} are left")));
        }
        let first_parent = self.parents.len();
        for vertex in first..first + vertices as u32 {
            self.vertex(source)?;
            let back = varint(source)?;
            let parent = u32::try_from(back).ok().and_then(|back| first.checked_sub(1)?.checked_sub(back));
            let parent =
                parent.ok_or_else(|| source.error_here("a split comes from no vertex that is there"))?;
            self.parents.push(parent);
            self.changes(source, vertex, parent)?;
        }
        for _ in 0..triangles {
            let mut triangle = [0; 3];
            for corner in &mut triangle {
                *corner = self.corner(source, first, &self.parents[first_parent..])?;
            }
            self.add(triangle);
        }
        self.vertex_starts.push(self.positions.len() as u32);
        self.triangle_starts.push(self.triangles.len() as u32);
        Ok(true)
    }

    /// The corners that go over from `parent` to `vertex`.
    fn changes(&mut self, source: &mut Source, vertex: u32, parent: u32) -> Result<(), ReadError> {
        let mut least = 0;
        for _ in 0..varint(source)? {
            let corner = varint(source)?.saturating_add(least);
            least = corner.saturating_add(1);
            match usize::try_from(corner).ok().and_then(|corner| self.now.get_mut(corner)) {
                Some(now) if *now == parent => *now = vertex,
                Some(_) => return Err(source.error_here("a split changes a corner of another vertex")),
                None => return Err(source.error_here("a split changes a corner that is not there")),
            }
            self.corners.push(corner as u32);
        }
        self.corner_starts.push(self.corners.len());
        Ok(())
    }

    /// A corner of a new triangle of a split that makes the vertices from `first` on.
    fn corner(&self, source: &mut Source, first: u32, parents: &[u32]) -> Result<u32, ReadError> {
        let code = varint(source)?;
        let named = 2 * parents.len() as u64;
        if code < named {
            let index = code / 2;
            return Ok(if code % 2 == 0 { first + index as u32 } else { parents[index as usize] });
        }
        let back = u32::try_from(code - named).ok();
        back.and_then(|back| first.checked_sub(1)?.checked_sub(back))
            .ok_or_else(|| source.error_here("a new triangle names a vertex that is not there"))
    }

    fn check_end(&self, source: &mut Source) -> Result<(), ReadError> {
        let Header { vertices, triangles, .. } = self.header;
        if self.positions.len() != vertices as usize || self.triangles.len() != triangles as usize {
            return Err(source.error_here(format!(
                "the steps end at {} vertices and {} triangles; {vertices} and {triangles} are promised",
                self.positions.len(),
                self.triangles.len()
            )));
        }
        if !source.peek(1)?.is_empty() {
            return Err(source.error_here("bytes follow the last step"));
        }
        Ok(())
    }

    fn finish(self) -> Result<Progressive, ReadError> {
        let steps = self.steps() as usize;
        let mut marks = self.header.marks;
        marks.retain(|mark| mark.step <= steps);
        Ok(Progressive {
            vertices: Mesh::with_attributes(self.positions, Vec::new(), self.attributes)?,
            triangles: self.triangles,
            vertex_starts: self.vertex_starts,
            triangle_starts: self.triangle_starts,
            parents: self.parents,
            corner_starts: self.corner_starts,
            corners: self.corners,
            marks,
            order: None,
        })
    }
}

fn number(source: &mut Source) -> Result<u32, ReadError> {
    let mut bytes = [0; 4];
    bytes.copy_from_slice(source.take(4)?);
    Ok(u32::from_le_bytes(bytes))
}

fn float(source: &mut Source) -> Result<f32, ReadError> {
    number(source).map(f32::from_bits)
}

fn floats<const N: usize>(source: &mut Source) -> Result<[f32; N], ReadError> {
    let mut values = [0.0; N];
    for value in &mut values {
        *value = float(source)?;
    }
    Ok(values)
}

/// At most six bytes: no number of a file takes more than 40 bits.
fn varint(source: &mut Source) -> Result<u64, ReadError> {
    let mut value = 0;
    for shift in (0..42).step_by(7) {
        let byte = source.take(1)?[0];
        value |= u64::from(byte & 0x7F) << shift;
        if byte < 0x80 {
            return Ok(value);
        }
    }
    Err(source.error_here("a number is longer than six bytes"))
}
