//! What a vertex of the surface is made of where vertices stay where they are: wedges.
//!
//! Where normals or texture coordinates jump, or triangles of two groups meet, the corners of the triangles
//! around a vertex name several vertices of the input. The surface knows one vertex, so that nothing can come
//! apart; each corner knows its wedge, which is a name in the input for good. When a vertex goes to a
//! neighbour, each of its wedges goes to the wedge of the neighbour that it shares a vanishing triangle
//! with: along a seam all of them do, across it some have none.

use super::HalfEdge;
use super::ring::Ring;
use super::surface::{Face, is_alive, next_corner, previous_corner};
use crate::mesh::Mesh;
use crate::mesh::places::Places;
use glam::Vec3A;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// The names of wedges: the input's vertices, and one more for each further group that has triangles at one.
#[derive(Debug, Clone, Default)]
pub(crate) struct WedgeNames {
    vertices: usize,
    /// The vertices of the wedges that are more than there are vertices.
    further: Vec<u32>,
    /// The group of the triangles of each wedge; empty where there are no groups.
    groups: Vec<u32>,
}

impl WedgeNames {
    /// The wedges of `mesh`, whose triangles are of these groups, and the wedge of each of its corners;
    /// without corners where each wedge is a vertex of its own.
    pub(crate) fn new(
        mesh: &Mesh,
        places: Option<&Places>,
        groups: Option<&[u32]>,
    ) -> (Self, Option<Vec<[u32; 3]>>) {
        let vertices = mesh.positions().len();
        let mut names = Self { vertices, ..Self::default() };
        let Some(groups) = groups else {
            let several = places.is_some_and(|places| (0..).zip(&places.first).any(|(v, &first)| v != first));
            return (names, several.then(|| mesh.triangles().to_vec()));
        };
        const NO_GROUP: (bool, u32) = (false, 0);
        let mut first_groups = vec![NO_GROUP; vertices];
        let mut others: HashMap<(u32, u32), u32> = HashMap::new();
        names.groups = vec![0; vertices];
        let corners = mesh.triangles().iter().zip(groups).map(|(triangle, &group)| {
            triangle.map(|vertex| {
                let first = &mut first_groups[vertex as usize];
                if *first == NO_GROUP {
                    *first = (true, group);
                    names.groups[vertex as usize] = group;
                }
                if first.1 == group {
                    return vertex;
                }
                *others.entry((vertex, group)).or_insert_with(|| {
                    names.further.push(vertex);
                    names.groups.push(group);
                    (vertices + names.further.len() - 1) as u32
                })
            })
        });
        let corners = corners.collect();
        (names, Some(corners))
    }

    /// The vertex of the input that a wedge is.
    #[inline(always)]
    pub(crate) fn vertex(&self, wedge: u32) -> u32 {
        let further = (wedge as usize).checked_sub(self.vertices);
        further.map_or(wedge, |index| self.further[index])
    }

    /// How many vertices the input has.
    pub(crate) fn vertex_count(&self) -> usize {
        self.vertices
    }

    /// Whether triangles have groups.
    pub(crate) fn have_groups(&self) -> bool {
        !self.groups.is_empty()
    }

    /// The group of a wedge's triangles, if there are groups.
    pub(crate) fn group(&self, wedge: u32) -> Option<u32> {
        self.groups.get(wedge as usize).copied()
    }
}

/// The wedges of all corners, to be looked at.
#[derive(Clone, Copy)]
pub(crate) struct Wedges<'a> {
    pub(crate) faces: &'a [Face],
    /// Face by face; empty where each vertex has one wedge, which is its source.
    pub(crate) corners: &'a [Face],
    /// The vertex of the input that each vertex is; empty where vertices move.
    pub(crate) sources: &'a [u32],
    pub(crate) names: &'a WedgeNames,
}

impl Wedges<'_> {
    /// The wedge of a corner, which is `face << 2 | corner`.
    #[inline(always)]
    pub(crate) fn at(&self, corner: u32) -> u32 {
        let [own, ..] = self.around(corner);
        own
    }

    /// The wedges of a corner, and of those after and before it.
    #[inline(always)]
    fn around(&self, corner: u32) -> [u32; 3] {
        let face = (corner >> 2) as usize;
        let corners = [corner, next_corner(corner), previous_corner(corner)];
        match self.corners.get(face) {
            Some(wedges) => corners.map(|corner| wedges[(corner & 3) as usize].load(Relaxed)),
            None => {
                let vertices = &self.faces[face];
                corners.map(|corner| self.sources[vertices[(corner & 3) as usize].load(Relaxed) as usize])
            }
        }
    }

    /// Whether there are vertices of more than one wedge.
    pub(crate) fn are_several(&self) -> bool {
        !self.corners.is_empty()
    }
}

/// The wedges around a vertex, face by face in the order of its ring.
#[derive(Debug, Clone, Default)]
pub(crate) struct RingWedges {
    /// The living corners of the vertex.
    pub(crate) corners: Vec<u32>,
    /// Their wedges, and those of the corners after and before them.
    pub(crate) own: Vec<u32>,
    pub(crate) next: Vec<u32>,
    pub(crate) previous: Vec<u32>,
    /// How many different ones are the vertex's own.
    kinds: usize,
}

