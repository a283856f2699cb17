//! A triangulation in the plane whose edges can be flipped and whose vertices can go to a neighbour.
//!
//! A corner table: three corners a triangle, and each corner also stands for the edge to the next corner of its
//! triangle, as one half of it. The other half is its *twin*; edges without are on the rim.

use crate::rate_distortion::raster::{Place, twice_area};

const NONE: u32 = u32::MAX;

/// A vertex: over which sample, and how high.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Vertex {
    pub(super) place: Place,
    pub(super) height: f32,
}

/// Triangles that lie side by side, counter-clockwise from above; they may leave holes.
#[derive(Debug, Clone)]
pub(super) struct Triangulation {
    pub(super) vertices: Vec<Vertex>,
    /// The vertex at each corner; `NONE` if its triangle is gone.
    corners: Vec<u32>,
    twins: Vec<u32>,
    /// A corner of each vertex.
    corner_of: Vec<u32>,
    /// Vertices where triangles meet in several fans. They stay.
    pinched: Vec<bool>,
}

/// What is around a vertex, counter-clockwise.
#[derive(Debug, Default)]
pub(super) struct Fan {
    /// The vertex's corner in each triangle, which is the edge to the neighbour of the same index.
    pub(super) spokes: Vec<u32>,
    /// The neighbours: one more than spokes if the fan is open.
    pub(super) ring: Vec<u32>,
}

impl Fan {
    /// Whether triangles are all around.
    pub(super) fn is_closed(&self) -> bool {
        self.spokes.len() == self.ring.len()
    }

    /// The neighbour after this one, going around.
    pub(super) fn after(&self, index: usize) -> usize {
        if index + 1 == self.ring.len() { 0 } else { index + 1 }
    }

    /// The spokes of the triangles that vanish when the vertex goes to a neighbour: the one before it and the
    /// one after, of which an open fan may have one only.
    fn vanishing(&self, target: usize) -> (Option<usize>, Option<usize>) {
        let before = if target > 0 { Some(target - 1) } else { self.is_closed().then(|| self.spokes.len() - 1) };
        (before, (target < self.spokes.len()).then_some(target))
    }

    /// The triangles that stay when the vertex goes to a neighbour, by spoke.
    pub(super) fn staying(&self, target: usize) -> impl Iterator<Item = usize> {
        let (before, after) = self.vanishing(target);
        (0..self.spokes.len()).filter(move |&spoke| Some(spoke) != before && Some(spoke) != after)
    }
}

/// The next corner of the same triangle.
#[inline]
pub(super) fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// The corner before in the same triangle.
#[inline]
pub(super) fn previous(corner: u32) -> u32 {
    if corner % 3 == 0 { corner + 2 } else { corner - 1 }
}

impl Triangulation {
    /// Puts triangles together: conforming, counter-clockwise, no two over each other. Linear.
    pub(super) fn new(vertices: Vec<Vertex>, triangles: &[[u32; 3]]) -> Self {
        let corners = triangles.as_flattened().to_vec();
        // Corners by vertex, in compressed rows: each edge is found among the few that leave its other end.
        let mut starts = vec![0u32; vertices.len() + 1];
        corners.iter().for_each(|&vertex| starts[vertex as usize + 1] += 1);
        (1..starts.len()).for_each(|vertex| starts[vertex] += starts[vertex - 1]);
        let mut ends = starts.clone();
        let mut leaving = vec![0u32; corners.len()];
        for (corner, &vertex) in corners.iter().enumerate() {
            leaving[ends[vertex as usize] as usize] = corner as u32;
            ends[vertex as usize] += 1;
        }
        let leaving = |vertex: u32| &leaving[starts[vertex as usize] as usize..ends[vertex as usize] as usize];
        let to = |corner: u32| corners[next(corner) as usize];
        let twin = |corner: u32| {
            let from = corners[corner as usize];
            leaving(to(corner)).iter().copied().find(|&other| to(other) == from).unwrap_or(NONE)
        };
        let twins: Vec<u32> = (0..corners.len() as u32).map(twin).collect();
        let names = 0..vertices.len() as u32;
        let corner_of = names.clone().map(|vertex| leaving(vertex).first().copied().unwrap_or(NONE)).collect();
        let counts: Vec<usize> = names.clone().map(|vertex| leaving(vertex).len()).collect();
        let pinched = vec![false; vertices.len()];
        let mut triangulation = Self { vertices, corners, twins, corner_of, pinched };
        let mut fan = Fan::default();
        for vertex in names.filter(|&vertex| counts[vertex as usize] > 0) {
            triangulation.gather(vertex, &mut fan);
            triangulation.pinched[vertex as usize] = fan.spokes.len() != counts[vertex as usize];
        }
        triangulation
    }

