//! Which vertices of a mesh are one vertex of its surface, found in the plainest way: what the engine that
//! moves no vertex is held to.

use std::collections::{BTreeMap, BTreeSet};

use decimesh::{HalfEdge, Mesh, Options, Placement};

/// The vertices of a mesh as vertices of its surface.
pub(crate) struct Places {
    /// For each vertex the first at its position.
    pub(crate) positions: Vec<u32>,
    /// For each vertex the first that is the same vertex of the surface.
    pub(crate) of: Vec<u32>,
    /// Vertices at edges of which nobody knows which sides belong together.
    pub(crate) tangled: BTreeSet<u32>,
}

/// Whether vertices at one place are one to these options.
pub(crate) fn are_known(options: &Options) -> bool {
    options.placement == Placement::Existing && options.keep_seams
}

impl Places {
    /// Each vertex on its own.
    pub(crate) fn none(mesh: &Mesh) -> Self {
        let each: Vec<u32> = (0..mesh.positions().len() as u32).collect();
        Self { positions: each.clone(), of: each, tangled: BTreeSet::new() }
    }

    /// Two vertices are one where an edge has one open side in each direction, and nothing else that is open.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let mut first_at = BTreeMap::new();
        let positions: Vec<u32> = (0..)
            .zip(mesh.positions())
            .map(|(vertex, position)| {
                // Both zeros are one place.
                *first_at.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(vertex)
            })
            .collect();
        let mut edges: BTreeMap<[u32; 2], Vec<[u32; 2]>> = BTreeMap::new();
        for triangle in mesh.triangles().iter().filter(|triangle| is_whole(&positions, triangle)) {
            for corner in 0..3 {
                let side = [triangle[corner], triangle[(corner + 1) % 3]];
                let [from, to] = side.map(|vertex| positions[vertex as usize]);
                edges.entry([from.min(to), from.max(to)]).or_default().push(side);
            }
        }
        let mut of: Vec<u32> = (0..positions.len() as u32).collect();
        let mut unite = |a: u32, b: u32| {
            let (a, b) = (of[a as usize], of[b as usize]);
            of.iter_mut().filter(|place| **place == a.max(b)).for_each(|place| *place = a.min(b));
        };
        let mut tangled: BTreeSet<u32> = BTreeSet::new();
        for sides in edges.values() {
            let open: Vec<[u32; 2]> =
                sides.iter().copied().filter(|&[from, to]| !sides.contains(&[to, from])).collect();
            match open[..] {
                [[a, b], [c, d]] if positions[a as usize] == positions[d as usize] => {
                    unite(a, d);
                    unite(b, c);
                }
                [] => {}
                // A border, or what the two vertices alone make of it.
                _ if sides.iter().flatten().collect::<BTreeSet<_>>().len() == 2 => {}
                _ => tangled.extend(sides.iter().flatten()),
            }
        }
        // Where one stays, all stay that are one with it.
        let stay: BTreeSet<u32> = tangled.iter().map(|&vertex| of[vertex as usize]).collect();
        let tangled = (0..positions.len() as u32).filter(|&v| stay.contains(&of[v as usize])).collect();
        Self { positions, of, tangled }
    }

    /// Those that the options ask for.
    pub(crate) fn for_options(mesh: &Mesh, options: &Options) -> Self {
        if are_known(options) { Self::new(mesh) } else { Self::none(mesh) }
    }

    /// Whether a triangle has three corners.
    pub(crate) fn is_whole(&self, triangle: &[u32; 3]) -> bool {
        is_whole(&self.positions, triangle)
    }

    /// How many vertices of the result one collapse removes at most: all at one place, and where that is a seam
    /// those that the two vanishing triangles alone name at their other corners.
    pub(crate) fn most_removed(&self) -> usize {
        let mut counts = vec![0; self.of.len()];
        self.of.iter().for_each(|&place| counts[place as usize] += 1);
        match counts.into_iter().max() {
            None | Some(1) => 1,
            Some(several) => several + 4,
        }
    }

    /// The triangles of the mesh that have three corners, on the vertices of its surface.
    pub(crate) fn surface(&self, mesh: &Mesh) -> Mesh {
        let whole = mesh.triangles().iter().filter(|triangle| self.is_whole(triangle));
        let triangles = whole.map(|triangle| triangle.map(|vertex| self.of[vertex as usize])).collect();
        Mesh::new(mesh.positions().to_vec(), triangles).unwrap()
    }
}

fn is_whole(positions: &[u32], triangle: &[u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
    a != b && b != c && c != a
}

/// The mesh with each vertex named by `place`, without those that no triangle names.
pub(crate) fn merged(mesh: &Mesh, place: impl Fn(u32) -> u32) -> Mesh {
    let mut names = BTreeMap::new();
    let mut positions = Vec::new();
    let triangles = mesh.triangles().iter().map(|triangle| {
        triangle.map(|vertex| {
            *names.entry(place(vertex)).or_insert_with(|| {
                positions.push(mesh.positions()[vertex as usize]);
                positions.len() as u32 - 1
            })
        })
    });
    let triangles = triangles.collect();
    Mesh::new(positions, triangles).unwrap()
}

/// The triangles that `collapses` leave of those of `mesh`, done one after the other.
pub(crate) fn replayed(mesh: &Mesh, places: &Places, collapses: &[HalfEdge]) -> Vec<[u32; 3]> {
    let mut triangles = mesh.triangles().to_vec();
    triangles.retain(|triangle| places.is_whole(triangle));
    collapses.iter().for_each(|&collapse| replay(&mut triangles, places, collapse));
    triangles
}

/// Does one collapse in the plainest way.
pub(crate) fn replay(triangles: &mut Vec<[u32; 3]>, places: &Places, collapse: HalfEdge) {
    for corner in triangles.as_flattened_mut().iter_mut().filter(|corner| **corner == collapse.source) {
        *corner = collapse.target;
    }
    triangles.retain(|triangle| places.is_whole(triangle));
}
