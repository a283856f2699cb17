//! Which vertices of a mesh are one vertex of its surface.
//!
//! Where normals or texture coordinates jump, an asset has several vertices at one place. Which of them
//! belong together is not said by their positions alone: two sheets of a surface may touch, or lie back to
//! back. What joins them is an edge that both sides leave open, at the same two places, in opposite
//! directions.

use super::Mesh;
use super::partition::Partition;
use super::weld::{are_shared, first_equal};

/// The vertices of a mesh as vertices of its surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Places {
    /// For each vertex the first that is at the same position.
    pub(crate) positions: Vec<u32>,
    /// For each vertex the first that is the same vertex of the surface.
    pub(crate) first: Vec<u32>,
    /// Vertices, some more than once, at open edges that lie on others otherwise than one on the other's back:
    /// nobody knows which belong together, so they are to stay.
    pub(crate) tangled: Vec<u32>,
}

impl Mesh {
    /// For each vertex the first that is the same vertex of the surface: where normals or texture coordinates
    /// jump, a mesh has several vertices at one place. Two belong together where an edge of each ends that
    /// is open, and both edges run between the same two places, in opposite directions; vertices of surfaces
    /// that only touch, or lie on each other, do not.
    ///
    /// n log n in the vertices that are not alone at their places, linear in the others.
    pub fn surface_vertices(&self) -> Vec<u32> {
        places(self).map_or_else(|| (0..self.positions().len() as u32).collect(), |places| places.first)
    }
}

/// One side of an edge: a triangle's edge from `from` to `to`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The positions of both ends, the smaller first.
    edge: [u32; 2],
    /// From the larger to the smaller.
    backwards: bool,
    from: u32,
    to: u32,
}

/// The places of `mesh`; `None` if no two of its vertices are at one position. Triangles with two corners at
/// one position are passed over. Linear in the vertices, and n log n in the triangles' edges that have an end
/// at a shared position.
pub(crate) fn places(mesh: &Mesh) -> Option<Places> {
    let positions = first_equal(mesh.positions());
    let shared = are_shared(&positions);
    if !shared.contains(&true) {
        return None;
    }
    let mut sides = sides(mesh, &positions, &shared);
    sides.sort_unstable();
    let mut partition = Partition::new(positions.len());
    let mut tangled = Vec::new();
    for edge in sides.chunk_by(|a, b| a.edge == b.edge) {
        join(edge, &mut partition, &mut tangled);
    }
    let first = (0..positions.len() as u32).map(|vertex| partition.find(vertex)).collect();
    Some(Places { positions, first, tangled })
}

/// The sides of the edges with an end at a shared position: all that are open on two sides. Where a seam ends,
/// both sides name the same vertex at the other end.
fn sides(mesh: &Mesh, positions: &[u32], shared: &[bool]) -> Vec<Side> {
    let mut sides = Vec::new();
    for &[a, b, c] in mesh.triangles() {
        let [at_a, at_b, at_c] = [a, b, c].map(|vertex| positions[vertex as usize]);
        if at_a == at_b || at_b == at_c || at_c == at_a {
            continue;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if shared[from as usize] || shared[to as usize] {
                let (start, end) = (positions[from as usize], positions[to as usize]);
                let edge = [start.min(end), start.max(end)];
                sides.push(Side { edge, backwards: start > end, from, to });
            }
        }
    }
    sides
}

