//! Vertices in an order in which neighbours lie near each other.
//!
//! Tiles are runs of vertices, so a mesh whose vertices come in random order would have nothing but
//! rings that leave their tile; and every gather would miss the cache. Most scans are coherent as
//! they are, and keep their order.

use crate::mesh::Mesh;

/// Faces looked at.
const SAMPLES: usize = 4096;
/// The share of faces that may reach far before the mesh is put in order.
const INCOHERENT: f32 = 0.03;

/// Where each vertex shall go, if more than 3 % of the (sampled) faces reach further than `reach`
/// in the order that the mesh has. Linear time: a counting sort by cells on a Morton curve.
pub(crate) fn rank(mesh: &Mesh, reach: usize) -> Option<Vec<u32>> {
    let vertices = mesh.positions().len();
    let stride = (mesh.triangles().len() / SAMPLES).max(1);
    let sample = || mesh.triangles().iter().step_by(stride);
    let far = |&&[a, b, c]: &&[u32; 3]| (a.max(b).max(c) - a.min(b).min(c)) as usize > reach;
    let share = sample().filter(far).count() as f32 / sample().len().max(1) as f32;
    (share > INCOHERENT && vertices > 2 * reach).then(|| morton_rank(mesh.positions()))
}

/// The place of each vertex when they are sorted by cell along a Morton curve, in the order they
/// have within a cell. There are at most as many cells as vertices.
fn morton_rank(positions: &[[f32; 3]]) -> Vec<u32> {
    let bits = (positions.len().max(8).ilog2() / 3).min(10);
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for position in positions {
        for axis in 0..3 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    let extent = (0..3).map(|axis| f64::from(high[axis]) - f64::from(low[axis])).fold(0.0, f64::max);
    let last = (1u32 << bits) - 1;
    let per_unit = if extent > 0.0 { f64::from(1 << bits) / extent } else { 0.0 };
    let cell = |position: &[f32; 3]| {
        (0..3).fold(0, |cell, axis| {
            let along = (f64::from(position[axis]) - f64::from(low[axis])) * per_unit;
            cell | spread((along as u32).min(last)) << axis
        })
    };
    let mut starts = vec![0u32; (1 << (3 * bits)) + 1];
    let mut ranks: Vec<u32> = positions.iter().map(cell).collect();
    ranks.iter().for_each(|&cell| starts[cell as usize + 1] += 1);
    for index in 1..starts.len() {
        starts[index] += starts[index - 1];
    }
    for rank in &mut ranks {
        let start = &mut starts[*rank as usize];
        *rank = *start;
        *start += 1;
    }
    ranks
}

/// Two empty bits between each two of the lowest ten.
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 16) & 0x0300_00ff;
    let bits = (bits | bits << 8) & 0x0300_f00f;
    let bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}
