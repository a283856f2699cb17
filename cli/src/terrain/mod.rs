//! `decimesh terrain`: heights over a grid become a mesh. `decompose` and `extract` do the same in two steps.

mod arguments;
mod decompose;
mod extract;
mod plot;
mod report;

use std::path::Path;
use std::time::Instant;

use decimesh::rate_distortion::{Approximation, Decomposition, DecompositionOptions, Error, HeightFileError};

pub(crate) use arguments::{DecomposeArguments, ExtractArguments, TerrainArguments};
pub(crate) use decompose::run as decompose;
pub(crate) use extract::run as extract;

use crate::allocation::peak_bytes;
use crate::failure::Failure;
use crate::files::{check_directory, check_output, write};
use crate::progress::Progress;
use crate::report::{print, write_json};
use arguments::CommonArguments;
use report::{MeasuredError, TerrainReport, certified_gap, summary};

pub(crate) fn run(arguments: &TerrainArguments) -> Result<(), Failure> {
    let TerrainArguments { input, output, detail, heights, plot, common } = arguments;
    check_output(output)?;
    common.report.as_deref().map_or(Ok(()), check_directory)?;
    plot.as_deref().map_or(Ok(()), check_directory)?;

    let begin = Instant::now();
    let field = heights.read(input)?;
    let seconds_read = begin.elapsed().as_secs_f64();

    let detail = detail.detail();
    let options = DecompositionOptions { threads: common.threads, ..DecompositionOptions::default() };
    let progress = Progress::new(common.quiet);
    let begin = Instant::now();
    let (result, peak_bytes) = peak_bytes(|| -> Result<_, Error> {
        let decomposition = progress
            .during("decomposing", |monitor| Decomposition::new(field, &options, monitor))?;
        let approximation = decomposition.at(detail)?;
        Ok((decomposition, approximation))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let (decomposition, approximation) = result?;

    let seconds_write = write_mesh(&approximation, output, common)?;
    if let Some(path) = plot {
        plot::write(&decomposition, &approximation, path)?;
    }
    let report = TerrainReport {
        certified_gap_db: certified_gap(&decomposition, detail, approximation.mesh.positions().len()),
        seconds,
        seconds_read: Some(seconds_read),
        seconds_write,
        peak_bytes,
        ..TerrainReport::of(&decomposition, &approximation)
    };
    tell(&report, common)
}

impl TerrainReport {
    /// What is known of a mesh without a clock.
    fn of(decomposition: &Decomposition, approximation: &Approximation) -> Self {
        let field = decomposition.field();
        Self {
            columns: field.columns(),
            rows: field.rows(),
            samples: decomposition.samples(),
            vertices_out: approximation.mesh.positions().len(),
            triangles_out: approximation.mesh.triangles().len(),
            error: MeasuredError::of(field, approximation),
            certified_gap_db: None,
            seconds: 0.0,
            seconds_read: None,
            seconds_write: 0.0,
            peak_bytes: 0,
        }
    }
}

/// Writes the mesh, and answers how many seconds that took.
fn write_mesh(
    approximation: &Approximation,
    output: &Path,
    common: &CommonArguments,
) -> Result<f64, Failure> {
    let begin = Instant::now();
    write(&approximation.mesh, output, common.ascii)?;
    Ok(begin.elapsed().as_secs_f64())
}

fn tell(report: &TerrainReport, common: &CommonArguments) -> Result<(), Failure> {
    if let Some(path) = &common.report {
        write_json(path, report)?;
    }
    if !common.quiet {
        print(&summary(report))?;
    }
    Ok(())
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Cancelled(_) => Self::Unexpected(error.to_string()),
            other => Self::Options(other.to_string()),
        }
    }
}

impl From<HeightFileError> for Failure {
    fn from(error: HeightFileError) -> Self {
        match error {
            HeightFileError::File(error) => Self::Read(error),
            other => Self::Options(other.to_string()),
        }
    }
}
