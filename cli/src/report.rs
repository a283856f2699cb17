//! What the command says: records that become JSON, and tables for people.

use std::io::{ErrorKind, Write};
use std::path::Path;

use comfy_table::{CellAlignment, Table, presets};
use decimesh::deviation::Bound;
use decimesh::{Mesh, Simplified, StoppedBy};
use serde::Serialize;

use crate::failure::Failure;
use crate::files::directory_of;

/// What `simplify --report` writes.
#[derive(Debug, Serialize)]
pub(crate) struct SimplifyReport {
    /// Triangles that went into the simplification, after welding.
    pub(crate) triangles_in: usize,
    /// Vertices that went into the simplification, after welding.
    pub(crate) vertices_in: usize,
    pub(crate) triangles_out: usize,
    pub(crate) vertices_out: usize,
    /// Of the simplification alone.
    pub(crate) seconds: f64,
    /// Of reading and, where asked for, welding.
    pub(crate) seconds_read: f64,
    pub(crate) seconds_write: f64,
    /// The highest point of the simplification above what was allocated when it began.
    pub(crate) peak_bytes: usize,
    /// Threads asked for, or all of the machine's where none were.
    pub(crate) threads: usize,
    pub(crate) stopped_by: &'static str,
    /// Vertices that were not to move: borders and seams.
    pub(crate) locked: usize,
    pub(crate) topology_changed: bool,
    /// Estimated, in units of the positions; measured for the engine multiple-choice; with `--certify` the bound.
    pub(crate) error: f32,
    /// With `--certify`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) bound: Option<BoundReport>,
    /// Estimated, weighted; 0 where no attribute has a weight.
    pub(crate) attribute_error: f32,
    pub(crate) passes: usize,
}

/// What `compare --bound` and `simplify --certify` add: no point is farther away than `upper`, and some are as far
/// as `lower`.
#[derive(Debug, Serialize)]
pub(crate) struct BoundReport {
    pub(crate) lower: f64,
    pub(crate) upper: f64,
    /// By the diagonal of the first mesh; null where it has none, and so the next.
    pub(crate) lower_rel: f64,
    pub(crate) upper_rel: f64,
}

impl From<Bound> for BoundReport {
    fn from(bound: Bound) -> Self {
        let (lower_rel, upper_rel) = (bound.lower_rel(), bound.upper_rel());
        Self { lower: bound.lower, upper: bound.upper, lower_rel, upper_rel }
    }
}

/// What `levels --report` writes.
#[derive(Debug, Serialize)]
pub(crate) struct LevelsReport {
    pub(crate) triangles_in: usize,
    pub(crate) vertices_in: usize,
    /// Of making all levels, without reading, measuring and writing.
    pub(crate) seconds: f64,
    pub(crate) peak_bytes: usize,
    pub(crate) levels: Vec<LevelReport>,
    /// With `--nested`: the file of all levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) nested: Option<NestedReport>,
    /// With `--progressive`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) progressive: Option<ProgressiveReport>,
}

#[derive(Debug, Serialize)]
pub(crate) struct NestedReport {
    pub(crate) file: String,
    pub(crate) bytes: u64,
    /// For each level, from the input on, where its prefix of the vertices ends.
    pub(crate) vertices: Vec<usize>,
    /// For each level, from the input on, what the file says: estimated, or a bound where `certified`.
    pub(crate) errors: Vec<f32>,
    pub(crate) certified: bool,
}

#[derive(Debug, Serialize)]
pub(crate) struct ProgressiveReport {
    pub(crate) file: String,
    pub(crate) bytes: u64,
    /// The file's bytes by the vertices of the finest level.
    pub(crate) bytes_per_vertex: f64,
    /// Splits from the coarsest level to the finest.
    pub(crate) steps: usize,
    /// Of making it from the collapses, without writing.
    pub(crate) seconds: f64,
}

/// What `play --report` writes.
#[derive(Debug, Serialize)]
pub(crate) struct PlayReport {
    pub(crate) triangles: usize,
    pub(crate) vertices: usize,
    /// Splits done since the coarsest level...
    pub(crate) step: usize,
    /// ...of so many that were read: no more than the level needs, where that is known beforehand.
    pub(crate) steps: usize,
    /// Of a numbered level, in units of the positions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) error: Option<f32>,
    pub(crate) seconds_read: f64,
    /// Of playing the splits.
    pub(crate) seconds: f64,
    pub(crate) seconds_write: f64,
}

