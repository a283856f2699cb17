//! Which edge of a vertex is the cheapest, of those that may be legal, and what its edges cost.

use super::{Finish, Scratch};
use crate::collapse::surface::{NONE, flag, is_alive, neighbours};
use crate::lanes::{LANES, named_vectors};
use crate::quadric::costs_of_placing;
use glam::Vec3A;
use std::array::from_fn;

/// The edge at which a vertex is cheapest to collapse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    pub(super) cost: f32,
    pub(super) partner: u32,
}

impl Candidate {
    /// Costs are not negative, so their bits order as they do.
    pub(super) fn order(&self) -> (u32, u32) {
        (self.cost.to_bits(), self.partner)
    }
}

pub(super) const IMPOSSIBLE: Candidate = Candidate { cost: f32::INFINITY, partner: NONE };
/// Comes up at once.
pub(super) const FREE: Candidate = Candidate { cost: 0.0, partner: NONE };

impl Finish<'_> {
    /// The neighbours of `vertex`, once or twice each; none of a hub.
    pub(super) fn gather_neighbours(&self, vertex: u32, around: &mut Vec<u32>) {
        around.clear();
        if self.is_hub(vertex) {
            return;
        }
        let is_open = self.is_open(vertex);
        for (next, previous) in self.names_around(vertex) {
            around.push(next);
            if is_open {
                around.push(previous);
            }
        }
    }

    /// The corners after and before `vertex` in each of its faces.
    fn names_around(&self, vertex: u32) -> impl Iterator<Item = (u32, u32)> {
        let faces = &self.surface.faces;
        let corner = |name: u32| (name != NONE).then_some(name);
        let corners = std::iter::successors(corner(self.first[vertex as usize]), move |&last| {
            corner(self.next[last as usize])
        });
        corners
            .filter(|&corner| is_alive(&faces[(corner >> 2) as usize]))
            .map(|corner| neighbours(faces, corner))
    }

    /// Whether `vertex` is on a border, as it was known when its ring last changed.
    fn is_open(&self, vertex: u32) -> bool {
        self.surface.flags[vertex as usize] & flag::BOUNDARY != 0
    }

    /// Whether the link condition may hold at the edge from `vertex`, whose neighbours are `around`, to `partner`: not
    /// where they have more neighbours in common than the edge has faces, nor where an inner edge joins two
    /// borders. That is most of what it forbids, and quickly seen: a surface that is stuck tries all of its edges.
    pub(super) fn may_join(&self, vertex: u32, around: &[u32], partner: u32) -> bool {
        if self.rules.any_topology {
            return true;
        }
        let [is_open, is_partner_open] = [vertex, partner].map(|end| self.is_open(end));
        // Of an open ring each neighbour stands there once for each face with the edge to it.
        let shared = match is_open {
            true => around.iter().filter(|&&neighbour| neighbour == partner).count(),
            false => 2,
        };
        if shared > 2 || shared == 2 && is_open && is_partner_open {
            return false;
        }
        let (mut common, mut found) = ([NONE; 2], 0);
        let mut is_excess = |name: u32| {
            if !around.contains(&name) || common[..found].contains(&name) {
                return false;
            }
            if found == shared {
                return true;
            }
            common[found] = name;
            found += 1;
            false
        };
        let mut names = self.names_around(partner);
        !names.any(|(next, previous)| is_excess(next) || is_partner_open && is_excess(previous))
    }

    /// The costs of the edges of `vertex` to `partners`, of which there are one to four: the same from both ends to
    /// the last bit.
    fn costs(&self, vertex: u32, partners: &[u32]) -> [f32; LANES] {
        let ends: [[u32; 2]; LANES] = from_fn(|lane| {
            let partner = partners[lane.min(partners.len() - 1)];
            [vertex.min(partner), vertex.max(partner)]
        });
        let [of_first, of_second] = [0, 1].map(|end| ends.map(|ends| &self.quadrics[ends[end] as usize]));
        let edges = ends.map(|[a, b]| self.surface.points[b as usize] - self.surface.points[a as usize]);
        let placed = costs_of_placing(of_first, of_second, named_vectors(edges).0).to_array();
        let stays = |vertex, other| self.is_locked(vertex) || self.is_open(vertex) && !self.is_open(other);
        from_fn(|lane| {
            let [a, b] = ends[lane];
            if self.is_hub(a) || self.is_hub(b) {
                return f32::INFINITY;
            }
            let edge = Vec3A::from_vec4(edges[lane]);
            let cost = match (stays(a, b), stays(b, a)) {
                (false, false) => placed[lane],
                (false, true) => of_first[lane].at(edge),
                (true, false) => of_second[lane].at(-edge),
                (true, true) => f32::INFINITY,
            };
            if cost.is_nan() { f32::INFINITY } else { cost }
        })
    }

    /// The cheapest edge of `vertex`, or the next one after `failed`. `around` is room to work in.
    pub(super) fn cheapest(
        &mut self,
        vertex: u32,
        failed: Option<Candidate>,
        around: &mut Vec<u32>,
    ) -> Candidate {
        if self.rules.half_edge {
            return self.cheapest_target(vertex, failed);
        }
        self.gather_neighbours(vertex, around);
        self.cheapest_edge(vertex, around, failed, |_| {})
    }

    /// The cheapest edge of `vertex` among those to `around`, or the next one after `failed`; `seen`
    /// is shown them all.
    pub(super) fn cheapest_edge(
        &self,
        vertex: u32,
        around: &[u32],
        failed: Option<Candidate>,
        mut seen: impl FnMut(Candidate),
    ) -> Candidate {
        let mut best = IMPOSSIBLE;
        for partners in around.chunks(LANES) {
            for (&partner, cost) in partners.iter().zip(self.costs(vertex, partners)) {
                let candidate = Candidate { cost, partner };
                seen(candidate);
                let is_next = |failed: Candidate| {
                    failed.order() < candidate.order() && self.may_join(vertex, around, partner)
                };
                if candidate.order() < best.order() && failed.is_none_or(is_next) {
                    best = candidate;
                }
            }
        }
        best
    }

    /// Where `vertex` goes most cheaply if vertices stay, or the next after `failed`.
    fn cheapest_target(&mut self, vertex: u32, failed: Option<Candidate>) -> Candidate {
        if self.is_locked(vertex) || self.is_hub(vertex) {
            return IMPOSSIBLE;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        self.gather_source(vertex, &mut scratch);
        let Scratch { source, half_edge, .. } = &mut scratch;
        let own_flags = self.flags_of(source);
        let failed = failed.map(|failed| (failed.cost, failed.partner));
        let flags = |neighbour: u32| self.surface.flags[neighbour as usize];
        let best = self.terms().cheapest(source, own_flags, flags, failed, f32::INFINITY, half_edge);
        self.scratch = scratch;
        best.filter(|(cost, _)| *cost < f32::INFINITY)
            .map_or(IMPOSSIBLE, |(cost, partner)| Candidate { cost, partner })
    }

    /// Puts the cheapest edge of `vertex` in the queue, or the next one after `failed`.
    pub(super) fn choose(&mut self, vertex: u32, failed: Option<Candidate>) {
        let mut around = std::mem::take(&mut self.around);
        let best = self.cheapest(vertex, failed, &mut around);
        self.around = around;
        self.set(vertex, best);
    }

    pub(super) fn set(&mut self, vertex: u32, candidate: Candidate) {
        self.candidates[vertex as usize] = candidate;
        self.queue.set(vertex, candidate.cost);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collapse::surface::{Setting, Surface};
    use crate::collapse::tests::{dirty, torn};
    use crate::collapse::{Counts, Edge, Rules};
    use crate::workers::Workers;
    use proptest::prelude::*;
    use std::borrow::Cow;

    proptest! {
        /// What names alone forbid, the link condition forbids; and the quadrics that are known are those of the rings.
        #[test]
        fn what_may_not_join_does_not_keep_the_topology(mesh in prop_oneof![torn(), dirty()]) {
            let mut surface = Surface::new(Cow::Borrowed(&mesh), &Setting::default(), &Workers::Caller);
            surface.classify(false, &Workers::Caller);
            let rules = Rules {
                any_topology: false,
                may_relax: false,
                error_limit: f32::INFINITY,
                half_edge: false,
                extent: [Vec3A::NEG_INFINITY, Vec3A::INFINITY],
            };
            let counts = Counts { faces: surface.faces.len(), vertices: surface.vertex_count() };
            let mut finish = Finish::new(&mut surface, counts, &rules);
            let (mut around, mut scratch) = (Vec::new(), Scratch::default());
            for vertex in 0..mesh.positions().len() as u32 {
                finish.gather_neighbours(vertex, &mut around);
                for &partner in &around {
                    finish.gather_ends([vertex, partner], &mut scratch);
                    let edge = Edge {
                        source: &scratch.source,
                        target: &scratch.target,
                        source_point: finish.surface.points[vertex as usize],
                        target_point: finish.surface.points[partner as usize],
                        target_locked: false,
                    };
                    let keeps = edge.keeps_topology(&mut scratch.neighbours);
                    prop_assert!(finish.may_join(vertex, &around, partner) || !keeps, "{vertex} and {partner}");
                    for mut ring in [scratch.source.clone(), scratch.target.clone()] {
                        let known = ring.quadric;
                        ring.complete_quadric();
                        prop_assert_eq!(known, ring.quadric);
                    }
                }
            }
        }
    }
}
