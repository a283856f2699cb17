//! `decimesh simplify --memory`: a file that may be larger than memory.

use std::time::Instant;

use decimesh::StoppedBy;
use decimesh::out_of_core::{OutOfCoreError, Outcome, is_unfinished, simplify_file, work_directory};
use serde::Serialize;

use crate::allocation::peak_bytes;
use crate::arguments::{EngineName, MemorySize, SimplifyArguments};
use crate::failure::Failure;
use crate::files::{check_directory, check_output};
use crate::progress::Progress;
use crate::report::{self, grouped, significant};

/// What `--report` writes.
#[derive(Debug, Serialize)]
struct OutOfCoreReport {
    triangles_in: usize,
    vertices_in: usize,
    triangles_out: usize,
    vertices_out: usize,
    /// Of all of it, reading and writing included; of this run alone where it went on with another's work.
    seconds: f64,
    memory: usize,
    /// The highest point of what was allocated.
    peak_bytes: usize,
    threads: usize,
    stopped_by: &'static str,
    topology_changed: bool,
    /// Estimated, in units of the positions.
    error: f32,
    /// How many times the mesh was cut into blocks, and how many there were in all.
    rounds: usize,
    blocks: usize,
    resumed: bool,
}

pub(crate) fn run(arguments: &SimplifyArguments, MemorySize(memory): MemorySize) -> Result<(), Failure> {
    let SimplifyArguments { input, output, target, engine, .. } = arguments;
    engine.check()?;
    check_output(output)?;
    arguments.report.as_deref().map_or(Ok(()), check_directory)?;
    for (refused, why) in [
        (engine.engine != EngineName::Hqms, "--memory is for --engine hqms"),
        (engine.weld().is_some(), "--weld takes the whole mesh: it cannot be had with --memory"),
        (arguments.verify, "--verify takes the whole mesh: it cannot be had with --memory"),
        (engine.ascii, "--memory writes binary PLY: it cannot be had with --ascii"),
    ] {
        if refused {
            return Err(Failure::Options(why.to_owned()));
        }
    }
    // A bound by the diagonal is refused as any bound is: there is none to know yet.
    let options = engine.options(target.target(f64::NAN));
    if is_unfinished(output) && !arguments.quiet {
        eprintln!("decimesh: going on with unfinished work in {}", work_directory(output).display());
    }
    let progress = Progress::new(arguments.quiet);
    let begin = Instant::now();
    let (outcome, peak_bytes) = peak_bytes(|| {
        progress.during("simplifying", |monitor| simplify_file(input, output, &options, memory, monitor))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let outcome = outcome?;
    if outcome.stopped_by == StoppedBy::Stuck {
        report::warn_of_size(&output.display().to_string(), outcome.triangles);
    }
    let report = OutOfCoreReport {
        triangles_in: outcome.triangles_in,
        vertices_in: outcome.vertices_in,
        triangles_out: outcome.triangles,
        vertices_out: outcome.vertices,
        seconds,
        memory,
        peak_bytes,
        threads: report::threads(options.threads),
        stopped_by: report::stopped_by(outcome.stopped_by),
        topology_changed: outcome.topology_changed,
        error: outcome.error,
        rounds: outcome.rounds,
        blocks: outcome.blocks,
        resumed: outcome.resumed,
    };
    if let Some(path) = &arguments.report {
        report::write_json(path, &report)?;
    }
    if !arguments.quiet {
        report::print(&summary(&report, &outcome))?;
    }
    Ok(())
}

fn summary(report: &OutOfCoreReport, outcome: &Outcome) -> String {
    let OutOfCoreReport { seconds, blocks, rounds, peak_bytes, .. } = *report;
    let topology = if outcome.topology_changed { "topology changed" } else { "topology kept" };
    let parts = match rounds {
        0 => "in one run".to_owned(),
        1 => format!("in {} blocks", grouped(blocks)),
        _ => format!("in {} blocks of {rounds} rounds", grouped(blocks)),
    };
    format!(
        "{} -> {} triangles {parts} in {seconds:.3} s and {} MB, error about {}, stopped by {}, {topology}\n",
        grouped(report.triangles_in),
        grouped(report.triangles_out),
        grouped(peak_bytes >> 20),
        significant(f64::from(report.error)),
        report.stopped_by,
    )
}

impl From<OutOfCoreError> for Failure {
    fn from(error: OutOfCoreError) -> Self {
        match error {
            OutOfCoreError::Read(error) => Self::Read(error),
            OutOfCoreError::Write(error) => Self::Write(error),
            OutOfCoreError::Work { path, source } => Self::WriteOther { path, source },
            OutOfCoreError::Occupied { .. } => Self::Occupied(error.to_string()),
            OutOfCoreError::TooLittleMemory { .. }
            | OutOfCoreError::InvalidOption(_)
            | OutOfCoreError::Threads(_) => Self::Options(error.to_string()),
            other => Self::Unexpected(other.to_string()),
        }
    }
}
