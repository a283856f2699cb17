//! Making one vertex of several at one place: the soup of an STL file, the seams of a game asset.

use std::collections::HashMap;
use std::hash::BuildHasher;

use hashbrown::hash_table::{Entry, HashTable};

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
    /// Linear time for [`Weld::Exact`], and for a tolerance at which a vertex has few neighbours.
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

/// For each position the index of the first one equal to it (zero and negative zero are equal).
///
/// Most meshes repeat few positions or none: a filter that fits the cache finds those that may be repeated,
/// one in 16 of the others among them, and only these are hashed in earnest.
pub(crate) fn first_equal(positions: &[[f32; 3]]) -> Vec<u32> {
    // Adding zero makes a negative zero positive.
    let bits = |vertex: u32| positions[vertex as usize].map(|x| (x + 0.0).to_bits());
    let vertices = 0..positions.len() as u32;
    let mut filter = Filter::new(positions.len());
    let repeated: Vec<u32> = vertices.clone().filter(|&vertex| filter.add(bits(vertex))).collect();
    let mut first: Vec<u32> = vertices.clone().collect();
    if repeated.is_empty() {
        return first;
    }
    let mut suspects = Filter::new(positions.len());
    repeated.iter().for_each(|&vertex| {
        suspects.add(bits(vertex));
    });
    let hasher = hashbrown::DefaultHashBuilder::default();
    let hash = |vertex: u32| hasher.hash_one(bits(vertex));
    let mut table = HashTable::with_capacity(repeated.len());
    for vertex in vertices.filter(|&vertex| suspects.has(bits(vertex))) {
        let own = bits(vertex);
        match table.entry(hash(vertex), |&other| bits(other) == own, |&other| hash(other)) {
            Entry::Occupied(entry) => first[vertex as usize] = *entry.get(),
            Entry::Vacant(entry) => {
                entry.insert(vertex);
            }
        }
    }
    first
}

/// A set of positions that may say yes where it should say no.
struct Filter {
    words: Vec<u64>,
    /// A hash is shifted right by so much to name a bit.
    shift: u32,
}

impl Filter {
    /// For so many positions, 16 bits each at least.
    fn new(positions: usize) -> Self {
        let bits = (16 * positions).next_power_of_two().max(64);
        Self { words: vec![0; bits / 64], shift: 64 - bits.ilog2() }
    }

    fn place(&self, [x, y, z]: [u32; 3]) -> (usize, u64) {
        let mixed = (u64::from(x) << 32 | u64::from(y)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mixed = (mixed ^ mixed >> 32 ^ u64::from(z)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
        let bit = mixed >> self.shift;
        ((bit / 64) as usize, 1 << (bit % 64))
    }

    /// Whether it has the position, or one that looks the same.
    fn has(&self, position: [u32; 3]) -> bool {
        let (word, bit) = self.place(position);
        self.words[word] & bit != 0
    }

    /// Adds a position; whether it had it.
    fn add(&mut self, position: [u32; 3]) -> bool {
        let (word, bit) = self.place(position);
        let had = self.words[word] & bit != 0;
        self.words[word] |= bit;
        had
    }
}

/// The vertices at which the sides of a seam meet: those that are not alone at their place, of a mesh that
/// has attributes; without, there is nothing that could differ there.
pub(crate) fn seams(mesh: &Mesh) -> Vec<u32> {
    if *mesh.attributes() == Attributes::default() { Vec::new() } else { shared_places(mesh) }
}

/// The vertices that are not alone at their place.
pub(crate) fn shared_places(mesh: &Mesh) -> Vec<u32> {
    let shared = are_shared(&first_equal(mesh.positions()));
    (0..).zip(shared).filter(|(_, shared)| *shared).map(|(vertex, _)| vertex).collect()
}

/// Whether each is not alone, given for each the first that is equal to it.
pub(crate) fn are_shared(first: &[u32]) -> Vec<bool> {
    let mut shared = vec![false; first.len()];
    for (vertex, &first) in first.iter().enumerate() {
        if first as usize != vertex {
            shared[vertex] = true;
            shared[first as usize] = true;
        }
    }
    shared
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
