//! The quads that a semi-regular surface is subdivided from, and how they hang together.

use super::SemiRegularError;
use crate::mesh::partition::Partition;

/// A side of a quad: side `k` runs from its corner `k` to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Side {
    pub(super) quad: u32,
    pub(super) side: u8,
}

/// The edge that a side lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OnEdge {
    pub(super) edge: u32,
    /// The side runs against the edge, which runs as its first side does.
    pub(super) reversed: bool,
}

/// Quads that form an oriented manifold, closed or with borders; any number of them may meet at a corner.
///
/// Corners of a quad are given counter-clockwise from outside. Its *diagonal* goes from its first corner to
/// its third: where all else is gone, the quad is the two triangles at this diagonal, so that it matters with
/// which corner a quad starts.
#[derive(Debug, Clone, PartialEq)]
pub struct BaseComplex {
    corners: usize,
    quads: Vec<[u32; 4]>,
    /// For each quad, the edges of its sides.
    sides: Vec<[OnEdge; 4]>,
    /// The one or two sides of each edge; edges are in the order of their ends.
    edges: Vec<(Side, Option<Side>)>,
}

impl BaseComplex {
    /// The complex of `quads`, which name `corners` corners.
    ///
    /// Every corner must be used and the quads form an oriented manifold; the coarsest mesh, two triangles a
    /// quad, must have no two edges between the same corners. n log n.
    pub fn new(corners: usize, quads: Vec<[u32; 4]>) -> Result<Self, SemiRegularError> {
        check_corners(corners, &quads)?;
        let mut all: Vec<([u32; 2], Side)> = Vec::with_capacity(4 * quads.len());
        for (quad, names) in (0..).zip(&quads) {
            for side in 0..4 {
                let [from, to] = [names[side], names[(side + 1) % 4]];
                all.push(([from.min(to), from.max(to)], Side { quad, side: side as u8 }));
            }
        }
        all.sort_unstable_by_key(|&(ends, side)| (ends, side.quad, side.side));

        let start = |side: Side| quads[side.quad as usize][side.side as usize];
        let mut sides = vec![[OnEdge { edge: 0, reversed: false }; 4]; quads.len()];
        let mut edges = Vec::with_capacity(2 * quads.len());
        for group in all.chunk_by(|a, b| a.0 == b.0) {
            let corners = group[0].0;
            let (first, second) = match *group {
                [(_, first)] => (first, None),
                [(_, first), (_, second)] if start(first) != start(second) => (first, Some(second)),
                [_, _] => return Err(SemiRegularError::InconsistentEdge { corners }),
                _ => return Err(SemiRegularError::NonManifoldEdge { corners }),
            };
            let edge = edges.len() as u32;
            sides[first.quad as usize][first.side as usize] = OnEdge { edge, reversed: false };
            if let Some(second) = second {
                sides[second.quad as usize][second.side as usize] = OnEdge { edge, reversed: true };
            }
            edges.push((first, second));
        }
        check_fans(corners, &quads, &edges)?;
        check_diagonals(&quads, all.iter().map(|&(ends, _)| ends))?;
        Ok(Self { corners, quads, sides, edges })
    }

    /// How many corners there are.
    pub fn corners(&self) -> usize {
        self.corners
    }

    /// The corners of each quad, counter-clockwise from outside.
    pub fn quads(&self) -> &[[u32; 4]] {
        &self.quads
    }

    /// How many edges there are.
    pub fn edges(&self) -> usize {
        self.edges.len()
    }

    pub(super) fn on_edge(&self, quad: u32, side: usize) -> OnEdge {
        self.sides[quad as usize][side]
    }

    pub(super) fn sides_of(&self, edge: usize) -> (Side, Option<Side>) {
        self.edges[edge]
    }
}

fn check_corners(corners: usize, quads: &[[u32; 4]]) -> Result<(), SemiRegularError> {
    if quads.is_empty() {
        return Err(SemiRegularError::Empty);
    }
    let mut used = vec![false; corners];
    for (quad, names) in quads.iter().enumerate() {
        for (place, &corner) in names.iter().enumerate() {
            let out_of_range = SemiRegularError::CornerOutOfRange { quad, corner, corners };
            *used.get_mut(corner as usize).ok_or(out_of_range)? = true;
            if names[..place].contains(&corner) {
                return Err(SemiRegularError::RepeatedCorner { quad, corner });
            }
        }
    }
    match used.iter().position(|used| !used) {
        Some(corner) => Err(SemiRegularError::UnusedCorner { corner }),
        None => Ok(()),
    }
}

