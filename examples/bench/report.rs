//! What was measured, as tables for people and as JSON.

use std::error::Error;

use comfy_table::{CellAlignment, Table, presets};
use decimesh::Monitor;
use decimesh::deviation::{Sampling, deviation};
use serde_json::{Value, json};

use crate::rounds::{Case, Contender, Measurement, REFERENCE};

/// What the numbers were measured on.
pub(crate) fn setting() -> Value {
    json!({
        "decimesh": env!("CARGO_PKG_VERSION"),
        "meshopt": locked_version("meshopt"),
        "openmesh": openmesh_sys::version().map(|(major, minor)| format!("{major}.{minor}")),
        "optimized": !cfg!(debug_assertions),
        "system": format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        "processor": processor(),
        "cores": std::thread::available_parallelism().map(usize::from).ok(),
    })
}

/// The version that the lock file holds: the one in this program.
fn locked_version(package: &str) -> Option<&'static str> {
    let name = format!("name = \"{package}\"");
    let mut lines = include_str!("../../Cargo.lock").lines();
    lines.find(|line| **line == name)?;
    lines.next()?.strip_prefix("version = ").map(|version| version.trim_matches('"'))
}

/// The processor's name, where the system has a file that says it.
fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    line.split_once(':').map(|(_, name)| name.trim().to_owned())
}

pub(crate) fn print_setting(setting: &Value) {
    let text = |key: &str| match &setting[key] {
        Value::String(text) => text.clone(),
        Value::Null => "unknown".to_owned(),
        other => other.to_string(),
    };
    println!(
        "decimesh {}, meshoptimizer of the crate meshopt {}, OpenMesh {}, {}, {} cores, {}",
        text("decimesh"),
        text("meshopt"),
        text("openmesh"),
        text("processor"),
        text("cores"),
        text("system"),
    );
    if cfg!(debug_assertions) {
        println!("NOT OPTIMIZED: run with --release, these times mean nothing");
    }
}

pub(crate) fn print_legend(runs: usize, openmesh: bool) {
    println!(
        "Times are of {runs} runs, contenders in turns. x update: the median of the rounds' ratios to the\n\
         time of {}. Mtri/s: input triangles in the median time. B/tri: peak of what\n\
         is allocated beyond the input, an input triangle, copies of what is overwritten included (their\n\
         time is not). RMS, max: two-sided distance from the input over its bounding box's diagonal.",
        REFERENCE.name(),
    );
    if openmesh {
        println!(
            "OpenMesh is the system's. Debian's is compiled with assertions, without which it is four to five\n\
             times as fast. Its mesh counts as a copy: it is made outside of the times."
        );
    }
}

/// Prints a table of the measurements of `case`, and returns them as JSON records.
pub(crate) fn comparison(case: &Case, measurements: &[Measurement]) -> Result<Vec<Value>, Box<dyn Error>> {
    let triangles = case.mesh.triangles().len() as f64;
    let mut table = table(&[
        "contender",
        "triangles",
        "min ms",
        "median ms",
        "Mtri/s",
        "x update",
        "B/tri",
        "RMS",
        "max",
    ]);
    let mut records = Vec::new();
    for measurement in measurements {
        let result = &measurement.result;
        let deviation = if result.triangles().is_empty() {
            None
        } else {
            Some(deviation(case.mesh, result, &Sampling::default(), &mut Monitor::silent())?)
        };
        let ratio = reference(measurements).map(|reference| measurement.ratio(reference));
        let bytes = measurement.peak_bytes as f64 / triangles;
        let distance = |distance: Option<f64>| distance.map_or("-".to_owned(), |d| format!("{d:.2e}"));
        let rms = deviation.map(|deviation| deviation.rms_rel());
        let max = deviation.map(|deviation| deviation.max_rel());
        table.add_row([
            measurement.contender.name(),
            result.triangles().len().to_string(),
            format!("{:.1}", 1e3 * measurement.fastest()),
            format!("{:.1}", 1e3 * measurement.median()),
            format!("{:.2}", triangles / measurement.median() / 1e6),
            ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.2}")),
            format!("{bytes:.1}"),
            distance(rms),
            distance(max),
        ]);
        records.push(json!({
            "contender": measurement.contender.name(),
            "triangles_in": case.mesh.triangles().len(),
            "triangles_wanted": case.triangles,
            "triangles_out": result.triangles().len(),
            "triangles_left_out": measurement.left_out,
            "seconds": measurement.seconds,
            "times_of_update": ratio,
            "peak_bytes_per_triangle": bytes,
            "rms_of_diagonal": rms,
            "max_of_diagonal": max,
        }));
    }
    println!("{table}");
    for measurement in measurements.iter().filter(|measurement| measurement.left_out > 0) {
        println!(
            "{} cannot hold {} of the triangles (non-manifold, degenerate) and simplified the others",
            measurement.contender.name(),
            measurement.left_out,
        );
    }
    Ok(records)
}

/// Prints how the time of a triangle grows with the mesh, and returns that as JSON records.
pub(crate) fn scaling(cases: &[Case], measurements: &[Vec<Measurement>]) -> Vec<Value> {
    let sizes = cases.iter().map(|case| format!("{:.2}M", case.mesh.triangles().len() as f64 / 1e6));
    let header: Vec<String> =
        std::iter::once("contender".to_owned()).chain(sizes).chain(["growth".to_owned()]).collect();
    let mut table = table(&header);
    let mut records = Vec::new();
    let contenders = measurements.first().map_or(0, Vec::len);
    for place in 0..contenders {
        let contender: Contender = measurements[0][place].contender;
        let costs: Vec<f64> = cases
            .iter()
            .zip(measurements)
            .map(|(case, of_case)| 1e6 * of_case[place].fastest() / case.mesh.triangles().len() as f64)
            .collect();
        let growth = costs.iter().copied().fold(0.0, f64::max) / costs[0];
        let cells = costs.iter().map(|cost| format!("{cost:.3}"));
        let row = std::iter::once(contender.name()).chain(cells).chain([format!("{growth:.2}")]);
        table.add_row(row);
        records.push(json!({
            "contender": contender.name(),
            "triangles_in": cases.iter().map(|case| case.mesh.triangles().len()).collect::<Vec<_>>(),
            "microseconds_per_triangle": costs,
            "growth": growth,
        }));
    }
    println!("{table}");
    println!("growth: the highest over that of the smallest mesh; linear time is 1");
    records
}

fn reference(measurements: &[Measurement]) -> Option<&Measurement> {
    measurements.iter().find(|measurement| measurement.contender == REFERENCE)
}

fn table(header: &[impl ToString]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_header(header.iter().map(ToString::to_string));
    for (place, column) in table.column_iter_mut().enumerate() {
        column.set_cell_alignment(if place == 0 { CellAlignment::Left } else { CellAlignment::Right });
    }
    table
}
