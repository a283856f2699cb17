//! The end of a pass: what has died goes.

use super::remains::last_merged;
use super::rings::split;
use super::{Face, NONE, Surface, flag, is_alive};
use crate::mesh::Attributes;
use crate::workers::Workers;
use std::sync::atomic::Ordering::Relaxed;

impl Surface {
    /// Drops dead vertices and faces, keeping the order of the others, and ends the pass: no
    /// vertex is used any more. The rings are lost.
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
            offsets: map,
            ..
        } = self;
        map.clear();
        map.reserve(points.len());
        let mut kept = 0;
        map.extend(flags.iter().map(|flags| {
            let dead = flags & flag::DEAD != 0;
            let successor = if dead { NONE } else { kept };
            kept += u32::from(!dead);
            successor
        }));
        if let Some(origins) = origins {
            for origin in origins.iter_mut().filter(|origin| **origin != NONE) {
                *origin = last_merged(merged, *origin).map_or(NONE, |vertex| map[vertex as usize]);
            }
            merged.clear();
            merged.extend(0..kept);
        }
        retain_alive(points, flags);
        sources.iter_mut().for_each(|sources| retain_alive(sources, flags));
        let Attributes { normals, colors, uvs } = attributes;
        normals.iter_mut().for_each(|normals| retain_alive(normals, flags));
        colors.iter_mut().for_each(|colors| retain_alive(colors, flags));
        uvs.iter_mut().for_each(|uvs| retain_alive(uvs, flags));
        if !attribute_errors.is_empty() {
            retain_alive(attribute_errors, flags);
        }
        flags.retain(|flags| flags & flag::DEAD == 0);
        if !absorbed.is_empty() {
            absorbed.clear();
            absorbed.resize(flags.len(), NONE);
        }
        flags.iter_mut().for_each(|flags| *flags &= !flag::USED);

        // Blocks of faces are packed in place side by side, and then moved together.
        let map = &map[..];
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

/// Moves the values of living vertices to the front.
fn retain_alive<T: Copy>(values: &mut Vec<T>, flags: &[u8]) {
    let mut kept = 0;
    // Written always and counted if alive, as in `pack_faces`.
    for (index, flags) in flags.iter().enumerate() {
        values[kept] = values[index];
        kept += usize::from(flags & flag::DEAD == 0);
    }
    values.truncate(kept);
}
