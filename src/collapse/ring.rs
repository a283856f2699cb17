//! A vertex with all that surrounds it, gathered once for cost, legality and placement.

use super::surface::NONE;
use crate::quadric::{Quadric, QuadricSum};
use glam::Vec3A;

/// The shape of one face around a vertex, as seen from it.
#[derive(Debug, Clone, Copy, Default)]
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

/// A vertex is pointed if the cosine, squared, of the angle between a face's normal and the mean of all is less.
const POINTED: f32 = 0.25;

/// Names are compared this many at a time.
const LANES: usize = 8;

/// The faces around a vertex, with the vertex as origin, and the quadric of their planes.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ring {
    /// The corner after the vertex and the one before it in each face, filled up with [`NONE`] to a
    /// multiple of [`LANES`].
    next: Vec<u32>,
    previous: Vec<u32>,
    spokes: Vec<Spoke>,
    count: usize,
    pub(crate) vertex: u32,
    /// The vertex lies on an edge with more faces in one direction than in the other.
    pub(crate) boundary: bool,
    pub(crate) quadric: Quadric,
}

/// A ring being filled. Its parts are borrowed apart, so that they and the sum stay in registers
/// from face to face.
pub(crate) struct Gathering<'a> {
    next: &'a mut [u32],
    previous: &'a mut [u32],
    spokes: &'a mut [Spoke],
    count: usize,
    sum: QuadricSum,
}

/// A ring of names alone, being filled.
pub(crate) struct Naming<'a> {
    next: &'a mut [u32],
    previous: &'a mut [u32],
    count: usize,
}

impl Naming<'_> {
    /// Adds a face. No more may be added than there is room for.
    #[inline(always)]
    pub(crate) fn push(&mut self, (next, previous): (u32, u32)) {
        self.next[self.count] = next;
        self.previous[self.count] = previous;
        self.count += 1;
    }
}

impl Gathering<'_> {
    /// Adds a face. No more may be added than there is room for.
    #[inline(always)]
    pub(crate) fn push(&mut self, next: u32, previous: u32, to_next: Vec3A, to_previous: Vec3A) {
        let cross = to_next.cross(to_previous);
        self.sum.add_face(cross);
        self.next[self.count] = next;
        self.previous[self.count] = previous;
        self.spokes[self.count] = Spoke { to_next, to_previous, cross };
        self.count += 1;
    }
}

impl Ring {
    /// Empties the ring for `vertex` and lets `fill` add up to `room` faces; then adds the lines
    /// that hold borders. What `fill` answers is returned.
    #[inline(always)]
    pub(crate) fn gather(
        &mut self,
        vertex: u32,
        boundary: bool,
        room: usize,
        fill: impl FnOnce(&mut Gathering) -> bool,
    ) -> bool {
        let padded = self.make_room(room);
        if self.spokes.len() < padded {
            self.spokes.resize(padded, Spoke::default());
        }
        let mut gathering = Gathering {
            next: &mut self.next[..padded],
            previous: &mut self.previous[..padded],
            spokes: &mut self.spokes[..padded],
            count: 0,
            sum: QuadricSum::default(),
        };
        let complete = fill(&mut gathering);
        let Gathering { count, sum, .. } = gathering;
        self.fill_up(count);
        self.vertex = vertex;
        self.boundary = boundary;
        self.quadric = sum.quadric();
        if boundary && complete {
            self.add_border_lines();
        }
        complete
    }

    /// Empties the ring for `vertex` and lets `fill` name up to `room` faces, whose shapes are not asked for:
    /// enough for the link condition at the end of an edge that stays where it is.
    #[inline(always)]
    pub(crate) fn gather_names(
        &mut self,
        vertex: u32,
        boundary: bool,
        room: usize,
        fill: impl FnOnce(&mut Naming),
    ) {
        let padded = self.make_room(room);
        let mut naming =
            Naming { next: &mut self.next[..padded], previous: &mut self.previous[..padded], count: 0 };
        fill(&mut naming);
        let count = naming.count;
        self.fill_up(count);
        self.vertex = vertex;
        self.boundary = boundary;
    }

    /// Sees to it that so many faces can be named, and the lanes filled up: how many that is.
    #[inline(always)]
    fn make_room(&mut self, room: usize) -> usize {
        let padded = room.next_multiple_of(LANES);
        if self.next.len() < padded {
            self.next.resize(padded, NONE);
            self.previous.resize(padded, NONE);
        }
        padded
    }

    /// Says that `count` faces are named, and fills up the lanes after them.
    #[inline(always)]
    fn fill_up(&mut self, count: usize) {
        self.count = count;
        let rest = count..count.next_multiple_of(LANES);
        self.next[rest.clone()].fill(NONE);
        self.previous[rest].fill(NONE);
    }

    /// The shapes of the faces.
    #[inline(always)]
    pub(crate) fn spokes(&self) -> &[Spoke] {
        &self.spokes[..self.count]
    }

    /// The mean of the faces' normals, weighted by their areas, of any length.
    pub(crate) fn mean_normal(&self) -> Vec3A {
        self.spokes().iter().map(|spoke| spoke.cross).sum()
    }

