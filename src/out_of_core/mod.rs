//! Meshes larger than memory: a PLY file to one of fewer triangles, by way of blocks on disk.
//!
//! 1. **Import** (`import.rs`): the file is read once, as a stream, into a file of vertices and one of triangles,
//!    in which anything can be looked up (`stored.rs`).
//! 2. **Rounds** (`round.rs`), until what is left fits the memory, or is as small as it shall be:
//!    - `cut.rs` divides the triangles among blocks that fit the memory, by a tree of cuts through space
//!      (`grid.rs`) that lies another way in each round, so that the seams of one are inside the blocks of the
//!      next;
//!    - each block (`block.rs`) is first followed down to see what it costs, then all are brought to the number
//!      of triangles at which the next collapse costs the same in each (`shares.rs`), as in one run over the
//!      whole, where the cheapest goes first. What a block has in common with others stays as it is.
//! 3. **The last run** is over all that is left, in memory, to the target. It takes the seams down, and evens out
//!    what blocks could not know of each other. Where the result itself is too large for that, the last rounds
//!    take its place: each is nearer to the target, so that the seams of the last are hardly denser than what is
//!    around them.
//!
//! A journal (`journal.rs`) says what is done, so that the same call goes on where another was ended.

mod block;
mod cut;
mod error;
mod grid;
mod import;
mod journal;
mod memory;
mod round;
mod shares;
mod stored;
mod vertex_set;

use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

pub use self::error::OutOfCoreError;
use self::journal::{Directory, Imported, Journal, Part, Task};
use self::memory::{BUFFER, Memory};
use self::round::{Setting, part};
use self::stored::{Columns, RANK, Stored, Triangles, Vertices, attribute_bytes};
use crate::hqms::{Options, Placement, Simplified, StoppedBy, Target, simplify};
use crate::io::{Encoding, FileError, Format, ReadError, WriteError, WriteOptions, ply, replace, write};
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use crate::workers::Workers;

/// Changes with what is stored in a work directory.
const VERSION: u32 = 1;

/// How much of all the work the import is, and the rest up to where it is written.
const IMPORTED: f32 = 0.15;
const SIMPLIFIED: f32 = 0.98;

/// The last run is over all that is left where it can take this many times the target...
const ROOM: f64 = 1.3;
/// ...and blocks are to leave so much of what it can take: vertices are counted by what they were on average.
const FILL: f64 = 0.9;
/// Without a last run, this is how far rounds go: to the second number, as a multiple of the target, from more
/// than the first.
const STEPS: [(f64, f64); 2] = [(2.0, 1.5), (1.2, 1.1)];
/// A round that does less than this of what it should is not followed by another.
const STALLED: f64 = 0.05;

/// What became of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Triangles of the input.
    pub triangles_in: usize,
    /// Vertices of the input.
    pub vertices_in: usize,
    /// Triangles of the output.
    pub triangles: usize,
    /// Vertices of the output.
    pub vertices: usize,
    /// Why it is as large as it is.
    pub stopped_by: StoppedBy,
    /// Estimated largest distance from the input, in units of the positions: the largest of each round and of
    /// the last run, added up.
    pub error: f32,
    /// Whether holes, handles or components had to be given up to meet the target.
    pub topology_changed: bool,
    /// How many times the mesh was cut into blocks.
    pub rounds: usize,
    /// How many blocks there were in all of the rounds together.
    pub blocks: usize,
    /// Whether the work of an earlier call was gone on with.
    pub resumed: bool,
}

/// The directory that [`simplify_file`] works in to write `output`: beside it, with `.work` after its name.
pub fn work_directory(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".work");
    name.into()
}

/// Whether there is work to go on with for `output`.
pub fn is_unfinished(output: &Path) -> bool {
    journal::has_journal(&work_directory(output))
}

