//! A mesh on disk: its vertices in one file, its triangles in another, in whole numbers of bytes each, so that
//! any of them can be had without the others.
//!
//! A vertex is stored as a binary PLY file has it (see [`ply::write_header`](crate::io::ply::write_header)), after
//! its *rank*: the index in the input of the vertex that it was before others went into it. By their ranks,
//! vertices are put back into the order of the input where they are in memory: collapses go by the order, and
//! with that of the blocks the error of one run on a statue of regular rows was a tenth larger.

use std::fs::{File, OpenOptions};
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::OutOfCoreError;
use super::error::work;
use super::memory::BUFFER;
use crate::io::ply::{Carried, Vertex};
use crate::mesh::{Attributes, Mesh, MeshError, select};

/// Bytes of a triangle.
pub(super) const TRIANGLE: usize = 12;

/// A mesh on disk: how large it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stored {
    pub(super) vertices: usize,
    pub(super) triangles: usize,
    pub(super) carried: Carried,
    /// The box around it, or around what it was made of.
    pub(super) bounds: [[f32; 3]; 2],
}

/// Bytes of the attributes of a vertex.
pub(super) fn attribute_bytes(carried: Carried) -> usize {
    12 * usize::from(carried.normals) + 4 * usize::from(carried.colors) + 8 * usize::from(carried.uvs)
}

/// Bytes of the rank of a vertex.
pub(super) const RANK: usize = 4;

/// Bytes of a vertex.
pub(super) fn vertex_bytes(carried: Carried) -> usize {
    RANK + 12 + attribute_bytes(carried)
}

fn write_vertex(
    rank: u32,
    vertex: &Vertex,
    carried: Carried,
    writer: &mut impl Write,
) -> std::io::Result<()> {
    writer.write_all(&rank.to_le_bytes())?;
    writer.write_all(vertex.position.map(f32::to_le_bytes).as_flattened())?;
    if carried.normals {
        writer.write_all(vertex.normal.map(f32::to_le_bytes).as_flattened())?;
    }
    if carried.colors {
        writer.write_all(&vertex.color)?;
    }
    if carried.uvs {
        writer.write_all(vertex.uv.map(f32::to_le_bytes).as_flattened())?;
    }
    Ok(())
}

/// A vertex of `mesh`.
pub(super) fn vertex_of(mesh: &Mesh, vertex: usize) -> Vertex {
    let Attributes { normals, colors, uvs } = mesh.attributes();
    Vertex {
        position: mesh.positions()[vertex],
        normal: normals.as_ref().map_or([0.0; 3], |normals| normals[vertex]),
        color: colors.as_ref().map_or([0; 4], |colors| colors[vertex]),
        uv: uvs.as_ref().map_or([0.0; 2], |uvs| uvs[vertex]),
    }
}

/// The first `N` numbers of a vertex, from a place in it on.
fn floats<const N: usize>(bytes: &[u8]) -> [f32; N] {
    let numbers = bytes.as_chunks::<4>().0;
    std::array::from_fn(|place| f32::from_le_bytes(numbers[place]))
}

/// Vertices in memory, to be.
pub(super) struct Columns {
    carried: Carried,
    ranks: Vec<u32>,
    positions: Vec<[f32; 3]>,
    attributes: Attributes,
}

impl Columns {
    pub(super) fn new(carried: Carried, count: usize) -> Self {
        let attributes = Attributes {
            normals: carried.normals.then(|| Vec::with_capacity(count)),
            colors: carried.colors.then(|| Vec::with_capacity(count)),
            uvs: carried.uvs.then(|| Vec::with_capacity(count)),
        };
        let (ranks, positions) = (Vec::with_capacity(count), Vec::with_capacity(count));
        Self { carried, ranks, positions, attributes }
    }

    /// Adds a vertex from its bytes.
    pub(super) fn push(&mut self, bytes: &[u8]) {
        let (rank, bytes) = bytes.split_at(RANK);
        self.ranks.push(u32::from_le_bytes(std::array::from_fn(|place| rank[place])));
        self.positions.push(floats(bytes));
        let Carried { normals, colors, .. } = self.carried;
        let after_normal = 12 + 12 * usize::from(normals);
        if let Some(normals) = &mut self.attributes.normals {
            normals.push(floats(&bytes[12..]));
        }
        if let Some(colors) = &mut self.attributes.colors {
            colors.push(std::array::from_fn(|channel| bytes[after_normal + channel]));
        }
        if let Some(uvs) = &mut self.attributes.uvs {
            uvs.push(floats(&bytes[after_normal + 4 * usize::from(colors)..]));
        }
    }