/// Each corner's quads must hang together through edges at that corner.
fn check_fans(
    corners: usize,
    quads: &[[u32; 4]],
    edges: &[(Side, Option<Side>)],
) -> Result<(), SemiRegularError> {
    let mut fans = Partition::new(4 * quads.len());
    let place = |Side { quad, side }: Side, further: u32| 4 * quad + (u32::from(side) + further) % 4;
    for &(first, second) in edges {
        if let Some(second) = second {
            fans.unite(place(first, 0), place(second, 1));
            fans.unite(place(first, 1), place(second, 0));
        }
    }
    let mut fan_of = vec![u32::MAX; corners];
    for (place, &corner) in (0..).zip(quads.as_flattened()) {
        let fan = fans.find(place);
        let known = &mut fan_of[corner as usize];
        if *known != u32::MAX && *known != fan {
            return Err(SemiRegularError::NonManifoldCorner { corner });
        }
        *known = fan;
    }
    Ok(())
}

/// `edges` are sorted.
fn check_diagonals(
    quads: &[[u32; 4]],
    edges: impl Iterator<Item = [u32; 2]>,
) -> Result<(), SemiRegularError> {
    let edges: Vec<[u32; 2]> = edges.collect();
    let mut diagonals: Vec<([u32; 2], usize)> =
        quads.iter().map(|names| [names[0].min(names[2]), names[0].max(names[2])]).zip(0..).collect();
    diagonals.sort_unstable();
    let repeated = diagonals.windows(2).find(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1]);
    let on_edge = || diagonals.iter().copied().find(|(ends, _)| edges.binary_search(ends).is_ok());
    match repeated.or_else(on_edge) {
        Some((corners, quad)) => Err(SemiRegularError::RepeatedDiagonal { quad, corners }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(corners: usize, quads: &[[u32; 4]]) -> SemiRegularError {
        BaseComplex::new(corners, quads.to_vec()).unwrap_err()
    }

    #[test]
    fn what_is_wrong_with_quads_is_named() {
        use SemiRegularError::*;
        assert_eq!(error(0, &[]), Empty);
        assert_eq!(error(4, &[[0, 1, 2, 4]]), CornerOutOfRange { quad: 0, corner: 4, corners: 4 });
        assert_eq!(error(4, &[[0, 1, 2, 3], [0, 1, 0, 3]]), RepeatedCorner { quad: 1, corner: 0 });
        assert_eq!(error(5, &[[0, 1, 2, 3]]), UnusedCorner { corner: 4 });
        // A book of three pages.
        let pages = [[0, 1, 2, 3], [1, 0, 4, 5], [0, 1, 6, 7]];
        assert_eq!(error(8, &pages), NonManifoldEdge { corners: [0, 1] });
        assert_eq!(error(6, &[[0, 1, 2, 3], [0, 1, 4, 5]]), InconsistentEdge { corners: [0, 1] });
        // Two quads that touch in a point.
        assert_eq!(error(7, &[[0, 1, 2, 3], [0, 4, 5, 6]]), NonManifoldCorner { corner: 0 });
        // Two quads with two sides in common have one diagonal, unless they start elsewhere.
        let pillow = [[0, 1, 2, 3], [2, 1, 0, 4]];
        assert_eq!(error(5, &pillow), RepeatedDiagonal { quad: 1, corners: [0, 2] });
        assert!(BaseComplex::new(5, vec![[0, 1, 2, 3], [1, 0, 4, 2]]).is_ok());
        assert_eq!(error(5, &[[0, 1, 2, 3], [0, 4, 2, 1]]), RepeatedDiagonal { quad: 1, corners: [0, 2] });
    }

    #[test]
    fn a_side_knows_its_edge_and_an_edge_its_sides() {
        let complex = BaseComplex::new(6, vec![[0, 1, 2, 3], [1, 4, 5, 2]]).unwrap();
        assert_eq!((complex.corners(), complex.edges()), (6, 7));
        for quad in 0..2 {
            for side in 0..4 {
                let OnEdge { edge, reversed } = complex.on_edge(quad, side);
                let (first, second) = complex.sides_of(edge as usize);
                let this = Side { quad, side: side as u8 };
                assert_eq!(if reversed { second } else { Some(first) }, Some(this));
            }
        }
        let shared = complex.on_edge(0, 1);
        assert_eq!(complex.on_edge(1, 3), OnEdge { edge: shared.edge, reversed: true });
    }
}
