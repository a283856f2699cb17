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

/// Room to work in.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) wedges: RingWedges,
    pub(crate) moves: Moves,
    quadric: AttributeQuadric,
    neighbours: Vec<Neighbour>,
}

/// A neighbour to which a vertex may go.
#[derive(Debug, Clone, Copy)]
struct Neighbour {
    /// The cost by the faces' planes.
    cost: f32,
    name: u32,
    edge: Vec3A,
    /// The vertex's wedge in a face with the neighbour, and the neighbour's.
    wedges: [u32; 2],
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
        ring: &mut Ring,
        own_flags: u8,
        flags: impl Fn(u32) -> u8,
        failed: Option<(f32, u32)>,
        limit: f32,
        scratch: &mut Scratch,
    ) -> Option<(f32, u32)> {
        let Scratch { wedges, moves, quadric, neighbours } = scratch;
        wedges.look_up(&self.wedges);
        if own_flags & flag::SEAM != 0 {
            let mut planes = ring.quadric;
            wedges.visit_seams(ring, |edge| planes.add_seam(edge));
            ring.quadric = planes;
        }
        let planes = ring.quadric.for_half_edge();
        let factor = factor(own_flags);
        neighbours.clear();
        let mut consider = |name: u32, edge: Vec3A, wedges: [u32; 2]| {
            let cost = factor * planes.at(edge);
            if cost < limit && ring.may_go_to(name) {
                neighbours.push(Neighbour { cost, name, edge, wedges });
            }
        };
        for (index, (&next, spoke)) in ring.next().iter().zip(ring.spokes()).enumerate() {
            consider(next, spoke.to_next, [wedges.own[index], wedges.next[index]]);
        }
        if ring.boundary {
            for (index, (&previous, spoke)) in ring.previous().iter().zip(ring.spokes()).enumerate() {
                consider(previous, spoke.to_previous, [wedges.own[index], wedges.previous[index]]);
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
        for &Neighbour { cost, name, edge, wedges: [own, other] } in &*neighbours {
            if key(cost, name) >= best {
                continue;
            }
            if (own_flags | flags(name)) & flag::SEAM == 0 {
                moves.set(own, other);
            } else if !self.find_moves(ring, own_flags, wedges, name, moves) {
                continue;
            }
            let of_attributes = self.rows.map_or(0.0, |rows| {
                if !is_gathered {
                    quadric.gather(rows, self.wedges.names, wedges, ring);
                    is_gathered = true;
                }
                quadric.cost(rows, self.wedges.names, moves, edge).0
            });
            let key = key(cost + factor * of_attributes, name);
            if key >= first {
                best = best.min(key);
            }
        }
        (best < key(limit, 0)).then(|| (f32::from_bits((best >> 32) as u32), best as u32))
    }

    /// Where the wedges around a ring's vertex go in a collapse into `target`; `false` if they may not.
    pub(crate) fn find_moves(
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

    /// The mean difference of the attributes, weighted, that `scratch.moves` make; 0 where they do not count.
    pub(crate) fn attribute_error(&self, ring: &Ring, edge: Vec3A, scratch: &mut Scratch) -> f32 {
        let Scratch { wedges, moves, quadric, .. } = scratch;
        let names = self.wedges.names;
        self.rows.map_or(0.0, |rows| {
            quadric.gather(rows, names, wedges, ring);
            quadric.cost(rows, names, moves, edge).1.sqrt()
        })
    }
}
