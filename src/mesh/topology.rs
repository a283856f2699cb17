//! How the triangles of a mesh hang together: edges, borders, fans, components and what Euler says.
//!
//! A triangle that names a vertex twice has no place in a surface: it is not a face here, and its
//! vertices count as used only if a proper face uses them. Two triangles on the same three vertices
//! are two faces. Positions play no part: two vertices at one point are two vertices
//! ([`Mesh::weld`] makes them one).

use std::ops::Range;

use rayon::prelude::*;

use super::partition::Partition;
use super::rings::Corner;
use super::{Mesh, Rings};

/// One face's side of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Side {
    /// The face, an index into [`Mesh::triangles`].
    pub face: usize,
    /// Whether the face runs from the edge's lower vertex to the higher one.
    pub ascending: bool,
}

/// An edge and the faces on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge<'a> {
    /// Its two vertices, the lower index first.
    pub vertices: [u32; 2],
    /// Its faces in ascending order: at least one.
    pub sides: &'a [Side],
}

impl Edge<'_> {
    /// Whether it has one face only.
    pub fn is_border(&self) -> bool {
        self.sides.len() == 1
    }

    /// Whether it has more than two faces.
    pub fn is_non_manifold(&self) -> bool {
        self.sides.len() > 2
    }

    /// Whether it has two faces that run the same way along it: one of them is inside out.
    pub fn is_inconsistent(&self) -> bool {
        matches!(self.sides, [first, second] if first.ascending == second.ascending)
    }
}

/// Calls `visit` with each edge of `mesh` once, ordered by its vertices.
///
/// No table of all the edges is built: the time is that of sorting each ring, the memory that of the
/// largest ring. `rings` must be those of `mesh`.
pub fn visit_edges(mesh: &Mesh, rings: &Rings, mut visit: impl FnMut(Edge<'_>)) {
    let mut star = Star::default();
    let mut sides = Vec::new();
    for vertex in 0..rings.vertices() {
        star.gather(mesh, rings, vertex);
        for spokes in star.spokes().filter(|spokes| spokes[0].end() as usize > vertex) {
            sides.clear();
            sides.extend(spokes.iter().map(|spoke| Side {
                face: star.corners[spoke.slot() as usize].face(),
                ascending: spoke.is_outgoing(),
            }));
            visit(Edge { vertices: [vertex as u32, spokes[0].end()], sides: &sides });
        }
    }
}

/// The first vertex whose faces form several fans.
pub(super) fn first_non_manifold_vertex(mesh: &Mesh, rings: &Rings) -> Option<u32> {
    (0..rings.vertices() as u32).find(|&vertex| {
        let vertex = vertex as usize;
        Survey::of_vertices(mesh, rings, vertex..vertex + 1).counts.non_manifold_vertices > 0
    })
}

/// What the connectivity of a mesh amounts to. See the [module](self) for what counts as a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Topology {
    /// Vertices that a face uses.
    pub vertices: usize,
    /// Edges, however many faces they have.
    pub edges: usize,
    /// Triangles with three different vertices.
    pub faces: usize,
    /// Edges with one face.
    pub border_edges: usize,
    /// Closed chains of border edges. Border edges that share a vertex are of one chain, as faces that
    /// do are of one component: two holes that touch in a point are one loop.
    pub boundary_loops: usize,
    /// Edges with more than two faces.
    pub non_manifold_edges: usize,
    /// Edges with two faces that run the same way along it.
    pub inconsistent_edges: usize,
    /// Vertices whose faces form several fans. Two faces at a vertex are of one fan if a chain of
    /// faces at that vertex, each sharing an edge with the next, leads from one to the other.
    pub non_manifold_vertices: usize,
    /// Pieces of the surface: faces that share a vertex are of one piece.
    pub components: usize,
}

impl Topology {
    /// Vertices minus edges plus faces: 2 for a sphere, 0 for a torus, one less for each hole.
    pub fn euler_characteristic(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }

    /// Whether every edge has at least two faces. A mesh without a face is closed.
    pub fn is_closed(&self) -> bool {
        self.border_edges == 0
    }

    /// Whether the surface is everywhere like a sheet of paper or its edge, and has two sides: no
    /// non-manifold edge or vertex and no inconsistent edge.
    pub fn is_oriented_manifold(&self) -> bool {
        self.non_manifold_edges == 0 && self.non_manifold_vertices == 0 && self.inconsistent_edges == 0
    }
}

impl Mesh {
    /// What the connectivity of the mesh amounts to. The time is that of sorting each ring, the memory
    /// that of [`Rings`], 4 bytes a triangle and 8 a vertex.
    pub fn topology(&self) -> Topology {
        Topology::new(self, &Rings::new(self))
    }
}

impl Topology {
    /// As [`Mesh::topology`], with the rings of `mesh` at hand.
    pub fn new(mesh: &Mesh, rings: &Rings) -> Self {
        let (survey, components) = rayon::join(|| Survey::new(mesh, rings), || Components::new(mesh).count);
        Self { boundary_loops: survey.loops(rings.vertices()), components, ..survey.counts }
    }
}

/// The pieces of a surface. Faces that share a vertex are of one piece.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Components {
    /// How many there are.
    pub count: usize,
    /// For each triangle its piece, numbered by their first faces; [`Components::NONE`] for a triangle
    /// that names a vertex twice.
    pub labels: Vec<u32>,
}

impl Components {
    /// The label of a triangle that is not a face.
    pub const NONE: u32 = u32::MAX;

