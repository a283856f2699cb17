//! A triangulation in the plane whose edges can be flipped and whose vertices can go to a neighbour.
//!
//! A corner table: each corner of a triangle also stands for the edge to the next corner, as one half of it. The
//! other half is its *twin*; edges without are on the rim. Corner `k` of triangle `t` is number `4 t + k`.

use crate::rate_distortion::raster::{Place, twice_area};

const NONE: u32 = u32::MAX;

/// A vertex: over which sample, and how high.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Vertex {
    pub(super) place: Place,
    pub(super) height: f32,
    /// A corner of it, or `NONE`.
    corner: u32,
}

impl Vertex {
    /// A vertex that has no triangles yet.
    pub(super) fn new(place: Place, height: f32) -> Self {
        Self { place, height, corner: NONE }
    }
}

/// All that is known of a triangle, in half a cache line: what is asked for next is nearly always next to it.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    /// The vertices; `NONE` if the triangle is gone.
    vertices: [u32; 3],
    twins: [u32; 3],
    error: f64,
}

/// Triangles that lie side by side, counter-clockwise from above; they may leave holes.
#[derive(Debug, Clone)]
pub(super) struct Triangulation {
    pub(super) vertices: Vec<Vertex>,
    triangles: Vec<Triangle>,
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

    /// The edge of the ring in the triangle of a spoke.
    pub(super) fn edge(&self, spoke: usize) -> [u32; 2] {
        [self.ring[spoke], self.ring[self.after(spoke)]]
    }

    /// The spokes of the triangles that vanish when the vertex goes to a neighbour: the one before it and the
    /// one after, of which an open fan may have one only.
    fn vanishing(&self, target: usize) -> (Option<usize>, Option<usize>) {
        let before =
            if target > 0 { Some(target - 1) } else { self.is_closed().then(|| self.spokes.len() - 1) };
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
    if corner % 4 == 2 { corner - 2 } else { corner + 1 }
}

/// The corner before in the same triangle.
#[inline]
pub(super) fn previous(corner: u32) -> u32 {
    if corner.is_multiple_of(4) { corner + 2 } else { corner - 1 }
}

impl Triangulation {
    /// Puts triangles together: conforming, counter-clockwise, no two over each other. Linear.
    pub(super) fn new(mut vertices: Vec<Vertex>, triangles: &[[u32; 3]]) -> Self {
        // Corners by vertex, in compressed rows: each edge is found among the few that leave its other end.
        let corners = || {
            let numbered = triangles.iter().zip((0..).step_by(4));
            numbered.flat_map(|(vertices, first)| vertices.iter().copied().zip(first..))
        };
        let mut starts = vec![0u32; vertices.len() + 1];
        corners().for_each(|(vertex, _)| starts[vertex as usize + 1] += 1);
        (1..starts.len()).for_each(|vertex| starts[vertex] += starts[vertex - 1]);
        let mut ends = starts.clone();
        let mut leaving = vec![0u32; 3 * triangles.len()];
        for (vertex, corner) in corners() {
            leaving[ends[vertex as usize] as usize] = corner;
            ends[vertex as usize] += 1;
        }
        let leaving =
            |vertex: u32| &leaving[starts[vertex as usize] as usize..ends[vertex as usize] as usize];
        let end = |corner: u32| triangles[corner as usize / 4][next(corner) as usize % 4];
        let twin = |from: u32, to: u32| {
            leaving(to).iter().copied().find(|&other| end(other) == from).unwrap_or(NONE)
        };
        let together = |&vertices @ [a, b, c]: &[u32; 3]| Triangle {
            vertices,
            twins: [twin(a, b), twin(b, c), twin(c, a)],
            error: 0.0,
        };
        let triangles = triangles.iter().map(together).collect();
        for (vertex, name) in vertices.iter_mut().zip(0..) {
            vertex.corner = leaving(name).first().copied().unwrap_or(NONE);
        }
        let mut triangulation = Self { pinched: vec![false; vertices.len()], vertices, triangles };
        let mut fan = Fan::default();
        for vertex in (0..triangulation.vertices.len() as u32).filter(|&vertex| !leaving(vertex).is_empty()) {
            triangulation.gather(vertex, &mut fan);
            triangulation.pinched[vertex as usize] = fan.spokes.len() != leaving(vertex).len();
        }
        triangulation
    }

