//! Making one vertex of several at one place: the soup of an STL file, the seams of a game asset.

use std::collections::HashMap;

use rayon::prelude::*;

use super::topology::is_face;
use super::{Attributes, Mesh, select};

/// Which vertices are at one place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Weld {
    /// Those with equal coordinates (zero and negative zero are equal).
    #[default]
    Exact,
    /// Those within this distance, in units of the positions: finite, not negative.
    ///
    /// In index order, each vertex goes into the first vertex kept so far that is within the distance,
    /// or else is kept itself. So nothing moves by more than the tolerance and no chain of near
    /// vertices collapses, the vertices kept are farther apart than the tolerance, and welding again
    /// changes nothing. Zero is [`Weld::Exact`].
    Tolerance(f32),
}

/// Why there is no welded mesh.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WeldError {
    /// A tolerance is negative, infinite or not a number.
    #[error("the weld tolerance must be finite and not negative, not {0}")]
    InvalidTolerance(f32),
}

/// A mesh with its vertices welded.
#[derive(Debug, Clone, PartialEq)]
pub struct Welded {
    /// The mesh.
    pub mesh: Mesh,
    /// For each vertex of the input the one it became.
    pub map: Vec<u32>,
}

impl Mesh {
    /// One vertex in place of all those at one place.
    ///
    /// The vertices that stay keep their order, positions and attributes, the triangles theirs. Each
    /// group goes into its first vertex. A triangle left with fewer than three different vertices is
    /// dropped, one that never had them as well; triangles that become duplicates and vertices that no
    /// triangle uses stay.
    ///
    /// n log n time for [`Weld::Exact`], linear for a tolerance at which a vertex has few neighbours.
    pub fn weld(&self, weld: Weld) -> Result<Welded, WeldError> {
        let mut map = match weld {
            Weld::Exact | Weld::Tolerance(0.0) => first_equal(self.positions()),
            Weld::Tolerance(tolerance) if tolerance.is_finite() && tolerance > 0.0 => {
                first_within(self.positions(), f64::from(tolerance))
            }
            Weld::Tolerance(tolerance) => return Err(WeldError::InvalidTolerance(tolerance)),
        };
        let mut kept = Vec::new();
        for vertex in 0..map.len() {
            // A vertex goes into itself or into an earlier one, whose new number is there already.
            let first = map[vertex] as usize;
            if first == vertex {
                map[vertex] = kept.len() as u32;
                kept.push(vertex as u32);
            } else {
                map[vertex] = map[first];
            }
        }
        let triangles = self.triangles().iter().map(|triangle| triangle.map(|vertex| map[vertex as usize]));
        let mesh = Mesh {
            positions: select(self.positions(), &kept),
            triangles: triangles.filter(is_face).collect(),
            attributes: self.attributes().select(&kept),
        };
        Ok(Welded { mesh, map })
    }
}

/// For each position the index of the first one equal to it.
///
/// Sorted, not hashed: no input is slow, and a record takes 16 bytes.
pub(crate) fn first_equal(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut records: Vec<([u32; 3], u32)> = positions
        .par_iter()
        .zip(0..positions.len() as u32)
        // Adding zero makes a negative zero positive.
        .map(|(position, index)| (position.map(|x| (x + 0.0).to_bits()), index))
        .collect();
    records.par_sort_unstable();
    let mut first = vec![0; positions.len()];
    for equal in records.chunk_by(|a, b| a.0 == b.0) {
        for record in equal {
            first[record.1 as usize] = equal[0].1;
        }
    }
    first
}

/// The vertices at which the sides of a seam meet: those that are not alone at their place, of a mesh that
/// has attributes; without, there is nothing that could differ there.
pub(crate) fn seams(mesh: &Mesh) -> Vec<u32> {
    if *mesh.attributes() == Attributes::default() { Vec::new() } else { shared_places(mesh) }
}

/// The vertices that are not alone at their place.
pub(crate) fn shared_places(mesh: &Mesh) -> Vec<u32> {
    let first = first_equal(mesh.positions());
    let mut shared = vec![false; first.len()];
    for (vertex, &first) in first.iter().enumerate() {
        if first as usize != vertex {
            shared[vertex] = true;
            shared[first as usize] = true;
        }
    }
    (0..).zip(shared).filter(|(_, shared)| *shared).map(|(vertex, _)| vertex).collect()
}

/// For each position the first kept one within `tolerance`; itself where it is kept.
///
/// The vertices kept are hashed by cells of a cubic grid. Since they are farther apart than the
/// tolerance, a cell holds only so many, however dense the input.
fn first_within(positions: &[[f32; 3]], tolerance: f64) -> Vec<u32> {
    // Four tolerances a cell: what lies within one tolerance is then in the position's own cell or, along
    // each axis, in one other, and mostly in the same. The reach has a margin for the rounding of the
    // quotient. Cells are whole numbers held as f64, for a tiny tolerance makes more of them than an i64
    // can count. Where they are so many that their numbers are rounded, neighbouring f32 are many cells
    // apart: only equal coordinates are within the tolerance, and those are in the same cell.
    let cell = |x: f64| (x / (4.0 * tolerance)).floor() + 0.0;
    let reach = 1.001 * tolerance;
    let mut heads: HashMap<[u64; 3], u32> = HashMap::new();
    let mut nexts = vec![NONE; positions.len()];
    let mut first = Vec::with_capacity(positions.len());
    for (vertex, position) in positions.iter().enumerate() {
        let position = position.map(f64::from);
        let own = position.map(cell);
        let other = position.map(|x| {
            let low = cell(x - reach);
            if low != cell(x) { low } else { cell(x + reach) }
        });
        let mut found = NONE;
        for corner in 0..8 {
            let in_other: [bool; 3] = std::array::from_fn(|axis| corner >> axis & 1 == 1);
            if (0..3).any(|axis| in_other[axis] && own[axis] == other[axis]) {
                continue;
            }
            let key =
                std::array::from_fn(|axis| if in_other[axis] { other[axis] } else { own[axis] }.to_bits());
            let mut candidate = heads.get(&key).copied().unwrap_or(NONE);
            while candidate != NONE {
                let kept = positions[candidate as usize].map(f64::from);
                let squared: f64 = (0..3).map(|axis| (position[axis] - kept[axis]).powi(2)).sum();
                if squared <= tolerance * tolerance {
                    found = found.min(candidate);
                }
                candidate = nexts[candidate as usize];
            }
        }
        if found == NONE {
            found = vertex as u32;
            nexts[vertex] = heads.insert(own.map(f64::to_bits), found).unwrap_or(NONE);
        }
        first.push(found);
    }
    first
}

/// No vertex: a mesh has fewer than `u32::MAX`.
const NONE: u32 = u32::MAX;