/// Simplifies the PLY file `input` to the binary PLY file `output`, in about `memory` bytes at any time, however
/// large the file is.
///
/// Of the options, all but these must be the defaults: the target (triangles or a ratio), selection, topology,
/// `lock_boundary`, `keep_seams` and threads. The result is the same, byte for byte, for any number of threads;
/// it depends on `memory`, which says how large blocks are. Where the whole mesh fits, it is what [`simplify`]
/// makes of it.
///
/// - **What is promised of the result** is what [`simplify`] promises: no cracks, no new non-manifold edges, the
///   topology, the count. Vertices are one where the file has them as one, by their index. The topology is given
///   up, where the options allow it, in the last run only.
/// - **Attributes** that PLY files have are carried along. While there are blocks, seams between attributes, and
///   with them all borders of a mesh with attributes, stay as they are (unless `keep_seams` is off); so a mesh
///   whose result does not fit the memory keeps its borders to the end.
/// - **Memory**: the least is about 4 megabytes and 3 bits for each vertex of the input. What threads and the
///   system need for themselves does not count.
/// - **Disk**: about 40 bytes for each triangle of the input, in [`work_directory`], which must be empty,
///   missing, or left by a call with the same arguments that was ended: that is gone on with, from the last step
///   that was finished, and leads to the same result as if it had not been ended. It is removed once the output
///   is there. A journal that was left by other arguments, or another input (by its length and time), is an
///   error, and so is another process that works there.
/// - **Time** is linear in the triangles: with reading and writing three to four times that of
///   [`simplify`], where the result fits the memory.
///
/// Errors name the file. On an error what stood at `output` still does; and the work is kept where the same call
/// may yet succeed: after a cancel, and where the disk was full.
pub fn simplify_file(
    input: &Path,
    output: &Path,
    options: &Options,
    memory: usize,
    monitor: &mut Monitor,
) -> Result<Outcome, OutOfCoreError> {
    check(options)?;
    check_format(input, OutOfCoreError::Read)?;
    check_format(output, OutOfCoreError::Write)?;
    // Threads that cannot be had are no reason to begin.
    drop(Workers::new(options.threads)?);
    let task = task(input, options, memory)?;
    monitor.report(0.0)?;
    let (directory, mut journal, resumed) = Directory::open(&work_directory(output), task)?;
    match go_on(input, output, options, memory, &directory, &mut journal, monitor) {
        Ok(outcome) => {
            directory.remove_all(journal.rounds.len())?;
            // What is done is done.
            monitor.report(1.0).unwrap_or_default();
            Ok(Outcome { resumed, ..outcome })
        }
        Err(
            error @ (OutOfCoreError::Cancelled(_)
            | OutOfCoreError::Work { .. }
            | OutOfCoreError::Write(_)
            | OutOfCoreError::Threads(_)),
        ) => Err(error),
        // The same call would fail again: its work is of no use.
        Err(error) => {
            directory.remove_all(journal.rounds.len()).ok();
            Err(error)
        }
    }
}

/// Does what the journal does not say is done.
fn go_on(
    input: &Path,
    output: &Path,
    options: &Options,
    memory: usize,
    directory: &Directory,
    journal: &mut Journal,
    monitor: &mut Monitor,
) -> Result<Outcome, OutOfCoreError> {
    let imported = match &journal.imported {
        Some(imported) => imported.clone(),
        None => {
            let imported = import::import(input, directory, &mut part(monitor, 0.0..IMPORTED))?;
            journal.imported = Some(imported.clone());
            directory.save(journal)?;
            imported
        }
    };
    let memory = Memory::new(memory, attribute_bytes(imported.carried));
    let setting = Setting { options, memory, directory };
    let target = match options.target {
        Target::Ratio(ratio) => (imported.triangles_in as f64 * ratio) as usize,
        Target::Triangles(count) => count,
        Target::Vertices(_) | Target::MaxError(_) => 0,
    };
    let (stored, last) = reduce(&imported, target, journal, &setting, monitor)?;

    let rounds = journal.rounds.len();
    let mut outcome = Outcome {
        triangles_in: imported.triangles_in,
        vertices_in: imported.vertices,
        triangles: stored.triangles,
        vertices: stored.vertices,
        stopped_by: if stored.triangles <= target { StoppedBy::Target } else { StoppedBy::Stuck },
        error: journal.rounds.iter().map(journal::Round::error).sum(),
        topology_changed: false,
        rounds,
        blocks: journal.rounds.iter().map(|round| round.blocks.len()).sum(),
        resumed: false,
    };
    match last {
        Some(Simplified { mesh, stopped_by, error, topology_changed, .. }) => {
            monitor.report(SIMPLIFIED)?;
            let options = WriteOptions { encoding: Encoding::Binary };
            write(&mesh, output, &options).map_err(OutOfCoreError::Write)?;
            outcome.triangles = mesh.triangles().len();
            outcome.vertices = mesh.positions().len();
            outcome.stopped_by = stopped_by;
            outcome.error = (outcome.error + error).min(f32::MAX);
            outcome.topology_changed = topology_changed;
        }
        None => write_stored(&stored, rounds, directory, output, &mut part(monitor, SIMPLIFIED..1.0))?,
    }
    Ok(outcome)
}