    /// How many triangles there were at first; some may be gone.
    pub(super) fn triangle_slots(&self) -> usize {
        self.corners.len() / 3
    }

    /// Whether a triangle is still there.
    pub(super) fn has_triangle(&self, triangle: usize) -> bool {
        self.corners[3 * triangle] != NONE
    }

    /// Whether the triangle of a corner is still there.
    pub(super) fn has_corner(&self, corner: u32) -> bool {
        self.corners[corner as usize] != NONE
    }

    /// Whether a vertex has a triangle.
    pub(super) fn has_vertex(&self, vertex: u32) -> bool {
        self.corner_of[vertex as usize] != NONE
    }

    /// The vertices of a triangle.
    pub(super) fn names(&self, triangle: usize) -> [u32; 3] {
        [0, 1, 2].map(|k| self.corners[3 * triangle + k])
    }

    /// The vertices of a triangle, and which of its edges are on the rim.
    pub(super) fn triangle(&self, triangle: usize) -> ([Vertex; 3], [bool; 3]) {
        let rim = [0, 1, 2].map(|k| self.twins[3 * triangle + k] == NONE);
        (self.names(triangle).map(|vertex| self.vertices[vertex as usize]), rim)
    }

    /// The other half of an edge.
    pub(super) fn twin(&self, corner: u32) -> Option<u32> {
        Some(self.twins[corner as usize]).filter(|&twin| twin != NONE)
    }

    /// Whether an edge is on the rim.
    pub(super) fn is_rim(&self, corner: u32) -> bool {
        self.twins[corner as usize] == NONE
    }

    /// The vertex at a corner.
    pub(super) fn name(&self, corner: u32) -> u32 {
        self.corners[corner as usize]
    }

    fn place(&self, vertex: u32) -> Place {
        self.vertices[vertex as usize].place
    }

    /// Collects what is around a vertex that has triangles; of a pinched one, a fan only.
    pub(super) fn gather(&self, vertex: u32, fan: &mut Fan) {
        fan.spokes.clear();
        fan.ring.clear();
        let first = self.corner_of[vertex as usize];
        let mut start = first;
        while let Some(twin) = self.twin(start) {
            start = next(twin);
            if start == first {
                break;
            }
        }
        let mut spoke = start;
        loop {
            fan.spokes.push(spoke);
            fan.ring.push(self.name(next(spoke)));
            match self.twin(previous(spoke)) {
                Some(twin) if twin == start => break,
                Some(twin) => spoke = twin,
                None => {
                    fan.ring.push(self.name(previous(spoke)));
                    break;
                }
            }
        }
    }

    /// Calls `consider` with the neighbours, by their index in the fan, to which a vertex may go: no triangle may
    /// turn over or become flat, and the rim stays where it is.
    ///
    /// That is enough for the triangulation to stay one: what comes out covers just what the fan did.
    pub(super) fn targets(&self, vertex: u32, fan: &Fan, mut consider: impl FnMut(usize)) {
        if self.pinched[vertex as usize] {
            return;
        }
        let keeps_shape = |target: usize| {
            let goal = self.place(fan.ring[target]);
            fan.staying(target).all(|spoke| {
                let ends = [fan.ring[spoke], fan.ring[fan.after(spoke)]].map(|end| self.place(end));
                twice_area([goal, ends[0], ends[1]]) > 0
            })
        };
        if fan.is_closed() {
            (0..fan.ring.len()).filter(|&target| keeps_shape(target)).for_each(consider);
            return;
        }
        let last = fan.ring.len() - 1;
        let [a, b] = [fan.ring[0], fan.ring[last]].map(|end| self.place(end));
        let between = self.place(vertex);
        let towards = |axis: usize| i64::from(a[axis] - between[axis]) * i64::from(b[axis] - between[axis]);
        if twice_area([a, between, b]) == 0 && towards(0) + towards(1) < 0 {
            [0, last].into_iter().filter(|&target| keeps_shape(target)).for_each(&mut consider);
        }
    }

