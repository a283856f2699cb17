//! `decimesh levels`: a chain of levels of detail, a file each.

use std::path::{Path, PathBuf};
use std::time::Instant;

use decimesh::deviation::{Sampling, deviation};
use decimesh::hqms::build_levels;
use decimesh::{Mesh, Simplified, Target};

use crate::allocation::peak_bytes;
use crate::arguments::LevelsArguments;
use crate::failure::Failure;
use crate::files::{check_directory, check_format, make_directory, read, write};
use crate::progress::Progress;
use crate::report::{self, LevelReport, LevelsReport, grouped, significant, table};

pub(crate) fn run(arguments: &LevelsArguments) -> Result<(), Failure> {
    let LevelsArguments { input, directory, count, ratio, engine, .. } = arguments;
    if !(*ratio > 0.0 && *ratio < 1.0) {
        return Err(Failure::Options(format!(
            "the ratio of levels must be above 0 and below 1, not {ratio}"
        )));
    }
    let paths = paths(arguments)?;
    arguments.report.as_deref().map_or(Ok(()), check_directory)?;
    let original = read(input, engine.weld())?;

    let targets: Vec<Target> = (1..=*count).map(|level| Target::Ratio(ratio.powi(level as i32))).collect();
    let options = engine.options(targets[0]);
    let progress = Progress::new(arguments.quiet);
    let begin = Instant::now();
    let (levels, peak_bytes) = peak_bytes(|| {
        progress.during("simplifying", |monitor| build_levels(&original, &targets, &options, monitor))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let levels = levels?;

    make_directory(directory)?;
    let mut reports = Vec::new();
    for (level, path) in levels.iter().zip(&paths) {
        write(&level.mesh, path, engine.ascii)?;
        let number = reports.len() + 1;
        report::warn_if_stuck(&path.display().to_string(), level);
        reports.push(measure(&original, level, number, path, arguments, &progress)?);
    }
    let report = LevelsReport {
        triangles_in: original.triangles().len(),
        vertices_in: original.positions().len(),
        seconds,
        peak_bytes,
        levels: reports,
    };
    if let Some(path) = &arguments.report {
        report::write_json(path, &report)?;
    }
    if !arguments.quiet {
        report::print(&text(&report, !arguments.no_measure))?;
    }
    Ok(())
}

/// Where the levels go: `NAME_1.ply` and so on, after the input's name.
fn paths(arguments: &LevelsArguments) -> Result<Vec<PathBuf>, Failure> {
    let name = arguments.input.file_stem().unwrap_or_default().to_string_lossy();
    let path = |level| arguments.directory.join(format!("{name}_{level}.{}", arguments.format));
    let paths: Vec<PathBuf> = (1..=arguments.count).map(path).collect();
    paths.iter().try_for_each(|path| check_format(path))?;
    Ok(paths)
}

fn measure(
    original: &Mesh,
    level: &Simplified,
    number: usize,
    path: &Path,
    arguments: &LevelsArguments,
    progress: &Progress,
) -> Result<LevelReport, Failure> {
    let empty = |mesh: &Mesh| mesh.triangles().is_empty();
    let measured = if arguments.no_measure || empty(original) || empty(&level.mesh) {
        None
    } else {
        let sampling = Sampling { threads: arguments.engine.threads, ..Sampling::default() };
        Some(progress.during("measuring", |monitor| deviation(original, &level.mesh, &sampling, monitor))?)
    };
    Ok(LevelReport {
        level: number,
        file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        triangles: level.mesh.triangles().len(),
        vertices: level.mesh.positions().len(),
        stopped_by: report::stopped_by(level.stopped_by),
        topology_changed: level.topology_changed,
        error: level.error,
        rms: measured.as_ref().map(|measured| measured.rms),
        max: measured.as_ref().map(|measured| measured.max),
    })
}

fn text(report: &LevelsReport, measured: bool) -> String {
    let row = |level: &LevelReport| {
        let mut row = vec![
            level.level.to_string(),
            grouped(level.triangles),
            grouped(level.vertices),
            significant(f64::from(level.error)),
        ];
        let distances = [level.rms, level.max].into_iter().filter(|_| measured);
        row.extend(distances.map(|distance| distance.map_or_else(|| "-".to_owned(), significant)));
        row
    };
    let header = ["level", "triangles", "vertices", "estimated error", "measured RMS", "measured maximum"];
    let columns = if measured { 6 } else { 4 };
    table(&header[..columns], 0, report.levels.iter().map(row))
}
