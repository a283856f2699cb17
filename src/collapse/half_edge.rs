//! Where a vertex goes when no vertex may move: to the neighbour where it costs least.
//!
//! The cost is that of the faces' planes ([`Quadric::for_half_edge`](crate::quadric::Quadric)), of the lines
//! along which wedges meet, and of the attributes, where these have weights.

use super::attributes::{AttributeQuadric, AttributeRows};
use super::ring::{Ring, key};
use super::surface::flag;
use super::wedges::{Moves, RingWedges, Wedges};
use glam::Vec3A;

/// What else than the faces' planes decides.
#[derive(Clone, Copy)]
pub(crate) struct Terms<'a> {
    pub(crate) wedges: Wedges<'a>,
    pub(crate) rows: Option<&'a AttributeRows>,
    /// Wedges may go where no triangle leads them.
    pub(crate) cross_seams: bool,
}

/// How much more a vertex costs that is to be kept as long as others can go.
const PRIORITY: f32 = 100.0;

/// Room to work in, and what was found last.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) wedges: RingWedges,
    /// Where the wedges go in the collapse that was [settled](Terms::settle), or before that in the one that
    /// was `chosen`.
    pub(crate) moves: Moves,
    chosen: Option<Chosen>,
    tried: Moves,
    quadric: AttributeQuadric,
    neighbours: Vec<Neighbour>,
}

impl Scratch {
    /// Whether the corners, and where the wedges go, are those of the collapse of `ends`: what
    /// [`Terms::cheapest`] chose, if nothing has been settled since.
    #[inline(always)]
    pub(crate) fn has_chosen(&self, ends: [u32; 2]) -> bool {
        self.chosen.is_some_and(|chosen| chosen.ends == ends)
    }
}

/// The collapse to which the costs of a vertex have led.
#[derive(Debug, Clone, Copy)]
struct Chosen {
    /// The vertex and where it goes.
    ends: [u32; 2],
    /// The mean difference of the attributes, squared.
    difference_squared: f32,
}

/// A neighbour to which a vertex may go.
#[derive(Debug, Clone, Copy)]
struct Neighbour {
    /// The cost by the faces' planes.
    cost: f32,
    name: u32,
    edge: Vec3A,
    /// A face with the neighbour, by its place in the ring, and whether the neighbour comes before the vertex
    /// there.
    face: usize,
    is_before: bool,
}

/// What the cost of a vertex with these flags is multiplied by.
#[inline(always)]
pub(super) fn factor(flags: u8) -> f32 {
    if flags & flag::PRIORITY != 0 { PRIORITY } else { 1.0 }
}

