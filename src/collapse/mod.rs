//! The edge-collapse operator: which collapses are legal, and what they do.
//!
//! Section 2.2 of the HQMS paper describes the operator without conditions. A library's users need
//! more: here a collapse keeps the topology (link condition), folds no face over, and moves no
//! locked vertex.

pub(crate) mod attributes;
pub(crate) mod half_edge;
mod load;
pub(crate) mod queue;
pub(crate) mod ring;
pub(crate) mod surface;
pub(crate) mod tile;
pub(crate) mod wedges;

use crate::lanes::{Numbers, Vectors, largest};
use crate::quadric::place;
use glam::{Vec3A, Vec4};
use ring::{Ring, Spokes};

/// How much a surface has, or lost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) faces: usize,
    /// Vertices of the result: where one of the surface has several wedges, each of these.
    pub(crate) vertices: usize,
}

impl Counts {
    pub(crate) fn remove(&mut self, removed: Self) {
        self.faces -= removed.faces;
        self.vertices -= removed.vertices;
    }

    pub(crate) fn add(&mut self, more: Self) {
        self.faces += more.faces;
        self.vertices += more.vertices;
    }
}

/// What a collapse must not do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    /// Collapses that change the topology are allowed.
    pub(crate) any_topology: bool,
    /// What is kept may be given up if the goal cannot be reached otherwise.
    pub(crate) may_relax: bool,
    /// The largest estimated error, in the units of the surface.
    pub(crate) error_limit: f32,
    /// No vertex moves: the source goes to where the target is.
    pub(crate) half_edge: bool,
    /// No vertex is placed beyond these corners of a box. What keeps the volume of a solid of few faces
    /// stretches it, a little more at each collapse.
    pub(crate) extent: [Vec3A; 2],
}

/// The two ends of a collapse: `source` goes away, `target` stays and moves.
#[derive(Clone, Copy)]
pub(crate) struct Edge<'a> {
    pub(crate) source: &'a Ring,
    pub(crate) target: &'a Ring,
    /// Where they are, and the errors that led there: see [`surface::Surface::points`].
    pub(crate) source_point: Vec4,
    pub(crate) target_point: Vec4,
    /// `target` must not move.
    pub(crate) target_locked: bool,
}

/// A half-edge collapse, in the names of the input's vertices: `source` went into `target`, which stayed
/// where it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HalfEdge {
    /// The vertex that went.
    pub source: u32,
    /// The vertex it went into.
    pub target: u32,
}

/// A legal collapse.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Collapse {
    /// Where the target goes, and the estimated distance of its surroundings from the input.
    pub(crate) point: Vec4,
    /// How far along the edge that is, 0 at the source, 1 at the target: for attributes.
    pub(crate) along: f32,
}

/// The cosine, squared, of the largest angle that a face may turn by at one collapse (84 degrees).
const TURN: f32 = 0.01;

/// A face whose corner is nearer to the opposite edge's line than this share of the way it moved is
/// a line: below that, single precision does not know on which side it lies.
const LINE: f32 = 1e-5;

/// So is a face that has less area than this share of the product of its longer sides, eight units
/// in the last place: it may have none.
const SLIVER: f32 = 4.8e-7;

/// A vertex whose squared distance from a face is less than this share of the way moved, squared, lies on it: the
/// rest is rounding.
const ON_FACE: f32 = 1e-12;