    /// Each face that survives a collapse with `other`: its normal, twice its area long, before and after
    /// the vertex has moved by `offset`.
    pub(crate) fn moved_faces(&self, other: u32, offset: Vec3A) -> impl Iterator<Item = (Vec3A, Vec3A)> {
        let faces = self.names().zip(self.spokes());
        faces
            .filter(move |((next, previous), _)| *next != other && *previous != other)
            .map(move |(_, spoke)| (spoke.cross, spoke.moved(offset)))
    }

    /// Whether the vertex is a tip, of a border or of a surface some of whose faces hardly look where the vertex
    /// does: when it goes back, the distance from its faces' planes says little.
    #[inline(always)]
    pub(crate) fn is_pointed(&self) -> bool {
        let mean = self.mean_normal();
        let least = POINTED * mean.length_squared();
        let mut pointed = self.boundary;
        for spoke in self.spokes() {
            let cosine = spoke.cross.dot(mean);
            pointed |= cosine.max(0.0).powi(2) < least * spoke.cross.length_squared();
        }
        pointed
    }

    /// The ways to the other two corners of each face that survives a collapse with `other`.
    pub(crate) fn surviving_edges(&self, other: u32) -> impl Iterator<Item = [Vec3A; 2]> {
        let faces = self.names().zip(self.spokes());
        faces
            .filter(move |((next, previous), _)| *next != other && *previous != other)
            .map(|(_, spoke)| [spoke.to_next, spoke.to_previous])
    }

    /// The corner after the vertex in each face.
    #[inline(always)]
    pub(crate) fn next(&self) -> &[u32] {
        &self.next[..self.count]
    }

    /// The corner before the vertex in each face.
    #[inline(always)]
    pub(crate) fn previous(&self) -> &[u32] {
        &self.previous[..self.count]
    }

    /// Both, face by face.
    #[inline(always)]
    pub(crate) fn names(&self) -> impl Iterator<Item = (u32, u32)> {
        self.next().iter().copied().zip(self.previous().iter().copied())
    }

    /// In how many faces `vertex` comes after the ring's, and in how many before.
    #[inline(always)]
    pub(crate) fn occurrences(&self, vertex: u32) -> (u32, u32) {
        let padded = self.count.next_multiple_of(LANES);
        (count_equal(&self.next[..padded], vertex), count_equal(&self.previous[..padded], vertex))
    }

    /// The first face in which `vertex` comes before the ring's.
    #[inline(always)]
    pub(crate) fn face_before(&self, vertex: u32) -> Option<usize> {
        let padded = self.count.next_multiple_of(LANES);
        let (groups, _) = self.previous[..padded].as_chunks::<LANES>();
        let masks = groups.iter().map(|group| mask_equal(group, vertex));
        let found = masks.enumerate().find(|(_, mask)| *mask != 0);
        found.map(|(index, mask)| LANES * index + mask.trailing_zeros() as usize)
    }

    /// Calls `see` with each face that has `vertex` as another corner, by its place in the ring, in order, and
    /// with whether `vertex` comes after the ring's there.
    #[inline(always)]
    pub(crate) fn visit_faces_with(&self, vertex: u32, mut see: impl FnMut(usize, bool)) {
        let padded = self.count.next_multiple_of(LANES);
        let (next, _) = self.next[..padded].as_chunks::<LANES>();
        let (previous, _) = self.previous[..padded].as_chunks::<LANES>();
        for (group, (next, previous)) in next.iter().zip(previous).enumerate() {
            let after = mask_equal(next, vertex);
            let mut either = after | mask_equal(previous, vertex);
            while either != 0 {
                let lane = either.trailing_zeros();
                see(LANES * group + lane as usize, after >> lane & 1 == 1);
                either &= either - 1;
            }
        }
    }

    /// How many vertices come after the vertex of this ring and of `other`.
    #[inline(always)]
    pub(crate) fn common_next(&self, other: &Self) -> u32 {
        let padded = self.count.next_multiple_of(LANES);
        other.next().iter().map(|&vertex| count_equal(&self.next[..padded], vertex)).sum()
    }

    /// Calls `see` with every edge to the vertex that has not two faces of one orientation (borders,
    /// non-manifold edges, and edges where the orientation changes), and with each of its faces.
    fn visit_borders(&self, mut see: impl FnMut(Vec3A, &Spoke)) {
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
        let mut consider = |neighbour: u32, edge: Vec3A| {
            let key = key(self.quadric.at(edge), neighbour);
            if eligible(neighbour) {
                best = best.min(key);
            }
        };
        for (&next, spoke) in self.next().iter().zip(self.spokes()) {
            consider(next, spoke.to_next);
        }
        if self.boundary {
            for (&previous, spoke) in self.previous().iter().zip(self.spokes()) {
                consider(previous, spoke.to_previous);
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
        neighbours.extend(self.next().iter().chain(self.previous()));
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

/// How often `name` is among `names`, whose count is a multiple of [`LANES`].
#[inline(always)]
fn count_equal(names: &[u32], name: u32) -> u32 {
    let (groups, _) = names.as_chunks::<LANES>();
    groups.iter().map(|group| group.iter().map(|&other| u32::from(other == name)).sum::<u32>()).sum()
}

/// A bit for each of `names`, which is set where it is `name`.
#[inline(always)]
fn mask_equal(names: &[u32; LANES], name: u32) -> u32 {
    let bits = std::array::from_fn::<u32, LANES, _>(|lane| 1 << lane);
    names.iter().zip(bits).map(|(&other, bit)| if other == name { bit } else { 0 }).sum()
}
