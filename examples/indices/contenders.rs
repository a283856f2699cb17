//! Both engines on the same terms: from a mesh to indices of its vertices, on one thread, towards a number
//! of triangles, with no limit of error.

use std::error::Error;
use std::time::Instant;

use decimesh::mesh::MeshError;
use decimesh::{Mesh, Monitor, Options, Placement, Simplified, SimplifyError, Target, simplify};
use meshopt::{SimplifyOptions, VertexDataAdapter};

use crate::allocation;

/// Of meshoptimizer: relative to the extent of the mesh, and beyond what any collapse costs.
pub(crate) const NO_ERROR_LIMIT: f32 = 1e3;

/// Indices of the input's vertices, three a triangle; a list a level.
pub(crate) type Levels = Vec<Vec<u32>>;

/// Something that makes levels, and can do so again.
pub(crate) type Contender<'a> = &'a dyn Fn() -> Result<Levels, Box<dyn Error>>;

/// What the rounds of a contender came to.
pub(crate) struct Measured {
    /// Of each round, in their order.
    pub(crate) seconds: Vec<f64>,
    /// Allocated at once at the highest, beyond the input; the indices returned are part of it.
    pub(crate) peak_bytes: usize,
    pub(crate) levels: Levels,
}

impl Measured {
    pub(crate) fn milliseconds(&self) -> f64 {
        1e3 * median(self.seconds.clone())
    }

    /// The time over that of `other`: the median of the rounds' ratios, as a machine that slows down
    /// meanwhile does so for both.
    pub(crate) fn time_over(&self, other: &Self) -> f64 {
        median(self.seconds.iter().zip(&other.seconds).map(|(own, other)| own / other).collect())
    }
}

/// The middle of `values`, of which there is at least one, or the mean of the middle two.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { (values[middle - 1] + values[middle]) / 2.0 }
}

/// Runs the contenders in turns.
pub(crate) fn in_turns<const N: usize>(
    rounds: usize,
    contenders: [Contender; N],
) -> Result<[Measured; N], Box<dyn Error>> {
    let mut measured = [const { Measured { seconds: Vec::new(), peak_bytes: 0, levels: Vec::new() } }; N];
    for _ in 0..rounds {
        for (contender, measured) in contenders.iter().zip(&mut measured) {
            measured.levels = Vec::new();
            allocation::reset_peak();
            let start = Instant::now();
            measured.levels = contender()?;
            measured.seconds.push(start.elapsed().as_secs_f64());
            measured.peak_bytes = measured.peak_bytes.max(allocation::peak_bytes());
        }
    }
    Ok(measured)
}

/// The share of the triangles of `mesh`, rounded down.
pub(crate) fn triangles_of(mesh: &Mesh, share: f64) -> usize {
    (mesh.triangles().len() as f64 * share) as usize
}

/// decimesh's options for both tables without attributes.
pub(crate) fn options(target: Target) -> Options {
    Options { placement: Placement::Existing, track_sources: true, threads: 1, ..Options::new(target) }
}

/// decimesh, as a user of the Rust API gets indices into the vertices that there are.
pub(crate) fn decimesh(mesh: &Mesh, options: &Options) -> Result<Vec<u32>, SimplifyError> {
    Ok(named_by_input(simplify(mesh, options, &mut Monitor::silent())?))
}

/// The indices of `level`, as those of the input's vertices.
pub(crate) fn named_by_input(level: Simplified) -> Vec<u32> {
    let sources = level.sources.unwrap_or_default();
    level.mesh.triangles().as_flattened().iter().map(|&index| sources[index as usize]).collect()
}

/// meshoptimizer's `simplify`, of the triangles that `indices` name.
pub(crate) fn meshoptimizer(
    mesh: &Mesh,
    indices: &[u32],
    triangles: usize,
    options: SimplifyOptions,
) -> Result<Vec<u32>, Box<dyn Error>> {
    let vertices = vertices(mesh)?;
    Ok(meshopt::simplify(indices, &vertices, 3 * triangles, NO_ERROR_LIMIT, options, None))
}

/// The positions, as meshoptimizer takes them.
pub(crate) fn vertices(mesh: &Mesh) -> Result<VertexDataAdapter<'_>, meshopt::Error> {
    VertexDataAdapter::new(meshopt::typed_to_bytes(mesh.positions()), size_of::<[f32; 3]>(), 0)
}

/// The mesh of what `indices` name, without the vertices that they do not.
pub(crate) fn mesh_of(input: &Mesh, indices: &[u32]) -> Result<Mesh, MeshError> {
    let mut successors = vec![u32::MAX; input.positions().len()];
    let mut positions = Vec::new();
    let mut renamed = Vec::with_capacity(indices.len());
    for &index in indices {
        let successor = &mut successors[index as usize];
        if *successor == u32::MAX {
            *successor = positions.len() as u32;
            positions.push(input.positions()[index as usize]);
        }
        renamed.push(*successor);
    }
    Mesh::from_buffers(&positions, &renamed)
}