    /// The pieces of `mesh`, in practically linear time.
    pub fn new(mesh: &Mesh) -> Self {
        let mut pieces = Partition::new(mesh.positions().len());
        for &[a, b, c] in mesh.triangles().iter().filter(|triangle| is_face(triangle)) {
            pieces.unite(a, b);
            pieces.unite(b, c);
        }
        let mut count = 0;
        let mut names = vec![Self::NONE; mesh.positions().len()];
        let label = |triangle: &[u32; 3]| {
            if !is_face(triangle) {
                return Self::NONE;
            }
            let name = &mut names[pieces.find(triangle[0]) as usize];
            if *name == Self::NONE {
                *name = count;
                count += 1;
            }
            *name
        };
        let labels = mesh.triangles().iter().map(label).collect();
        Self { count: count as usize, labels }
    }
}

/// Whether a triangle has three different vertices.
pub(crate) fn is_face(&[a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// One face's side of an edge as seen from one of its ends, packed so that sorting brings those
/// to the same other end together: other end, place in [`Star::corners`], direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Spoke(u64);

impl Spoke {
    fn new(end: u32, slot: usize, outgoing: bool) -> Self {
        Self(u64::from(end) << 32 | (slot as u64) << 1 | u64::from(outgoing))
    }

    fn end(self) -> u32 {
        (self.0 >> 32) as u32
    }

    fn slot(self) -> u32 {
        self.0 as u32 >> 1
    }

    /// Whether the face runs away from the vertex.
    fn is_outgoing(self) -> bool {
        self.0 & 1 == 1
    }
}

/// The faces and edges at one vertex.
#[derive(Debug, Default)]
struct Star {
    corners: Vec<Corner>,
    spokes: Vec<Spoke>,
}

impl Star {
    fn gather(&mut self, mesh: &Mesh, rings: &Rings, vertex: usize) {
        self.corners.clear();
        self.spokes.clear();
        for &corner in rings.corners(vertex) {
            let triangle = &mesh.triangles()[corner.face()];
            if is_face(triangle) {
                let slot = self.corners.len();
                self.corners.push(corner);
                self.spokes.push(Spoke::new(triangle[corner.next().place()], slot, true));
                self.spokes.push(Spoke::new(triangle[corner.previous().place()], slot, false));
            }
        }
        self.spokes.sort_unstable();
    }

    /// The edges by their other ends, each as its sides.
    fn spokes(&self) -> impl Iterator<Item = &[Spoke]> {
        self.spokes.chunk_by(|a, b| a.end() == b.end())
    }
}

/// What can be told of a range of vertices without regard to the others.
#[derive(Debug, Default)]
struct Survey {
    counts: Topology,
    /// The ends of the border edges.
    border: Vec<[u32; 2]>,
    /// How many vertices they have.
    border_vertices: usize,
}

impl Survey {
    const BLOCK: usize = 1 << 16;

    fn new(mesh: &Mesh, rings: &Rings) -> Self {
        let vertices = rings.vertices();
        let blocks: Vec<Survey> = (0..vertices.div_ceil(Self::BLOCK))
            .into_par_iter()
            .map(|block| {
                Self::of_vertices(mesh, rings, block * Self::BLOCK..vertices.min((block + 1) * Self::BLOCK))
            })
            .collect();
        blocks.into_iter().fold(Self::default(), Self::and)
    }

    fn of_vertices(mesh: &Mesh, rings: &Rings, vertices: Range<usize>) -> Self {
        let Self { mut counts, mut border, mut border_vertices } = Self::default();
        let mut star = Star::default();
        let mut fans = Partition::default();
        for vertex in vertices {
            star.gather(mesh, rings, vertex);
            if star.corners.is_empty() {
                continue;
            }
            counts.vertices += 1;
            // Each face and each edge is counted at one of its vertices.
            counts.faces += star.corners.iter().filter(|corner| corner.place() == 0).count();
            fans.reset(star.corners.len());
            let mut is_border = false;
            for spokes in star.spokes() {
                for pair in spokes.windows(2) {
                    fans.unite(pair[0].slot(), pair[1].slot());
                }
                is_border |= spokes.len() == 1;
                let end = spokes[0].end();
                if end as usize > vertex {
                    counts.edges += 1;
                    match *spokes {
                        [_] => border.push([vertex as u32, end]),
                        [a, b] => {
                            counts.inconsistent_edges += usize::from(a.is_outgoing() == b.is_outgoing());
                        }
                        _ => counts.non_manifold_edges += 1,
                    }
                }
            }
            counts.non_manifold_vertices += usize::from(fans.sets() > 1);
            border_vertices += usize::from(is_border);
        }
        counts.border_edges = border.len();
        Self { counts, border, border_vertices }
    }

    fn and(mut self, mut other: Self) -> Self {
        let (sum, more) = (&mut self.counts, &other.counts);
        sum.vertices += more.vertices;
        sum.edges += more.edges;
        sum.faces += more.faces;
        sum.border_edges += more.border_edges;
        sum.non_manifold_edges += more.non_manifold_edges;
        sum.inconsistent_edges += more.inconsistent_edges;
        sum.non_manifold_vertices += more.non_manifold_vertices;
        self.border.append(&mut other.border);
        self.border_vertices += other.border_vertices;
        self
    }

    /// Each border vertex is a chain of its own until an edge joins it to another.
    fn loops(&self, vertices: usize) -> usize {
        let mut chains = Partition::new(vertices);
        let joins = self.border.iter().filter(|&&[from, to]| chains.unite(from, to)).count();
        self.border_vertices - joins
    }
}
