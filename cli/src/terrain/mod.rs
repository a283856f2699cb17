//! `decimesh terrain`: heights over a grid become a mesh. `decompose` and `extract` do the same in two steps.

mod arguments;
mod decompose;
mod extract;
mod plot;
mod report;
mod tiles;
mod tin;

use std::path::Path;
use std::time::Instant;

use decimesh::Mesh;
use decimesh::rate_distortion::{Decomposition, DecompositionOptions, Detail, Error, HeightFileError};

pub(crate) use arguments::{DecomposeArguments, ExtractArguments, TerrainArguments, TilesArguments};
pub(crate) use decompose::run as decompose;
pub(crate) use extract::run as extract;
pub(crate) use tiles::run as tiles;

use crate::allocation::peak_bytes;
use crate::failure::Failure;
use crate::files::{check_directory, check_output, file_name, write};
use crate::progress::Progress;
use crate::report::{print, write_json};
use arguments::CommonArguments;
use report::{TerrainReport, summary};

pub(crate) fn run(arguments: &TerrainArguments) -> Result<(), Failure> {
    let TerrainArguments { input, output, heights, plot, threads, common, .. } = arguments;
    let detail = arguments.detail.detail();
    if arguments.tin {
        tin::check(detail)?;
    }
    check_output(output)?;
    common.report.as_deref().map_or(Ok(()), check_directory)?;
    plot.as_deref().map_or(Ok(()), check_directory)?;

    let begin = Instant::now();
    let field = heights.read(input)?;
    let seconds_read = begin.elapsed().as_secs_f64();

    let options = DecompositionOptions { threads: *threads, ..DecompositionOptions::default() };
    let progress = Progress::new(common.quiet);
    let begin = Instant::now();
    let (result, peak_bytes) = peak_bytes(|| -> Result<_, Failure> {
        let decomposition =
            progress.during("decomposing", |monitor| Decomposition::new(field, &options, monitor))?;
        let taken = match arguments.tin {
            true => progress.during("setting free", |monitor| {
                tin::take(&decomposition, detail, arguments.least_squares, monitor)
            })?,
            false => decomposition.at(detail)?,
        };
        Ok((decomposition, taken))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let (decomposition, taken) = result?;

    let seconds_write = write_mesh(&taken.mesh, output, common)?;
    if let Some(path) = plot {
        let name = file_name(input);
        progress.during("plotting", |monitor| plot::write(&decomposition, &name, path, monitor))?;
    }
    let report = TerrainReport {
        seconds,
        seconds_read: Some(seconds_read),
        seconds_write,
        peak_bytes,
        ..TerrainReport::of(&decomposition, &taken)
    };
    tell(&report, detail, common)
}

/// Writes the mesh, and answers how many seconds that took.
fn write_mesh(mesh: &Mesh, output: &Path, common: &CommonArguments) -> Result<f64, Failure> {
    let begin = Instant::now();
    write(mesh, output, common.ascii)?;
    Ok(begin.elapsed().as_secs_f64())
}

/// Says what became of a wish, where and how that is asked for.
fn tell(report: &TerrainReport, detail: Detail, common: &CommonArguments) -> Result<(), Failure> {
    report.warn_if_more(detail);
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