/// Joins the two open sides of an edge, if there are two. `sides` are all of the edge, sorted.
fn join(sides: &[Side], partition: &mut Partition, tangled: &mut Vec<u32>) {
    let (forwards, backwards) = sides.split_at(sides.partition_point(|side| !side.backwards));
    // Sides between the same two vertices are joined as they are.
    let is_open = |side: &&Side, others: &[Side]| {
        !others.iter().any(|other| (other.to, other.from) == (side.from, side.to))
    };
    let open_forwards: Vec<&Side> = forwards.iter().filter(|side| is_open(side, backwards)).collect();
    let open_backwards: Vec<&Side> = backwards.iter().filter(|side| is_open(side, forwards)).collect();
    let is_of_two = |side: &Side| {
        let first = &sides[0];
        (side.from, side.to) == (first.from, first.to) || (side.to, side.from) == (first.from, first.to)
    };
    match (&open_forwards[..], &open_backwards[..]) {
        ([there], [back]) => {
            partition.unite(there.from, back.to);
            partition.unite(there.to, back.from);
        }
        ([], []) => {}
        // A border, or what the two vertices alone make of it.
        _ if sides.iter().all(is_of_two) => {}
        _ => tangled.extend(sides.iter().flat_map(|side| [side.from, side.to])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    /// The mesh with a vertex of its own for each corner of each triangle.
    fn exploded(mesh: &Mesh) -> Mesh {
        let corners = mesh.triangles().as_flattened();
        let positions = corners.iter().map(|&corner| mesh.positions()[corner as usize]).collect();
        let triangles = (0..mesh.triangles().len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        Mesh::new(positions, triangles.collect()).unwrap()
    }

    #[test]
    fn a_mesh_without_shared_positions_has_no_places() {
        assert_eq!(places(&shapes::bumpy_sphere(8, 1)), None);
        assert_eq!(places(&Mesh::default()), None);
    }

    #[test]
    fn a_soup_comes_together() {
        let mesh = shapes::bumpy_sphere(8, 1);
        let soup = exploded(&mesh);
        let places = places(&soup).unwrap();
        let corners = mesh.triangles().as_flattened();
        for (vertex, &first) in places.first.iter().enumerate() {
            assert_eq!(corners[vertex], corners[first as usize]);
        }
        assert_eq!(places.first, places.positions);
        assert!(places.tangled.is_empty());
    }

    /// Two sheets back to back are two surfaces, each of which knows its own vertices.
    #[test]
    fn sheets_that_lie_on_each_other_stay_two() {
        let sheet = [[0, 1, 2], [1, 3, 2]];
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let same = sheet.map(|triangle| triangle.map(|vertex| vertex + 4));
        let mesh = Mesh::new([corners, corners].concat(), [sheet, same].concat()).unwrap();
        let places = places(&mesh).unwrap();
        assert_eq!(places.first, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(places.positions, [0, 1, 2, 3, 0, 1, 2, 3]);
        // Their borders run the same way at the same places: whose neighbours are whose is not said.
        assert!(!places.tangled.is_empty());
    }

    #[test]
    fn sheets_that_look_away_from_each_other_are_joined_at_their_borders() {
        let sheet = [[0, 1, 2], [1, 3, 2]];
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let back = sheet.map(|[a, b, c]| [a + 4, c + 4, b + 4]);
        let mesh = Mesh::new([corners, corners].concat(), [sheet, back].concat()).unwrap();
        let places = places(&mesh).unwrap();
        assert_eq!(places.first, [0, 1, 2, 3, 0, 1, 2, 3]);
        assert!(places.tangled.is_empty());
    }

    /// A seam need not have a vertex between its ends whose neighbours are doubled too.
    #[test]
    fn a_seam_of_two_edges_is_found() {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5], [0.5, 0.5]];
        let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 5], [3, 0, 5]];
        let mesh = Mesh::new(positions.map(|[x, y]| [x, y, 0.0]).to_vec(), triangles).unwrap();
        let places = places(&mesh).unwrap();
        assert_eq!(places.first, [0, 1, 2, 3, 4, 4]);
        assert!(places.tangled.is_empty());
    }

    /// A wall on a floor that is one there: the wall does not belong to it, but must not leave it.
    #[test]
    fn an_open_edge_on_others_is_tangled() {
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let mesh = Mesh::new(positions.to_vec(), vec![[0, 1, 2], [1, 0, 3], [4, 5, 6]]).unwrap();
        let mut places = places(&mesh).unwrap();
        assert_eq!(places.first, [0, 1, 2, 3, 4, 5, 6]);
        places.tangled.sort_unstable();
        places.tangled.dedup();
        assert_eq!(places.tangled, [0, 1, 4, 5]);
    }
}
