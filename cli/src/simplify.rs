//! `decimesh simplify`: a mesh of fewer triangles.

use std::time::Instant;

use decimesh::{Mesh, Simplified, Topology, mesh};

use crate::allocation::peak_bytes;
use crate::arguments::SimplifyArguments;
use crate::failure::Failure;
use crate::files::{check_directory, check_output, read, write};
use crate::progress::Progress;
use crate::report::{self, SimplifyReport, grouped, significant};

pub(crate) fn run(arguments: &SimplifyArguments) -> Result<(), Failure> {
    let SimplifyArguments { input, output, target, engine, .. } = arguments;
    check_output(output)?;
    arguments.report.as_deref().map_or(Ok(()), check_directory)?;

    let begin = Instant::now();
    let original = read(input, engine.weld())?;
    let seconds_read = begin.elapsed().as_secs_f64();

    let options = engine.options(target.target(original.diagonal()));
    let progress = Progress::new(arguments.quiet);
    let begin = Instant::now();
    let (result, peak_bytes) = peak_bytes(|| {
        progress.during("simplifying", |monitor| decimesh::simplify(&original, &options, monitor))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let result = result?;

    if arguments.verify {
        verify(&original, &result, options.topology)?;
    }

    let begin = Instant::now();
    write(&result.mesh, output, engine.ascii)?;
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
        threads: threads(options.threads),
        stopped_by: report::stopped_by(result.stopped_by),
        locked: result.locked,
        topology_changed: result.topology_changed,
        error: result.error,
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

/// Fails if an invariant is broken. A change of the topology is none only where it was allowed and is
/// admitted.
fn verify(original: &Mesh, result: &Simplified, topology: Topology) -> Result<(), Failure> {
    let topology_kept = topology == Topology::Keep || !result.topology_changed;
    mesh::verify(original, &result.mesh, topology_kept).map_err(Failure::Verification)
}

fn threads(asked: usize) -> usize {
    match asked {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        some => some,
    }
}

fn summary(report: &SimplifyReport, result: &Simplified, diagonal: f64) -> String {
    let SimplifyReport { triangles_in, triangles_out, seconds, error, .. } = *report;
    let topology = if result.topology_changed { "topology changed" } else { "topology kept" };
    let share = report::percent(f64::from(error) / diagonal);
    format!(
        "{} -> {} triangles in {seconds:.3} s ({:.2} Mtri/s), error about {} ({share} of the diagonal), \
         stopped by {}, {topology}\n",
        grouped(triangles_in),
        grouped(triangles_out),
        triangles_in as f64 / seconds.max(f64::EPSILON) / 1e6,
        significant(f64::from(error)),
        report.stopped_by,
    )
}

#[cfg(test)]
mod tests {
    use decimesh::StoppedBy;

    use super::*;

    fn simplified(mesh: Mesh, topology_changed: bool) -> Simplified {
        let (stopped_by, error, locked, passes) = (StoppedBy::Target, 0.0, 0, 1);
        let (origins, sources, collapses) = (None, None, None);
        Simplified { mesh, stopped_by, error, locked, topology_changed, origins, sources, collapses, passes }
    }

    fn mesh(triangles: &[[u32; 3]]) -> Mesh {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Mesh::new(positions, triangles.to_vec()).unwrap()
    }

    #[test]
    fn topology_may_change_where_that_is_allowed_and_admitted() {
        let closed = mesh(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        let opened = mesh(&[[0, 2, 1], [0, 1, 3], [1, 2, 3]]);
        assert!(verify(&closed, &simplified(closed.clone(), false), Topology::Keep).is_ok());
        assert!(verify(&closed, &simplified(opened.clone(), true), Topology::RelaxIfStuck).is_ok());
        for (admitted, topology) in
            [(false, Topology::RelaxIfStuck), (false, Topology::Keep), (true, Topology::Keep)]
        {
            let failure = verify(&closed, &simplified(opened.clone(), admitted), topology).unwrap_err();
            assert!(matches!(failure, Failure::Verification(_)), "{failure}");
        }
    }
}
