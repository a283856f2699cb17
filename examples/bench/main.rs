//! decimesh beside meshoptimizer and OpenMesh on your meshes, or on some made by rule: time, memory and
//! error.
//!
//! `cargo run --release --example bench -- scan.ply --targets 10%,20000`

mod allocation;
#[path = "../../benches/peers/mod.rs"]
mod peers;
mod report;
mod rounds;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use clap::Parser;
use decimesh::mesh::shapes::bumpy_sphere;
use decimesh::{Mesh, io};
use serde_json::{Value, json};

use rounds::{Case, Contender, play};

/// Cells along an edge of the meshes made by rule, of `12n²` triangles: 70 thousand to 16 million.
const SIZES: [usize; 5] = [76, 153, 304, 577, 1155];
/// How many of them to compare on.
const COMPARED: usize = 4;
/// And those of a mesh of 100 million.
const HUGE: usize = 2887;
/// What the meshes are reduced to where it is the time of a triangle that is of interest.
const SCALING_SHARE: Wish = Wish::Share(0.1);

/// Measure decimesh beside meshoptimizer, and OpenMesh if asked for: time, memory and error.
#[derive(Debug, Parser)]
struct Arguments {
    /// Meshes to measure on; none: meshes made by rule, of 70 thousand to 4 million triangles.
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// What to leave: shares of the triangles, or counts of them.
    #[arg(long, value_delimiter = ',', value_name = "N%|N", default_value = "50%,10%,1%")]
    targets: Vec<Wish>,
    /// Times that each contender runs.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Numbers of threads for decimesh.
    #[arg(long, value_delimiter = ',', value_name = "N", default_value = "1,2")]
    threads: Vec<usize>,
    /// Beside OpenMesh's decimaters too. They take five to twenty seconds a million triangles in each run.
    #[arg(long)]
    openmesh: bool,
    /// Instead: how the time of a triangle grows from 70 thousand to 16 million, leaving 10 %.
    #[arg(long, conflicts_with_all = ["files", "targets"])]
    scaling: bool,
    /// The same up to 100 million triangles, and decimesh alone: others take minutes there, and 11 GB.
    #[arg(long, requires = "scaling")]
    huge: bool,
    /// Write the measurements, as JSON, to this file.
    #[arg(long, value_name = "FILE.json")]
    json: Option<PathBuf>,
}

/// How much of a mesh to leave.
#[derive(Debug, Clone, Copy)]
enum Wish {
    Share(f64),
    Triangles(usize),
}

impl FromStr for Wish {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || format!("'{text}' is neither a share such as 10% nor a number of triangles");
        match text.strip_suffix('%') {
            Some(percent) => match percent.parse::<f64>() {
                Ok(percent) if (0.0..=100.0).contains(&percent) => Ok(Self::Share(percent / 100.0)),
                _ => Err(wrong()),
            },
            None => text.parse().map(Self::Triangles).map_err(|_| wrong()),
        }
    }
}

impl Wish {
    fn of(self, mesh: &Mesh) -> Case<'_> {
        let triangles = match self {
            Self::Share(share) => (mesh.triangles().len() as f64 * share) as usize,
            Self::Triangles(count) => count,
        };
        Case { mesh, triangles }
    }
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
    if arguments.openmesh && !openmesh_sys::AVAILABLE {
        return Err(openmesh_sys::Error::Unavailable.into());
    }
    allocation::count_meshoptimizer();
    let mut contenders = Contender::all(&arguments.threads, arguments.openmesh);
    contenders.retain(|contender| !arguments.huge || contender.is_default());
    let setting = report::setting();
    report::print_setting(&setting);
    let records = if arguments.scaling {
        scaling(arguments, &contenders)?
    } else {
        comparisons(arguments, &contenders)?
    };
    if let Some(path) = &arguments.json {
        let report = json!({ "setting": setting, "measurements": records });
        std::fs::write(path, serde_json::to_vec_pretty(&report)?)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    }
    Ok(())
}

fn comparisons(arguments: &Arguments, contenders: &[Contender]) -> Result<Vec<Value>, Box<dyn Error>> {
    report::print_legend(arguments.runs, arguments.openmesh);
    let mut records = Vec::new();
    let mut compare = |name: &str, mesh: &Mesh| -> Result<(), Box<dyn Error>> {
        for wish in &arguments.targets {
            let case = wish.of(mesh);
            println!("\n{name}: {} to {} triangles", mesh.triangles().len(), case.triangles);
            let cases = [case];
            let measurements = play(contenders, &cases, arguments.runs)?;
            for (case, measurements) in cases.iter().zip(&measurements) {
                for mut record in report::comparison(case, measurements)? {
                    record["mesh"] = name.into();
                    records.push(record);
                }
            }
        }
        Ok(())
    };
    for path in &arguments.files {
        compare(&path.display().to_string(), &io::read(path)?)?;
    }
    if arguments.files.is_empty() {
        for cells in &SIZES[..COMPARED] {
            compare("bumpy sphere", &bumpy_sphere(*cells, 1))?;
        }
    }
    Ok(records)
}

fn scaling(arguments: &Arguments, contenders: &[Contender]) -> Result<Vec<Value>, Box<dyn Error>> {
    let huge = arguments.huge.then_some(HUGE);
    let meshes: Vec<Mesh> = SIZES.into_iter().chain(huge).map(|cells| bumpy_sphere(cells, 1)).collect();
    let cases: Vec<Case> = meshes.iter().map(|mesh| SCALING_SHARE.of(mesh)).collect();
    println!("\nbumpy spheres to 10 %, microseconds a triangle of the input (the fastest run)");
    let measurements = play(contenders, &cases, arguments.runs)?;
    Ok(report::scaling(&cases, &measurements))
}