    /// Lets the vertex of a fan go to a neighbour that [`Triangulation::targets`] allows.
    pub(super) fn collapse(&mut self, vertex: u32, fan: &Fan, target: usize) {
        let goal = fan.ring[target];
        let (before, after) = fan.vanishing(target);
        for spoke in fan.staying(target) {
            self.corners[fan.spokes[spoke] as usize] = goal;
            self.corner_of[goal as usize] = fan.spokes[spoke];
        }
        // What lay beyond a vanishing triangle now lies beyond the one that stays next to it.
        if let Some(after) = after {
            let spoke = fan.spokes[after];
            let side = self.twins[previous(spoke) as usize];
            self.remove(spoke, next(spoke), side, next(side));
        }
        if let Some(before) = before {
            let spoke = fan.spokes[before];
            let side = self.twins[spoke as usize];
            self.remove(spoke, next(spoke), side, side);
        }
        self.corner_of[vertex as usize] = NONE;
    }

    /// Takes the triangle of a corner away; the half `inner` of an edge takes the place of its `outer` one, and
    /// the third vertex of the triangle is left with `corner`.
    fn remove(&mut self, spoke: u32, outer: u32, inner: u32, corner: u32) {
        self.link(inner, self.twins[outer as usize]);
        let third = self.corners[corner as usize];
        self.corner_of[third as usize] = corner;
        for corner in [spoke, next(spoke), previous(spoke)] {
            self.corners[corner as usize] = NONE;
        }
    }

    /// Makes two halves one edge; `half` is on the rim if there is no other.
    fn link(&mut self, half: u32, other: u32) {
        self.twins[half as usize] = other;
        if other != NONE {
            self.twins[other as usize] = half;
        }
    }

    /// The vertices around an edge between two triangles: that opposite, its start, that on the other side, and its
    /// end; `None` on the rim or if they make no strictly convex quad, so that it cannot be flipped.
    pub(super) fn quad(&self, corner: u32) -> Option<[u32; 4]> {
        let twin = self.twin(corner)?;
        let corners = [previous(corner), corner, previous(twin), next(corner)];
        let names = corners.map(|corner| self.name(corner));
        let [a, b, c, d] = names.map(|vertex| self.place(vertex));
        (twice_area([a, b, c]) > 0 && twice_area([a, c, d]) > 0).then_some(names)
    }

    /// The four edges around the two triangles of an edge, each from one to the next of [`Triangulation::quad`].
    pub(super) fn quad_edges(&self, corner: u32) -> [u32; 4] {
        let twin = self.twins[corner as usize];
        [previous(corner), next(twin), previous(twin), next(corner)]
    }

    /// Replaces an edge by the other diagonal of its quad. The triangle of `corner` becomes the first, third and
    /// fourth vertex of the quad, that of its twin the first three.
    pub(super) fn flip(&mut self, corner: u32) {
        let twin = self.twins[corner as usize];
        let edges = self.quad_edges(corner);
        let [ab, bc, cd, da] = edges.map(|edge| self.twins[edge as usize]);
        let [a, b, c, d] = edges.map(|edge| self.corners[edge as usize]);
        let places = [
            (corner, a, twin),
            (next(corner), c, cd),
            (previous(corner), d, da),
            (twin, c, corner),
            (next(twin), a, ab),
            (previous(twin), b, bc),
        ];
        for (half, vertex, other) in places {
            self.corners[half as usize] = vertex;
            self.corner_of[vertex as usize] = half;
            self.link(half, other);
        }
    }

    /// The vertices that have triangles, in their order, and the triangles by these.
    pub(super) fn into_parts(self) -> (Vec<Vertex>, Vec<[u32; 3]>) {
        let mut names = vec![NONE; self.vertices.len()];
        let mut vertices = Vec::new();
        for (vertex, name) in names.iter_mut().enumerate().filter(|&(vertex, _)| self.has_vertex(vertex as u32)) {
            *name = vertices.len() as u32;
            vertices.push(self.vertices[vertex]);
        }
        let standing = (0..self.triangle_slots()).filter(|&triangle| self.has_triangle(triangle));
        let triangles =
            standing.map(|triangle| self.names(triangle).map(|vertex| names[vertex as usize])).collect();
        (vertices, triangles)
    }
}
