//! Cracks: open edges of a result where its input was closed.

use std::collections::HashMap;

use decimesh::Mesh;
use decimesh::mesh::{Weld, WeldError};

/// The vertices of an input by their places, and where it is open.
pub(crate) struct Places {
    /// For each vertex its place.
    of: Vec<u32>,
    /// For each place whether an open edge ends there.
    open: Vec<bool>,
}

impl Places {
    pub(crate) fn new(input: &Mesh) -> Result<Self, WeldError> {
        let welded = input.weld(Weld::Exact)?;
        let mut open = vec![false; welded.mesh.positions().len()];
        for end in open_edges(input.triangles().as_flattened(), &welded.map).flatten() {
            open[end as usize] = true;
        }
        Ok(Self { of: welded.map, open })
    }

    /// Open edges of the triangles that `indices` name, welded by place, that have an end where the welded
    /// input has no open edge. An edge along the input's own border is none, however long it has become.
    pub(crate) fn cracks(&self, indices: &[u32]) -> usize {
        open_edges(indices, &self.of).filter(|ends| ends.iter().any(|&end| !self.open[end as usize])).count()
    }
}

/// Edges, by the places of their ends, that one triangle alone has; triangles with two corners at one
/// place have no say.
fn open_edges(indices: &[u32], places: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    let mut faces: HashMap<[u32; 2], u32> = HashMap::new();
    for corners in indices.as_chunks::<3>().0 {
        let [a, b, c] = corners.map(|vertex| places[vertex as usize]);
        if a != b && b != c && c != a {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *faces.entry([from.min(to), from.max(to)]).or_default() += 1;
            }
        }
    }
    faces.into_iter().filter(|(_, faces)| *faces == 1).map(|(ends, _)| ends)
}
