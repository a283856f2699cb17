//! The edge-collapse operator: which collapses are legal, and what they do.
//!
//! Section 2.2 of the HQMS paper describes the operator without conditions. A library's users need
//! more: here a collapse keeps the topology (link condition), folds no face over, and moves no
//! locked vertex.

pub(crate) mod queue;
pub(crate) mod ring;
pub(crate) mod surface;
pub(crate) mod tile;

use crate::quadric::place;
use glam::Vec3;
use ring::{Ring, Spoke};

/// What a collapse must not do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    /// Collapses that change the topology are allowed.
    pub(crate) any_topology: bool,
    /// The largest estimated error, in the units of the surface.
    pub(crate) error_limit: f32,
}

/// The two ends of a collapse: `source` goes away, `target` stays and moves.
#[derive(Clone, Copy)]
pub(crate) struct Edge<'a> {
    pub(crate) source: &'a Ring,
    pub(crate) target: &'a Ring,
    pub(crate) source_position: Vec3,
    pub(crate) target_position: Vec3,
    /// `target` must not move.
    pub(crate) target_locked: bool,
    /// The larger of the errors that led to the two ends.
    pub(crate) error: f32,
}

/// A legal collapse.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Collapse {
    /// Where the target goes.
    pub(crate) position: Vec3,
    /// How far along the edge that is, 0 at the source, 1 at the target: for attributes.
    pub(crate) along: f32,
    /// The estimated distance of the new vertex's surroundings from the input.
    pub(crate) error: f32,
}

/// The cosine, squared, of the largest angle that a face may turn by at one collapse (84 degrees).
const TURN: f32 = 0.01;

/// A face whose height is below this share of its edges has no direction to keep.
const SLIVER: f32 = 1e-5;

impl Edge<'_> {
    /// The collapse of this edge, if the rules allow it. `neighbours` is room to work in.
    #[inline(always)]
    pub(crate) fn collapse(&self, rules: &Rules, neighbours: &mut [Vec<u32>; 2]) -> Option<Collapse> {
        if !rules.any_topology && !self.keeps_topology(neighbours) {
            return None;
        }
        let edge = self.target_position - self.source_position;
        let position = if self.target_locked {
            self.target_position
        } else {
            self.source_position + place(&self.source.quadric, &self.target.quadric, edge).offset
        };
        // What is checked is the place after rounding: far from the origin that is another one.
        let from_source = position - self.source_position;
        let from_target = position - self.target_position;
        let distance_squared = f32::max(
            fold(self.source, self.target.vertex, from_source)?,
            fold(self.target, self.source.vertex, from_target)?,
        );
        let error = self.error + distance_squared.sqrt();
        if error > rules.error_limit || !position.is_finite() {
            return None;
        }
        let along = (from_source.dot(edge) / edge.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        Some(Collapse { position, along, error })
    }

    /// The link condition (Dey, Edelsbrunner, Guha and Nekhayev): the common neighbours of both
    /// ends are the corners opposite the edge, and no others. Besides, an inner edge must not join
    /// two borders, and no component may vanish.
    #[inline(always)]
    fn keeps_topology(&self, neighbours: &mut [Vec<u32>; 2]) -> bool {
        let (source, target) = (self.source, self.target);
        let touches = |spoke: &&Spoke| (spoke.next == source.vertex) | (spoke.previous == source.vertex);
        let shared = target.spokes().iter().filter(touches).count();
        if shared == 0 || shared > 2 {
            return false;
        }
        if source.boundary || target.boundary {
            return shared_by_borders(source, target, shared, neighbours);
        }
        // All rings are closed fans: each neighbour stands once as `next`.
        let mut common = 0;
        for spoke in target.spokes() {
            for other in source.spokes() {
                common += usize::from(spoke.next == other.next);
            }
        }
        let around = source.spokes().len() + target.spokes().len() - 2 - common.min(2);
        shared == 2 && common == 2 && around >= 3
    }
}

/// [`Edge::keeps_topology`] where a ring may be open.
#[cold]
#[inline(never)]
fn shared_by_borders(source: &Ring, target: &Ring, shared: usize, neighbours: &mut [Vec<u32>; 2]) -> bool {
    let [of_source, of_target] = neighbours;
    source.neighbours(of_source);
    target.neighbours(of_target);
    let common = of_source.iter().filter(|vertex| of_target.binary_search(vertex).is_ok()).count();
    let around = of_source.len() + of_target.len() - 2 - common;
    let joins_borders = shared == 2 && source.boundary && target.boundary;
    common == shared && !joins_borders && around >= 2
}

/// Moves the ring's vertex by `offset` and looks at each face that survives a collapse with
/// `other`: `None` if one turns by too much, else the largest squared distance of the new place
/// from the planes of the ring.
#[inline(always)]
fn fold(ring: &Ring, other: u32, offset: Vec3) -> Option<f32> {
    let mut distance_squared = 0f32;
    let mut folded = false;
    for spoke in ring.spokes() {
        let before = spoke.cross;
        let after = before + offset.cross(spoke.to_next - spoke.to_previous);
        let area_before = before.length_squared();
        let area_after = after.length_squared();
        let cosine = before.dot(after);
        let turns = (cosine <= 0.0) | (cosine * cosine < TURN * area_before * area_after);
        let survives = (spoke.next != other) & (spoke.previous != other);
        folded |= survives & turns & !is_sliver(spoke, area_before);
        let height = before.dot(offset);
        distance_squared = distance_squared.max(height * height / (area_before + f32::MIN_POSITIVE));
    }
    (!folded).then_some(distance_squared)
}

/// Whether a face (its doubled area squared is `area`) is a line or a point: such faces are common
/// in real data and would block every collapse around them.
#[inline(always)]
fn is_sliver(spoke: &Spoke, area: f32) -> bool {
    area <= (SLIVER * SLIVER) * spoke.to_next.length_squared() * spoke.to_previous.length_squared()
}
