//! Where space is cut into blocks: a grid of cells, and a tree of cuts along them.
//!
//! The grid does not lie along the axes but turned, another way in each round: a cut then runs along no wall of
//! a building, and where one round cuts, the next one cuts across, so that the seams of a round come to lie
//! inside the blocks of the next.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DMat3, DQuat, DVec3};

/// Turns as quaternions of small whole numbers, no two of which have an axis or a plane in common: these need no
/// sines, and so are the same on every machine.
const TURNS: [[f64; 4]; 4] =
    [[3.0, 1.0, 2.0, 9.0], [-4.0, 1.0, 3.0, 5.0], [1.0, -5.0, 4.0, 3.0], [5.0, 3.0, -3.0, 2.0]];

/// The fewest and the most bits of a coordinate of a cell.
const BITS: Range<u32> = 2..8;

/// A cube of cells around a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    center: DVec3,
    turn: DMat3,
    bits: u32,
}

impl Grid {
    /// A grid around the box from `low` to `high` for the cuts of a round: with the most cells that are at most
    /// `cells`, but 64 at least.
    pub(super) fn new([low, high]: [[f32; 3]; 2], round: usize, cells: usize) -> Self {
        let [low, high] = [low, high].map(|corner| DVec3::from(corner.map(f64::from)));
        let [x, y, z, w] = TURNS[round % TURNS.len()];
        let turn = DMat3::from_quat(DQuat::from_xyzw(x, y, z, w).normalize());
        let bits = BITS.rev().find(|bits| 1 << (3 * bits) <= cells).unwrap_or(BITS.start);
        let side = f64::from(1 << bits);
        // The ball around the box fits, however it is turned.
        let scale = side / (high - low).length().max(f64::MIN_POSITIVE);
        Self { center: 0.5 * (low + high), turn: turn * scale, bits }
    }

    pub(super) fn cells(&self) -> usize {
        1 << (3 * self.bits)
    }

    /// The cell of a triangle's middle.
    #[inline]
    pub(super) fn cell(&self, corners: [[f32; 3]; 3]) -> u32 {
        let [a, b, c] = corners.map(|corner| DVec3::from(corner.map(f64::from)));
        let middle = (a + b + c) / 3.0;
        let half = f64::from(1 << (self.bits - 1));
        let last = f64::from((1 << self.bits) - 1);
        let place = (self.turn * (middle - self.center) + half).clamp(DVec3::ZERO, DVec3::splat(last));
        let [x, y, z] = [place.x as u32, place.y as u32, place.z as u32];
        (z << self.bits | y) << self.bits | x
    }
}

/// Which block each triangle goes to.
#[derive(Debug)]
pub(super) struct Cuts {
    /// The block of each cell, or the first of several.
    blocks: Vec<u32>,
    /// Of a cell that holds more than a block may: how many triangles go into each of its blocks, and how many
    /// have come.
    full: HashMap<u32, (usize, usize)>,
    counts: Vec<usize>,
}

impl Cuts {
    /// Cuts the cells, which hold so many triangles each, into blocks of at most `limit` triangles, of much the
    /// same size.
    pub(super) fn new(grid: &Grid, histogram: &[u32], limit: usize) -> Self {
        let limit = limit.max(1);
        let mut cuts = Self { blocks: vec![0; histogram.len()], full: HashMap::new(), counts: Vec::new() };
        let side = 1 << grid.bits;
        let mut boxes = vec![[0..side, 0..side, 0..side]];
        while let Some(cells) = boxes.pop() {
            let cells = Cells { cells, bits: grid.bits, histogram };
            let slabs: [Vec<usize>; 3] = cells.slabs();
            let count: usize = slabs[0].iter().sum();
            let block = cuts.counts.len() as u32;
            if count <= limit {
                if count > 0 {
                    cells.visit(|cell, _| cuts.blocks[cell] = block);
                    cuts.counts.push(count);
                }
                continue;
            }
            match cells.cut(&slabs, count, limit) {
                Some(parts) => boxes.extend(parts),
                None => cells.visit(|cell, held| {
                    if held > 0 {
                        let parts = held.div_ceil(limit);
                        let each = held.div_ceil(parts);
                        cuts.blocks[cell] = block;
                        cuts.full.insert(cell as u32, (each, 0));
                        cuts.counts.extend((0..parts).map(|part| each.min(held - part * each)));
                    }
                }),
            }
        }
        cuts
    }

    /// How many triangles each block has.
    pub(super) fn counts(&self) -> &[usize] {
        &self.counts
    }

    /// The block of the next triangle, which is in this cell.
    #[inline]
    pub(super) fn block(&mut self, cell: u32) -> usize {
        let first = self.blocks[cell as usize] as usize;
        if self.full.is_empty() {
            return first;
        }
        self.full.get_mut(&cell).map_or(first, |(each, come)| {
            *come += 1;
            first + (*come - 1) / *each
        })
    }
}

