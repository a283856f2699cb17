//! A vertex with all that surrounds it, gathered once for cost, legality and placement.

use super::surface::NONE;
use crate::lanes::{LANES, Names, Numbers, Vectors, first_lanes, named_vectors};
use crate::quadric::Quadric;
use glam::{Vec3A, Vec4};

/// The shape of one face around a vertex, as seen from it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spoke {
    /// From the vertex to the corner after it, and to the one before it.
    pub(crate) to_next: Vec3A,
    pub(crate) to_previous: Vec3A,
    /// `to_next x to_previous`: along the face's normal, twice its area long.
    pub(crate) cross: Vec3A,
}

impl Spoke {
    /// [`cross`](Self::cross) after the vertex has moved by `offset`.
    #[inline(always)]
    pub(crate) fn moved(&self, offset: Vec3A) -> Vec3A {
        self.cross + offset.cross(self.to_next - self.to_previous)
    }
}

/// Four spokes side by side.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spokes {
    pub(crate) to_next: Vectors,
    pub(crate) to_previous: Vectors,
    pub(crate) cross: Vectors,
}

impl Spokes {
    /// [`cross`](Self::cross) after the vertex has moved by an offset.
    #[inline(always)]
    pub(crate) fn moved(&self, offset: Vectors) -> Vectors {
        self.cross + offset.cross(self.to_next - self.to_previous)
    }
}

/// A way from the vertex to another corner, and the bits of that one's name: brought side by side together.
type Way = Vec4;

/// Four faces around a vertex: the corner after the vertex and the one before it in each, and the shapes. Where
/// there are fewer, names are [`NONE`], and there is no area.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    next: Names,
    previous: Names,
    spokes: Spokes,
}

impl Block {
    /// Brings side by side what is known of faces of which there are `count` or more; of those after them the
    /// ways are anything, and nothing comes of that.
    #[inline(always)]
    fn new(faces: &[[Way; 2]; LANES], count: usize) -> Self {
        let [(to_next, next), (to_previous, previous)] =
            [0, 1].map(|end| named_vectors(faces.each_ref().map(|ways| ways[end])));
        let known = first_lanes(count);
        let cross = to_next.cross(to_previous).masked(known);
        let spokes = Spokes { to_next, to_previous, cross };
        Self { next: next | !known, previous: previous | !known, spokes }
    }

    /// A bit for each face in which `vertex` comes after the ring's.
    #[inline(always)]
    fn after(&self, vertex: u32) -> u32 {
        self.next.simd_eq(Names::splat(vertex)).to_bitmask()
    }

    /// A bit for each face in which `vertex` comes before the ring's.
    #[inline(always)]
    fn before(&self, vertex: u32) -> u32 {
        self.previous.simd_eq(Names::splat(vertex)).to_bitmask()
    }
}

/// A face looks away if the cosine, squared, of the angle between its normal and the mean of all is less.
const POINTED: f32 = 0.25;

/// The faces around a vertex, with the vertex as origin, and the quadric of their planes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ring {
    /// To the corners after and before the vertex, as many as there are faces, and more.
    ways: Vec<[Way; 2]>,
    blocks: Vec<Block>,
    count: usize,
    pub(crate) vertex: u32,
    /// The vertex lies on an edge with more faces in one direction than in the other.
    pub(crate) boundary: bool,
    pub(crate) quadric: Quadric,
}

/// A ring being filled. What it needs is borrowed, so that it stays in registers from face to face.
pub(crate) struct Gathering<'a> {
    ways: &'a mut [[Way; 2]],
    count: usize,
}

impl Gathering<'_> {
    /// Adds a face. No more may be added than there is room for.
    #[inline(always)]
    pub(crate) fn push(&mut self, (next, previous): (u32, u32), to_next: Vec3A, to_previous: Vec3A) {
        let ways = [(to_next, next), (to_previous, previous)];
        self.ways[self.count] = ways.map(|(way, name)| way.extend(f32::from_bits(name)));
        self.count += 1;
    }

    /// How many were added.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.count
    }
}

