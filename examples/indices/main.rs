//! The engine that moves no vertex beside meshoptimizer's, on your meshes: time, memory and error of single
//! levels, the time of a chain of levels, and what becomes of attributes and seams.
//!
//! `cargo run --release --example indices --features io,deviation -- scan.ply asset.glb`
//!
//! A mesh without normals and texture coordinates is welded first, as both engines need connected
//! triangles, and goes into the first two tables. One that has them stays as it is, and goes into the third.

#[path = "../bench/allocation.rs"]
mod allocation;
mod attribute_error;
mod attributes;
mod chain;
mod contenders;
mod cracks;
mod geometry;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use decimesh::mesh::Weld;
use decimesh::{Mesh, io};

use attributes::Weights;

/// Measure index-only simplification beside meshoptimizer's, one thread.
#[derive(Debug, Parser)]
struct Arguments {
    /// Meshes to measure on.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Times that each contender runs, in turns; times are the medians.
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// One round, and a tenth of the samples of a surface.
    #[arg(long)]
    quick: bool,
    /// What a normal's difference of 1 weighs beside a distance as long as the mesh.
    #[arg(long, default_value_t = 0.5)]
    normal_weight: f32,
    /// What a texture coordinate's difference of 1 weighs beside a distance as long as the mesh.
    #[arg(long, default_value_t = 1.0)]
    uv_weight: f32,
}

/// How thoroughly to measure.
#[derive(Debug, Clone, Copy)]
struct Effort {
    rounds: usize,
    /// Points on each surface.
    samples: usize,
}

/// A mesh, and what its file is called.
struct Subject {
    name: String,
    mesh: Mesh,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    allocation::count_meshoptimizer();
    if cfg!(debug_assertions) {
        println!("NOT OPTIMIZED: run with --release, these times mean nothing");
    }
    let effort = if arguments.quick {
        Effort { rounds: 1, samples: 50_000 }
    } else {
        Effort { rounds: arguments.rounds.max(1), samples: 500_000 }
    };
    let weights = Weights { normal: arguments.normal_weight, uv: arguments.uv_weight };
    let subjects = arguments.files.iter().map(|path| read(path)).collect::<Result<Vec<_>, _>>()?;
    let (assets, scans): (Vec<_>, Vec<_>) =
        subjects.into_iter().partition(|subject| attributes::has_any(&subject.mesh));
    if !scans.is_empty() {
        geometry::compare(&scans, effort)?;
        chain::compare(&scans, effort)?;
    }
    if !assets.is_empty() {
        attributes::compare(&assets, weights, effort)?;
    }
    Ok(())
}

fn read(path: &Path) -> Result<Subject, Box<dyn Error>> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mesh = io::read(path)?;
    let mesh = if attributes::has_any(&mesh) { mesh } else { mesh.weld(Weld::Exact)?.mesh };
    Ok(Subject { name, mesh })
}

/// The geometric mean; of nothing it is not a number.
fn geometric_mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    (values.clone().map(f64::ln).sum::<f64>() / values.count() as f64).exp()
}