    /// The triangles that are there.
    pub(super) fn triangles(&self) -> impl Iterator<Item = u32> {
        (0..self.triangles.len() as u32).filter(|&triangle| self.has_triangle(triangle))
    }

    /// How many triangles there were at first: all numbers of triangles are below.
    pub(super) fn triangle_slots(&self) -> u32 {
        self.triangles.len() as u32
    }

    /// Whether a triangle is still there.
    pub(super) fn has_triangle(&self, triangle: u32) -> bool {
        self.triangles[triangle as usize].vertices[0] != NONE
    }

    /// Whether a vertex has a triangle.
    pub(super) fn has_vertex(&self, vertex: u32) -> bool {
        self.vertices[vertex as usize].corner != NONE
    }

    /// The vertices of a triangle.
    pub(super) fn names(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize].vertices
    }

    /// The vertices of a triangle, and which of its edges are on the rim.
    pub(super) fn triangle(&self, triangle: u32) -> ([Vertex; 3], [bool; 3]) {
        let Triangle { vertices: [a, b, c], twins, .. } = self.triangles[triangle as usize];
        (
            [self.vertex(a), self.vertex(b), self.vertex(c)],
            [twins[0] == NONE, twins[1] == NONE, twins[2] == NONE],
        )
    }

    /// The error of a triangle, as it was last set.
    pub(super) fn error(&self, triangle: u32) -> f64 {
        self.triangles[triangle as usize].error
    }

    /// Remembers the error of a triangle.
    pub(super) fn set_error(&mut self, triangle: u32, error: f64) {
        self.triangles[triangle as usize].error = error;
    }

    pub(super) fn vertex(&self, name: u32) -> Vertex {
        self.vertices[name as usize]
    }

    fn twin_or_none(&self, corner: u32) -> u32 {
        self.triangles[corner as usize / 4].twins[corner as usize % 4]
    }

    /// The other half of an edge.
    pub(super) fn twin(&self, corner: u32) -> Option<u32> {
        Some(self.twin_or_none(corner)).filter(|&twin| twin != NONE)
    }

    /// Whether an edge is on the rim.
    pub(super) fn is_rim(&self, corner: u32) -> bool {
        self.twin_or_none(corner) == NONE
    }

    /// The vertex at a corner.
    pub(super) fn name(&self, corner: u32) -> u32 {
        self.triangles[corner as usize / 4].vertices[corner as usize % 4]
    }

    fn set_name(&mut self, corner: u32, vertex: u32) {
        self.triangles[corner as usize / 4].vertices[corner as usize % 4] = vertex;
    }

    fn place(&self, vertex: u32) -> Place {
        self.vertices[vertex as usize].place
    }

    /// Whether the vertex of a fan is not on the rim.
    pub(super) fn may_move(&self, vertex: u32, fan: &Fan) -> bool {
        fan.is_closed() && !self.pinched[vertex as usize]
    }

    /// Moves a vertex, to where it [sees](Triangulation::sees) all of its ring.
    pub(super) fn move_to(&mut self, vertex: u32, place: Place, height: f32) {
        let vertex = &mut self.vertices[vertex as usize];
        (vertex.place, vertex.height) = (place, height);
    }

