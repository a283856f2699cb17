//! A mesh on disk, cut into blocks on disk.
//!
//! Any division of the triangles would do for the seams to close: vertices are known by their index, and one
//! that has triangles in several blocks is *shared*. Cuts in space make few of them.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};

use super::OutOfCoreError;
use super::error::work;
use super::grid::{Cuts, Grid};
use super::journal::{Block, Directory, Part, Round};
use super::memory::{BUFFER, Memory};
use super::stored::{Appended, Stored, TRIANGLE, Triangles, Vertices};
use super::vertex_set::{VertexBits, VertexSet};
use crate::monitor::Monitor;

/// Triangles between two looks at the monitor.
const BATCH: usize = 1 << 16;
/// A cell for so many triangles, up to a few million: blocks are a whole number of cells.
const TRIANGLES_PER_CELL: usize = 8;
/// How often blocks are cut smaller for having more vertices than was expected.
const ATTEMPTS: usize = 8;

/// Cuts the mesh that a round begins with; what is left of it is to have `goal` triangles.
pub(super) fn cut(
    mesh: &Stored,
    round: usize,
    goal: usize,
    memory: &Memory,
    directory: &Directory,
    monitor: &mut Monitor,
) -> Result<Round, OutOfCoreError> {
    let mut limit = memory.block_triangles(mesh.vertices, mesh.triangles)?;
    let most_cells = memory.for_cutting() / 16;
    let grid = Grid::new(mesh.bounds, round, most_cells.min(mesh.triangles / TRIANGLES_PER_CELL));
    let histogram = find_cells(mesh, round, &grid, memory, directory, monitor)?;
    let mut attempt = 0;
    loop {
        let cuts = Cuts::new(&grid, &histogram, limit);
        let counts = cuts.counts().to_vec();
        distribute(mesh, round, cuts, memory, directory, monitor)?;
        let (vertices, shared) = find_shared(mesh, round, &counts, directory, monitor)?;
        let checked = counts.iter().zip(&vertices);
        let checked = checked.map(|(&count, &own)| memory.check_block(mesh.vertices, count, own));
        let checked: Result<(), OutOfCoreError> = checked.collect();
        attempt += 1;
        if checked.is_ok() || attempt == ATTEMPTS {
            checked?;
            directory.remove(Part::Cells, round)?;
            let block = |(triangles, vertices)| Block { triangles, vertices, prices: Vec::new(), done: None };
            return Ok(Round { goal, shared, blocks: counts.into_iter().zip(vertices).map(block).collect() });
        }
        limit -= limit / 4;
    }
}

/// The vertices that are of several blocks of a round.
pub(super) fn read_shared(
    vertices: usize,
    round: usize,
    directory: &Directory,
) -> Result<VertexSet, OutOfCoreError> {
    let path = directory.path(Part::Shared, round);
    let file = File::open(&path).map_err(work(&path))?;
    let bits = VertexBits::read(vertices, &mut BufReader::with_capacity(BUFFER, file));
    bits.map(VertexSet::new).map_err(work(&path))
}

/// Writes down the cell of each triangle; how many each cell has.
fn find_cells(
    mesh: &Stored,
    round: usize,
    grid: &Grid,
    memory: &Memory,
    directory: &Directory,
    monitor: &mut Monitor,
) -> Result<Vec<u32>, OutOfCoreError> {
    let path = directory.path(Part::Vertices, round);
    let mut vertices = Vertices::open(&path, mesh.carried, mesh.vertices, memory.for_cutting())?;
    let mut triangles = Triangles::open(&directory.path(Part::Triangles, round), 0, mesh.triangles)?;
    let mut cells = Appended::open(&directory.path(Part::Cells, round), 0)?;
    let mut histogram = vec![0u32; grid.cells()];
    let mut seen = 0;
    while let Some([a, b, c]) = triangles.next()? {
        let cell = grid.cell([vertices.position(a)?, vertices.position(b)?, vertices.position(c)?]);
        histogram[cell as usize] += 1;
        cells.bytes(&cell.to_le_bytes())?;
        seen += 1;
        if seen % BATCH == 0 {
            monitor.report(0.5 * seen as f32 / mesh.triangles as f32)?;
        }
    }
    cells.flush()?;
    Ok(histogram)
}

