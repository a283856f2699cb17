//! The engine of Jia, Tang and Pan with each of its costs and selections, over a mesh: what it takes and
//! what it errs, beside the default engine that moves no vertex.
//!
//! `cargo run --release --example half_edge -- [MESH]`

use std::time::Instant;

use decimesh::deviation::{Sampling, deviation};
use decimesh::mesh::shapes;
use decimesh::multiple_choice::{Cost, Decimation, Selection};
use decimesh::{Mesh, Monitor, Options, Placement, Target, simplify};

const SHARES: [f64; 3] = [0.5, 0.1, 0.01];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mesh = match std::env::args_os().nth(1) {
        Some(path) => decimesh::io::read(path.as_ref())?,
        None => shapes::bumpy_sphere(100, 1),
    };
    let quiet = &mut Monitor::silent();
    println!("{:36} {:>9} {:>8} {:>10} {:>10} {:>10}", "", "triangles", "ms", "evaluated", "RMS", "maximum");
    for cost in [Cost::Visual, Cost::Melax, Cost::Quadric] {
        for selection in [Selection::default(), Selection::LazyHeap] {
            let start = Instant::now();
            let mut decimation = Decimation::new(&mesh, cost, selection);
            let mut time = milliseconds(start);
            println!("{cost:?}, {selection:?}: {time:.1} ms to begin");
            for share in SHARES {
                let start = Instant::now();
                decimation.reduce_to((mesh.triangles().len() as f64 * share) as usize, quiet)?;
                time += milliseconds(start);
                let result = Mesh::new(mesh.positions().to_vec(), decimation.triangles())?;
                report(&mesh, &result, time, &decimation.evaluations().to_string())?;
            }
        }
    }
    println!("the default engine, moving no vertex, one thread:");
    for share in SHARES {
        let options =
            Options { placement: Placement::Existing, threads: 1, ..Options::new(Target::Ratio(share)) };
        let start = Instant::now();
        let result = simplify(&mesh, &options, quiet)?;
        report(&mesh, &result.mesh, milliseconds(start), "-")?;
    }
    Ok(())
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// A row: the time is all that led to it from the input.
fn report(input: &Mesh, result: &Mesh, time: f64, evaluated: &str) -> Result<(), Box<dyn std::error::Error>> {
    let measured = deviation(input, result, &Sampling::default(), &mut Monitor::silent())?;
    println!(
        "{:36} {:>9} {time:>8.1} {evaluated:>10} {:>10.2e} {:>10.2e}",
        "",
        result.triangles().len(),
        measured.rms_rel(),
        measured.max_rel()
    );
    Ok(())
}