impl Edge<'_> {
    /// The collapse of this edge, if the rules allow it. `neighbours` is room to work in.
    #[inline(always)]
    pub(crate) fn collapse(&self, rules: &Rules, neighbours: &mut [Vec<u32>; 2]) -> Option<Collapse> {
        if !rules.any_topology && !self.keeps_topology(neighbours) {
            return None;
        }
        if rules.half_edge && !self.source.may_go_to(self.target.vertex) {
            return None;
        }
        let from = Vec3A::from_vec4(self.source_point);
        let into = Vec3A::from_vec4(self.target_point);
        let edge = into - from;
        // A border stays where it is when a vertex beside it goes into it.
        let target_stays =
            self.target_locked || rules.half_edge || goes_onto_border(self.source, self.target);
        let position = if target_stays {
            into
        } else if goes_onto_border(self.target, self.source) {
            from
        } else {
            let placed = from + place(&self.source.quadric, &self.target.quadric, edge).offset;
            let [low, high] = rules.extent;
            placed.max(low).min(high)
        };
        // What is checked is the place after rounding: far from the origin that is another one.
        let from_source = position - from;
        let moved = fold(self.source, self.target.vertex, from_source)?;
        let mut distance_squared = moved.distance_squared;
        let target_moved = if target_stays {
            Moved::default()
        } else {
            fold(self.target, self.source.vertex, position - into)?
        };
        distance_squared = distance_squared.max(target_moved.distance_squared);
        for (is_pointed, end) in [(moved.is_pointed, from), (target_moved.is_pointed, into)] {
            if is_pointed {
                distance_squared = self.retreat_squared(end, position, target_stays, distance_squared);
            }
        }
        // What stays where it is adds nothing to the error that led there.
        let error = if rules.half_edge {
            self.target_point.w.max(self.source_point.w + distance_squared.sqrt())
        } else {
            self.source_point.w.max(self.target_point.w) + distance_squared.sqrt()
        };
        if error > rules.error_limit || !position.is_finite() {
            return None;
        }
        let along = (from_source.dot(edge) / edge.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        Some(Collapse { point: position.extend(error), along })
    }

    /// The squared distance of an end of the edge that was at `point` from the faces around its new `position`, or
    /// `least` if that is larger: a tip that goes back along the planes around it is on none of the surfaces
    /// that are left.
    #[cold]
    #[inline(never)]
    fn retreat_squared(&self, point: Vec3A, position: Vec3A, target_stays: bool, least: f32) -> f32 {
        let ends = [
            (self.source, self.target.vertex, self.source_point),
            (self.target, self.source.vertex, self.target_point),
        ];
        // Of a target that stays only the names of its faces are known.
        let known = if target_stays { &ends[..1] } else { &ends[..] };
        let mut nearest = (position - point).length_squared();
        for &(ring, other, origin) in known {
            let from_point = Vec3A::from_vec4(origin) - point;
            for [next, previous] in ring.surviving_edges(other) {
                let triangle = [position - point, from_point + next, from_point + previous];
                nearest = nearest.min(distance_to_triangle_squared(triangle));
                if nearest <= least {
                    return least;
                }
            }
        }
        if nearest <= ON_FACE * (position - point).length_squared() { least } else { nearest }
    }

    /// Whether a face would come to look away from the mean of those around the new vertex, as none did
    /// around the old ones: after several collapses, none of which turned it by much, a face can have
    /// folded over.
    pub(crate) fn buckles(&self, collapse: &Collapse) -> bool {
        let position = Vec3A::from_vec4(collapse.point);
        let ends = [
            (self.source, self.target.vertex, position - Vec3A::from_vec4(self.source_point)),
            (self.target, self.source.vertex, position - Vec3A::from_vec4(self.target_point)),
        ];
        let all = ends.iter().flat_map(|&(ring, other, offset)| ring.moved_faces(other, offset));
        let mean: Vec3A = all.map(|(_, after)| after).sum();
        ends.iter().any(|&(ring, other, offset)| {
            let mean_before = ring.mean_normal();
            let mut faces = ring.moved_faces(other, offset);
            faces.any(|(before, after)| after.dot(mean) < 0.0 && before.dot(mean_before) >= 0.0)
        })
    }

    /// The link condition (Dey, Edelsbrunner, Guha and Nekhayev): the links of both ends have in
    /// common the corners opposite the edge, no other vertex, and no edge. Besides, an inner edge
    /// must not join two borders, and no face that hangs by its corners alone may vanish.
    #[inline(always)]
    pub(crate) fn keeps_topology(&self, neighbours: &mut [Vec<u32>; 2]) -> bool {
        let (source, target) = (self.source, self.target);
        let (after, before) = target.occurrences(source.vertex);
        let shared = after + before;
        if shared == 0 || shared > 2 {
            return false;
        }
        if source.boundary || target.boundary {
            return self.keeps_borders(shared as usize, neighbours);
        }
        // All fans are closed: each neighbour stands once as `next`.
        shared == 2 && source.common_next(target) == 2 && !self.joins_faces()
    }

    /// [`keeps_topology`](Self::keeps_topology) where a fan may be open.
    #[cold]
    #[inline(never)]
    fn keeps_borders(&self, shared: usize, [of_source, of_target]: &mut [Vec<u32>; 2]) -> bool {
        let (source, target) = (self.source, self.target);
        source.neighbours(of_source);
        target.neighbours(of_target);
        let mut both = of_source.iter().filter(|vertex| of_target.binary_search(vertex).is_ok());
        let common = both.clone().count();
        let joins_borders = shared == 2 && source.boundary && target.boundary;
        let faces = |ring: &Ring, vertex: u32| {
            let (after, before) = ring.occurrences(vertex);
            after + before
        };
        let is_loose = shared == 1
            && both.next().is_some_and(|&third| faces(source, third) == 1 && faces(target, third) == 1);
        common == shared && !joins_borders && !is_loose && !self.joins_faces()
    }

    /// Whether a face of the source would come to lie on one of the target. As the links have no
    /// vertices in common but those opposite the edge, it can only be one with both of these. Two faces
    /// on the same three vertices lie on each other already, and make one opposite vertex look like two.
    #[inline(always)]
    fn joins_faces(&self) -> bool {
        let source = self.source.vertex;
        let mut opposite = [source; 2];
        self.target.visit_faces_with(source, |face, comes_after| {
            if comes_after {
                opposite[0] = self.target.name(face).1;
            } else {
                opposite[1] = self.target.name(face).0;
            }
        });
        let [a, b] = opposite;
        a == b || self.source.has_face([a, b]) && self.target.has_face([a, b])
    }
}