/// Rounds, until what is left can be simplified in one run, or is small enough: what is left on disk, and, where
/// there was a last run, its result.
fn reduce(
    imported: &Imported,
    target: usize,
    journal: &mut Journal,
    setting: &Setting,
    monitor: &mut Monitor,
) -> Result<(Stored, Option<Simplified>), OutOfCoreError> {
    let Setting { options, memory, directory } = setting;
    let bounds = [imported.low, imported.high].map(|corner| corner.map(f32::from_bits));
    let carried = imported.carried;
    let mut stored = Stored { vertices: imported.vertices, triangles: imported.triangles, carried, bounds };
    let mut done = IMPORTED;
    for round in 0.. {
        let Stored { vertices, triangles, .. } = stored;
        let fits = memory.fits(triangles, vertices, target.min(triangles));
        let is_begun = journal.rounds.len() > round;
        if fits && !is_begun {
            let mesh = load(&stored, round, directory)?;
            let options = Options { target: Target::Triangles(target), ..(*options).clone() };
            let last = simplify(&mesh, &options, &mut part(monitor, done..SIMPLIFIED))?;
            return Ok((stored, Some(last)));
        }
        if !is_begun && is_over(journal, triangles, target) {
            break;
        }
        let per_triangle = vertices as f64 / triangles.max(1) as f64;
        let goal = goal(triangles, target, memory.most_at_once(per_triangle, target));
        // Nobody knows how many rounds there will be: each has most of what is left.
        let next = done + 0.75 * (SIMPLIFIED - done);
        if !journal.rounds.get(round).is_some_and(journal::Round::is_finished) {
            round::run(&stored, round, goal, journal, setting, &mut part(monitor, done..next))?;
        }
        directory.remove_round(round)?;
        let record = &journal.rounds[round];
        stored = Stored { vertices: record.vertices(), triangles: record.triangles(), ..stored };
        done = next;
    }
    Ok((stored, None))
}

/// Whether no further round would lead nearer to the target.
fn is_over(journal: &Journal, triangles: usize, target: usize) -> bool {
    let Some(last) = journal.rounds.last() else { return false };
    let before: usize = last.blocks.iter().map(|block| block.triangles).sum();
    let (wanted, removed) = (before.saturating_sub(last.goal), before - triangles);
    triangles <= target || (removed as f64) < STALLED * wanted as f64
}

/// How many triangles a round is to leave, of which one run could take `most`.
fn goal(triangles: usize, target: usize, most: usize) -> usize {
    if target as f64 * ROOM <= most as f64 {
        return ((most as f64 * FILL) as usize).max(target);
    }
    let multiple = triangles as f64 / target.max(1) as f64;
    let step = STEPS.iter().find(|(from, _)| multiple > *from);
    step.map_or(target, |(_, to)| (target as f64 * to) as usize)
}

/// All of a mesh on disk.
fn load(stored: &Stored, round: usize, directory: &Directory) -> Result<Mesh, OutOfCoreError> {
    let path = directory.path(Part::Vertices, round);
    let mut vertices = Vertices::open(&path, stored.carried, stored.vertices, 0)?;
    let mut columns = Columns::new(stored.carried, stored.vertices);
    for vertex in 0..stored.vertices {
        columns.push(vertices.get(vertex as u32)?);
    }
    let mut triangles = Vec::with_capacity(stored.triangles);
    let mut on_disk = Triangles::open(&directory.path(Part::Triangles, round), 0, stored.triangles)?;
    while let Some(corners) = on_disk.next()? {
        triangles.push(corners);
    }
    Ok(columns.into_mesh(triangles)?.mesh)
}