impl RingWedges {
    /// Looks up the wedges of the `corners`.
    pub(crate) fn look_up(&mut self, wedges: &Wedges) {
        let Self { corners, own, next, previous, kinds } = self;
        for names in [&mut *own, &mut *next, &mut *previous] {
            names.resize(corners.len(), 0);
        }
        let names = own.iter_mut().zip(&mut *next).zip(&mut *previous);
        for (&corner, ((own, next), previous)) in corners.iter().zip(names) {
            [*own, *next, *previous] = wedges.around(corner);
        }
        let is_one = own.iter().all(|&wedge| wedge == own[0]);
        let is_first = |index: usize| !own[..index].contains(&own[index]);
        *kinds =
            if is_one { own.len().min(1) } else { (0..own.len()).filter(|&index| is_first(index)).count() };
    }

    /// Calls `see` with each edge of the ring at which wedges meet: on one of its sides the vertex, or the
    /// neighbour, has another wedge than on the other.
    pub(crate) fn visit_seams(&self, ring: &Ring, mut see: impl FnMut(Vec3A)) {
        for (index, (neighbour, _)) in ring.names().enumerate() {
            let is_seam = ring.face_before(neighbour).is_some_and(|other| {
                (self.own[other], self.previous[other]) != (self.own[index], self.next[index])
            });
            if is_seam {
                see(ring.spoke(index).to_next);
            }
        }
    }
}

/// Where the wedges of a vertex go when it goes to a neighbour.
#[derive(Debug, Clone, Default)]
pub(crate) struct Moves {
    pairs: Vec<HalfEdge>,
    /// Room to work in.
    ends: Vec<u32>,
}

/// How far apart two wedges' attributes are: for those that have no triangle to go by.
pub(crate) type Distance<'a> = dyn Fn(u32, u32) -> f32 + 'a;

impl Moves {
    /// Finds them for the vertex of a ring, whose `wedges` are given; `false` if a wedge, or a vertex of the
    /// input that is several, has nowhere to go, or two places to go to. Given a distance, such a wedge goes
    /// to the wedge of the same group at the collapsed edge that is nearest by it.
    pub(crate) fn find(
        &mut self,
        wedges: &RingWedges,
        names: &WedgeNames,
        ring: &Ring,
        target: u32,
        distance: Option<&Distance>,
    ) -> bool {
        self.pairs.clear();
        let mut torn = false;
        ring.visit_faces_with(target, |index, is_after| {
            let into = if is_after { wedges.next[index] } else { wedges.previous[index] };
            let pair = HalfEdge { source: wedges.own[index], target: into };
            torn |= self.pairs.iter().any(|other| other.source == pair.source && other.target != pair.target);
            if !self.pairs.contains(&pair) {
                self.pairs.push(pair);
            }
        });
        // Where none has two places to go to, each pair is another wedge's.
        let found = !torn && self.pairs.len() == wedges.kinds
            || distance.is_some_and(|distance| self.bridge(wedges, names, distance));
        found && self.agree(names)
    }

    /// Whether all wedges that are one vertex of the input go to one: whoever does the collapse again knows
    /// no wedges.
    fn agree(&self, names: &WedgeNames) -> bool {
        names.further.is_empty()
            || self.named(names).enumerate().all(|(index, pair)| {
                self.named(names).skip(index).all(|other| pair.source != other.source || pair == other)
            })
    }

    /// Gives each wedge the nearest one of those that any of them goes to.
    fn bridge(&mut self, wedges: &RingWedges, names: &WedgeNames, distance: &Distance) -> bool {
        let Self { pairs, ends } = self;
        ends.clear();
        ends.extend(pairs.drain(..).map(|pair| pair.target));
        for (index, &source) in wedges.own.iter().enumerate() {
            if wedges.own[..index].contains(&source) {
                continue;
            }
            let group = names.group(source);
            let eligible = ends.iter().filter(|&&end| names.group(end) == group);
            let nearest = eligible
                .copied()
                .min_by(|&a, &b| distance(source, a).total_cmp(&distance(source, b)).then(a.cmp(&b)));
            let Some(target) = nearest else { return false };
            pairs.push(HalfEdge { source, target });
        }
        true
    }

    /// One wedge, one place to go to.
    pub(crate) fn set(&mut self, source: u32, target: u32) {
        self.pairs.clear();
        self.pairs.push(HalfEdge { source, target });
    }

    /// Source and target of each wedge, in the names of the input's vertices.
    fn named<'a>(&'a self, names: &'a WedgeNames) -> impl Iterator<Item = HalfEdge> + 'a {
        self.pairs
            .iter()
            .map(|pair| HalfEdge { source: names.vertex(pair.source), target: names.vertex(pair.target) })
    }

    /// What this is to whoever knows no wedges: each vertex of the input that goes, once.
    pub(crate) fn collapses<'a>(&'a self, names: &'a WedgeNames) -> impl Iterator<Item = HalfEdge> + 'a {
        let is_new = |&(index, pair): &(usize, HalfEdge)| {
            self.named(names).take(index).all(|other| other.source != pair.source)
        };
        self.named(names).enumerate().filter(is_new).map(|(_, pair)| pair)
    }

    /// Where `wedge` goes; itself if it is none of those that go.
    pub(crate) fn target(&self, wedge: u32) -> u32 {
        self.pairs.iter().find(|pair| pair.source == wedge).map_or(wedge, |pair| pair.target)
    }

    /// Renames the wedges of the living corners, of those that go.
    pub(crate) fn apply(&self, faces: &[Face], wedges: &[Face], corners: &[u32]) {
        for &corner in corners.iter().filter(|corner| is_alive(&faces[(**corner >> 2) as usize])) {
            let wedge: &AtomicU32 = &wedges[(corner >> 2) as usize][(corner & 3) as usize];
            wedge.store(self.target(wedge.load(Relaxed)), Relaxed);
        }
    }
}
