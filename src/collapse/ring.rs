//! A vertex with all that surrounds it, gathered once for cost, legality and placement.

use crate::quadric::Quadric;
use glam::Vec3;

/// One face around a vertex, as seen from it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spoke {
    /// The corner after the vertex, and the one before it.
    pub(crate) next: u32,
    pub(crate) previous: u32,
    /// From the vertex to each of them.
    pub(crate) to_next: Vec3,
    pub(crate) to_previous: Vec3,
    /// `to_next x to_previous`: along the face's normal, twice its area long.
    pub(crate) cross: Vec3,
}

/// The faces around a vertex, with the vertex as origin, and the quadric of their planes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ring {
    spokes: Vec<Spoke>,
    count: usize,
    pub(crate) vertex: u32,
    /// The vertex lies on an edge that has not exactly two faces of one orientation.
    pub(crate) boundary: bool,
    pub(crate) quadric: Quadric,
}

impl Ring {
    /// Empties the ring for `vertex`, with room for `capacity` faces.
    #[inline(always)]
    pub(crate) fn begin(&mut self, vertex: u32, boundary: bool, capacity: usize) {
        self.vertex = vertex;
        self.boundary = boundary;
        self.count = 0;
        if self.spokes.len() < capacity {
            self.spokes.resize(capacity.next_power_of_two(), Spoke::default());
        }
    }

    /// Adds a face and, to `quadric`, its plane. The caller holds the quadric, so that it stays in
    /// registers along the ring (a third of the time of a gather otherwise goes into storing and
    /// reloading it); [`finish`](Self::finish) takes it in.
    #[inline(always)]
    pub(crate) fn push(
        &mut self,
        quadric: &mut Quadric,
        next: u32,
        previous: u32,
        to_next: Vec3,
        to_previous: Vec3,
    ) {
        let cross = to_next.cross(to_previous);
        quadric.add_face(cross);
        self.spokes[self.count] = Spoke { next, previous, to_next, to_previous, cross };
        self.count += 1;
    }

    /// Ends the gathering: adds the planes that hold borders to `quadric` and keeps it.
    #[inline(always)]
    pub(crate) fn finish(&mut self, quadric: Quadric) {
        self.quadric = quadric;
        if self.boundary {
            self.add_border_planes();
        }
    }

    /// The faces, in no particular order.
    #[inline(always)]
    pub(crate) fn spokes(&self) -> &[Spoke] {
        &self.spokes[..self.count]
    }

    /// Whether no face is left around the vertex.
    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How many faces name `vertex`, as next and as previous.
    fn occurrences(&self, vertex: u32) -> (usize, usize) {
        let spokes = self.spokes().iter();
        spokes.fold((0, 0), |(next, previous), spoke| {
            (next + usize::from(spoke.next == vertex), previous + usize::from(spoke.previous == vertex))
        })
    }

    /// Every edge to the vertex that has not two faces of one orientation is held by a plane for
    /// each of its faces: borders, non-manifold edges, and edges where the orientation changes.
    #[cold]
    #[inline(never)]
    fn add_border_planes(&mut self) {
        for index in 0..self.count {
            let spoke = self.spokes[index];
            for (neighbour, edge) in [(spoke.next, spoke.to_next), (spoke.previous, spoke.to_previous)] {
                if self.occurrences(neighbour) != (1, 1) {
                    self.quadric.add_border(edge, spoke.cross);
                }
            }
        }
    }

    /// The neighbour, of those that are `eligible`, at which this vertex's quadric is least, and
    /// the cost there: `Q_i(v_j)` of section 3.3. Ties go to the smaller index.
    #[inline(always)]
    pub(crate) fn cheapest_neighbour(&self, eligible: impl Fn(u32) -> bool) -> Option<(f32, u32)> {
        // Costs are not negative, so their bits order as they do, and one integer compares both.
        let mut best = u64::MAX;
        let mut consider = |neighbour: u32, edge: Vec3| {
            let key = u64::from(self.quadric.at(edge).to_bits()) << 32 | u64::from(neighbour);
            if eligible(neighbour) {
                best = best.min(key);
            }
        };
        for spoke in self.spokes() {
            consider(spoke.next, spoke.to_next);
        }
        if self.boundary {
            for spoke in self.spokes() {
                consider(spoke.previous, spoke.to_previous);
            }
        }
        (best != u64::MAX).then(|| (f32::from_bits((best >> 32) as u32), best as u32))
    }

    /// Each neighbour once, in ascending order, into `neighbours`.
    pub(crate) fn neighbours(&self, neighbours: &mut Vec<u32>) {
        neighbours.clear();
        neighbours.extend(self.spokes().iter().flat_map(|spoke| [spoke.next, spoke.previous]));
        neighbours.sort_unstable();
        neighbours.dedup();
    }
}