/// A box of cells.
struct Cells<'a> {
    cells: [Range<usize>; 3],
    bits: u32,
    histogram: &'a [u32],
}

impl Cells<'_> {
    /// Calls `visit` with each cell and what it holds.
    fn visit(&self, mut visit: impl FnMut(usize, usize)) {
        let [x, y, z] = self.cells.clone();
        for (z, y) in z.flat_map(|z| y.clone().map(move |y| (z, y))) {
            let row = (z << self.bits | y) << self.bits;
            for cell in row + x.start..row + x.end {
                visit(cell, self.histogram[cell] as usize);
            }
        }
    }

    /// What each slice across each axis holds.
    fn slabs(&self) -> [Vec<usize>; 3] {
        let mut slabs = self.cells.clone().map(|range| vec![0; range.len()]);
        let mask = (1 << self.bits) - 1;
        self.visit(|cell, held| {
            for (axis, slab) in slabs.iter_mut().enumerate() {
                slab[(cell >> (axis as u32 * self.bits) & mask) - self.cells[axis].start] += held;
            }
        });
        slabs
    }

    /// The two parts of the box, cut across its longest side as far as it is filled, so that each part has a
    /// whole number of blocks' worth, as nearly as cells allow; none if all is in one cell.
    fn cut(&self, slabs: &[Vec<usize>; 3], count: usize, limit: usize) -> Option<[[Range<usize>; 3]; 2]> {
        let filled = slabs.each_ref().map(|slab| {
            let first = slab.iter().position(|&held| held > 0).unwrap_or(0);
            let last = slab.iter().rposition(|&held| held > 0).unwrap_or(0);
            first..last + 1
        });
        let axis =
            (0..3).max_by_key(|&axis| (filled[axis].len(), axis)).filter(|&axis| filled[axis].len() > 1)?;
        let parts = count.div_ceil(limit);
        let wanted = count as f64 * (parts / 2) as f64 / parts as f64;
        let mut sum = 0;
        // Something is on both sides of each of these.
        let places = filled[axis].clone().take(filled[axis].len() - 1).map(|slab| {
            sum += slabs[axis][slab];
            (slab + 1, (sum as f64 - wanted).abs())
        });
        let (place, _) = places.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        let cut = |range: Range<usize>| {
            let mut cells = self.cells.clone();
            let start = self.cells[axis].start;
            cells[axis] = start + range.start..start + range.end;
            cells
        };
        Some([cut(place..slabs[axis].len()), cut(0..place)])
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn every_triangle_has_a_block_that_has_room(
            points in prop::collection::vec(prop::array::uniform3(-1f32..1.0), 1..400),
            copies in 1usize..40,
            limit in 1usize..100,
            round in 0usize..8,
        ) {
            let bounds = [[-1.0; 3], [1.0; 3]];
            let grid = Grid::new(bounds, round, 4096);
            let mut histogram = vec![0; grid.cells()];
            // Many in one place overfill a cell.
            let points: Vec<_> = points.iter().copied().chain((0..copies).map(|_| points[0])).collect();
            let cells: Vec<u32> = points.iter().map(|&point| grid.cell([point; 3])).collect();
            cells.iter().for_each(|&cell| histogram[cell as usize] += 1);
            let mut cuts = Cuts::new(&grid, &histogram, limit);
            let expected = cuts.counts().to_vec();
            prop_assert!(expected.iter().all(|&count| (1..=limit).contains(&count)), "{expected:?}");
            let mut counts = vec![0; expected.len()];
            cells.iter().for_each(|&cell| counts[cuts.block(cell)] += 1);
            prop_assert_eq!(counts, expected);
        }
    }

    #[test]
    fn extreme_boxes_have_cells() {
        for bounds in [[[0.0; 3]; 2], [[f32::MIN; 3], [f32::MAX; 3]], [[1e-45; 3], [3e-45; 3]]] {
            for round in 0..4 {
                let grid = Grid::new(bounds, round, 1 << 12);
                for corner in bounds {
                    assert!((grid.cell([corner; 3]) as usize) < grid.cells());
                }
            }
        }
    }

    #[test]
    fn cuts_of_two_rounds_are_not_alike() {
        let grids: Vec<Grid> = (0..4).map(|round| Grid::new([[-1.0; 3], [1.0; 3]], round, 1 << 12)).collect();
        let axes = |grid: &Grid| [0, 1, 2].map(|axis| grid.turn.row(axis).normalize());
        for first in 0..4 {
            for second in first + 1..4 {
                for a in axes(&grids[first]) {
                    assert!(axes(&grids[second]).iter().all(|b| a.dot(*b).abs() < 0.97), "{first} {second}");
                }
            }
        }
    }
}