/// Whether `inner` is inside and `other` on a border.
fn goes_onto_border(inner: &Ring, other: &Ring) -> bool {
    other.boundary && !inner.boundary
}

/// What is known of a vertex that may move.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Moved {
    /// The largest squared distance of the new place from the planes of the ring.
    distance_squared: f32,
    /// The vertex is a tip, of a border or of a surface some of whose faces hardly look where the vertex does:
    /// when it goes back, the distance from its faces' planes says little.
    is_pointed: bool,
}

/// Moves the ring's vertex by `offset` and looks at each face that survives a collapse with
/// `other`: `None` if one turns by too much or becomes a line.
///
/// Faces that have no area before have no side to be turned from. They are common in real data, and
/// would block every collapse around them.
#[inline(always)]
fn fold(ring: &Ring, other: u32, offset: Vec3A) -> Option<Moved> {
    let mut distances_squared = Numbers::ZERO;
    let mut folded = 0;
    let mut look_away = Numbers::ZERO;
    let moved = Vectors::splat(offset);
    let narrowest = Numbers::splat(LINE * LINE * offset.length_squared());
    for (spokes, survive) in ring.surviving_spokes(other) {
        let before = spokes.cross;
        let after = spokes.moved(moved);
        let areas_before = before.length_squared();
        let areas_after = after.length_squared();
        look_away |= ring.look_away(before, areas_before);
        let cosines = before.dot(after);
        let turned = cosines.simd_le(Numbers::ZERO)
            | (cosines * cosines).simd_lt(Numbers::splat(TURN) * areas_before * areas_after);
        let faulty = turned | are_lines(areas_after, spokes, narrowest);
        folded |= survive & (faulty & areas_before.simd_gt(Numbers::ZERO)).to_bitmask();
        let heights = before.dot(moved);
        let distances = heights * heights / (areas_before + Numbers::splat(f32::MIN_POSITIVE));
        distances_squared = distances_squared.fast_max(distances);
    }
    let mut distance_squared = largest(distances_squared);
    if ring.boundary {
        distance_squared = distance_squared.max(ring.border_distance_squared(offset));
    }
    (folded == 0).then_some(Moved { distance_squared, is_pointed: ring.boundary || look_away.any() })
}

/// The squared distance of a triangle from the origin; of its corners' nearest edge where it has no area.
///
/// The regions are those of Ericson, *Real-Time Collision Detection* (2005), section 5.1.5.
fn distance_to_triangle_squared([a, b, c]: [Vec3A; 3]) -> f32 {
    let to_edge = |from: Vec3A, to: Vec3A| {
        let along = to - from;
        let at = (-from.dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        (from + at * along).length_squared()
    };
    let normal = (b - a).cross(c - a);
    let area_squared = normal.length_squared();
    let is_inside = |from: Vec3A, to: Vec3A| from.cross(to).dot(normal) > 0.0;
    if area_squared > f32::MIN_POSITIVE && is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
        let height = a.dot(normal);
        return height * height / area_squared;
    }
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

/// Whether a face of which single precision does not know on which side it lies: twice its area, squared,
/// is `area_squared` after its vertex, which saw the other corners at these places, has moved by `offset`.
#[inline(always)]
pub(crate) fn is_line(area_squared: f32, to_next: Vec3A, to_previous: Vec3A, offset: Vec3A) -> bool {
    let narrowest = LINE * LINE * offset.length_squared();
    // What rounding leaves of the area is a share of the sides' product, which is nothing beside the way
    // moved unless the face is a sliver: there their dot product is the same.
    let sides = SLIVER * to_next.dot(to_previous);
    area_squared <= f32::max(narrowest * (to_next - to_previous).length_squared(), sides * sides)
}

/// [`is_line`] for faces side by side, after a way moved of which `narrowest` is the share of its square.
#[inline(always)]
fn are_lines(areas_squared: Numbers, spokes: &Spokes, narrowest: Numbers) -> Numbers {
    let sides = Numbers::splat(SLIVER) * spokes.to_next.dot(spokes.to_previous);
    let opposite = (spokes.to_next - spokes.to_previous).length_squared();
    areas_squared.simd_le((narrowest * opposite).fast_max(sides * sides))
}

#[cfg(test)]
pub(crate) mod tests;
