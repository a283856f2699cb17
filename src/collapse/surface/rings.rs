//! Which faces surround each vertex.

use super::{Face, NONE, Surface, VERTEX_BLOCK};
use crate::workers::Workers;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Faces in a block of parallel work over faces.
const FACE_BLOCK: usize = 1 << 15;

impl Surface {
    /// Builds the rings, in time linear in the faces. Within a ring, corners are in face order.
    pub(crate) fn build_rings(&mut self, workers: &Workers) {
        let vertices = self.points.len();
        let Self { faces, offsets, incidence, .. } = self;
        offsets.clear();
        offsets.resize(vertices + 1, 0);
        if incidence.len() > faces.len() {
            incidence.truncate(faces.len());
        } else {
            incidence.resize_with(faces.len(), Face::default);
        }
        // Each worker owns a range of vertices and passes over the faces; blocks of faces that do
        // not touch its range are skipped, which in an ordered mesh is nearly all of them.
        let ranges = if vertices > VERTEX_BLOCK { workers.count() } else { 1 };
        let bound = |range: usize| range * vertices / ranges;
        let spans: Vec<(u32, u32)> = if ranges == 1 {
            vec![(0, NONE); faces.len().div_ceil(FACE_BLOCK)]
        } else {
            workers.map(faces.chunks(FACE_BLOCK).collect(), span)
        };
        let touching = |first: u32, last: u32| {
            let blocks = faces.chunks(FACE_BLOCK).zip(&spans).enumerate();
            blocks
                .filter(move |(_, (_, span))| span.0 < last && span.1 >= first)
                .map(|(index, (block, _))| (index * FACE_BLOCK, block))
        };
        let pieces = split(&mut offsets[..vertices], (1..ranges).map(bound));
        let sums = workers.map(pieces.into_iter().enumerate().collect(), |(range, degrees)| {
            let first = bound(range) as u32;
            let own = degrees.len();
            for (_, block) in touching(first, first + own as u32) {
                for corner in block.iter().flatten() {
                    if let Some(degree) = degrees.get_mut(corner.load(Relaxed).wrapping_sub(first) as usize) {
                        *degree += 1;
                    }
                }
            }
            // Offsets count back from the end of each ring while the rings are filled.
            degrees.iter_mut().fold(0, |sum, degree| {
                *degree += sum;
                *degree
            })
        });
        let starts: Vec<u32> =
            sums.iter().scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect();
        offsets[vertices] = sums.iter().sum();
        let pieces = split(&mut offsets[..vertices], (1..ranges).map(bound));
        let rings = split(incidence.as_flattened_mut(), starts.iter().skip(1).map(|&start| start as usize));
        let pieces = pieces.into_iter().zip(rings).enumerate().collect();
        workers.map(pieces, |(range, (offsets, ring)): (usize, (&mut [u32], &mut [AtomicU32]))| {
            let first = bound(range) as u32;
            let last = first + offsets.len() as u32;
            let blocks: Vec<_> = touching(first, last).collect();
            for (base, block) in blocks.into_iter().rev() {
                for (index, face) in block.iter().enumerate().rev() {
                    for (corner, vertex) in face.iter().enumerate() {
                        let vertex = vertex.load(Relaxed).wrapping_sub(first) as usize;
                        if let Some(end) = offsets.get_mut(vertex) {
                            *end -= 1;
                            *ring[*end as usize].get_mut() = ((base + index) as u32) << 2 | corner as u32;
                        }
                    }
                }
            }
            for offset in offsets {
                *offset += starts[range];
            }
        });
    }
}

/// The smallest and the largest vertex of the faces.
fn span(faces: &[Face]) -> (u32, u32) {
    let corners = faces.iter().flatten().map(|corner| corner.load(Relaxed));
    corners.fold((NONE, 0), |(low, high), corner| (low.min(corner), high.max(corner)))
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
