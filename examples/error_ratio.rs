//! How far the estimated error is from the measured one: the largest distance found between the two surfaces over
//! the estimate, for maximum errors and for counts, on your meshes.
//!
//! `cargo run --release --example error_ratio --features io,deviation -- [--existing] MESH...`

use std::error::Error;
use std::path::PathBuf;

use clap::Parser;
use decimesh::deviation::{BoundOptions, bound};
use decimesh::{Mesh, Monitor, Options, Placement, Simplified, Target, build_levels, io, simplify};

/// Maximum errors, as shares of the diagonal.
const LIMITS: [f64; 4] = [0.0002, 0.001, 0.005, 0.02];
/// Shares of the triangles.
const COUNTS: [f64; 3] = [0.5, 0.1, 0.01];
/// What is said of all meshes together.
const QUANTILES: [(&str, f64); 7] = [
    ("least", 0.0),
    ("5 %", 0.05),
    ("25 %", 0.25),
    ("median", 0.5),
    ("75 %", 0.75),
    ("95 %", 0.95),
    ("largest", 1.0),
];

/// Compare the estimated error with the measured one.
#[derive(Debug, Parser)]
struct Arguments {
    /// Meshes to simplify.
    #[arg(value_name = "MESH", required = true)]
    files: Vec<PathBuf>,
    /// Collapse vertices into others, without moving any.
    #[arg(long)]
    existing: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let placement = if arguments.existing { Placement::Existing } else { Placement::Optimal };
    print_row("measured / asked for, or / estimated", &headings());
    print_row("---", &headings().map(|_| "--:".to_owned()));
    let mut columns: [Vec<f64>; LIMITS.len() + COUNTS.len()] = Default::default();
    for path in &arguments.files {
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        let ratios = match io::read(path) {
            Ok(mesh) => ratios(&mesh, placement)?,
            Err(error) => {
                eprintln!("{name} is left out: {error}");
                continue;
            }
        };
        print_row(&name, &ratios.map(shown));
        for (column, ratio) in columns.iter_mut().zip(ratios) {
            column.extend(ratio);
        }
    }
    columns.iter_mut().for_each(|column| column.sort_by(f64::total_cmp));
    for (name, share) in QUANTILES {
        print_row(name, &columns.each_ref().map(|column| shown(quantile(column, share))));
    }
    Ok(())
}

fn headings() -> [String; LIMITS.len() + COUNTS.len()] {
    let mut limits = LIMITS.iter().map(|limit| format!("within {} %", 100.0 * limit));
    let mut counts = COUNTS.iter().map(|count| format!("to {} %", 100.0 * count));
    std::array::from_fn(|_| limits.next().or_else(|| counts.next()).unwrap_or_default())
}

fn print_row(name: &str, cells: &[String]) {
    println!("| {name} | {} |", cells.join(" | "));
}

fn shown(ratio: Option<f64>) -> String {
    ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.2}"))
}

/// For each limit and count the measured error over what was asked for, or what was estimated; none where
/// there is nothing to compare, as no triangle is left or no error was made.
fn ratios(mesh: &Mesh, placement: Placement) -> Result<[Option<f64>; 7], Box<dyn Error>> {
    let quiet = &mut Monitor::silent();
    let options = |target| Options { placement, ..Options::new(target) };
    let diagonal = mesh.diagonal();
    let mut ratios = Vec::new();
    for share in LIMITS {
        let limit = share * diagonal;
        let result = simplify(mesh, &options(Target::MaxError(limit as f32)), quiet)?;
        ratios.push(ratio(mesh, &result, limit)?);
    }
    let targets = COUNTS.map(Target::Ratio);
    for result in build_levels(mesh, &targets, &options(targets[0]), quiet)? {
        ratios.push(ratio(mesh, &result, f64::from(result.error))?);
    }
    Ok(std::array::from_fn(|index| ratios[index]))
}

fn ratio(mesh: &Mesh, result: &Simplified, estimate: f64) -> Result<Option<f64>, Box<dyn Error>> {
    // Rounding of coordinates is not what is looked for.
    let least = 1e-6 * mesh.diagonal();
    if result.mesh.triangles().is_empty() || f64::from(result.error) < least {
        return Ok(None);
    }
    let options = BoundOptions { tolerance: 0.05, ..BoundOptions::default() };
    Ok(Some(bound(mesh, &result.mesh, &options, &mut Monitor::silent())?.lower / estimate))
}

/// The value below which this share of `sorted` lies.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    sorted.get((share * sorted.len().saturating_sub(1) as f64).round() as usize).copied()
}
