//! The faces around a vertex, in the order in which they lie side by side.

use glam::Vec3A;

use super::corners::{Corners, neighbours};
use crate::collapse::is_line;

/// The faces around a vertex `v`, with `v` as origin: face `i` is `v`, `rim[i]`, `rim[i + 1]`.
#[derive(Default)]
pub(super) struct Fan {
    /// The neighbours in order; a closed fan's first one stands once more at the end.
    pub(super) rim: Vec<u32>,
    /// Where they are, seen from the vertex.
    pub(super) spokes: Vec<Vec3A>,
    /// For each face the cross product of its spokes: along its normal, twice its area long.
    pub(super) crosses: Vec<Vec3A>,
    /// The faces lie all around the vertex; otherwise it is on the border, and so are both ends of the rim.
    pub(super) closed: bool,
    pairs: Vec<(u32, u32)>,
}

/// Puts those pairs in front that follow from the first one, each beginning where the one before it ends:
/// how many.
fn chain(pairs: &mut [(u32, u32)]) -> usize {
    for face in 1..pairs.len() {
        let last = pairs[face - 1].1;
        let Some(after) = (face..pairs.len()).find(|&other| pairs[other].0 == last) else { return face };
        pairs.swap(face, after);
    }
    pairs.len()
}

impl Fan {
    /// Gathers the fan of `vertex`; `false` if its faces do not make one fan, or are too many.
    pub(super) fn gather(
        &mut self,
        vertex: u32,
        corners: &Corners,
        faces: &[[u32; 3]],
        points: &[Vec3A],
    ) -> bool {
        let Some(corners) = corners.of(vertex) else { return false };
        let Self { rim, spokes, crosses, closed, pairs } = self;
        if corners.is_empty() {
            return false;
        }
        pairs.clear();
        pairs.extend(corners.iter().map(|&corner| neighbours(faces, corner)));
        // Mostly the vertex is inside, and any face does to begin with.
        if chain(pairs) < pairs.len() {
            let mut starts =
                (0..pairs.len()).filter(|&face| pairs.iter().all(|pair| pair.1 != pairs[face].0));
            let (Some(start), None) = (starts.next(), starts.next()) else { return false };
            pairs.swap(0, start);
            if chain(pairs) < pairs.len() {
                return false;
            }
        }
        rim.clear();
        rim.push(pairs[0].0);
        rim.extend(pairs.iter().map(|pair| pair.1));
        *closed = rim.first() == rim.last();
        let origin = points[vertex as usize];
        spokes.clear();
        spokes.extend(rim.iter().map(|&neighbour| points[neighbour as usize] - origin));
        crosses.clear();
        crosses.extend(spokes.windows(2).map(|pair| pair[0].cross(pair[1])));
        true
    }

    /// How many faces there are.
    pub(super) fn faces(&self) -> usize {
        self.crosses.len()
    }

    /// Each neighbour once, in the order of the rim.
    pub(super) fn neighbours(&self) -> &[u32] {
        &self.rim[..self.rim.len() - usize::from(self.closed)]
    }

    /// Whether the edge to the neighbour `place` is on the border.
    pub(super) fn is_border(&self, place: usize) -> bool {
        !self.closed && (place == 0 || place == self.faces())
    }

    /// The faces beside the edge to the neighbour `place`: the one before it on the rim, and the one after.
    pub(super) fn beside(&self, place: usize) -> [Option<usize>; 2] {
        let before =
            if self.closed { Some((place + self.faces() - 1) % self.faces()) } else { place.checked_sub(1) };
        [before, (place < self.faces()).then_some(place)]
    }

    /// Whether a face would fold over, or come to nothing, if `vertex`, whose fan this is, went to the
    /// neighbour `place`.
    ///
    /// No face turns by a right angle, and none comes to lie against `facing`, the input's normals at its
    /// corners: small turns, one after the other, would else turn it to its back. A face without area has no
    /// side to be turned from, and does not count.
    pub(super) fn folds(&self, vertex: u32, place: usize, facing: &[Vec3A]) -> bool {
        let offset = self.spokes[place];
        let beside = self.beside(place);
        let [from, into] = [vertex, self.rim[place]].map(|corner| facing[corner as usize]);
        self.crosses.iter().enumerate().any(|(face, &before)| {
            if beside.contains(&Some(face)) || before.length_squared() <= 0.0 {
                return false;
            }
            let (next, previous) = (self.spokes[face], self.spokes[face + 1]);
            let after = before + offset.cross(next - previous);
            let cosine = before.dot(after);
            if cosine <= 0.0 || cosine.is_nan() || is_line(after.length_squared(), next, previous, offset) {
                return true;
            }
            let rim = facing[self.rim[face] as usize] + facing[self.rim[face + 1] as usize];
            // What lies so in the input may stay so: it would else never go.
            after.dot(rim + into) < 0.0 && before.dot(rim + from) >= 0.0
        })
    }
}
