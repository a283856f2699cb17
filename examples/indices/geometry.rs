//! Single levels without attributes: time, memory, and measured distance from the input.

use std::error::Error;

use decimesh::deviation::{Sampling, deviation};
use decimesh::{Monitor, Target};
use meshopt::SimplifyOptions;

use crate::contenders::{self, Measured, in_turns, triangles_of};
use crate::{Effort, Subject, geometric_mean};

const SHARES: [f64; 3] = [0.5, 0.1, 0.01];

/// decimesh over meshoptimizer.
struct Ratios {
    name: String,
    share: f64,
    rms: f64,
    max: f64,
    time: f64,
}

/// Prints a row for each subject and share, and means over the subjects.
pub(crate) fn compare(subjects: &[Subject], effort: Effort) -> Result<(), Box<dyn Error>> {
    println!(
        "Single levels, each from the input; median ms of {} rounds, one thread. Bytes: peak of the heap\n\
         beyond the input, an input triangle. RMS, max: two-sided, over the diagonal. x: over meshoptimizer's.\n",
        effort.rounds,
    );
    println!(
        "{:14} {:>4} | {:^39} | {:^39} | {:>6} {:>6} {:>6}",
        "", "", "decimesh", "meshoptimizer", "x", "x", "x"
    );
    let columns = format!("{:>8} {:>7} {:>5} {:>8} {:>7}", "tris", "ms", "bytes", "RMS", "max");
    println!("{:14} {:>4} | {columns} | {columns} | {:>6} {:>6} {:>6}", "mesh", "left", "RMS", "max", "time");
    let mut rows = Vec::new();
    for subject in subjects {
        for share in SHARES {
            rows.push(row(subject, share, effort)?);
        }
    }
    println!();
    for share in SHARES {
        let of_share = rows.iter().filter(|row| row.share == share);
        println!(
            "{:>3} %: geometric means x RMS {:.3}, x max {:.3}, x time {:.3}",
            100.0 * share,
            geometric_mean(of_share.clone().map(|row| row.rms)),
            geometric_mean(of_share.clone().map(|row| row.max)),
            geometric_mean(of_share.map(|row| row.time)),
        );
    }
    if let Some(worst) = rows.iter().max_by(|a, b| a.rms.total_cmp(&b.rms)) {
        println!("worst x RMS: {:.3}, {} at {} %", worst.rms, worst.name, 100.0 * worst.share);
    }
    if let Some(slowest) = rows.iter().max_by(|a, b| a.time.total_cmp(&b.time)) {
        println!("worst x time: {:.3}, {} at {} %", slowest.time, slowest.name, 100.0 * slowest.share);
    }
    println!();
    Ok(())
}

fn row(subject: &Subject, share: f64, effort: Effort) -> Result<Ratios, Box<dyn Error>> {
    let Subject { name, mesh } = subject;
    let triangles = triangles_of(mesh, share);
    let options = contenders::options(Target::Triangles(triangles));
    let [own, peer] = in_turns(
        effort.rounds,
        [&|| Ok(vec![contenders::decimesh(mesh, &options)?]), &|| {
            let indices = mesh.triangles().as_flattened();
            Ok(vec![contenders::meshoptimizer(mesh, indices, triangles, SimplifyOptions::None)?])
        }],
    )?;
    let sampling = Sampling { samples: effort.samples, ..Sampling::default() };
    let distances = |measured: &Measured| -> Result<(f64, f64), Box<dyn Error>> {
        let result = contenders::mesh_of(mesh, &measured.levels[0])?;
        let measured = deviation(mesh, &result, &sampling, &mut Monitor::silent())?;
        Ok((measured.rms_rel(), measured.max_rel()))
    };
    let ((own_rms, own_max), (peer_rms, peer_max)) = (distances(&own)?, distances(&peer)?);
    let cells = |measured: &Measured, rms: f64, max: f64| {
        format!(
            "{:>8} {:>7.1} {:>5.1} {rms:>8.2e} {max:>7.1e}",
            measured.levels[0].len() / 3,
            measured.milliseconds(),
            measured.peak_bytes as f64 / mesh.triangles().len() as f64,
        )
    };
    let ratios = Ratios {
        name: name.clone(),
        share,
        rms: own_rms / peer_rms,
        max: own_max / peer_max,
        time: own.time_over(&peer),
    };
    println!(
        "{name:14} {:>2} % | {} | {} | {:>6.3} {:>6.3} {:>6.3}",
        100.0 * share,
        cells(&own, own_rms, own_max),
        cells(&peer, peer_rms, peer_max),
        ratios.rms,
        ratios.max,
        ratios.time,
    );
    Ok(ratios)
}
