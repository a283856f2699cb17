//! A chain of six levels in one vertex buffer: one run, against a call a level.

use std::error::Error;

use decimesh::{Mesh, Monitor, Target, build_levels};
use meshopt::SimplifyOptions;

use crate::contenders::{self, Levels, in_turns, triangles_of};
use crate::{Effort, Subject, geometric_mean};

const SHARES: [f64; 6] = [0.5, 0.25, 0.125, 0.06, 0.03, 0.015];

/// Prints a row for each subject, and means over them.
pub(crate) fn compare(subjects: &[Subject], effort: Effort) -> Result<(), Box<dyn Error>> {
    println!(
        "Six levels of 50, 25, 12.5, 6, 3 and 1.5 %, total ms. meshoptimizer: each from the one before, the\n\
         same told that the indices are sparse, and each from the input. x: decimesh over each.\n"
    );
    println!(
        "{:14} {:>9} {:>9} {:>9} {:>9} | {:>7} {:>7} {:>7}",
        "mesh", "decimesh", "previous", "sparse", "input", "x prev.", "x spar.", "x input"
    );
    let mut ratios = Vec::new();
    for Subject { name, mesh } in subjects {
        let [own, previous, sparse, input] = in_turns(
            effort.rounds,
            [
                &|| decimesh(mesh),
                &|| from_previous(mesh, SimplifyOptions::None),
                &|| from_previous(mesh, SimplifyOptions::Sparse),
                &|| from_input(mesh),
            ],
        )?;
        let row = [&previous, &sparse, &input].map(|other| own.time_over(other));
        println!(
            "{name:14} {:>9.1} {:>9.1} {:>9.1} {:>9.1} | {:>7.3} {:>7.3} {:>7.3}",
            own.milliseconds(),
            previous.milliseconds(),
            sparse.milliseconds(),
            input.milliseconds(),
            row[0],
            row[1],
            row[2],
        );
        ratios.push(row);
    }
    let mean = |column: usize| geometric_mean(ratios.iter().map(|row| row[column]));
    println!("{:54} | {:>7.3} {:>7.3} {:>7.3}\n", "geometric means", mean(0), mean(1), mean(2));
    Ok(())
}

fn decimesh(mesh: &Mesh) -> Result<Levels, Box<dyn Error>> {
    let targets = SHARES.map(|share| Target::Triangles(triangles_of(mesh, share)));
    let options = contenders::options(targets[0]);
    let levels = build_levels(mesh, &targets, &options, &mut Monitor::silent())?;
    Ok(levels.into_iter().map(contenders::named_by_input).collect())
}

fn from_previous(mesh: &Mesh, options: SimplifyOptions) -> Result<Levels, Box<dyn Error>> {
    let mut levels: Levels = Vec::with_capacity(SHARES.len());
    for share in SHARES {
        let finer = levels.last().map_or(mesh.triangles().as_flattened(), Vec::as_slice);
        levels.push(contenders::meshoptimizer(mesh, finer, triangles_of(mesh, share), options)?);
    }
    Ok(levels)
}

fn from_input(mesh: &Mesh) -> Result<Levels, Box<dyn Error>> {
    let level = |share| {
        let indices = mesh.triangles().as_flattened();
        contenders::meshoptimizer(mesh, indices, triangles_of(mesh, share), SimplifyOptions::None)
    };
    SHARES.into_iter().map(level).collect()
}
