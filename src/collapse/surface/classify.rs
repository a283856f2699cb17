//! What is known of vertices by their faces: borders, seams, and who has none.

use super::rings::{Spans, split};
use super::{NONE, Surface, corners, flag, hash};
use crate::workers::Workers;
use std::sync::atomic::Ordering::Relaxed;

impl Surface {
    /// Gives vertices their [`flag::BOUNDARY`], and locks them if asked, and their [`flag::SEAM`]; buries
    /// those without a face, and counts these. Time linear in the faces, and no ring is needed: see
    /// [`is_open`](super::is_open).
    pub(crate) fn classify(&mut self, lock_boundary: bool, workers: &Workers) -> usize {
        let Self { faces, wedges, flags, merged, .. } = self;
        let (faces, wedges) = (&faces[..], &wedges[..]);
        let count = flags.len();
        let ranges = workers.count().min(count.max(1));
        let spans = if ranges > 1 { Spans::new(faces, workers) } else { Spans::default() };
        let bound = |range: usize| range * count / ranges;
        let pieces = split(flags, (1..ranges).map(bound)).into_iter().enumerate().collect();
        let unreferenced = workers.map(pieces, |(range, flags): (usize, &mut [u8])| {
            let first = bound(range) as u32;
            let vertices = first..first + flags.len() as u32;
            let mut balances = vec![0u32; flags.len()];
            let mut wedge_of = vec![NONE; if wedges.is_empty() { 0 } else { flags.len() }];
            flags.iter_mut().for_each(|flags| *flags |= flag::DEAD);
            for (base, block, _) in spans.touching(faces, &vertices) {
                for (index, face) in block.iter().enumerate() {
                    let corners = corners(face);
                    let [a, b, c] = corners.map(hash);
                    let changes = [b.wrapping_sub(c), c.wrapping_sub(a), a.wrapping_sub(b)];
                    for (corner, (vertex, change)) in corners.into_iter().zip(changes).enumerate() {
                        let vertex = vertex.wrapping_sub(first) as usize;
                        let Some(balance) = balances.get_mut(vertex) else { continue };
                        *balance = balance.wrapping_add(change);
                        flags[vertex] &= !flag::DEAD;
                        if let Some(wedge_of) = wedge_of.get_mut(vertex) {
                            let wedge = wedges[base + index][corner].load(Relaxed);
                            if *wedge_of == NONE {
                                *wedge_of = wedge;
                            } else if *wedge_of != wedge {
                                flags[vertex] |= flag::SEAM;
                            }
                        }
                    }
                }
            }
            let border = flag::BOUNDARY | if lock_boundary { flag::LOCKED } else { 0 };
            let mut unreferenced = 0;
            for (flags, balance) in flags.iter_mut().zip(balances) {
                *flags |= if balance != 0 { border } else { 0 };
                unreferenced += usize::from(*flags & flag::DEAD != 0);
            }
            unreferenced
        });
        for (merged, flags) in merged.iter_mut().zip(flags) {
            if *flags & flag::DEAD != 0 {
                *merged = NONE;
            }
        }
        unreferenced.into_iter().sum()
    }
}