#[derive(Debug, Serialize)]
pub(crate) struct LevelReport {
    /// 1 is the finest.
    pub(crate) level: usize,
    pub(crate) file: String,
    pub(crate) triangles: usize,
    pub(crate) vertices: usize,
    pub(crate) stopped_by: &'static str,
    pub(crate) topology_changed: bool,
    /// Estimated, in units of the positions.
    pub(crate) error: f32,
    /// Measured distance from the input in units of the positions; absent with `--no-measure`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rms: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) max: Option<f64>,
}

/// The word for it in reports.
pub(crate) fn stopped_by(reason: StoppedBy) -> &'static str {
    match reason {
        StoppedBy::Target => "target",
        StoppedBy::Error => "error",
        StoppedBy::Stuck => "stuck",
        _ => "other",
    }
}

/// How many threads there are where so many were asked for.
pub(crate) fn threads(asked: usize) -> usize {
    match asked {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        some => some,
    }
}

/// Tells the user, on the error stream, that an output has more triangles than were asked for.
pub(crate) fn warn_of_size(name: &str, triangles: usize) {
    eprintln!(
        "decimesh: warning: {name} has {triangles} triangles, more than asked for: every further collapse would \
         change the topology, fold a face over, or move a locked vertex"
    );
}

/// Tells the user, on the error stream, where `result` is not what was asked for.
pub(crate) fn warn_if_stuck(name: &str, result: &Simplified) {
    if result.stopped_by == StoppedBy::Stuck {
        warn_of_size(name, result.mesh.triangles().len());
        if result.locked > 0 {
            eprintln!(
                "decimesh: {} vertices of the input were locked, as borders or as seams between \
                 attributes; --weld makes seams one surface, --open-seams lets them part",
                grouped(result.locked)
            );
        }
    }
}

/// Writes `record` to `path` as JSON, whole or not at all.
pub(crate) fn write_json(path: &Path, record: &impl Serialize) -> Result<(), Failure> {
    write_atomically(path, json(record)?.as_bytes())
}

/// `record` as JSON text.
pub(crate) fn json(record: &impl Serialize) -> Result<String, Failure> {
    let text =
        serde_json::to_string_pretty(record).map_err(|error| Failure::Unexpected(error.to_string()))?;
    Ok(text + "\n")
}

/// Replaces the file at `path` by `bytes` in one step.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let write = || {
        let mut file = new_file(directory_of(path))?;
        file.write_all(bytes)?;
        file.persist(path)?;
        Ok(())
    };
    write().map_err(Failure::write(path))
}

/// A temporary file with the permissions that an ordinary new file would have.
fn new_file(directory: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(directory)
}

/// Prints to the output stream. That nobody reads on is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::write(Path::new("the standard output"))(error))
        }
        _ => Ok(()),
    }
}

/// A plain table whose columns, but for the first `left`, are aligned to the right.
pub(crate) fn table(header: &[&str], left: usize, rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_header(header.iter().copied()).add_rows(rows);
    for column in table.column_iter_mut().skip(left) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// `count` with separators of thousands.
pub(crate) fn grouped(count: usize) -> String {
    indicatif::HumanCount(count as u64).to_string()
}

/// Triangles and vertices of `mesh`, for a sentence.
pub(crate) fn size(mesh: &Mesh) -> String {
    format!("{} triangles, {} vertices", grouped(mesh.triangles().len()), grouped(mesh.positions().len()))
}

/// A share of the diagonal in percent, with digits enough to tell small ones apart.
pub(crate) fn percent(share: f64) -> String {
    format!("{} %", significant(share * 100.0))
}

/// `value` with three significant digits and no exponent where that can be read.
pub(crate) fn significant(value: f64) -> String {
    let magnitude = value.abs().log10().floor();
    if value == 0.0 {
        "0".to_owned()
    } else if (-5.0..6.0).contains(&magnitude) {
        format!("{value:.*}", (2.0 - magnitude).max(0.0) as usize)
    } else {
        format!("{value:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_say_enough() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1.00"),
            (0.001234, "0.00123"),
            (123456.0, "123456"),
            (1.5e9, "1.50e9"),
            (2.5e-9, "2.50e-9"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(significant(value), text);
        }
    }

    #[test]
    fn file_is_replaced_whole_or_left_alone() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("report.json");
        write_atomically(&path, b"one").unwrap();
        write_atomically(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert!(write_atomically(&directory.path().join("missing/report.json"), b"three").is_err());
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }
}
