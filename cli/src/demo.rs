//! `decimesh demo`: a statue of a million triangles, what simplification makes of it, and a picture.

use std::time::Instant;

use decimesh::deviation::{Deviation, Sampling, deviation};
use decimesh::mesh::shapes;
use decimesh::{Mesh, Options, Target};

use crate::arguments::DemoArguments;
use crate::failure::Failure;
use crate::files::{make_directory, write};
use crate::progress::Progress;
use crate::render::{self, Exhibit};
use crate::report::{self, grouped, percent, table};

/// Triangles of the statue to one of the level's.
const REDUCTIONS: [usize; 4] = [10, 100, 500, 2000];
/// Fewer triangles than this do not make a statue.
const FEWEST: usize = 100;

/// A level, and what it took.
struct Level {
    mesh: Mesh,
    seconds: f64,
    deviation: Deviation,
}

pub(crate) fn run(arguments: &DemoArguments) -> Result<(), Failure> {
    let directory = &arguments.directory;
    make_directory(directory)?;
    let progress = Progress::new(arguments.quiet);
    let original = shapes::statue(arguments.triangles);
    write(&original, &directory.join("statue.ply"), false)?;

    let mut levels = Vec::new();
    let targets = REDUCTIONS.map(|reduction| original.triangles().len() / reduction);
    for target in targets.into_iter().filter(|&target| target >= FEWEST) {
        let level = make_level(&original, target, &progress)?;
        write(&level.mesh, &directory.join(format!("statue_{}.ply", levels.len() + 1)), false)?;
        levels.push(level);
    }
    if !arguments.quiet {
        report::print(&text(&original, &levels))?;
    }

    let path = directory.join("demo.png");
    let exhibits = exhibits(&original, &levels);
    render::write(&exhibits, arguments.width, &path, &progress)?;
    if !arguments.quiet {
        report::print(&format!("\nThe picture is {}, the levels are beside it.\n", path.display()))?;
    }
    Ok(())
}

fn make_level(original: &Mesh, triangles: usize, progress: &Progress) -> Result<Level, Failure> {
    let options = Options::new(Target::Triangles(triangles));
    let begin = Instant::now();
    let simplified =
        progress.during("simplifying", |monitor| decimesh::simplify(original, &options, monitor))?;
    let seconds = begin.elapsed().as_secs_f64();
    let deviation = progress.during("measuring", |monitor| {
        deviation(original, &simplified.mesh, &Sampling::default(), monitor)
    })?;
    Ok(Level { mesh: simplified.mesh, seconds, deviation })
}

fn text(original: &Mesh, levels: &[Level]) -> String {
    let row = |level: &Level| {
        vec![
            grouped(level.mesh.triangles().len()),
            format!("{:.3}", level.seconds),
            format!("{:.2}", original.triangles().len() as f64 / level.seconds.max(f64::EPSILON) / 1e6),
            percent(level.deviation.rms_rel()),
            percent(level.deviation.max_rel()),
        ]
    };
    let header = ["triangles", "seconds", "Mtri/s", "RMS", "maximum"];
    let table = table(&header, 0, levels.iter().map(row));
    format!(
        "A statue of {}, each level made from all of it.\nDistances are measured, both ways, as shares of \
         the bounding box's diagonal.\n\n{table}",
        report::size(original)
    )
}

fn exhibits<'a>(original: &'a Mesh, levels: &'a [Level]) -> Vec<Exhibit<'a>> {
    let title = |mesh: &Mesh| format!("{} triangles", grouped(mesh.triangles().len()));
    let mut exhibits =
        vec![Exhibit { mesh: original, title: title(original), subtitle: "the input".to_owned() }];
    exhibits.extend(levels.iter().map(|level| Exhibit {
        mesh: &level.mesh,
        title: title(&level.mesh),
        subtitle: format!("RMS distance {}", percent(level.deviation.rms_rel())),
    }));
    exhibits
}