    /// The mesh of these and of `triangles`, vertices by their rank and triangles by their lowest vertex, unless
    /// vertices are in that order already; and for each of its vertices the rank and the place here.
    pub(super) fn into_mesh(self, mut triangles: Vec<[u32; 3]>) -> Result<Ranked, MeshError> {
        let Self { ranks, positions, attributes, .. } = self;
        let mut order: Vec<u32> = (0..ranks.len() as u32).collect();
        if ranks.is_sorted() {
            return Ok(Ranked {
                mesh: Mesh::with_attributes(positions, triangles, attributes)?,
                ranks,
                order,
            });
        }
        order.sort_unstable_by_key(|&vertex| ranks[vertex as usize]);
        let mut places = vec![0; order.len()];
        (0..).zip(&order).for_each(|(place, &vertex)| places[vertex as usize] = place);
        for vertex in triangles.as_flattened_mut() {
            *vertex = places[*vertex as usize];
        }
        drop(places);
        triangles.sort_unstable_by_key(|&[a, b, c]| (a.min(b).min(c), [a, b, c]));
        let (positions, attributes) = (select(&positions, &order), attributes.select(&order));
        let mesh = Mesh::with_attributes(positions, triangles, attributes)?;
        Ok(Ranked { mesh, ranks: select(&ranks, &order), order })
    }
}

/// A mesh whose vertices are in the order of their ranks.
pub(super) struct Ranked {
    pub(super) mesh: Mesh,
    pub(super) ranks: Vec<u32>,
    /// For each vertex where it came.
    pub(super) order: Vec<u32>,
}

/// Vertices in a page of a file.
const PAGE: usize = 1024;

/// Vertices on disk, looked up by their index. What was read is kept as far as memory allows: a file in which
/// the triangles come in an order in which they lie together is read about once.
pub(super) struct Vertices {
    file: File,
    path: PathBuf,
    bytes: usize,
    count: usize,
    /// The page that each slot holds, and what is in it. A page has one slot that it can be in.
    slots: Vec<(usize, Vec<u8>)>,
}

impl Vertices {
    /// Those in the file at `path`, of which `memory` bytes at most are kept, but one page at least.
    pub(super) fn open(
        path: &Path,
        carried: Carried,
        count: usize,
        memory: usize,
    ) -> Result<Self, OutOfCoreError> {
        let bytes = vertex_bytes(carried);
        let slots = (memory / (PAGE * bytes)).clamp(1, count.div_ceil(PAGE).max(1));
        let file = File::open(path).map_err(work(path))?;
        Ok(Self { file, path: path.to_owned(), bytes, count, slots: vec![(usize::MAX, Vec::new()); slots] })
    }

    /// The bytes of a vertex.
    #[inline]
    pub(super) fn get(&mut self, vertex: u32) -> Result<&[u8], OutOfCoreError> {
        let (page, place) = (vertex as usize / PAGE, vertex as usize % PAGE);
        let slot = page % self.slots.len();
        if self.slots[slot].0 != page {
            self.load(page, slot)?;
        }
        Ok(&self.slots[slot].1[place * self.bytes..][..self.bytes])
    }

    pub(super) fn position(&mut self, vertex: u32) -> Result<[f32; 3], OutOfCoreError> {
        self.get(vertex).map(|bytes| floats(&bytes[RANK..]))
    }

    #[cold]
    fn load(&mut self, page: usize, slot: usize) -> Result<(), OutOfCoreError> {
        let first = page * PAGE;
        let (held, bytes) = &mut self.slots[slot];
        *held = usize::MAX;
        bytes.resize((self.count - first).min(PAGE) * self.bytes, 0);
        let mut read = || {
            self.file.seek(SeekFrom::Start((first * self.bytes) as u64))?;
            self.file.read_exact(bytes)
        };
        read().map_err(work(&self.path))?;
        *held = page;
        Ok(())
    }
}

/// Triangles on disk, one after the other.
pub(super) struct Triangles {
    reader: BufReader<File>,
    path: PathBuf,
    left: usize,
}

impl Triangles {
    /// `count` of those in the file at `path`, from the one of index `first` on.
    pub(super) fn open(path: &Path, first: usize, count: usize) -> Result<Self, OutOfCoreError> {
        let mut file = File::open(path).map_err(work(path))?;
        file.seek(SeekFrom::Start((first * TRIANGLE) as u64)).map_err(work(path))?;
        Ok(Self { reader: BufReader::with_capacity(BUFFER, file), path: path.to_owned(), left: count })
    }

    #[inline]
    pub(super) fn next(&mut self) -> Result<Option<[u32; 3]>, OutOfCoreError> {
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        let mut bytes = [[0; 4]; 3];
        self.reader.read_exact(bytes.as_flattened_mut()).map_err(work(&self.path))?;
        Ok(Some(bytes.map(u32::from_le_bytes)))
    }
}

/// A file that is made front to back, and gone on with from any length that it had.
pub(super) struct Appended {
    writer: BufWriter<File>,
    path: PathBuf,
}

impl Appended {
    /// The file at `path`, cut off after so many bytes; a new one where it is to have none.
    pub(super) fn open(path: &Path, bytes: usize) -> Result<Self, OutOfCoreError> {
        let open = || {
            let mut file = OpenOptions::new().write(true).create(bytes == 0).truncate(false).open(path)?;
            if file.metadata()?.len() < bytes as u64 {
                return Err(std::io::ErrorKind::UnexpectedEof.into());
            }
            file.set_len(bytes as u64)?;
            file.seek(SeekFrom::End(0))?;
            Ok(file)
        };
        let file = open().map_err(work(path))?;
        Ok(Self { writer: BufWriter::with_capacity(BUFFER, file), path: path.to_owned() })
    }

