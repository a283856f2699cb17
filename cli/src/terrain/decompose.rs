//! `decimesh decompose`: heights become a hierarchy in a file.

use std::time::Instant;

use decimesh::rate_distortion::{Decomposition, DecompositionOptions};

use super::arguments::DecomposeArguments;
use super::report::DecomposeReport;
use crate::allocation::peak_bytes;
use crate::failure::Failure;
use crate::files::{bytes, check_directory};
use crate::progress::Progress;
use crate::report::{grouped, print, write_json};

pub(crate) fn run(arguments: &DecomposeArguments) -> Result<(), Failure> {
    let DecomposeArguments { input, output, heights, threads, quiet, .. } = arguments;
    check_directory(output)?;
    arguments.report.as_deref().map_or(Ok(()), check_directory)?;

    let begin = Instant::now();
    let field = heights.read(input)?;
    let seconds_read = begin.elapsed().as_secs_f64();

    let options = DecompositionOptions { threads: *threads, ..DecompositionOptions::default() };
    let progress = Progress::new(*quiet);
    let begin = Instant::now();
    let (decomposition, peak_bytes) =
        peak_bytes(|| progress.during("decomposing", |monitor| Decomposition::new(field, &options, monitor)));
    let seconds = begin.elapsed().as_secs_f64();
    let decomposition = decomposition?;

    let begin = Instant::now();
    decomposition.write(output).map_err(Failure::Write)?;
    let seconds_write = begin.elapsed().as_secs_f64();

    let (field, bytes) = (decomposition.field(), bytes(output)?);
    let report = DecomposeReport {
        columns: field.columns(),
        rows: field.rows(),
        samples: decomposition.samples(),
        bytes,
        bytes_per_sample: bytes as f64 / field.heights().len() as f64,
        seconds,
        seconds_read,
        seconds_write,
        peak_bytes,
    };
    if let Some(path) = &arguments.report {
        write_json(path, &report)?;
    }
    if !quiet {
        print(&format!(
            "{} samples decomposed in {seconds:.3} s, {} bytes ({:.1} a sample)\n",
            grouped(report.samples),
            grouped(bytes as usize),
            report.bytes_per_sample,
        ))?;
    }
    Ok(())
}