/// Copies a mesh on disk to the output.
fn write_stored(
    stored: &Stored,
    round: usize,
    directory: &Directory,
    output: &Path,
    monitor: &mut Monitor,
) -> Result<(), OutOfCoreError> {
    let path = directory.path(Part::Vertices, round);
    let mut vertices = Vertices::open(&path, stored.carried, stored.vertices, 0)?;
    let mut triangles = Triangles::open(&directory.path(Part::Triangles, round), 0, stored.triangles)?;
    monitor.report(0.0)?;
    let mut failure = None;
    let written = replace(output, |file| {
        let mut writer = BufWriter::with_capacity(BUFFER, file);
        let Stored { carried, vertices: count, triangles: faces, .. } = *stored;
        ply::write_header(Encoding::Binary, count, carried, faces, &mut writer)?;
        let mut fail = |error| {
            failure = Some(error);
            // Nobody is told of this one.
            WriteError::Io(std::io::ErrorKind::Other.into())
        };
        for vertex in 0..count {
            writer.write_all(&vertices.get(vertex as u32).map_err(&mut fail)?[RANK..])?;
        }
        while let Some(corners) = triangles.next().map_err(&mut fail)? {
            let mut face = [3; 13];
            face[1..].copy_from_slice(corners.map(u32::to_le_bytes).as_flattened());
            writer.write_all(&face)?;
        }
        Ok(writer.flush()?)
    });
    failure.map_or(Ok(()), Err)?;
    written.map_err(OutOfCoreError::Write)
}

fn check(options: &Options) -> Result<(), OutOfCoreError> {
    let invalid = |message: &str| Err(OutOfCoreError::InvalidOption(message.to_owned()));
    match options.target {
        Target::Triangles(_) => {}
        Target::Ratio(ratio) if (0.0..=1.0).contains(&ratio) => {}
        Target::Ratio(ratio) => return invalid(&format!("ratio {ratio} is not between 0 and 1")),
        Target::Vertices(_) | Target::MaxError(_) => {
            return invalid("out of core, the target is a number of triangles or a ratio");
        }
    }
    if options.placement != Placement::Optimal {
        return invalid("out of core, vertices move (Placement::Optimal)");
    }
    let Options { target, selection, topology, lock_boundary, keep_seams, threads, .. } = options.clone();
    let rest = Options { selection, topology, lock_boundary, keep_seams, threads, ..Options::new(target) };
    if *options != rest {
        return invalid(
            "out of core, the options are a target, the selection, the topology, lock_boundary, keep_seams and \
             threads alone: locks, groups, weights and tracks are for meshes in memory",
        );
    }
    Ok(())
}

fn check_format(path: &Path, failure: fn(FileError) -> OutOfCoreError) -> Result<(), OutOfCoreError> {
    match Format::from_path(path).map_err(failure)? {
        Format::Ply => Ok(()),
        _ => Err(OutOfCoreError::InvalidOption(format!(
            "{}: out of core, files are read and written as PLY alone",
            path.display()
        ))),
    }
}

/// What is asked for, as the journal has it.
fn task(input: &Path, options: &Options, memory: usize) -> Result<Task, OutOfCoreError> {
    let read = || {
        let metadata = fs::metadata(input)?;
        if !metadata.is_file() {
            return Err(ReadError::Unsupported("what is no ordinary file".to_owned()));
        }
        let modified = metadata.modified()?.duration_since(UNIX_EPOCH).unwrap_or_default();
        Ok(Task {
            version: VERSION,
            input: fs::canonicalize(input)?,
            input_bytes: metadata.len(),
            input_modified: (modified.as_secs(), modified.subsec_nanos()),
            target: format!("{:?}", options.target),
            options: format!(
                "{:?}, {:?}, lock_boundary: {}, keep_seams: {}",
                options.selection, options.topology, options.lock_boundary, options.keep_seams
            ),
            memory,
        })
    };
    let failure = |source| OutOfCoreError::Read(FileError::Read { path: input.to_owned(), source });
    read().map_err(failure)
}