impl Terms<'_> {
    /// Whether the planes alone decide.
    pub(crate) fn are_none(&self) -> bool {
        self.rows.is_none() && !self.wedges.are_several()
    }

    /// The neighbour to which the ring's vertex goes most cheaply, and the cost, which is below `limit`: of
    /// those that come after `failed` in the order of cost and name. `flags` are those of a neighbour;
    /// `scratch` has the corners.
    pub(crate) fn cheapest(
        &self,
        ring: &Ring,
        own_flags: u8,
        flags: impl Fn(u32) -> u8,
        failed: Option<(f32, u32)>,
        limit: f32,
        scratch: &mut Scratch,
    ) -> Option<(f32, u32)> {
        let Scratch { wedges, moves, chosen, tried, quadric, neighbours } = scratch;
        *chosen = None;
        let mut planes = ring.quadric;
        if !self.are_none() {
            wedges.look_up(&self.wedges);
            if own_flags & flag::SEAM != 0 {
                wedges.visit_seams(ring, |edge| planes.add_seam(edge));
            }
        }
        let planes = planes.for_half_edge();
        let factor = factor(own_flags);
        neighbours.clear();
        let mut consider = |name: u32, edge: Vec3A, face: usize, is_before: bool| {
            let cost = factor * planes.at(edge);
            if cost < limit && ring.may_go_to(name) {
                neighbours.push(Neighbour { cost, name, edge, face, is_before });
            }
        };
        for (face, ((next, _), spoke)) in ring.names().zip(ring.spokes()).enumerate() {
            consider(next, spoke.to_next, face, false);
        }
        if ring.boundary {
            for (face, ((_, previous), spoke)) in ring.names().zip(ring.spokes()).enumerate() {
                consider(previous, spoke.to_previous, face, true);
            }
        }
        // What the attributes cost comes on top, and is worked out only where it can still decide: beginning
        // with the neighbour that is the cheapest by the planes.
        let order = |neighbour: &Neighbour| key(neighbour.cost, neighbour.name);
        if let Some(cheapest) = (0..neighbours.len()).min_by_key(|&index| order(&neighbours[index])) {
            neighbours.swap(0, cheapest);
        }
        let first = failed.map_or(0, |(cost, name)| key(cost, name) + 1);
        let mut best = key(limit, 0);
        let mut is_gathered = false;
        for &Neighbour { cost, name, edge, face, is_before } in &*neighbours {
            if key(cost, name) >= best {
                continue;
            }
            let mut of_attributes = (0.0, 0.0);
            if !self.are_none() {
                if (own_flags | flags(name)) & flag::SEAM == 0 {
                    let others = if is_before { &wedges.previous } else { &wedges.next };
                    tried.set(wedges.own[face], others[face]);
                } else if !self.find_moves(ring, own_flags, wedges, name, tried) {
                    continue;
                }
                if let Some(rows) = self.rows {
                    if !is_gathered {
                        quadric.gather(rows, self.wedges.names, wedges, ring);
                        is_gathered = true;
                    }
                    of_attributes = quadric.cost(rows, self.wedges.names, tried, edge);
                }
            }
            let key = key(cost + factor * of_attributes.0, name);
            if key >= first && key < best {
                best = key;
                std::mem::swap(moves, tried);
                *chosen = Some(Chosen { ends: [ring.vertex, name], difference_squared: of_attributes.1 });
            }
        }
        (best < key(limit, 0)).then(|| (f32::from_bits((best >> 32) as u32), best as u32))
    }

    /// Finds where the wedges around a ring's vertex go in a collapse into `target`, which is `edge` away, into
    /// `scratch.moves`: what mean difference of the attributes, weighted, that makes, 0 where they do not count;
    /// `None` if the wedges may not go. `scratch` has the corners. What [`cheapest`](Self::cheapest) found is
    /// taken, if it was this collapse and none has been settled since.
    pub(crate) fn settle(
        &self,
        ring: &Ring,
        own_flags: u8,
        target: u32,
        edge: Vec3A,
        scratch: &mut Scratch,
    ) -> Option<f32> {
        let Scratch { wedges, moves, chosen, quadric, .. } = scratch;
        if let Some(chosen) = chosen.take().filter(|chosen| chosen.ends == [ring.vertex, target]) {
            return Some(chosen.difference_squared.sqrt());
        }
        wedges.look_up(&self.wedges);
        if !self.find_moves(ring, own_flags, wedges, target, moves) {
            return None;
        }
        Some(self.rows.map_or(0.0, |rows| {
            quadric.gather(rows, self.wedges.names, wedges, ring);
            quadric.cost(rows, self.wedges.names, moves, edge).1.sqrt()
        }))
    }

    /// Where the wedges around a ring's vertex go in a collapse into `target`; `false` if they may not.
    fn find_moves(
        &self,
        ring: &Ring,
        own_flags: u8,
        wedges: &RingWedges,
        target: u32,
        moves: &mut Moves,
    ) -> bool {
        let names = self.wedges.names;
        let distance = |a: u32, b: u32| self.rows.map_or(0.0, |rows| rows.distance_squared(names, a, b));
        let may_cross = self.cross_seams && own_flags & flag::PROTECTED == 0;
        moves.find(wedges, names, ring, target, may_cross.then_some(&distance))
    }
}
