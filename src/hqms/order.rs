//! Vertices in an order in which neighbours lie near each other.
//!
//! Tiles are runs of vertices, so a mesh whose vertices come in random order would have nothing but
//! rings that leave their tile; and every gather would miss the cache. Most scans are coherent as
//! they are, and keep their order.

use crate::mesh::Mesh;
use crate::mesh::places::Places;
use glam::Vec3A;

/// Faces looked at.
const SAMPLES: usize = 4096;
/// The share of faces that may reach far before the mesh is put in order.
const INCOHERENT: f32 = 0.03;

/// Where each vertex shall go, those in one of the `places` being its first, if more than 3 % of the (sampled) faces reach further than `reach`
/// in the order that the mesh has. Linear time: a counting sort by cells on a Morton curve.
pub(crate) fn rank(mesh: &Mesh, places: Option<&Places>, reach: usize) -> Option<Vec<u32>> {
    let vertices = mesh.positions().len();
    let stride = (mesh.triangles().len() / SAMPLES).max(1);
    let sample = || mesh.triangles().iter().step_by(stride);
    let far = |&&triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| places.map_or(vertex, |places| places.first[vertex as usize]));
        (a.max(b).max(c) - a.min(b).min(c)) as usize > reach
    };
    let share = sample().filter(far).count() as f32 / sample().len().max(1) as f32;
    (share > INCOHERENT && vertices > 2 * reach).then(|| morton_rank(mesh.positions()))
}

/// The place of each vertex when they are sorted by cell along a Morton curve, in the order they
/// have within a cell. There are at most as many cells as vertices.
fn morton_rank(positions: &[[f32; 3]]) -> Vec<u32> {
    let bits = (positions.len().max(8).ilog2() / 3).min(10);
    let points = || positions.iter().map(|&position| Vec3A::from_array(position));
    let (low, high) =
        points().fold((Vec3A::INFINITY, -Vec3A::INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    // The extent of finite coordinates may be infinite: then all are in cell 0, which is an order too.
    let per_unit = (1 << bits) as f32 / (high - low).max_element().max(f32::MIN_POSITIVE);
    let last = Vec3A::splat(((1 << bits) - 1) as f32);
    let cell = |point: Vec3A| {
        let along = ((point - low) * per_unit).min(last).as_uvec3();
        spread(along.x) | spread(along.y) << 1 | spread(along.z) << 2
    };
    let mut starts = vec![0u32; (1 << (3 * bits)) + 1];
    let mut ranks: Vec<u32> = points().map(cell).collect();
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