/// Puts the triangles of each block together, in the order that the mesh has them in.
fn distribute(
    mesh: &Stored,
    round: usize,
    mut cuts: Cuts,
    memory: &Memory,
    directory: &Directory,
    monitor: &mut Monitor,
) -> Result<(), OutOfCoreError> {
    let cells_path = directory.path(Part::Cells, round);
    let cells = File::open(&cells_path).map_err(work(&cells_path))?;
    let mut cells = BufReader::with_capacity(BUFFER, cells);
    let mut triangles = Triangles::open(&directory.path(Part::Triangles, round), 0, mesh.triangles)?;
    let path = directory.path(Part::Blocks, round);
    let mut file = File::create(&path).map_err(work(&path))?;

    // Each block has its place in the file, which fills up front to back.
    let count = cuts.counts().len();
    let room = (memory.for_cutting() / count.max(1)).clamp(16 * TRIANGLE, BUFFER);
    let mut start = 0;
    let places = cuts.counts().iter().map(|&count| {
        let place = start;
        start += (count * TRIANGLE) as u64;
        (place, Vec::with_capacity(room))
    });
    let mut places: Vec<(u64, Vec<u8>)> = places.collect();
    let mut put = |(place, bytes): &mut (u64, Vec<u8>)| {
        file.seek(SeekFrom::Start(*place))?;
        file.write_all(bytes)?;
        *place += bytes.len() as u64;
        bytes.clear();
        Ok(())
    };
    let mut seen = 0;
    while let Some(corners) = triangles.next()? {
        let mut cell = [0; 4];
        cells.read_exact(&mut cell).map_err(work(&cells_path))?;
        let place = &mut places[cuts.block(u32::from_le_bytes(cell))];
        if place.1.len() + TRIANGLE > room {
            put(place).map_err(work(&path))?;
        }
        place.1.extend_from_slice(corners.map(u32::to_le_bytes).as_flattened());
        seen += 1;
        if seen % BATCH == 0 {
            monitor.report(0.5 + 0.3 * seen as f32 / mesh.triangles as f32)?;
        }
    }
    places.iter_mut().try_for_each(&mut put).map_err(work(&path))?;
    file.sync_data().map_err(work(&path))
}

/// How many vertices each block has, and how many are of several, which are written down.
fn find_shared(
    mesh: &Stored,
    round: usize,
    counts: &[usize],
    directory: &Directory,
    monitor: &mut Monitor,
) -> Result<(Vec<usize>, usize), OutOfCoreError> {
    let path = directory.path(Part::Blocks, round);
    let mut seen = VertexBits::new(0..mesh.vertices);
    let mut shared = VertexBits::new(0..mesh.vertices);
    let mut vertices = Vec::with_capacity(counts.len());
    let mut first = 0;
    for &count in counts {
        let mut triangles = Triangles::open(&path, first, count)?;
        let mut own = VertexBits::new(0..mesh.vertices);
        while let Some(corners) = triangles.next()? {
            corners.iter().for_each(|&vertex| own.insert(vertex));
        }
        seen.add(&own, &mut shared);
        vertices.push(own.count());
        first += count;
        monitor.report(0.8 + 0.2 * first as f32 / mesh.triangles as f32)?;
    }
    let path = directory.path(Part::Shared, round);
    let write = || {
        let mut writer = BufWriter::with_capacity(BUFFER, File::create(&path)?);
        shared.write(&mut writer)?;
        writer.flush()?;
        writer.get_ref().sync_data()
    };
    write().map_err(work(&path))?;
    Ok((vertices, shared.count()))
}
