//! `decimesh simplify`: a mesh of fewer triangles.

use std::time::Instant;

use decimesh::Simplified;

use crate::allocation::peak_bytes;
use crate::arguments::SimplifyArguments;
use crate::engine;
use crate::failure::Failure;
use crate::files::{check_directory, check_output, read, write};
use crate::out_of_core;
use crate::progress::Progress;
use crate::report::{self, BoundReport, SimplifyReport, grouped, significant};

pub(crate) fn run(arguments: &SimplifyArguments) -> Result<(), Failure> {
    if let Some(memory) = arguments.memory {
        return out_of_core::run(arguments, memory);
    }
    let SimplifyArguments { input, output, target, engine: engine_arguments, .. } = arguments;
    engine_arguments.check()?;
    check_output(output)?;
    arguments.report.as_deref().map_or(Ok(()), check_directory)?;

    let begin = Instant::now();
    let original = read(input, engine_arguments.weld())?;
    let seconds_read = begin.elapsed().as_secs_f64();

    let target = target.target(original.diagonal());
    let options = engine_arguments.options(target);
    let progress = Progress::new(arguments.quiet);
    let begin = Instant::now();
    let certified = arguments.target.max_error(original.diagonal()).filter(|_| arguments.certify);
    let (result, peak_bytes) = peak_bytes(|| {
        progress.during("simplifying", |monitor| match certified {
            None => Ok((engine::simplify(&original, target, engine_arguments, monitor)?, None)),
            Some(max_error) => {
                let certified = engine::simplify_within(&original, max_error, engine_arguments, monitor)?;
                Ok::<_, Failure>((certified.simplified, Some(certified.bound)))
            }
        })
    });
    let seconds = begin.elapsed().as_secs_f64();
    let (result, bound) = result?;

    if arguments.verify {
        engine::check(&original, &result, &options)?;
    }

    let begin = Instant::now();
    write(&result.mesh, output, engine_arguments.ascii)?;
    let seconds_write = begin.elapsed().as_secs_f64();

    report::warn_if_stuck(&output.display().to_string(), &result);
    let report = SimplifyReport {
        triangles_in: original.triangles().len(),
        vertices_in: original.positions().len(),
        triangles_out: result.mesh.triangles().len(),
        vertices_out: result.mesh.positions().len(),
        seconds,
        seconds_read,
        seconds_write,
        peak_bytes,
        threads: report::threads(options.threads),
        stopped_by: report::stopped_by(result.stopped_by),
        locked: result.locked,
        topology_changed: result.topology_changed,
        error: result.error,
        bound: bound.map(BoundReport::from),
        attribute_error: result.attribute_error,
        passes: result.passes,
    };
    if let Some(path) = &arguments.report {
        report::write_json(path, &report)?;
    }
    if !arguments.quiet {
        report::print(&summary(&report, &result, original.diagonal()))?;
    }
    Ok(())
}

fn summary(report: &SimplifyReport, result: &Simplified, diagonal: f64) -> String {
    let SimplifyReport { triangles_in, triangles_out, seconds, error, .. } = *report;
    let topology = if result.topology_changed { "topology changed" } else { "topology kept" };
    let share = report::percent(f64::from(error) / diagonal);
    let how = if report.bound.is_some() { "at most" } else { "about" };
    format!(
        "{} -> {} triangles in {seconds:.3} s ({:.2} Mtri/s), error {how} {} ({share} of the diagonal), \
         stopped by {}, {topology}\n",
        grouped(triangles_in),
        grouped(triangles_out),
        triangles_in as f64 / seconds.max(f64::EPSILON) / 1e6,
        significant(f64::from(error)),
        report.stopped_by,
    )
}
