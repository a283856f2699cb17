//! Which faces surround each vertex.
//!
//! The paper keeps the rings of all vertices through a pass. Here those of a tile are found when a thread
//! comes to it, and forgotten with it: they lie in the cache while they are needed, are found by all threads
//! at once, and 14 bytes a triangle, two fifths of all memory, are not needed at all.

use super::{Face, NONE, corners};
use crate::workers::Workers;
use std::ops::Range;

/// Faces in a block of which the least and the largest vertex are noted.
const FACE_BLOCK: usize = 256;

/// Blocks that one thread looks at in a go.
const BLOCKS: usize = 128;

/// The faces around some vertices, as corners `face << 2 | corner`, in compressed rows. Within a row, corners
/// are in face order.
#[derive(Debug, Default)]
pub(crate) struct Rings {
    first: u32,
    /// The ring of `first + i`: `corners[offsets[i]..offsets[i + 1]]`.
    offsets: Vec<u32>,
    corners: Vec<u32>,
}

impl Rings {
    /// The rings of the vertices of a range, in time linear in the faces of the blocks that have one of them
    /// between their least and largest vertex: of all where no `spans` are given.
    ///
    /// Faces that have none of these vertices, and have none later, may change meanwhile.
    pub(crate) fn new(faces: &[Face], spans: &[Range<u32>], vertices: Range<u32>) -> Self {
        let (first, own) = (vertices.start, vertices.len());
        let mut near = Vec::new();
        for (base, block) in touching(faces, spans, &vertices) {
            let mut count = near.len();
            near.resize(count + block.len(), 0);
            // Written always and counted if near: a branch would miss.
            for (face, index) in block.iter().zip(base as u32..) {
                near[count] = index;
                let is_own = |corner: u32| (corner.wrapping_sub(first) as usize) < own;
                let [a, b, c] = corners(face).map(is_own);
                count += usize::from(a | b | c);
            }
            near.truncate(count);
        }
        let mut offsets = vec![0u32; own + 1];
        for &index in &near {
            for corner in corners(&faces[index as usize]) {
                if let Some(degree) = offsets[..own].get_mut(corner.wrapping_sub(first) as usize) {
                    *degree += 1;
                }
            }
        }
        let mut corners_around = vec![0; to_ends(&mut offsets)];
        for &index in near.iter().rev() {
            for (corner, vertex) in (0..).zip(corners(&faces[index as usize])) {
                if let Some(end) = offsets[..own].get_mut(vertex.wrapping_sub(first) as usize) {
                    *end -= 1;
                    corners_around[*end as usize] = index << 2 | corner;
                }
            }
        }
        Self { first, offsets, corners: corners_around }
    }

    /// The corners around `vertex`, which is one of the range.
    #[inline(always)]
    pub(crate) fn around(&self, vertex: u32) -> &[u32] {
        let vertex = (vertex - self.first) as usize;
        &self.corners[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }
}

/// The blocks of faces that may have one of `vertices`, and the first face of each.
pub(super) fn touching<'a>(
    faces: &'a [Face],
    spans: &'a [Range<u32>],
    vertices: &'a Range<u32>,
) -> impl Iterator<Item = (usize, &'a [Face])> {
    let touches = |block: usize| {
        spans.get(block).is_none_or(|span| span.start < vertices.end && vertices.start < span.end)
    };
    let blocks = faces.chunks(FACE_BLOCK).enumerate();
    blocks.filter(move |&(block, _)| touches(block)).map(|(block, faces)| (block * FACE_BLOCK, faces))
}

/// The least and the largest vertex of each block of faces, as a range.
pub(super) fn spans(faces: &[Face], workers: &Workers) -> Vec<Range<u32>> {
    let of_blocks = |faces: &[Face]| -> Vec<Range<u32>> {
        faces.chunks(FACE_BLOCK).map(|block| span(block.iter().map(corners))).collect()
    };
    workers.map(faces.chunks(BLOCKS * FACE_BLOCK).collect(), of_blocks).concat()
}

