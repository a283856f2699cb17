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

/// Blocks in a group, which one thread looks at in a go.
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
    /// between their least and largest vertex: of all where no spans are known.
    ///
    /// Faces that have none of these vertices, and have none later, may change meanwhile.
    pub(crate) fn new(faces: &[Face], spans: &Spans, vertices: Range<u32>) -> Self {
        let (first, own) = (vertices.start, vertices.len());
        let mut near = Vec::new();
        let mut of_block = [0; FACE_BLOCK];
        for (base, block, is_within) in spans.touching(faces, &vertices) {
            if is_within {
                near.extend(base as u32..(base + block.len()) as u32);
                continue;
            }
            let mut count = 0;
            // Written always and counted if near: a branch would miss.
            for (face, index) in block.iter().zip(base as u32..) {
                of_block[count] = index;
                let is_own = |corner: u32| (corner.wrapping_sub(first) as usize) < own;
                let [a, b, c] = corners(face).map(is_own);
                count += usize::from(a | b | c);
            }
            near.extend_from_slice(&of_block[..count]);
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

/// The least and the largest vertex of each block of faces, as a range, and of each group of blocks: a tile that
/// looked at every block would make the time of all tiles grow as the square of the surface.
#[derive(Debug, Default)]
pub(crate) struct Spans {
    groups: Vec<Range<u32>>,
    blocks: Vec<Range<u32>>,
}

impl Spans {
    pub(super) fn new(faces: &[Face], workers: &Workers) -> Self {
        let of_group = |faces: &[Face]| -> Vec<Range<u32>> {
            faces.chunks(FACE_BLOCK).map(|block| span(block.iter().map(corners))).collect()
        };
        let blocks = workers.map(faces.chunks(BLOCKS * FACE_BLOCK).collect(), of_group).concat();
        let hull = |spans: &[Range<u32>]| {
            let bounds = spans.iter().map(|span| (span.start, span.end));
            let (start, end) = bounds.fold((NONE, 0), |(a, b), (start, end)| (a.min(start), b.max(end)));
            start..end
        };
        Self { groups: blocks.chunks(BLOCKS).map(hull).collect(), blocks }
    }

    /// The blocks of `faces` that may have one of `vertices`, as which face is their first, and whether they have
    /// no others. No span is known of a surface that was not worth it: any of its blocks may have any vertex.
    pub(super) fn touching<'a>(
        &'a self,
        faces: &'a [Face],
        vertices: &'a Range<u32>,
    ) -> impl Iterator<Item = (usize, &'a [Face], bool)> {
        let touches = |span: &Range<u32>| span.start < vertices.end && vertices.start < span.end;
        let is_within = |span: &Range<u32>| vertices.start <= span.start && span.end <= vertices.end;
        let group_length = BLOCKS * FACE_BLOCK;
        let groups = faces.chunks(group_length).enumerate();
        let near = groups.filter(move |&(group, _)| self.groups.get(group).is_none_or(touches));
        near.flat_map(move |(group, faces)| {
            faces.chunks(FACE_BLOCK).enumerate().filter_map(move |(block, faces)| {
                let span = self.blocks.get(group * BLOCKS + block);
                let first = group * group_length + block * FACE_BLOCK;
                span.is_none_or(touches).then(|| (first, faces, span.is_none_or(is_within)))
            })
        })
    }
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
    /// Samples a vertex, in units of 2⁻³².
    density: u64,
    offsets: Vec<u32>,
    corners: Vec<u32>,
}

impl SampledRings {
    /// Those of `count` of the `vertices`, or a few less, in time linear in the faces.
    pub(super) fn new(faces: &[Face], vertices: usize, count: usize, workers: &Workers) -> Self {
        let density = ((count as u64) << 32) / (vertices as u64).max(1);
        let mut rings = Self { density, offsets: Vec::new(), corners: Vec::new() };
        let samples = vertices.checked_sub(1).map_or(0, |last| rings.index(last as u32) + 1);
        rings.offsets = vec![0; samples + 1];
        let length = BLOCKS * FACE_BLOCK;
        let found = workers.map(faces.chunks(length).enumerate().collect(), |(chunk, faces)| {
            let mut found = Vec::new();
            for (face, index) in faces.iter().zip((chunk * length) as u32..) {
                let corners = corners(face);
                let [a, b, c] = corners.map(|vertex| rings.is_sample(vertex));
                if !(a | b | c) {
                    continue;
                }
                for (corner, vertex) in (0..).zip(corners) {
                    if rings.is_sample(vertex) {
                        found.push((rings.index(vertex), index << 2 | corner));
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

    /// How many samples there are.
    pub(crate) fn count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The vertex of a sample: the first to which its index belongs.
    pub(crate) fn vertex(&self, index: usize) -> u32 {
        ((index as u64) << 32).div_ceil(self.density) as u32
    }

    /// The sample that is at a vertex, or the last before it.
    fn index(&self, vertex: u32) -> usize {
        ((u64::from(vertex) * self.density) >> 32) as usize
    }

    /// Whether a vertex is the first to which an index belongs.
    #[inline(always)]
    fn is_sample(&self, vertex: u32) -> bool {
        u64::from((u64::from(vertex) * self.density) as u32) < self.density
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use std::sync::atomic::AtomicU32;

    use super::*;

    const VERTICES: u32 = 3000;

    /// Faces that mostly follow their vertices, and some that do not.
    fn faces() -> impl Strategy<Value = Vec<[u32; 3]>> {
        let face = (0..VERTICES, 1u32..40, 1u32..40, prop::bool::weighted(0.01)).prop_map(
            |(vertex, next, previous, far)| {
                let reach = if far { 50 } else { 1 };
                [vertex, (vertex + reach * next) % VERTICES, (vertex + reach * next + previous) % VERTICES]
            },
        );
        prop::collection::vec(face, 0..4000).prop_map(|mut faces| {
            faces.sort_unstable();
            faces
        })
    }

    fn atomic(faces: &[[u32; 3]]) -> Vec<Face> {
        faces.iter().map(|face| face.map(AtomicU32::new)).collect()
    }

    fn around(faces: &[[u32; 3]], vertex: u32) -> Vec<u32> {
        let corners = faces.iter().zip(0..).flat_map(|(face, index)| {
            face.iter().zip(0..).map(move |(&vertex, corner)| (vertex, index << 2 | corner))
        });
        corners.filter(|&(of, _)| of == vertex).map(|(_, corner)| corner).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// With spans and without, of any range.
        #[test]
        fn rings_are_those_of_all_faces(faces in faces(), bounds in [0..=VERTICES, 0..=VERTICES]) {
            let [start, end] = [bounds[0].min(bounds[1]), bounds[0].max(bounds[1])];
            let atomic = atomic(&faces);
            for spans in [Spans::default(), Spans::new(&atomic, &Workers::Caller)] {
                let rings = Rings::new(&atomic, &spans, start..end);
                for vertex in (start..end).step_by(37) {
                    prop_assert_eq!(rings.around(vertex), around(&faces, vertex));
                }
            }
        }

        /// No block is left out that has one of the vertices, and none passes for having no others that has some.
        #[test]
        fn spans_leave_out_no_face(faces in faces(), start in 0..VERTICES, length in 0..VERTICES) {
            let vertices = start..(start + length).min(VERTICES);
            let atomic = atomic(&faces);
            let spans = Spans::new(&atomic, &Workers::Caller);
            let mut seen = vec![false; faces.len()];
            for (first, block, is_within) in spans.touching(&atomic, &vertices) {
                for (index, face) in (first..).zip(block) {
                    seen[index] = true;
                    prop_assert!(!is_within || corners(face).iter().all(|corner| vertices.contains(corner)));
                }
            }
            for (face, seen) in faces.iter().zip(seen) {
                prop_assert!(seen || !face.iter().any(|corner| vertices.contains(corner)));
            }
        }

        /// As many as are asked for but one, strided evenly, each with its corners.
        #[test]
        fn samples_are_strided(faces in faces(), count in 1usize..=VERTICES as usize) {
            let rings = SampledRings::new(&atomic(&faces), VERTICES as usize, count, &Workers::Caller);
            prop_assert!((count - 1..=count).contains(&rings.count()), "{} of {}", rings.count(), count);
            let vertices: Vec<u32> = (0..rings.count()).map(|index| rings.vertex(index)).collect();
            let stride = f64::from(VERTICES) / count as f64;
            for (index, &vertex) in vertices.iter().enumerate() {
                prop_assert!(vertex < VERTICES);
                prop_assert!((f64::from(vertex) - index as f64 * stride).abs() <= 1.0 + 1e-6 * f64::from(vertex));
            }
            for index in (0..rings.count()).step_by(61) {
                prop_assert_eq!(rings.around(index), around(&faces, vertices[index]));
            }
        }
    }
}