impl Ring {
    /// Empties the ring, for up to `room` faces to be added.
    #[inline(always)]
    pub(crate) fn begin(&mut self, room: usize) -> Gathering<'_> {
        let padded = room.next_multiple_of(LANES);
        if self.ways.len() < padded {
            self.ways.resize(padded, [Way::ZERO; 2]);
            self.blocks.resize(padded / LANES, Block::default());
        }
        Gathering { ways: &mut self.ways, count: 0 }
    }

    /// Says that the `count` faces that were added are all those around `vertex`: works out their quadric, with
    /// the lines that hold borders.
    #[inline(always)]
    pub(crate) fn complete(&mut self, vertex: u32, boundary: bool, count: usize) {
        self.complete_names(vertex, boundary, count);
        self.complete_quadric();
    }

    /// The quadric of the faces of a ring that is complete but for it.
    #[inline(always)]
    pub(crate) fn complete_quadric(&mut self) {
        self.quadric = Quadric::of_faces(self.blocks().iter().map(|block| block.spokes.cross));
        if self.boundary {
            self.add_border_lines();
        }
    }

    /// [`complete`](Self::complete) without a quadric, which is what it was: enough for the link condition at the
    /// end of an edge that stays where it is, to which the ways may be anything.
    #[inline(always)]
    pub(crate) fn complete_names(&mut self, vertex: u32, boundary: bool, count: usize) {
        self.count = count;
        self.vertex = vertex;
        self.boundary = boundary;
        let (ways, _) = self.ways.as_chunks::<LANES>();
        for ((block, ways), first) in self.blocks.iter_mut().zip(ways).zip((0..count).step_by(LANES)) {
            *block = Block::new(ways, count - first);
        }
    }

    /// How many faces there are.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// The shapes of the faces.
    pub(crate) fn spokes(&self) -> impl Iterator<Item = Spoke> {
        (0..self.count).map(|face| self.spoke(face))
    }

    /// The shape of a face, by its place in the ring.
    #[inline(always)]
    pub(crate) fn spoke(&self, face: usize) -> Spoke {
        let [to_next, to_previous] = self.ways[face].map(Vec3A::from_vec4);
        Spoke { to_next, to_previous, cross: to_next.cross(to_previous) }
    }

    /// The corner after the vertex in a face, and the one before it.
    #[inline(always)]
    pub(crate) fn name(&self, face: usize) -> (u32, u32) {
        let [next, previous] = self.ways[face].map(|way| way.w.to_bits());
        (next, previous)
    }

    /// Both, face by face.
    #[inline(always)]
    pub(crate) fn names(&self) -> impl Iterator<Item = (u32, u32)> {
        (0..self.count).map(|face| self.name(face))
    }

    #[inline(always)]
    fn blocks(&self) -> &[Block] {
        &self.blocks[..self.count.div_ceil(LANES)]
    }

    /// The shapes of the faces, side by side, with a bit for each face that survives a collapse with `other`.
    #[inline(always)]
    pub(crate) fn surviving_spokes(&self, other: u32) -> impl Iterator<Item = (&Spokes, u32)> {
        self.blocks().iter().map(move |block| (&block.spokes, !(block.after(other) | block.before(other))))
    }

    /// The mean of the faces' normals, weighted by their areas, of any length.
    pub(crate) fn mean_normal(&self) -> Vec3A {
        self.spokes().map(|spoke| spoke.cross).sum()
    }

    /// Each face that survives a collapse with `other`: its normal, twice its area long, before and after
    /// the vertex has moved by `offset`.
    pub(crate) fn moved_faces(&self, other: u32, offset: Vec3A) -> impl Iterator<Item = (Vec3A, Vec3A)> {
        let faces = self.names().zip(self.spokes());
        faces
            .filter(move |((next, previous), _)| *next != other && *previous != other)
            .map(move |(_, spoke)| (spoke.cross, spoke.moved(offset)))
    }

    /// Four of its faces hardly look where the vertex does, given their vector areas, and the squares of these.
    #[inline(always)]
    pub(crate) fn look_away(&self, crosses: Vectors, areas_squared: Numbers) -> Numbers {
        let mean = self.quadric.sweep();
        let cosines = crosses.dot(Vectors::splat(mean)).fast_max(Numbers::ZERO);
        (cosines * cosines).simd_lt(Numbers::splat(POINTED * mean.length_squared()) * areas_squared)
    }

    /// The ways to the other two corners of each face that survives a collapse with `other`.
    pub(crate) fn surviving_edges(&self, other: u32) -> impl Iterator<Item = [Vec3A; 2]> {
        let faces = self.names().zip(self.spokes());
        faces
            .filter(move |((next, previous), _)| *next != other && *previous != other)
            .map(|(_, spoke)| [spoke.to_next, spoke.to_previous])
    }

    /// In how many faces `vertex` comes after the ring's, and in how many before.
    #[inline(always)]
    pub(crate) fn occurrences(&self, vertex: u32) -> (u32, u32) {
        let name = Names::splat(vertex);
        let (mut after, mut before) = (Names::ZERO, Names::ZERO);
        for block in self.blocks() {
            // What is equal is all ones, which is one less than nothing.
            after -= block.next.simd_eq(name);
            before -= block.previous.simd_eq(name);
        }
        (after.to_array().into_iter().sum(), before.to_array().into_iter().sum())
    }

    /// The first face in which `vertex` comes before the ring's.
    #[inline(always)]
    pub(crate) fn face_before(&self, vertex: u32) -> Option<usize> {
        let masks = self.blocks().iter().map(|block| block.before(vertex));
        let found = masks.enumerate().find(|(_, mask)| *mask != 0);
        found.map(|(index, mask)| LANES * index + mask.trailing_zeros() as usize)
    }

    /// Calls `see` with each face that has `vertex` as another corner, by its place in the ring, in order, and
    /// with whether `vertex` comes after the ring's there.
    #[inline(always)]
    pub(crate) fn visit_faces_with(&self, vertex: u32, mut see: impl FnMut(usize, bool)) {
        for (index, block) in self.blocks().iter().enumerate() {
            let after = block.after(vertex);
            let mut either = after | block.before(vertex);
            while either != 0 {
                let lane = either.trailing_zeros();
                see(LANES * index + lane as usize, after >> lane & 1 == 1);
                either &= either - 1;
            }
        }
    }

    /// How many vertices come after the vertex of this ring and of `other`.
    #[inline(always)]
    pub(crate) fn common_next(&self, other: &Self) -> u32 {
        let mut common = Names::ZERO;
        for theirs in other.blocks() {
            let [a, b, c, d] = theirs.next.to_array().map(Names::splat);
            for own in self.blocks() {
                // What is equal is all ones, which is one less than nothing.
                let pairs =
                    (own.next.simd_eq(a) + own.next.simd_eq(b)) + (own.next.simd_eq(c) + own.next.simd_eq(d));
                common -= pairs;
            }
        }
        let of_lanes: u32 = common.to_array().into_iter().sum();
        // The lanes that name nothing are equal too.
        let empty = |ring: &Self| (LANES * ring.blocks().len() - ring.count) as u32;
        of_lanes - empty(self) * empty(other)
    }

    /// Whether a face has these other corners, in either order.
    #[inline(always)]
    pub(crate) fn has_face(&self, [a, b]: [u32; 2]) -> bool {
        self.blocks()
            .iter()
            .any(|block| block.after(a) & block.before(b) | block.after(b) & block.before(a) != 0)
    }

    /// Calls `see` with every edge to the vertex that has not two faces of one orientation (borders,
    /// non-manifold edges, and edges where the orientation changes), and with each of its faces.
    fn visit_borders(&self, mut see: impl FnMut(Vec3A, Spoke)) {
        for ((next, previous), spoke) in self.names().zip(self.spokes()) {
            for (neighbour, edge) in [(next, spoke.to_next), (previous, spoke.to_previous)] {
                if self.occurrences(neighbour) != (1, 1) {
                    see(edge, spoke);
                }
            }
        }
    }

    /// Holds borders by the lines of their edges, and no volume.
    #[cold]
    #[inline(never)]
    fn add_border_lines(&mut self) {
        let mut quadric = self.quadric;
        quadric.open();
        self.visit_borders(|edge, _| quadric.add_border(edge));
        self.quadric = quadric;
    }

    /// The largest squared distance of `offset` from the planes upright on the faces along borders.
    #[cold]
    #[inline(never)]
    pub(crate) fn border_distance_squared(&self, offset: Vec3A) -> f32 {
        let mut largest = 0f32;
        self.visit_borders(|edge, spoke| {
            let normal = edge.cross(spoke.cross);
            let height = normal.dot(offset);
            largest = largest.max(height * height / (normal.length_squared() + f32::MIN_POSITIVE));
        });
        largest
    }

    /// The neighbour, of those that are `eligible`, at which this vertex's quadric is least, and
    /// the cost there: `Q_i(v_j)` of section 3.3. Ties go to the smaller index.
    #[inline(always)]
    pub(crate) fn cheapest_neighbour(&self, eligible: impl Fn(u32) -> bool) -> Option<(f32, u32)> {
        let mut best = u64::MAX;
        let mut consider = |names: Names, ways: Vectors| {
            let costs = self.quadric.at_each(ways).to_array();
            for (neighbour, cost) in names.to_array().into_iter().zip(costs) {
                if neighbour != NONE && eligible(neighbour) {
                    best = best.min(key(cost, neighbour));
                }
            }
        };
        for block in self.blocks() {
            consider(block.next, block.spokes.to_next);
            if self.boundary {
                consider(block.previous, block.spokes.to_previous);
            }
        }
        (best != u64::MAX).then(|| (f32::from_bits((best >> 32) as u32), best as u32))
    }

    /// Whether this vertex may go to `neighbour` without taking a border away from where it is: one on a
    /// border goes along it.
    #[inline(always)]
    pub(crate) fn may_go_to(&self, neighbour: u32) -> bool {
        !self.boundary || self.occurrences(neighbour) != (1, 1)
    }

    /// The neighbour to which this vertex goes most cheaply as it is, where neighbours do not move, and the
    /// cost: see [`Quadric::for_half_edge`].
    #[inline(always)]
    pub(crate) fn cheapest_target(&mut self) -> Option<(f32, u32)> {
        self.quadric = self.quadric.for_half_edge();
        if self.boundary {
            self.cheapest_neighbour(|neighbour| self.may_go_to(neighbour))
        } else {
            self.cheapest_neighbour(|_| true)
        }
    }

    /// Each neighbour once, in ascending order, into `neighbours`.
    pub(crate) fn neighbours(&self, neighbours: &mut Vec<u32>) {
        neighbours.clear();
        neighbours.extend(self.names().flat_map(|(next, previous)| [next, previous]));
        neighbours.sort_unstable();
        neighbours.dedup();
    }
}

/// Orders by cost, ties by name: costs are not negative, so their bits order as they do, and one integer
/// compares both.
#[inline(always)]
pub(super) fn key(cost: f32, name: u32) -> u64 {
    u64::from(cost.to_bits()) << 32 | u64::from(name)
}
