//! `decimesh levels`: a chain of levels of detail, a file each.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::time::Instant;

use decimesh::deviation::{BoundOptions, Sampling, deviation};
use decimesh::hqms::build_levels;
use decimesh::lod::{NestedLevels, Progressive};
use decimesh::{Mesh, Options, Placement, Simplified, Target};

use crate::allocation::peak_bytes;
use crate::arguments::{EngineName, LevelsArguments};
use crate::failure::Failure;
use crate::files::{bytes, check_directory_but, check_format, file_name, make_directory, read, write};
use crate::progress::Progress;
use crate::report::{
    self, LevelReport, LevelsReport, NestedReport, ProgressiveReport, grouped, significant, table,
};

pub(crate) fn run(arguments: &LevelsArguments) -> Result<(), Failure> {
    let LevelsArguments { input, directory, count, ratio, engine, .. } = arguments;
    engine.check()?;
    if engine.engine == EngineName::MultipleChoice {
        return Err(Failure::Options("levels are made by the engines hqms and indices".into()));
    }
    if !(*ratio > 0.0 && *ratio < 1.0) {
        return Err(Failure::Options(format!(
            "the ratio of levels must be above 0 and below 1, not {ratio}"
        )));
    }
    let paths = paths(arguments)?;
    for path in arguments.report.iter().chain(&arguments.progressive) {
        check_directory_but(path, directory)?;
    }
    let original = read(input, engine.weld())?;

    let targets: Vec<Target> = (1..=*count).map(|level| Target::Ratio(ratio.powi(level as i32))).collect();
    let options = options(arguments, targets[0]);
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
    let nested =
        if arguments.nested { Some(write_nested(&original, &levels, arguments, &progress)?) } else { None };
    let progressive = arguments.progressive.as_deref();
    let progressive = progressive.map(|path| write_progressive(&original, &levels, path)).transpose()?;
    let report = LevelsReport {
        triangles_in: original.triangles().len(),
        vertices_in: original.positions().len(),
        seconds,
        peak_bytes,
        levels: reports,
        nested,
        progressive,
    };
    if let Some(path) = &arguments.report {
        report::write_json(path, &report)?;
    }
    if !arguments.quiet {
        report::print(&text(&report, !arguments.no_measure))?;
    }
    Ok(())
}

/// Nested levels need to know where each vertex comes from and goes to, progressive ones each collapse.
fn options(arguments: &LevelsArguments, target: Target) -> Options {
    let LevelsArguments { engine, nested, progressive, .. } = arguments;
    let options = engine.options(target);
    if !nested {
        return options;
    }
    Options {
        placement: Placement::Existing,
        track_origins: true,
        track_sources: true,
        track_collapses: progressive.is_some(),
        ..options
    }
}

fn write_nested(
    original: &Mesh,
    levels: &[Simplified],
    arguments: &LevelsArguments,
    progress: &Progress,
) -> Result<NestedReport, Failure> {
    let path = path(arguments, "levels", "glb");
    let mut nested = NestedLevels::from_levels(original, levels)?;
    if arguments.certify {
        let options = BoundOptions { threads: arguments.engine.threads, ..BoundOptions::default() };
        progress.during("certifying", |monitor| nested.certify(&options, monitor))?;
    }
    nested.write_glb(&path).map_err(Failure::Write)?;
    Ok(NestedReport {
        file: file_name(&path),
        bytes: bytes(&path)?,
        vertices: nested.levels().iter().map(|level| level.vertices).collect(),
        errors: nested.levels().iter().map(|level| level.error).collect(),
        certified: arguments.certify,
    })
}

fn write_progressive(
    original: &Mesh,
    levels: &[Simplified],
    path: &Path,
) -> Result<ProgressiveReport, Failure> {
    let begin = Instant::now();
    let progressive =
        Progressive::from_levels(original, levels).map_err(|error| Failure::Unexpected(error.to_string()))?;
    let seconds = begin.elapsed().as_secs_f64();
    if progressive.marks().len() < levels.len() {
        eprintln!(
            "decimesh: warning: {} ends at level {}: from there on the topology changes, which is no matter of \
             collapses; --keep-topology makes all levels so",
            path.display(),
            progressive.marks().len()
        );
    }
    progressive.write(path).map_err(Failure::Write)?;
    let bytes = bytes(path)?;
    Ok(ProgressiveReport {
        file: file_name(path),
        bytes,
        bytes_per_vertex: bytes as f64 / progressive.vertices().positions().len().max(1) as f64,
        steps: progressive.steps(),
        seconds,
    })
}

/// Where something goes, after the input's name.
fn path(arguments: &LevelsArguments, what: impl Display, extension: &str) -> PathBuf {
    let name = arguments.input.file_stem().unwrap_or_default().to_string_lossy();
    arguments.directory.join(format!("{name}_{what}.{extension}"))
}

/// Where the levels go: `NAME_1.ply` and so on.
fn paths(arguments: &LevelsArguments) -> Result<Vec<PathBuf>, Failure> {
    let path = |level| path(arguments, level, &arguments.format);
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
        file: file_name(path),
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
    let mut text = table(&header[..columns], 0, report.levels.iter().map(row));
    if let Some(NestedReport { file, bytes, errors, certified, .. }) = &report.nested {
        text += &format!("{file}: all levels on one vertex buffer, {} bytes\n", grouped(*bytes as usize));
        if *certified {
            let errors: Vec<_> = errors[1..].iter().map(|&error| significant(f64::from(error))).collect();
            text += &format!("no level is farther from the input than {}\n", errors.join(", "));
        }
    }
    if let Some(ProgressiveReport { file, bytes, bytes_per_vertex, steps, .. }) = &report.progressive {
        let (bytes, steps) = (grouped(*bytes as usize), grouped(*steps));
        text += &format!("{file}: {steps} steps, {bytes} bytes ({bytes_per_vertex:.1} a vertex)\n");
    }
    text
}
