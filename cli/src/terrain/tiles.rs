//! `decimesh terrain-tiles`: a pyramid of tiles of a large terrain, a file each.

use std::path::{Path, PathBuf};
use std::time::Instant;

use decimesh::io::Format;
use decimesh::io::heights::{HeightFile, HeightFormat};
use decimesh::rate_distortion::OnDisk;
use decimesh::rate_distortion::tiles::{Source, TileOptions, Tiles};
use serde::Serialize;

use super::arguments::TilesArguments;
use crate::allocation::peak_bytes;
use crate::failure::Failure;
use crate::files::{check_directory_but, check_format, make_directory, write};
use crate::progress::Progress;
use crate::report::{grouped, print, significant, table, write_json};

/// What `tiles.json` says, and `--report`.
#[derive(Debug, Serialize)]
struct TilesReport {
    columns: usize,
    rows: usize,
    /// Samples that are not void.
    samples: usize,
    spacing: [f32; 2],
    /// The side of a tile of level 0, in samples.
    tile: usize,
    levels: Vec<LevelReport>,
}

#[derive(Debug, Serialize)]
struct LevelReport {
    level: usize,
    /// How many tiles of level 0 a tile of this level is wide.
    width: usize,
    /// Those of all tiles together, on borders more than once.
    vertices: usize,
    triangles: usize,
    rms: f64,
    max: f64,
    tiles: Vec<TileReport>,
}

#[derive(Debug, Serialize)]
struct TileReport {
    /// From the north-western tile on.
    column: usize,
    row: usize,
    file: String,
    vertices: usize,
    triangles: usize,
    max: f64,
}

/// What only the report says: the rest is the same whenever it is made.
#[derive(Debug, Serialize)]
struct RunReport<'a> {
    #[serde(flatten)]
    tiles: &'a TilesReport,
    /// How often tiles looked at their borders until they agreed.
    rounds: usize,
    seconds: f64,
    seconds_write: f64,
    peak_bytes: usize,
}

pub(crate) fn run(arguments: &TilesArguments) -> Result<(), Failure> {
    let TilesArguments { input, directory, common, format, .. } = arguments;
    check_format(&directory.join(format!("tile.{format}")))?;
    if let Some(path) = &common.report {
        check_directory_but(path, directory)?;
    }
    let source = open(arguments, input)?;
    make_directory(directory)?;
    let store = OnDisk::new(directory).map_err(Failure::write(directory))?;
    let options = TileOptions { side: arguments.tile, threads: arguments.threads, ..TileOptions::default() };
    let progress = Progress::new(common.quiet);
    let begin = Instant::now();
    let (tiles, peak) = peak_bytes(|| {
        progress.during("decomposing", |monitor| Tiles::new(&*source, &store, &options, monitor))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let tiles = tiles?;

    let begin = Instant::now();
    let (levels, writing_peak) = peak_bytes(|| levels(&tiles, arguments));
    let [columns, rows] = source.size();
    let report = TilesReport {
        columns,
        rows,
        samples: tiles.samples(),
        spacing: source.spacing(),
        tile: arguments.tile,
        levels: levels?,
    };
    // Last, so that what it names is there.
    write_json(&directory.join("tiles.json"), &report)?;
    let run = RunReport {
        tiles: &report,
        rounds: tiles.rounds(),
        seconds,
        seconds_write: begin.elapsed().as_secs_f64(),
        peak_bytes: peak.max(writing_peak),
    };
    if let Some(path) = &common.report {
        write_json(path, &run)?;
    }
    if !common.quiet {
        print(&summary(&run))?;
    }
    Ok(())
}

/// The file as it lies on disk, where its samples lie open; else all of it.
fn open(arguments: &TilesArguments, input: &Path) -> Result<Box<dyn Source>, Failure> {
    match HeightFormat::from_path(input).map_err(Failure::Read)? {
        HeightFormat::Npy | HeightFormat::Raw => {
            let file = HeightFile::open(input, &arguments.heights.options()).map_err(Failure::Read)?;
            Ok(Box::new(file))
        }
        _ => Ok(Box::new(arguments.heights.read(input)?)),
    }
}

/// Writes level after level, each with a quarter of the vertices of the one before and tiles twice as wide, up to
/// one tile for all.
fn levels(tiles: &Tiles, arguments: &TilesArguments) -> Result<Vec<LevelReport>, Failure> {
    let TilesArguments { directory, format, common, .. } = arguments;
    let wanted = arguments.detail.vertices(tiles.samples())?;
    let [across, down] = tiles.size();
    let coarsest = across.max(down).next_power_of_two().trailing_zeros() as usize;
    let count = arguments.levels.unwrap_or(coarsest + 1).min(coarsest + 1);
    let mut reports = Vec::new();
    for level in 0..count {
        let width = 1 << level;
        let slope = tiles.slope_for(wanted >> (2 * level));
        let place = directory.join(level.to_string());
        make_directory(&place)?;
        let mut report =
            LevelReport { level, width, vertices: 0, triangles: 0, rms: 0.0, max: 0.0, tiles: Vec::new() };
        let mut squared = 0.0;
        for row in 0..down.div_ceil(width) {
            for column in 0..across.div_ceil(width) {
                let block = tiles.mesh([column * width, row * width], [width, width], slope)?;
                let Some(block) = block else { continue };
                let file = format!("{level}/{row}-{column}.{format}");
                let (vertices, triangles) = (block.mesh.positions().len(), block.mesh.triangles().len());
                write(&block.mesh, &directory.join(&file), common.ascii)?;
                squared += block.squared_error;
                report.vertices += vertices;
                report.triangles += triangles;
                report.max = report.max.max(block.max_error);
                report.tiles.push(TileReport {
                    column,
                    row,
                    file,
                    vertices,
                    triangles,
                    max: block.max_error,
                });
            }
        }
        report.rms = (squared / tiles.samples() as f64).sqrt();
        reports.push(report);
    }
    Ok(reports)
}

fn summary(run: &RunReport) -> String {
    let rows = run.tiles.levels.iter().map(|level| {
        vec![
            level.level.to_string(),
            level.tiles.len().to_string(),
            grouped(level.vertices),
            grouped(level.triangles),
            significant(level.rms),
            significant(level.max),
        ]
    });
    let table = table(&["level", "tiles", "vertices", "triangles", "RMS error", "maximum"], 0, rows);
    format!("{} samples in {:.3} s\n{table}", grouped(run.tiles.samples), run.seconds)
}

/// What tiles are written as, by its extension.
pub(super) fn format(text: &str) -> Result<String, String> {
    match Format::from_path(&PathBuf::from(format!("tile.{text}"))) {
        Ok(_) => Ok(text.to_owned()),
        Err(_) => Err(format!("{text} names no format of meshes")),
    }
}
