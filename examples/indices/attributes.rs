//! Meshes with normals and texture coordinates, at a tenth of the triangles: whether the target is reached,
//! and what becomes of attributes and seams.

use std::error::Error;

use decimesh::deviation::{Sampling, deviation};
use decimesh::{AttributeWeights, Mesh, Monitor, Options, Target};
use meshopt::SimplifyOptions;

use crate::attribute_error::attribute_error;
use crate::contenders::{self, Measured, NO_ERROR_LIMIT, in_turns, triangles_of};
use crate::cracks::Places;
use crate::{Effort, Subject, geometric_mean};

const SHARE: f64 = 0.1;

/// What an attribute's difference of 1 weighs beside a distance as long as the mesh.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    pub(crate) normal: f32,
    pub(crate) uv: f32,
}

/// Whether `mesh` has normals or texture coordinates.
pub(crate) fn has_any(mesh: &Mesh) -> bool {
    mesh.attributes().normals.is_some() || mesh.attributes().uvs.is_some()
}

/// What is left of a subject.
struct Quality {
    triangles: usize,
    rms: f64,
    normal: Option<f64>,
    uv: Option<f64>,
    cracks: usize,
}

/// Prints two rows for each subject, and means over the subjects.
pub(crate) fn compare(subjects: &[Subject], weights: Weights, effort: Effort) -> Result<(), Box<dyn Error>> {
    println!(
        "With attributes, to {} %; weights: normal {}, uv {}. Median ms of {} rounds, one thread. Bytes: peak\n\
         of the heap beyond the input, an input triangle. RMS: two-sided, over the diagonal. Normal, uv: RMS\n\
         of the difference to the nearest place that faces the same way, the larger of both directions.\n\
         Cracks: open edges, welded by position, where the welded input has none.\n",
        100.0 * SHARE,
        weights.normal,
        weights.uv,
        effort.rounds,
    );
    println!(
        "{:20} {:13} {:>8} {:>8} {:>8} {:>6} {:>8} {:>8} {:>8} {:>6}",
        "mesh", "", "wanted", "reached", "ms", "bytes", "RMS", "normal", "uv", "cracks"
    );
    let mut ratios = Vec::new();
    for subject in subjects {
        let Subject { name, mesh } = subject;
        let wanted = triangles_of(mesh, SHARE);
        let options = options(wanted, weights);
        let packed = PackedAttributes::new(mesh, weights);
        let [own, peer] = in_turns(
            effort.rounds,
            [&|| Ok(vec![contenders::decimesh(mesh, &options)?]), &|| {
                Ok(vec![packed.meshoptimizer(mesh, wanted)?])
            }],
        )?;
        let places = Places::new(mesh)?;
        let [own_quality, peer_quality] =
            [&own, &peer].map(|measured| quality(mesh, &measured.levels[0], &places, effort));
        let (own_quality, peer_quality) = (own_quality?, peer_quality?);
        print_row(mesh, [name, "decimesh"], wanted, &own, &own_quality);
        print_row(mesh, ["", "meshoptimizer"], wanted, &peer, &peer_quality);
        let ratio = |own: Option<f64>, peer: Option<f64>| Some(own? / peer?);
        let row = [
            Some(own.time_over(&peer)),
            Some(own_quality.rms / peer_quality.rms),
            ratio(own_quality.normal, peer_quality.normal),
            ratio(own_quality.uv, peer_quality.uv),
        ];
        println!(
            "{:20} {:13} {:>17} {:>8} {:>6} {:>8} {:>8} {:>8}",
            "",
            "x",
            "",
            cell(row[0]),
            "",
            cell(row[1]),
            cell(row[2]),
            cell(row[3])
        );
        ratios.push(row);
    }
    let mean = |column: usize| geometric_mean(ratios.iter().filter_map(|row| row[column]));
    println!(
        "\ngeometric means: x time {:.3}, x RMS {:.3}, x normal {:.3}, x uv {:.3}\n",
        mean(0),
        mean(1),
        mean(2),
        mean(3)
    );
    Ok(())
}

/// decimesh's options, with the same weights.
fn options(triangles: usize, weights: Weights) -> Options {
    let attribute_weights = AttributeWeights { normals: weights.normal, uvs: weights.uv, colors: 0.0 };
    Options { attribute_weights, ..contenders::options(Target::Triangles(triangles)) }
}

/// Attributes as meshoptimizer takes them, made outside of the timing, which is in its favour.
struct PackedAttributes {
    /// Those of a vertex one after the other.
    values: Vec<f32>,
    /// One for each value of a vertex.
    weights: Vec<f32>,
    /// No vertex is; the crate wants to hear so of each.
    locked: Vec<bool>,
}

impl PackedAttributes {
    fn new(mesh: &Mesh, weights: Weights) -> Self {
        let attributes = mesh.attributes();
        let mut each = Vec::new();
        if attributes.normals.is_some() {
            each.extend([weights.normal; 3]);
        }
        if attributes.uvs.is_some() {
            each.extend([weights.uv; 2]);
        }
        let mut values = Vec::with_capacity(each.len() * mesh.positions().len());
        for vertex in 0..mesh.positions().len() {
            values.extend(attributes.normals.iter().flat_map(|normals| normals[vertex]));
            values.extend(attributes.uvs.iter().flat_map(|uvs| uvs[vertex]));
        }
        Self { values, weights: each, locked: vec![false; mesh.positions().len()] }
    }

    fn meshoptimizer(&self, mesh: &Mesh, triangles: usize) -> Result<Vec<u32>, Box<dyn Error>> {
        Ok(meshopt::simplify_with_attributes_and_locks(
            mesh.triangles().as_flattened(),
            &contenders::vertices(mesh)?,
            &self.values,
            &self.weights,
            size_of_val(self.weights.as_slice()),
            &self.locked,
            3 * triangles,
            NO_ERROR_LIMIT,
            SimplifyOptions::None,
            None,
        ))
    }
}

fn quality(mesh: &Mesh, indices: &[u32], places: &Places, effort: Effort) -> Result<Quality, Box<dyn Error>> {
    let sampling = Sampling { samples: effort.samples, ..Sampling::default() };
    let result = contenders::mesh_of(mesh, indices)?;
    let measured = deviation(mesh, &result, &sampling, &mut Monitor::silent())?;
    let error = attribute_error(mesh, indices, effort.samples);
    Ok(Quality {
        triangles: indices.len() / 3,
        rms: measured.rms_rel(),
        normal: error.normal,
        uv: error.uv,
        cracks: places.cracks(indices),
    })
}

fn print_row(mesh: &Mesh, names: [&str; 2], wanted: usize, measured: &Measured, quality: &Quality) {
    println!(
        "{:20} {:13} {wanted:>8} {:>8} {:>8.1} {:>6.1} {:>8.2e} {:>8} {:>8} {:>6}",
        names[0],
        names[1],
        quality.triangles,
        measured.milliseconds(),
        measured.peak_bytes as f64 / mesh.triangles().len() as f64,
        quality.rms,
        cell(quality.normal),
        cell(quality.uv),
        quality.cracks,
    );
}

fn cell(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.4}"))
}
