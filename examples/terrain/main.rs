//! What decomposing terrain and taking meshes from it costs: time and memory for each sample, and for each vertex.
//!
//! `cargo run --release --example terrain` measures on fractal terrain of growing size;
//! `cargo run --release --example terrain --features io -- dem.npy dem.png` on files. With `--baselines`, what the error
//! is by the methods of the paper, at the same rates.

use std::alloc::System;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Parser;
use decimesh::Monitor;
use decimesh::rate_distortion::{
    Baseline, Criterion, Decomposition, DecompositionOptions, Detail, HeightField,
};
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};

#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// Measure the decomposition of terrain.
#[derive(Debug, Parser)]
struct Arguments {
    /// Heights to measure on, as `decimesh terrain` reads them; none: fractal terrain.
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The largest fractal terrain has 2^N + 1 columns and rows.
    #[arg(long, value_name = "N", default_value_t = 13)]
    largest: u32,
    /// Compare with the paper's generalized decimation and with what it compares with, in decibels.
    #[arg(long)]
    baselines: bool,
    /// How often each is done; the fastest counts.
    #[arg(long, default_value_t = 5)]
    rounds: usize,
}

/// The parts of the samples that are taken.
const RATIOS: [f64; 5] = [0.2, 0.05, 0.01, 0.001, 0.0001];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    if arguments.baselines {
        return compare(&arguments);
    }
    let mut last = None;
    println!("| terrain | samples | 1 thread, s/M | 2 threads, s/M | bytes/sample |");
    println!("| --- | --: | --: | --: | --: |");
    for (name, field) in fields(&arguments)? {
        last = Some(measure(&name, &field, arguments.rounds)?);
    }
    if let Some(decomposition) = last {
        println!("\n| vertices of the last | triangles | ms | ns/vertex | RMS | certified gap, dB |");
        println!("| --: | --: | --: | --: | --: | --: |");
        for ratio in RATIOS {
            extract(&decomposition, ratio, arguments.rounds)?;
        }
    }
    Ok(())
}

type Named = (String, HeightField);

#[cfg(feature = "io")]
fn read(path: &Path) -> Result<HeightField, Box<dyn Error>> {
    Ok(HeightField::read(path, &decimesh::io::heights::HeightOptions::default())?)
}

#[cfg(not(feature = "io"))]
fn read(path: &Path) -> Result<HeightField, Box<dyn Error>> {
    Err(format!("{}: files need --features io", path.display()).into())
}

/// One after the other, as the largest fill memory.
fn fields(arguments: &Arguments) -> Result<Box<dyn Iterator<Item = Named>>, Box<dyn Error>> {
    if arguments.files.is_empty() {
        return Ok(Box::new(
            (10..=arguments.largest).map(|depth| (format!("fractal, 2^{depth} + 1"), fractal(depth))),
        ));
    }
    let read = |path: &PathBuf| Ok((path.display().to_string(), self::read(path)?));
    let fields: Vec<Named> = arguments.files.iter().map(read).collect::<Result<_, Box<dyn Error>>>()?;
    Ok(Box::new(fields.into_iter()))
}

/// Midpoint displacement: each midpoint is off the mean of its neighbours by up to half as much on each halving.
fn fractal(depth: u32) -> HeightField {
    let side = (1 << depth) + 1;
    let mut heights = vec![0.0f32; side * side];
    let mut state = 1u32;
    // An xorshift generator: what it gives only has to be rough.
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as f32 / u32::MAX as f32 - 0.5
    };
    let (mut step, mut rough) = (side - 1, 1000.0);
    while step > 1 {
        let half = step / 2;
        for y in (0..side).step_by(step) {
            for x in (half..side).step_by(step) {
                heights[y * side + x] =
                    (heights[y * side + x - half] + heights[y * side + x + half]) / 2.0 + rough * random();
            }
        }
        for y in (half..side).step_by(step) {
            for x in (0..side).step_by(half) {
                heights[y * side + x] = (heights[(y - half) * side + x] + heights[(y + half) * side + x])
                    / 2.0
                    + rough * random();
            }
        }
        (step, rough) = (half, rough * 0.55);
    }
    HeightField::new(side, side, heights, None).expect("finite heights")
}

