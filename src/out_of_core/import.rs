//! A PLY file to a mesh on disk, in one go and in little memory.

use std::fs::File;
use std::io;
use std::path::Path;

use super::OutOfCoreError;
use super::journal::{Directory, Imported, Part};
use super::stored::Appended;
use crate::io::ply::{self, Carried, Sink, Vertex};
use crate::io::source::Source;
use crate::io::{FileError, ReadError, unit};
use crate::mesh::topology::is_face;
use crate::mesh::{Mesh, MeshError};
use crate::monitor::Monitor;

/// Rows between two looks at the monitor.
const BATCH: usize = 1 << 16;

/// Takes over the file at `path`, as reading it whole would: but for triangles that name a vertex twice, which
/// no simplification keeps.
pub(super) fn import(
    path: &Path,
    directory: &Directory,
    monitor: &mut Monitor,
) -> Result<Imported, OutOfCoreError> {
    let read_error =
        |source: ReadError| OutOfCoreError::Read(FileError::Read { path: path.to_owned(), source });
    let mut import = Import {
        vertices: Appended::open(&directory.path(Part::Vertices, 0), 0)?,
        triangles: Appended::open(&directory.path(Part::Triangles, 0), 0)?,
        carried: Carried::default(),
        counts: Counts::default(),
        low: [f32::INFINITY; 3],
        high: [f32::NEG_INFINITY; 3],
        expected: [0, 0],
        monitor,
        failure: None,
    };
    let mut file = File::open(path).map_err(|error| read_error(error.into()))?;
    let length = file.metadata().map_err(|error| read_error(error.into()))?.len();
    let mut source = Source::new(&mut file, Some(length));
    let read = match source.peek(1).map(<[u8]>::is_empty) {
        Ok(true) => Err(source.error_here("the file is empty")),
        _ => ply::stream(&mut source, &mut import),
    };
    if let Some(failure) = import.failure {
        return Err(failure);
    }
    read.map_err(read_error)?;
    import.vertices.sync()?;
    import.triangles.sync()?;
    let Counts { vertices, triangles, faces } = import.counts;
    Ok(Imported {
        triangles_in: triangles,
        vertices,
        triangles: faces,
        carried: import.carried,
        low: import.low.map(f32::to_bits),
        high: import.high.map(f32::to_bits),
    })
}

#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    vertices: usize,
    triangles: usize,
    /// Triangles with three different corners.
    faces: usize,
}

struct Import<'a, 'b> {
    vertices: Appended,
    triangles: Appended,
    carried: Carried,
    counts: Counts,
    low: [f32; 3],
    high: [f32; 3],
    /// Vertices and triangles that the file promises, as far as it has done so.
    expected: [usize; 2],
    monitor: &'a mut Monitor<'b>,
    /// What went wrong that is not the file's fault.
    failure: Option<OutOfCoreError>,
}

impl Import<'_, '_> {
    /// Ends the reading with an error that is not told: `failure` is.
    fn fail(&mut self, failure: OutOfCoreError) -> ReadError {
        self.failure = Some(failure);
        io::Error::from(io::ErrorKind::Interrupted).into()
    }

    fn report(&mut self) -> Result<(), ReadError> {
        let Counts { vertices, triangles, .. } = self.counts;
        if !(vertices + triangles).is_multiple_of(BATCH) {
            return Ok(());
        }
        // Where one of them is yet to come, as many are expected as a closed mesh has.
        let [expected_vertices, expected_triangles] = self.expected;
        let expected = match self.expected {
            [count, 0] => 3 * count,
            [0, count] => count + count / 2,
            _ => expected_vertices + expected_triangles,
        };
        let fraction = (vertices + triangles) as f32 / expected.max(1) as f32;
        match self.monitor.report(fraction) {
            Ok(()) => Ok(()),
            Err(cancelled) => Err(self.fail(cancelled.into())),
        }
    }
}

impl Sink for Import<'_, '_> {
    fn begin_vertices(&mut self, carried: Carried, room: usize) -> Result<(), ReadError> {
        self.carried = carried;
        self.expected[0] = room;
        Ok(())
    }

    fn vertex(&mut self, vertex: &Vertex) -> Result<(), ReadError> {
        let finite = |what, values: &[f32]| match values.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err(MeshError::NotFinite { what, vertex: self.counts.vertices }),
        };
        finite("position", &vertex.position)?;
        let mut vertex = *vertex;
        if self.carried.normals {
            finite("normal", &vertex.normal)?;
            vertex.normal = unit(vertex.normal).unwrap_or(vertex.normal);
        }
        if self.carried.uvs {
            finite("uv", &vertex.uv)?;
        }
        for (axis, &x) in vertex.position.iter().enumerate() {
            self.low[axis] = self.low[axis].min(x);
            self.high[axis] = self.high[axis].max(x);
        }
        // There are no more than 32 bits can count.
        let rank = self.counts.vertices as u32;
        if let Err(failure) = self.vertices.vertex(rank, &vertex, self.carried) {
            return Err(self.fail(failure));
        }
        self.counts.vertices += 1;
        self.report()
    }

    fn begin_triangles(&mut self, room: usize) -> Result<(), ReadError> {
        self.expected[1] += room;
        Ok(())
    }

    fn triangle(&mut self, corners: [u32; 3]) -> Result<(), ReadError> {
        self.counts.triangles += 1;
        if is_face(&corners) {
            if let Err(failure) = self.triangles.triangle(corners) {
                return Err(self.fail(failure));
            }
            self.counts.faces += 1;
        }
        let limit = Mesh::MAX_TRIANGLES;
        if self.counts.triangles > limit {
            let count = self.counts.triangles;
            return Err(MeshError::TooLarge { what: "triangles", count, limit }.into());
        }
        self.report()
    }
}
