//! What lies across each side of a face.

use crate::collapse::surface::{NONE, Surface, next_corner, previous_corner};
use crate::workers::Workers;

/// Faces in a block of parallel work.
const BLOCK: usize = 1 << 13;

/// For each corner of each face the corner that lies opposite to it across the side between them, as
/// `face << 2 | corner`; [`NONE`] at a border, and where more than two faces meet or two disagree in
/// orientation.
pub(super) fn opposites(surface: &Surface, workers: &Workers) -> Vec<[u32; 3]> {
    let blocks = (0..surface.faces.len().div_ceil(BLOCK)).collect();
    let of_face = |face: usize| [0, 1, 2].map(|corner| opposite(surface, (face as u32) << 2 | corner));
    let of_block = |block: usize| -> Vec<_> {
        (block * BLOCK..surface.faces.len().min((block + 1) * BLOCK)).map(of_face).collect()
    };
    workers.map(blocks, of_block).concat()
}

fn opposite(surface: &Surface, corner: u32) -> u32 {
    let (from, to) = (surface.vertex(next_corner(corner)), surface.vertex(previous_corner(corner)));
    let (mut along, mut against, mut found) = (0, 0, NONE);
    for other in surface.ring(from) {
        along += u32::from(surface.vertex(next_corner(other)) == to);
        if surface.vertex(previous_corner(other)) == to {
            against += 1;
            found = next_corner(other);
        }
    }
    if along == 1 && against == 1 { found } else { NONE }
}
