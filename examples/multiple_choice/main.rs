//! The comparison of Jia, Tang and Pan: their engine beside quadrics and Melax's cost under a heap, in time
//! (their Table 2) and in error (their Figures 5 and 6), and beside the default engine.
//!
//! `cargo run --release --example multiple_choice -- [--rounds N] [--plot DIR] [MESH...]`

mod measure;
mod method;
mod plot;

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Parser;
use decimesh::mesh::shapes;
use decimesh::{Mesh, io};

use measure::{Level, Time, levels, times};
use method::Method;

/// Shares of the triangles at which the error is measured, for the curves.
const SHARES: [f64; 9] = [0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005];
/// Those of them that the table shows.
const SHOWN: [usize; 2] = [3, 7];

/// Compare the multiple-choice engine with what its paper compares it with.
#[derive(Debug, Parser)]
struct Arguments {
    /// Meshes to compare on, besides three that are made by rule.
    #[arg(value_name = "MESH")]
    files: Vec<PathBuf>,
    /// How many times each method is timed, in turn with the others.
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Draw the errors over the number of triangles into this directory, an SVG file a mesh.
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,
}

/// How much longer than the paper's engine another must take, for the paper's claim to hold.
struct Claim {
    method: usize,
    ratio: f64,
}

const CLAIMS: [Claim; 2] =
    [Claim { method: Method::QEM, ratio: 1.25 }, Claim { method: Method::MELAX, ratio: 1.6 }];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    if let Some(directory) = &arguments.plot {
        std::fs::create_dir_all(directory)?;
    }
    let made = [
        ("torus", shapes::torus(108, 54)),
        ("stone", shapes::bumpy_sphere(76, 1)),
        ("statue", shapes::statue(100_000)),
    ];
    for (name, mesh) in &made {
        compare(name, mesh, &arguments)?;
    }
    for path in &arguments.files {
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        compare(&name, &io::read(path)?, &arguments)?;
    }
    Ok(())
}

fn compare(name: &str, mesh: &Mesh, arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let methods = Method::all();
    let times = times(&methods, mesh, usize::from(arguments.rounds))?;
    let curves = methods.iter().map(|method| levels(method, mesh, &SHARES)).collect::<Result<Vec<_>, _>>()?;
    println!("## {name}: {} vertices, {} triangles\n", mesh.positions().len(), mesh.triangles().len());
    print_heading();
    for ((method, time), curve) in methods.iter().zip(&times).zip(&curves) {
        print_row(method.name, time, curve);
    }
    println!();
    for Claim { method, ratio } in CLAIMS {
        let measured = times[method].total() / times[Method::JIA].total();
        let verdict = if measured >= ratio { "holds" } else { "does not hold" };
        println!("- {}: {measured:.2} times Jia's time. At least {ratio} {verdict}.", methods[method].name);
    }
    println!();
    if let Some(directory) = &arguments.plot {
        let names = methods.iter().map(|method| method.name);
        plot::draw(&file(directory, name), name, &names.zip(curves).collect::<Vec<_>>())?;
    }
    Ok(())
}

fn file(directory: &Path, name: &str) -> PathBuf {
    directory.join(format!("{name}.svg"))
}

fn print_heading() {
    print!("| | begin ms | simplify ms | total ms | evaluations | left |");
    for shown in SHOWN {
        print!(" RMS at {0} % | Hausdorff | flipped |", SHARES[shown] * 100.0);
    }
    println!("\n| --- |{}", " --: |".repeat(5 + 3 * SHOWN.len()));
}

fn print_row(name: &str, time: &Time, curve: &[Level]) {
    let evaluations = time.evaluations.map_or("-".into(), |count| count.to_string());
    print!(
        "| {name} | {:.1} | {:.1} | {:.1} | {evaluations} | {} |",
        time.begin,
        time.simplify,
        time.total(),
        time.left
    );
    for level in SHOWN.map(|shown| &curve[shown]) {
        print!(" {:.2e} | {:.2e} | {} |", level.rms, level.hausdorff, level.flipped);
    }
    println!();
}
