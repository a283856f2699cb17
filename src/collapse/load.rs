//! How a mesh becomes a surface: its scale, and its faces in a good order.

use super::surface::{Face, are_coherent};
use crate::mesh::Mesh;
use crate::workers::Workers;
use glam::Vec3;
use std::borrow::Cow;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Faces looked at for the scale.
const SAMPLES: usize = 1024;

/// Triangles are in good order if those that follow each other have vertices this near: as many as a tile has.
const REACH: u32 = 16384;

/// A power of two that makes edges about one unit long: products of four of them and more then
/// neither overflow nor vanish in single precision, however fine or large the mesh.
pub(crate) fn unit_scale(mesh: &Mesh) -> f32 {
    let position = |vertex: u32| Vec3::from(mesh.positions()[vertex as usize]).as_dvec3();
    let longest = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(position);
        (b - a).length().max((c - b).length()).max((a - c).length())
    };
    let stride = mesh.triangles().len().div_ceil(SAMPLES).max(1);
    let sampled = mesh.triangles().iter().step_by(stride).map(longest);
    let mut lengths: Vec<f64> = sampled.filter(|&length| length > 0.0).collect();
    if lengths.is_empty() {
        return 1.0;
    }
    let middle = lengths.len() / 2;
    let (_, &mut length, _) = lengths.select_nth_unstable_by(middle, f64::total_cmp);
    let exponent = -length.log2().floor();
    // The bits of numbers that are not negative order as these do, and compare four at a time.
    let largest = mesh.positions().as_flattened().iter().map(|x| x.abs().to_bits().cast_signed()).max();
    let room = |largest: f32| 100.0 - f64::from(largest).log2().ceil();
    let mut room_left = room(f32::from_bits(largest.unwrap_or(0).cast_unsigned()));
    if room_left < exponent {
        // Vertices that no triangle uses must not set the scale.
        let used = mesh.triangles().as_flattened().iter().flat_map(|&v| mesh.positions()[v as usize]);
        room_left = room(used.map(f32::abs).fold(0.0, f32::max));
    }
    f32::exp2(exponent.min(room_left).clamp(-126.0, 126.0) as f32)
}

/// `values[v]` goes to `rank[v]`.
pub(super) fn scatter<T: Copy + Default>(values: impl ExactSizeIterator<Item = T>, rank: &[u32]) -> Vec<T> {
    let mut scattered = vec![T::default(); rank.len()];
    for (value, &place) in values.zip(rank) {
        scattered[place as usize] = value;
    }
    scattered
}

/// The faces of a mesh, and the wedges of their corners; these are empty where each vertex has one.
pub(super) struct Faces {
    pub(super) faces: Vec<Face>,
    pub(super) wedges: Vec<Face>,
}

/// The triangles that are `whole`, `renamed`, and if there is a rank, or they lie in no order that the vertices
/// have, sorted into buckets of 64 vertices by their first corner, so that faces lie in memory as their
/// vertices do. `wedges` are those of the corners
/// of all triangles.
pub(super) fn ordered_faces(
    triangles: Cow<[[u32; 3]]>,
    wedges: Option<&[[u32; 3]]>,
    vertices: usize,
    is_ranked: bool,
    whole: impl Fn(&[u32; 3]) -> bool + Sync,
    renamed: impl Fn(u32) -> u32 + Sync,
    workers: &Workers,
) -> Faces {
    if !is_ranked && are_coherent(&triangles, &renamed, REACH) {
        let chosen = |triangle: &usize| whole(&triangles[*triangle]);
        let wedges = wedges.map_or(Vec::new(), |wedges| {
            (0..triangles.len()).filter(chosen).map(|index| wedges[index].map(AtomicU32::new)).collect()
        });
        let face = |triangle: [u32; 3]| triangle.map(|vertex| AtomicU32::new(renamed(vertex)));
        let faces = match triangles {
            // In the memory that is there.
            Cow::Owned(mut triangles) => {
                triangles.retain(&whole);
                triangles.into_iter().map(face).collect()
            }
            Cow::Borrowed(triangles) => {
                let mut faces =
                    Vec::with_capacity(triangles.iter().filter(|&triangle| whole(triangle)).count());
                faces.extend(triangles.iter().copied().filter(&whole).map(face));
                faces
            }
        };
        return Faces { faces, wedges };
    }
    let triangles = &*triangles;
    let chosen = |triangle: &usize| whole(&triangles[*triangle]);
    let count = triangles.iter().filter(|triangle| whole(triangle)).count();
    let empty = |count: usize| {
        let mut faces = Vec::new();
        faces.resize_with(count, Face::default);
        faces
    };
    // Each worker counts and then places the triangles of a block; within a bucket, blocks follow
    // each other, so that the order is the same for any number of them.
    let bucket = |triangle: usize| (renamed(triangles[triangle][0]) >> 6) as usize;
    let length = triangles.len().div_ceil(workers.count()).max(1);
    let blocks: Vec<_> = (0..triangles.len())
        .step_by(length)
        .map(|first| first..(first + length).min(triangles.len()))
        .collect();
    let mut counts = workers.map(blocks.clone(), |block| {
        let mut counts = vec![0u32; (vertices >> 6) + 1];
        block.filter(chosen).for_each(|triangle| counts[bucket(triangle)] += 1);
        counts
    });
    let mut sum = 0;
    for bucket in 0..=vertices >> 6 {
        for counts in &mut counts {
            sum += std::mem::replace(&mut counts[bucket], sum);
        }
    }
    let ordered = Faces { faces: empty(count), wedges: empty(if wedges.is_some() { count } else { 0 }) };
    let store = |into: &Face, corners: [u32; 3]| {
        into.iter().zip(corners).for_each(|(into, corner)| into.store(corner, Relaxed));
    };
    workers.map(blocks.into_iter().zip(counts).collect(), |(block, mut starts)| {
        for triangle in block.filter(chosen) {
            let start = &mut starts[bucket(triangle)];
            store(&ordered.faces[*start as usize], triangles[triangle].map(&renamed));
            if let Some(wedges) = wedges {
                store(&ordered.wedges[*start as usize], wedges[triangle]);
            }
            *start += 1;
        }
    });
    ordered
}
