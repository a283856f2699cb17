//! `decimesh remesh`: a semi-regular surface from any manifold mesh, whole or decimated.

use std::path::Path;
use std::time::Instant;

use decimesh::Mesh;
use decimesh::deviation::{Sampling, deviation};
use decimesh::mesh::Weld;
use decimesh::rate_distortion::{DecompositionOptions, RemeshOptions, SurfaceDecomposition, remesh};
use serde::Serialize;

use crate::arguments::RemeshArguments;
use crate::failure::Failure;
use crate::files::{check_directory, check_output, read, write};
use crate::progress::Progress;
use crate::render::{self, Exhibit};
use crate::report::{self, grouped, percent};

pub(crate) fn run(arguments: &RemeshArguments) -> Result<(), Failure> {
    let RemeshArguments { input, output, .. } = arguments;
    let RemeshArguments { depth, base_quads, threads, .. } = *arguments;
    let ratio = arguments.ratio.map(|ratio| match ratio > 0.0 && ratio <= 1.0 {
        true => Ok(ratio),
        false => Err(Failure::Options(format!("a ratio must be above 0 and at most 1, not {ratio}"))),
    });
    let ratio = ratio.transpose()?;
    check_output(output)?;
    for path in arguments.report.iter().chain(&arguments.picture) {
        check_directory(path)?;
    }

    let original = read(input, Some(Weld::Exact))?;
    let options = RemeshOptions { base_quads, threads, ..RemeshOptions::new(depth) };
    let progress = Progress::new(arguments.quiet);
    let begin = Instant::now();
    let remeshed = progress.during("remeshing", |monitor| remesh(&original, &options, monitor))?;
    let seconds_remesh = begin.elapsed().as_secs_f64();
    let full = remeshed.surface.to_mesh();
    let sampling = Sampling { threads, ..Sampling::default() };
    let measured = progress.during("measuring", |monitor| deviation(&original, &full, &sampling, monitor))?;

    let quads = remeshed.surface.complex().quads().len();
    let vertices = full.positions().len();
    let wanted = ratio.map(|ratio| (ratio * vertices as f64).round() as usize).or(arguments.vertices);
    let decimated = wanted
        .map(|wanted| {
            let options = DecompositionOptions { threads, ..DecompositionOptions::default() };
            let begin = Instant::now();
            let decomposition = progress.during("decomposing", |monitor| {
                SurfaceDecomposition::new(remeshed.surface, &options, monitor)
            })?;
            let left = decomposition.at_vertices(wanted);
            let seconds = begin.elapsed().as_secs_f64();
            let gap = Some(decomposition.certified_gap(left.vertices.len())).filter(|gap| gap.is_finite());
            let report =
                DecimationReport { seconds, rms: left.rms, certified_gap_db: gap, wanted_vertices: wanted };
            Ok::<_, Failure>((left.mesh, report))
        })
        .transpose()?;
    let (decimated, decimation) = decimated.unzip();
    let mesh = decimated.as_ref().unwrap_or(&full);
    write(mesh, output, arguments.ascii)?;
    if let Some(path) = &arguments.picture {
        let meshes = [(&original, "the input"), (&full, "remeshed"), (mesh, "decimated")];
        let shown = if decimation.is_some() { &meshes[..] } else { &meshes[..2] };
        draw(shown, path, &progress)?;
    }

    let report = RemeshReport {
        triangles_in: original.triangles().len(),
        vertices_in: original.positions().len(),
        base_quads: quads,
        vertices,
        folded: remeshed.folded,
        seconds: seconds_remesh,
        rms: measured.rms,
        max: measured.max,
        rms_rel: measured.rms_rel(),
        max_rel: measured.max_rel(),
        vertices_out: mesh.positions().len(),
        triangles_out: mesh.triangles().len(),
        decimation,
    };
    if let Some(path) = &arguments.report {
        report::write_json(path, &report)?;
    }
    if !arguments.quiet {
        report::print(&report.text(mesh))?;
    }
    Ok(())
}

/// Pixels across.
const WIDTH: usize = 1100;

fn draw(meshes: &[(&Mesh, &str)], path: &Path, progress: &Progress) -> Result<(), Failure> {
    let turned: Vec<Mesh> = meshes.iter().map(|(mesh, _)| upright(mesh)).collect::<Result<_, _>>()?;
    let exhibits: Vec<Exhibit> = turned
        .iter()
        .zip(meshes)
        .map(|(mesh, (_, subtitle))| Exhibit {
            mesh,
            title: format!("{} triangles", grouped(mesh.triangles().len())),
            subtitle: (*subtitle).to_owned(),
        })
        .collect();
    render::write(&exhibits, WIDTH, path, progress)
}

/// The same mesh with +x up, as pictures have it, where it has +y.
fn upright(mesh: &Mesh) -> Result<Mesh, Failure> {
    let turned = mesh.positions().iter().map(|&[x, y, z]| [y, -x, z]);
    Mesh::new(turned.collect(), mesh.triangles().to_vec())
        .map_err(|error| Failure::Unexpected(error.to_string()))
}

/// What `remesh --report` writes. Distances are between the input and the remesh at full resolution, two-sided, in
/// units of the positions and as shares of the input's diagonal.
#[derive(Debug, Serialize)]
struct RemeshReport {
    triangles_in: usize,
    vertices_in: usize,
    base_quads: usize,
    /// Of the remesh at full resolution.
    vertices: usize,
    /// Its triangles that face away from the input.
    folded: usize,
    /// Of remeshing.
    seconds: f64,
    rms: f64,
    max: f64,
    rms_rel: f64,
    max_rel: f64,
    vertices_out: usize,
    triangles_out: usize,
    /// Where it was decimated.
    #[serde(skip_serializing_if = "Option::is_none")]
    decimation: Option<DecimationReport>,
}

#[derive(Debug, Serialize)]
struct DecimationReport {
    wanted_vertices: usize,
    /// Of decomposing and extracting.
    seconds: f64,
    /// Between the remesh's vertices and where they are in the result, in units of the positions.
    rms: f64,
    /// How far above the best conforming mesh of as many vertices this can be; null where nothing is known.
    certified_gap_db: Option<f64>,
}

impl RemeshReport {
    fn text(&self, mesh: &Mesh) -> String {
        let mut text = format!(
            "{} triangles -> {} quads, subdivided to {} vertices in {:.2} s; RMS distance {}, maximum {} of the \
             diagonal; {} folded triangles\n",
            grouped(self.triangles_in),
            grouped(self.base_quads),
            grouped(self.vertices),
            self.seconds,
            percent(self.rms_rel),
            percent(self.max_rel),
            self.folded,
        );
        if let Some(decimation) = &self.decimation {
            text += &format!(
                "decimated to {} in {:.2} s; RMS {}\n",
                report::size(mesh),
                decimation.seconds,
                report::significant(decimation.rms),
            );
        }
        text
    }
}