    /// Collects what is around a vertex that has triangles; of a pinched one, a fan only.
    pub(super) fn gather(&self, vertex: u32, fan: &mut Fan) {
        fan.spokes.clear();
        fan.ring.clear();
        let first = self.vertices[vertex as usize].corner;
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
    pub(super) fn targets(&self, vertex: u32, fan: &Fan, consider: impl FnMut(usize)) {
        if self.pinched[vertex as usize] {
            return;
        }
        let keeps_shape = |&target: &usize| self.sees(self.place(fan.ring[target]), fan, fan.staying(target));
        if fan.is_closed() {
            (0..fan.ring.len()).filter(keeps_shape).for_each(consider);
            return;
        }
        let last = fan.ring.len() - 1;
        let [a, b] = [fan.ring[0], fan.ring[last]].map(|end| self.place(end));
        let between = self.place(vertex);
        let towards = |axis: usize| i64::from(a[axis] - between[axis]) * i64::from(b[axis] - between[axis]);
        if twice_area([a, between, b]) == 0 && towards(0) + towards(1) < 0 {
            [0, last].into_iter().filter(keeps_shape).for_each(consider);
        }
    }

    /// Whether triangles from a place to the edges of the ring at these spokes are counter-clockwise and have areas.
    pub(super) fn sees(&self, from: Place, fan: &Fan, mut spokes: impl Iterator<Item = usize>) -> bool {
        spokes.all(|spoke| {
            let [start, end] = fan.edge(spoke).map(|name| self.place(name));
            twice_area([from, start, end]) > 0
        })
    }

    /// Lets the vertex of a fan go to a neighbour that [`Triangulation::targets`] allows.
    pub(super) fn collapse(&mut self, vertex: u32, fan: &Fan, target: usize) {
        let goal = fan.ring[target];
        let (before, after) = fan.vanishing(target);
        for spoke in fan.staying(target).map(|spoke| fan.spokes[spoke]) {
            self.set_name(spoke, goal);
            self.vertices[goal as usize].corner = spoke;
        }
        // What lay beyond a vanishing triangle now lies beyond the one that stays next to it.
        if let Some(spoke) = after.map(|after| fan.spokes[after]) {
            let inner = self.twin_or_none(previous(spoke));
            self.remove(spoke, inner, next(inner));
        }
        if let Some(spoke) = before.map(|before| fan.spokes[before]) {
            let inner = self.twin_or_none(spoke);
            self.remove(spoke, inner, inner);
        }
        self.vertices[vertex as usize].corner = NONE;
    }

    /// Takes the triangle of a spoke away. Across the edge opposite of it there is `inner` now, half of an edge of
    /// the triangle that stays next to it; of the vertex that both have, `corner` stays.
    fn remove(&mut self, spoke: u32, inner: u32, corner: u32) {
        self.link(inner, self.twin_or_none(next(spoke)));
        let shared = self.name(corner);
        self.vertices[shared as usize].corner = corner;
        self.triangles[spoke as usize / 4].vertices = [NONE; 3];
    }

    /// Makes two halves one edge; `half` is on the rim if there is no other.
    fn link(&mut self, half: u32, other: u32) {
        self.triangles[half as usize / 4].twins[half as usize % 4] = other;
        if other != NONE {
            self.triangles[other as usize / 4].twins[other as usize % 4] = half;
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
        let twin = self.twin_or_none(corner);
        [previous(corner), next(twin), previous(twin), next(corner)]
    }

    /// Replaces an edge by the other diagonal of its quad. The triangle of `corner` becomes the first, third and
    /// fourth vertex of the quad, that of its twin the first three.
    pub(super) fn flip(&mut self, corner: u32) {
        let twin = self.twin_or_none(corner);
        let edges = self.quad_edges(corner);
        let [ab, bc, cd, da] = edges.map(|edge| self.twin_or_none(edge));
        let [a, b, c, d] = edges.map(|edge| self.name(edge));
        let places = [
            (corner, a, twin),
            (next(corner), c, cd),
            (previous(corner), d, da),
            (twin, c, corner),
            (next(twin), a, ab),
            (previous(twin), b, bc),
        ];
        for (half, vertex, other) in places {
            self.set_name(half, vertex);
            self.vertices[vertex as usize].corner = half;
            self.link(half, other);
        }
    }

    /// The vertices that have triangles, in their order, and the triangles by these.
    pub(super) fn into_parts(self) -> (Vec<Vertex>, Vec<[u32; 3]>) {
        let mut names = vec![NONE; self.vertices.len()];
        let mut vertices = Vec::new();
        for (vertex, name) in
            names.iter_mut().enumerate().filter(|&(vertex, _)| self.has_vertex(vertex as u32))
        {
            *name = vertices.len() as u32;
            vertices.push(self.vertices[vertex]);
        }
        let renamed = |triangle| self.names(triangle).map(|vertex| names[vertex as usize]);
        let triangles = self.triangles().map(renamed).collect();
        (vertices, triangles)
    }
}