    pub(super) fn vertex(
        &mut self,
        rank: u32,
        vertex: &Vertex,
        carried: Carried,
    ) -> Result<(), OutOfCoreError> {
        write_vertex(rank, vertex, carried, &mut self.writer).map_err(work(&self.path))
    }

    pub(super) fn triangle(&mut self, corners: [u32; 3]) -> Result<(), OutOfCoreError> {
        self.bytes(corners.map(u32::to_le_bytes).as_flattened())
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) -> Result<(), OutOfCoreError> {
        self.writer.write_all(bytes).map_err(work(&self.path))
    }

    /// Returns once others can read all of it.
    pub(super) fn flush(&mut self) -> Result<(), OutOfCoreError> {
        self.writer.flush().map_err(work(&self.path))
    }

    /// Returns once all of it is on disk.
    pub(super) fn sync(&mut self) -> Result<(), OutOfCoreError> {
        self.writer.flush().and_then(|()| self.writer.get_ref().sync_data()).map_err(work(&self.path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_come_back_in_any_order_and_memory() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("vertices");
        let number = |index: usize| index as f32 + 0.25;
        let vertex = |index: usize| Vertex {
            position: [number(index), 1.0, 2.0],
            normal: [3.0, number(index), 4.0],
            color: [index as u8, 1, 2, 3],
            uv: [5.0, number(index)],
        };
        for bits in 0..8 {
            let carried = Carried { normals: bits & 1 > 0, colors: bits & 2 > 0, uvs: bits & 4 > 0 };
            let count = 2 * PAGE + 7;
            let mut file = Appended::open(&path, 0).unwrap();
            (0..count).for_each(|index| file.vertex(index as u32, &vertex(index), carried).unwrap());
            file.sync().unwrap();
            for memory in [0, 1 << 20] {
                let mut stored = Vertices::open(&path, carried, count, memory).unwrap();
                let mut columns = Columns::new(carried, count);
                for index in (0..count).step_by(97).chain([count - 1, 0, PAGE]) {
                    assert_eq!(stored.position(index as u32).unwrap(), vertex(index).position);
                    columns.push(stored.get(index as u32).unwrap());
                    let mesh = Mesh::with_attributes(
                        columns.positions.clone(),
                        Vec::new(),
                        columns.attributes.clone(),
                    );
                    let last = vertex_of(&mesh.unwrap(), columns.positions.len() - 1);
                    assert_eq!(last.normal, if carried.normals { vertex(index).normal } else { [0.0; 3] });
                    assert_eq!(last.color, if carried.colors { vertex(index).color } else { [0; 4] });
                    assert_eq!(last.uv, if carried.uvs { vertex(index).uv } else { [0.0; 2] });
                }
            }
        }
    }

    #[test]
    fn vertices_are_put_back_into_their_order() {
        let carried = Carried { uvs: true, ..Carried::default() };
        let ranks = [40, 10, 30, 20];
        let mut columns = Columns::new(carried, 4);
        for rank in ranks {
            let number = rank as f32;
            let vertex = Vertex { position: [number, 0.0, 0.0], uv: [0.0, number], ..Vertex::default() };
            let mut bytes = Vec::new();
            write_vertex(rank, &vertex, carried, &mut bytes).unwrap();
            assert_eq!(bytes.len(), vertex_bytes(carried));
            columns.push(&bytes);
        }
        let ranked = columns.into_mesh(vec![[0, 1, 2], [3, 2, 1]]).unwrap();
        assert_eq!(ranked.ranks, [10, 20, 30, 40]);
        assert_eq!(ranked.order, [1, 3, 2, 0]);
        assert_eq!(ranked.mesh.triangles(), [[1, 2, 0], [3, 0, 2]]);
        for (&rank, vertex) in ranked.ranks.iter().zip(0..) {
            let vertex = vertex_of(&ranked.mesh, vertex);
            assert_eq!((vertex.position[0], vertex.uv[1]), (rank as f32, rank as f32));
        }
    }

    #[test]
    fn a_file_that_lost_its_end_is_not_gone_on_with() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("triangles");
        let mut file = Appended::open(&path, 0).unwrap();
        (0..5).for_each(|corner| file.triangle([corner; 3]).unwrap());
        file.sync().unwrap();
        let mut file = Appended::open(&path, 2 * TRIANGLE).unwrap();
        file.triangle([9; 3]).unwrap();
        file.sync().unwrap();
        let mut triangles = Triangles::open(&path, 1, 2).unwrap();
        assert_eq!(triangles.next().unwrap(), Some([1; 3]));
        assert_eq!(triangles.next().unwrap(), Some([9; 3]));
        assert_eq!(triangles.next().unwrap(), None);
        assert!(Appended::open(&path, 4 * TRIANGLE).is_err());
        let mut triangles = Triangles::open(&path, 2, 2).unwrap();
        assert!(triangles.next().is_ok() && triangles.next().is_err());
    }
}
