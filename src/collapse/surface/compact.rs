//! The end of a pass: what has died goes.

use super::remains::last_merged;
use super::rings::split;
use super::{Face, NONE, Surface, flag, is_alive};
use crate::mesh::Attributes;
use crate::workers::Workers;
use std::sync::atomic::Ordering::Relaxed;

/// Vertices in a block of parallel work.
const BLOCK: usize = 1 << 15;

impl Surface {
    /// Drops dead vertices and faces, keeping the order of the others, and ends the pass: no
    /// vertex is used any more.
    pub(crate) fn compact(&mut self, workers: &Workers) {
        let Self {
            points,
            faces,
            wedges,
            flags,
            attributes,
            attribute_errors,
            merged,
            absorbed,
            origins,
            sources,
            ..
        } = self;
        let map = &successors(flags, workers)[..];
        if let Some(origins) = origins {
            for origin in origins.iter_mut().filter(|origin| **origin != NONE) {
                *origin = last_merged(merged, *origin).map_or(NONE, |vertex| map[vertex as usize]);
            }
        }
        retain_alive(points, map, workers);
        sources.iter_mut().for_each(|sources| retain_alive(sources, map, workers));
        let Attributes { normals, colors, uvs } = attributes;
        normals.iter_mut().for_each(|normals| retain_alive(normals, map, workers));
        colors.iter_mut().for_each(|colors| retain_alive(colors, map, workers));
        uvs.iter_mut().for_each(|uvs| retain_alive(uvs, map, workers));
        if !attribute_errors.is_empty() {
            retain_alive(attribute_errors, map, workers);
        }
        flags.retain(|flags| flags & flag::DEAD == 0);
        flags.iter_mut().for_each(|flags| *flags &= !flag::USED);
        if origins.is_some() {
            merged.clear();
            merged.extend(0..flags.len() as u32);
        }
        if !absorbed.is_empty() {
            absorbed.clear();
            absorbed.resize(flags.len(), NONE);
        }

        // Blocks of faces are packed in place side by side, and then moved together.
        let length = faces.len().div_ceil(workers.count()).max(1);
        let corners = wedges.len();
        let cuts = (1..faces.len().div_ceil(length)).map(|block| (block * length).min(corners));
        let blocks = faces.chunks_mut(length).zip(split(wedges, cuts)).collect();
        let counts = workers.map(blocks, |(block, wedges): (&mut [Face], &mut [Face])| {
            pack_wedges(wedges, block);
            pack_faces(block, map)
        });
        let mut kept = 0;
        for (index, count) in counts.into_iter().enumerate() {
            let first = index * length;
            if first != kept {
                (0..count).for_each(|face| faces.swap(kept + face, first + face));
                if !wedges.is_empty() {
                    (0..count).for_each(|face| wedges.swap(kept + face, first + face));
                }
            }
            kept += count;
        }
        faces.truncate(kept);
        wedges.truncate(kept);
    }
}

/// Moves the living faces of a block to its front, their corners renamed by `map`: how many.
fn pack_faces(block: &mut [Face], map: &[u32]) -> usize {
    let mut kept = 0;
    for index in 0..block.len() {
        let [a, b, c] = block[index].each_ref().map(|corner| corner.load(Relaxed));
        // Written always and counted if alive: as fast as the memory, where a branch would miss.
        for (corner, into) in [a, b, c].into_iter().zip(&mut block[kept]) {
            *into.get_mut() = map[corner as usize];
        }
        kept += usize::from(a != b);
    }
    kept
}

/// Moves the wedges of a block's living faces to its front; none where there are none.
fn pack_wedges(wedges: &mut [Face], faces: &[Face]) {
    let mut kept = 0;
    for (index, face) in faces.iter().enumerate().take(wedges.len()) {
        wedges.swap(kept, index);
        kept += usize::from(is_alive(face));
    }
}

/// For each vertex its number among the living, or [`NONE`].
fn successors(flags: &[u8], workers: &Workers) -> Vec<u32> {
    let is_alive = |flags: &u8| flags & flag::DEAD == 0;
    let blocks: Vec<&[u8]> = flags.chunks(BLOCK).collect();
    let counts = workers.map(blocks, |block| block.iter().filter(|flags| is_alive(flags)).count() as u32);
    let mut map = vec![NONE; flags.len()];
    let starts = counts.into_iter().scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count)));
    let blocks = map.chunks_mut(BLOCK).zip(flags.chunks(BLOCK)).zip(starts).collect();
    workers.map(blocks, |((map, flags), mut successor): ((&mut [u32], &[u8]), u32)| {
        for (into, flags) in map.iter_mut().zip(flags) {
            *into = if is_alive(flags) { successor } else { NONE };
            successor += u32::from(is_alive(flags));
        }
    });
    map
}

/// Moves the values of vertices that have a successor to the front.
fn retain_alive<T: Copy + Send>(values: &mut Vec<T>, map: &[u32], workers: &Workers) {
    let blocks = values.chunks_mut(BLOCK).zip(map.chunks(BLOCK)).collect();
    let counts = workers.map(blocks, |(values, map): (&mut [T], &[u32])| {
        let mut kept = 0;
        // Written always and counted if alive, as in `pack_faces`.
        for (index, successor) in map.iter().enumerate() {
            values[kept] = values[index];
            kept += usize::from(*successor != NONE);
        }
        kept
    });
    let mut kept = 0;
    for (block, count) in counts.into_iter().enumerate() {
        let first = block * BLOCK;
        values.copy_within(first..first + count, kept);
        kept += count;
    }
    values.truncate(kept);
}
