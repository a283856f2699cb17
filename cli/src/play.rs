//! `decimesh play`: a level of a progressive file as a mesh file.

use std::time::Instant;

use decimesh::lod::{Extent, Progressive};

use crate::arguments::{PlayArguments, PlayedLevel};
use crate::failure::Failure;
use crate::files::{check_directory, check_output, write};
use crate::report::{self, PlayReport, grouped, significant};

pub(crate) fn run(arguments: &PlayArguments) -> Result<(), Failure> {
    let PlayArguments { input, output, level, .. } = arguments;
    check_output(output)?;
    arguments.report.as_deref().map_or(Ok(()), check_directory)?;
    check_ratio(level)?;

    let begin = Instant::now();
    // What is finer than asked for need not be read, if the file's coarse part says what that is.
    let extent = level.triangles.map_or(Extent::Whole, Extent::Triangles);
    let progressive = Progressive::read(input, extent).map_err(Failure::Read)?;
    let seconds_read = begin.elapsed().as_secs_f64();

    let begin = Instant::now();
    let (step, error) = step(&progressive, level)?;
    let mesh = progressive.mesh_at(step);
    let seconds = begin.elapsed().as_secs_f64();

    let begin = Instant::now();
    write(&mesh, output, arguments.ascii)?;
    let report = PlayReport {
        triangles: mesh.triangles().len(),
        vertices: mesh.positions().len(),
        step,
        steps: progressive.steps(),
        error,
        seconds_read,
        seconds,
        seconds_write: begin.elapsed().as_secs_f64(),
    };
    if let Some(path) = &arguments.report {
        report::write_json(path, &report)?;
    }
    if !arguments.quiet {
        report::print(&summary(&report))?;
    }
    Ok(())
}

fn check_ratio(level: &PlayedLevel) -> Result<(), Failure> {
    match level.ratio {
        Some(ratio) if !(0.0..=1.0).contains(&ratio) => {
            Err(Failure::Options(format!("the ratio must be between 0 and 1, not {ratio}")))
        }
        _ => Ok(()),
    }
}

/// The step of the level asked for, and its error where it is known. Tells the user where even the coarsest
/// has more triangles than asked for.
fn step(progressive: &Progressive, level: &PlayedLevel) -> Result<(usize, Option<f32>), Failure> {
    let finest = progressive.steps();
    if let Some(number) = level.level {
        let marks = progressive.marks();
        return match number.checked_sub(1) {
            None => Ok((finest, Some(0.0))),
            Some(index) => match marks.get(index) {
                Some(mark) => Ok((mark.step, Some(mark.error))),
                None => Err(Failure::Options(format!(
                    "there is no level {number}: the file has levels 0 to {}",
                    marks.len()
                ))),
            },
        };
    }
    let ratio = level.ratio.unwrap_or(1.0);
    let most = level.triangles.unwrap_or((progressive.triangle_count(finest) as f64 * ratio) as usize);
    let step = progressive.step_within(most);
    let triangles = progressive.triangle_count(step);
    if triangles > most {
        eprintln!(
            "decimesh: warning: the coarsest level has {} triangles, more than asked for",
            grouped(triangles)
        );
    }
    Ok((step, None))
}

fn summary(report: &PlayReport) -> String {
    let PlayReport { triangles, vertices, step, seconds_read, seconds, .. } = *report;
    let error = report
        .error
        .map_or_else(String::new, |error| format!(", error about {}", significant(f64::from(error))));
    format!(
        "{} triangles, {} vertices{error}: read in {seconds_read:.3} s, {} steps played in {seconds:.3} s\n",
        grouped(triangles),
        grouped(vertices),
        grouped(step),
    )
}