/// Whether triangles that follow each other have vertices near each other, so that few blocks of them have
/// a vertex of a given range of `reach` between their least and largest one: a sample of the blocks, as found
/// by `renamed`, reaches over four ranges at most in the mean.
pub(crate) fn are_coherent(triangles: &[[u32; 3]], renamed: impl Fn(u32) -> u32, reach: u32) -> bool {
    const SAMPLES: usize = 256;
    let stride = triangles.len().div_ceil(FACE_BLOCK * SAMPLES).max(1);
    let blocks = triangles.chunks(FACE_BLOCK).step_by(stride);
    let count = blocks.len() as u64;
    let reached = |block: &[[u32; 3]]| {
        let span = span(block.iter().map(|triangle| triangle.map(&renamed)));
        u64::from(span.len() as u32 / reach)
    };
    blocks.map(reached).sum::<u64>() <= 4 * count
}

/// The vertices from the least to the largest corner.
fn span(faces: impl Iterator<Item = [u32; 3]>) -> Range<u32> {
    let (least, largest) =
        faces.flatten().fold((NONE, 0), |(least, largest), corner| (least.min(corner), largest.max(corner)));
    least..largest.saturating_add(1)
}

/// The corners around vertices strided over all of them, row by row: see [`Rings`].
pub(crate) struct SampledRings {
    vertices: usize,
    count: usize,
    offsets: Vec<u32>,
    corners: Vec<u32>,
}

impl SampledRings {
    /// Those of `count` of the `vertices`, in time linear in the faces.
    pub(super) fn new(faces: &[Face], vertices: usize, count: usize, workers: &Workers) -> Self {
        let mut chosen = vec![0u64; vertices.div_ceil(64)];
        let mut rings = Self { vertices, count, offsets: vec![0; count + 1], corners: Vec::new() };
        (0..count).map(|index| rings.vertex(index)).for_each(|v| chosen[v as usize >> 6] |= 1 << (v & 63));
        let length = BLOCKS * FACE_BLOCK;
        let found = workers.map(faces.chunks(length).enumerate().collect(), |(chunk, faces)| {
            let mut found = Vec::new();
            for (index, face) in faces.iter().enumerate() {
                for (corner, vertex) in corners(face).into_iter().enumerate() {
                    if chosen[vertex as usize >> 6] >> (vertex & 63) & 1 != 0 {
                        found.push((rings.index(vertex), ((chunk * length + index) << 2 | corner) as u32));
                    }
                }
            }
            found
        });
        for &(index, _) in found.iter().flatten() {
            rings.offsets[index] += 1;
        }
        rings.corners = vec![0; to_ends(&mut rings.offsets)];
        for &(index, corner) in found.iter().flatten().rev() {
            let end = &mut rings.offsets[index];
            *end -= 1;
            rings.corners[*end as usize] = corner;
        }
        rings
    }

    /// The vertex of a sample.
    pub(crate) fn vertex(&self, index: usize) -> u32 {
        (index * self.vertices / self.count) as u32
    }

    /// The sample of a vertex that is one.
    fn index(&self, vertex: u32) -> usize {
        (vertex as usize * self.count).div_ceil(self.vertices)
    }

    /// The corners around the vertex of a sample.
    pub(crate) fn around(&self, index: usize) -> &[u32] {
        &self.corners[self.offsets[index] as usize..self.offsets[index + 1] as usize]
    }
}

/// Makes of the sizes of rows where each ends, from which it counts back to its beginning while the row is filled
/// backwards; how much all hold.
fn to_ends(sizes: &mut [u32]) -> usize {
    let mut sum = 0;
    for size in sizes {
        sum += *size;
        *size = sum;
    }
    sum as usize
}

/// Cuts a slice before each of `cuts`, which ascend.
pub(super) fn split<T>(slice: &mut [T], cuts: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let mut pieces = Vec::new();
    let (mut rest, mut first) = (slice, 0);
    for cut in cuts {
        let (piece, tail) = rest.split_at_mut(cut - first);
        pieces.push(piece);
        (rest, first) = (tail, cut);
    }
    pieces.push(rest);
    pieces
}