/// The methods of the paper, and what they are called.
const BASELINES: [(Baseline, &str); 5] = [
    (Baseline::GeneralizedDecimation, "generalized decimation"),
    (Baseline::Decimation(Criterion::Global), "one at a time, global error"),
    (Baseline::Decimation(Criterion::Local), "one at a time, local error"),
    (Baseline::Insertion(Criterion::Global), "insertion, global error"),
    (Baseline::Insertion(Criterion::Local), "insertion, local error"),
];
/// The parts of the samples at which they are compared.
const RATES: [f64; 7] = [0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005];

/// Prints the RMS of ours, and by how many decibels the others' are above it.
fn compare(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    println!("| terrain | | s | {} |", RATES.map(|rate| format!("{} %", 100.0 * rate)).join(" | "));
    println!("| --- | --- | --: |{}", " --: |".repeat(RATES.len()));
    for (name, field) in fields(arguments)? {
        let rms = |decomposition: &Decomposition| {
            let at = |rate| Ok(decomposition.at(Detail::Ratio(rate))?.rms);
            RATES.into_iter().map(at).collect::<Result<Vec<f64>, Box<dyn Error>>>()
        };
        let options = DecompositionOptions { threads: 1, ..DecompositionOptions::default() };
        let begin = Instant::now();
        let ours = Decomposition::new(field.clone(), &options, &mut Monitor::silent())?;
        let seconds = begin.elapsed().as_secs_f64();
        let ours = rms(&ours)?;
        let cells: Vec<String> = ours.iter().map(|rms| format!("{rms:.4}")).collect();
        println!("| {name} | flow sweeps, RMS | {seconds:.2} | {} |", cells.join(" | "));
        for (baseline, method) in BASELINES {
            let begin = Instant::now();
            let other = Decomposition::by_baseline(field.clone(), baseline, &mut Monitor::silent())?;
            let seconds = begin.elapsed().as_secs_f64();
            let above =
                rms(&other)?.into_iter().zip(&ours).map(|(other, ours)| 20.0 * (other / ours).log10());
            let cells: Vec<String> = above.map(|decibels| format!("{decibels:+.2}")).collect();
            println!("| {name} | {method}, dB | {seconds:.2} | {} |", cells.join(" | "));
        }
    }
    Ok(())
}

/// Prints a row about the decomposition of a field, which comes back.
fn measure(name: &str, field: &HeightField, rounds: usize) -> Result<Decomposition, Box<dyn Error>> {
    let samples = field.heights().len() as f64;
    let mut made = None;
    let (mut seconds, mut peak) = ([f64::INFINITY; 2], 0);
    for _ in 0..rounds {
        for (threads, least) in [1, 2].into_iter().zip(&mut seconds) {
            drop(made.take());
            ALLOCATOR.reset_peak_memory();
            // A copy, which belongs to the decomposition and counts as part of it.
            let given = field.clone();
            let options = DecompositionOptions { threads, ..DecompositionOptions::default() };
            let begin = Instant::now();
            let decomposition = Decomposition::new(given, &options, &mut Monitor::silent())?;
            *least = least.min(begin.elapsed().as_secs_f64());
            peak = ALLOCATOR.get_peak_memory();
            made = Some(decomposition);
        }
    }
    let [one, two] = seconds.map(|seconds| seconds / samples * 1e6);
    println!("| {name} | {samples} | {one:.3} | {two:.3} | {:.1} |", peak as f64 / samples);
    made.ok_or("no rounds were asked for".into())
}

/// Prints a row about a mesh that is taken.
fn extract(decomposition: &Decomposition, ratio: f64, rounds: usize) -> Result<(), Box<dyn Error>> {
    let mut least = f64::INFINITY;
    // Once for the sums of errors, which the first one pays for all.
    let mut taken = decomposition.at(Detail::Ratio(ratio))?;
    for _ in 0..rounds {
        let begin = Instant::now();
        taken = decomposition.at(Detail::Ratio(ratio))?;
        least = least.min(begin.elapsed().as_secs_f64());
    }
    let vertices = taken.samples.len();
    println!(
        "| {vertices} | {} | {:.3} | {:.0} | {:.4} | {:.4} |",
        taken.mesh.triangles().len(),
        least * 1e3,
        least * 1e9 / vertices as f64,
        taken.rms,
        taken.certified_gap,
    );
    Ok(())
}
