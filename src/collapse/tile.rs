//! A run of vertices that one thread works on: what a pass may touch.
//!
//! A tile holds the points, flags and attributes of its own vertices alone. It sees all
//! faces, but changes only those with all three corners in the tile: these no other tile changes,
//! and a face between tiles nobody does. A ring that leaves the tile is not gathered at all. So
//! tiles can work side by side without locks, and what each does depends on nothing the others do.

use super::half_edge::{self, Terms};
use super::ring::Ring;
use super::surface::{Face, NONE, Rings, Spans, flag, is_alive, neighbours};
use super::wedges::Wedges;
use super::{Collapse, Counts, Edge, HalfEdge, Rules};
use glam::{Vec2, Vec3, Vec3A, Vec4};
use std::ops::Range;
use std::sync::atomic::Ordering::Relaxed;

/// Rings with more faces are left to the final heap: the pairwise comparison of two rings in the
/// link condition is quadratic.
const MAX_DEGREE: usize = 64;

/// The most faces two vertices may have whose target has absorbed another in this pass: it would gather a
/// ring that no later collapse can afford to look at.
const MAX_ABSORBED: usize = 28;

/// A run of vertices, with the faces of the whole surface. See the [module](self).
pub(crate) struct Tile<'a> {
    first: u32,
    columns: Columns<'a>,
    shared: Shared<'a>,
    rings: Rings,
    /// What was collapsed, in the names of the input's vertices, where that is tracked.
    collapses: Option<Vec<HalfEdge>>,
}

/// What a tile alone may look at and change: an element a vertex, or none where it is not carried.
pub(crate) struct Columns<'a> {
    pub(crate) points: &'a mut [Vec4],
    pub(crate) flags: &'a mut [u8],
    pub(crate) merged: &'a mut [u32],
    pub(crate) absorbed: &'a mut [u32],
    pub(crate) attribute_errors: &'a mut [f32],
    pub(crate) normals: &'a mut [[f32; 3]],
    pub(crate) colors: &'a mut [[u8; 4]],
    pub(crate) uvs: &'a mut [[f32; 2]],
}

/// What all tiles look at.
#[derive(Clone, Copy)]
pub(crate) struct Shared<'a> {
    pub(crate) faces: &'a [Face],
    pub(crate) spans: &'a Spans,
    pub(crate) terms: Terms<'a>,
}

/// Room to work in, one a thread.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) source: Ring,
    pub(crate) target: Ring,
    half_edge: half_edge::Scratch,
    neighbours: [Vec<u32>; 2],
}

impl<'a> Columns<'a> {
    /// The first `count` vertices, and the others.
    fn split(self, count: usize) -> [Self; 2] {
        fn cut<T>(column: &mut [T], count: usize) -> (&mut [T], &mut [T]) {
            column.split_at_mut(count.min(column.len()))
        }
        let (points, points_after) = cut(self.points, count);
        let (flags, flags_after) = cut(self.flags, count);
        let (merged, merged_after) = cut(self.merged, count);
        let (absorbed, absorbed_after) = cut(self.absorbed, count);
        let (attribute_errors, attribute_errors_after) = cut(self.attribute_errors, count);
        let (normals, normals_after) = cut(self.normals, count);
        let (colors, colors_after) = cut(self.colors, count);
        let (uvs, uvs_after) = cut(self.uvs, count);
        [
            Self { points, flags, merged, absorbed, attribute_errors, normals, colors, uvs },
            Self {
                points: points_after,
                flags: flags_after,
                merged: merged_after,
                absorbed: absorbed_after,
                attribute_errors: attribute_errors_after,
                normals: normals_after,
                colors: colors_after,
                uvs: uvs_after,
            },
        ]
    }
}

impl<'a> Tile<'a> {
    /// A tile of all vertices, that remembers its collapses if they are `tracked`.
    pub(crate) fn new(columns: Columns<'a>, shared: Shared<'a>, tracked: bool) -> Self {
        Self { first: 0, columns, shared, rings: Rings::default(), collapses: tracked.then(Vec::new) }
    }

    /// Two tiles, the second from vertex `cut` on.
    pub(crate) fn split(self, cut: usize) -> [Self; 2] {
        let Self { first, shared, collapses, .. } = self;
        let [columns, after] = self.columns.split(cut - first as usize);
        [
            Self { first, columns, shared, rings: Rings::default(), collapses: collapses.clone() },
            Self { first: cut as u32, columns: after, shared, rings: Rings::default(), collapses },
        ]
    }

    /// Finds the rings of the tile's vertices, which what follows needs.
    pub(crate) fn find_rings(&mut self) {
        self.rings = Rings::new(self.shared.faces, self.shared.spans, self.vertices());
    }

    /// What was collapsed, if that was tracked.
    pub(crate) fn into_collapses(self) -> Vec<HalfEdge> {
        self.collapses.unwrap_or_default()
    }

    /// The tile's vertices.
    pub(crate) fn vertices(&self) -> Range<u32> {
        self.first..self.first + self.columns.points.len() as u32
    }

    /// Whether there are vertices of several wedges.
    pub(crate) fn has_wedges(&self) -> bool {
        self.shared.terms.wedges.are_several()
    }

    pub(crate) fn flags(&self, vertex: u32) -> u8 {
        self.columns.flags[(vertex - self.first) as usize]
    }

    /// Whether `vertex` lies in the tile and has not been part of a collapse.
    #[inline(always)]
    pub(crate) fn is_unused(&self, vertex: u32) -> bool {
        let flags = self.columns.flags.get(vertex.wrapping_sub(self.first) as usize);
        flags.is_some_and(|flags| flags & (flag::USED | flag::DEAD) == 0)
    }

    pub(crate) fn unblock(&mut self, vertex: u32) {
        self.columns.flags[(vertex - self.first) as usize] &= !flag::BLOCKED;
    }

    #[inline(always)]
    fn position(&self, vertex: u32) -> Option<Vec3A> {
        self.columns
            .points
            .get(vertex.wrapping_sub(self.first) as usize)
            .map(|&point| Vec3A::from_vec4(point))
    }

    /// The corners around `vertex` when the pass began. Needs the rings.
    #[inline(always)]
    pub(crate) fn corners(&self, vertex: u32) -> &[u32] {
        self.rings.around(vertex)
    }

    /// How many faces the ring of `vertex` had when the pass began.
    pub(crate) fn degree(&self, vertex: u32) -> usize {
        self.corners(vertex).len()
    }

    /// Gathers the ring of `vertex`, of which the `corners` are given; `false` if it leaves the tile or is too
    /// large.
    #[inline(always)]
    pub(crate) fn gather(&self, vertex: u32, corners: &[u32], ring: &mut Ring) -> bool {
        let (Some(origin), true) = (self.position(vertex), corners.len() <= MAX_DEGREE) else {
            return false;
        };
        let boundary = self.flags(vertex) & flag::BOUNDARY != 0;
        let mut gathering = ring.begin(corners.len());
        for &corner in corners {
            if !is_alive(&self.shared.faces[(corner >> 2) as usize]) {
                continue;
            }
            let names = neighbours(self.shared.faces, corner);
            let (Some(next), Some(previous)) = (self.position(names.0), self.position(names.1)) else {
                return false;
            };
            gathering.push(names, next - origin, previous - origin);
        }
        let count = gathering.count();
        ring.complete(vertex, boundary, count);
        true
    }

    /// The neighbour to which `scratch.source`, which has been gathered of these `corners`, goes most cheaply if
    /// neighbours do not move, and the cost. What costs `limit` or more need not be found.
    #[inline(always)]
    pub(crate) fn cheapest_target(
        &self,
        corners: &[u32],
        limit: f32,
        scratch: &mut Scratch,
    ) -> Option<(f32, u32)> {
        let vertex = scratch.source.vertex;
        if self.shared.terms.are_none() {
            let factor = half_edge::factor(self.flags(vertex));
            return scratch.source.cheapest_target().map(|(cost, name)| (factor * cost, name));
        }
        self.gather_corners(corners, &mut scratch.half_edge.wedges.corners);
        let Scratch { source, half_edge, .. } = scratch;
        let flags = |neighbour| self.flags(neighbour);
        self.shared.terms.cheapest(source, self.flags(vertex), flags, None, limit, half_edge)
    }

    /// The living ones of the corners around a vertex, in the order of its ring.
    fn gather_corners(&self, all: &[u32], corners: &mut Vec<u32>) {
        corners.clear();
        let is_alive = |corner: &u32| is_alive(&self.shared.faces[(corner >> 2) as usize]);
        corners.extend(all.iter().copied().filter(is_alive));
    }

    /// What `vertex`, or one that was absorbed before, has absorbed next in this pass, or [`NONE`].
    fn absorbed(&self, vertex: u32) -> u32 {
        self.columns.absorbed[(vertex - self.first) as usize]
    }

    /// Gathers the names of the ring of a `vertex` that stays where it is, and may have absorbed others;
    /// the ring may leave the tile. `false` if there are too many beside the `joining` ones.
    #[inline(always)]
    fn gather_names(&self, vertex: u32, joining: usize, ring: &mut Ring) -> bool {
        let has_absorbed = self.absorbed(vertex) != NONE;
        let mut room = self.degree(vertex);
        let mut absorbed = self.absorbed(vertex);
        while absorbed != NONE {
            room += self.degree(absorbed);
            absorbed = self.absorbed(absorbed);
        }
        if room > if has_absorbed { 2 * MAX_DEGREE } else { MAX_DEGREE } {
            return false;
        }
        let boundary = self.flags(vertex) & flag::BOUNDARY != 0;
        let mut gathering = ring.begin(room);
        let mut member = vertex;
        while member != NONE {
            for &corner in self.corners(member) {
                if is_alive(&self.shared.faces[(corner >> 2) as usize]) {
                    gathering.push(neighbours(self.shared.faces, corner), Vec3A::ZERO, Vec3A::ZERO);
                }
            }
            member = self.absorbed(member);
        }
        let count = gathering.count();
        ring.complete_names(vertex, boundary, count);
        !has_absorbed || ring.count() + joining <= MAX_ABSORBED
    }

    /// Collapses `scratch.source`, which has been gathered and is unused, into `target`, if the
    /// rules allow it: what this removed. Where they do not, the source is blocked.
    #[inline(always)]
    pub(crate) fn collapse(&mut self, target: u32, rules: &Rules, scratch: &mut Scratch) -> Option<Counts> {
        let source = scratch.source.vertex;
        let (from, into) = ((source - self.first) as usize, (target - self.first) as usize);
        let gathered = if rules.half_edge {
            self.gather_names(target, scratch.source.count(), &mut scratch.target)
        } else {
            self.columns.flags[into] & flag::USED == 0
                && self.gather(target, self.corners(target), &mut scratch.target)
        };
        if !gathered {
            return None;
        }
        let edge = Edge {
            source: &scratch.source,
            target: &scratch.target,
            source_point: self.columns.points[from],
            target_point: self.columns.points[into],
            target_locked: self.columns.flags[into] & flag::LOCKED != 0,
        };
        let collapse = edge.collapse(rules, &mut scratch.neighbours);
        let legal = collapse.and_then(|collapse| Some((collapse, self.settle(target, rules, scratch)?)));
        let Some((collapse, error)) = legal else {
            self.columns.flags[from] |= flag::BLOCKED;
            return None;
        };
        let faces = self.execute(source, target, &collapse);
        let vertices =
            if rules.half_edge { self.execute_half_edge(source, target, error, scratch) } else { 1 };
        Some(Counts { faces, vertices })
    }

    /// Finds where the wedges of `scratch.source` go in a collapse into `target`, and what the attributes differ
    /// by then; `None` if they may not go.
    #[inline(always)]
    fn settle(&self, target: u32, rules: &Rules, scratch: &mut Scratch) -> Option<f32> {
        let terms = &self.shared.terms;
        if !rules.half_edge || terms.are_none() {
            return Some(0.0);
        }
        let Scratch { source, half_edge, .. } = scratch;
        if !half_edge.has_chosen([source.vertex, target]) {
            self.gather_corners(self.corners(source.vertex), &mut half_edge.wedges.corners);
        }
        let place = |vertex: u32| Vec3A::from_vec4(self.columns.points[(vertex - self.first) as usize]);
        let edge = place(target) - place(source.vertex);
        terms.settle(source, self.flags(source.vertex), target, edge, half_edge)
    }

    fn execute(&mut self, source: u32, target: u32, collapse: &Collapse) -> usize {
        let (from, into) = ((source - self.first) as usize, (target - self.first) as usize);
        let faces = self.shared.faces;
        let mut removed = 0;
        for &corner in self.corners(source) {
            let face = &faces[(corner >> 2) as usize];
            if !is_alive(face) {
                continue;
            }
            let (next, previous) = neighbours(faces, corner);
            if next == target || previous == target {
                face[1].store(face[0].load(Relaxed), Relaxed);
                removed += 1;
            } else {
                face[(corner & 3) as usize].store(target, Relaxed);
            }
        }
        let columns = &mut self.columns;
        columns.points[into] = collapse.point;
        columns.flags[into] |= columns.flags[from] & flag::BOUNDARY | flag::USED;
        columns.flags[from] |= flag::DEAD;
        if let Some(merged) = columns.merged.get_mut(from) {
            *merged = target;
        }
        blend_attributes(columns.normals, columns.colors, columns.uvs, [from, into], collapse.along);
        removed
    }

    /// What a half-edge collapse does besides, `error` to the attributes; how many vertices of the result it
    /// removes.
    #[inline(always)]
    fn execute_half_edge(&mut self, source: u32, target: u32, error: f32, scratch: &Scratch) -> usize {
        let (from, into) = ((source - self.first) as usize, (target - self.first) as usize);
        let Self { columns, shared, collapses, .. } = self;
        columns.absorbed[from] = std::mem::replace(&mut columns.absorbed[into], source);
        let Wedges { faces, corners, sources, names } = shared.terms.wedges;
        if shared.terms.are_none() {
            if let Some(collapses) = collapses {
                collapses
                    .push(HalfEdge { source: sources[source as usize], target: sources[target as usize] });
            }
            return 1;
        }
        if !columns.attribute_errors.is_empty() {
            let errors = &mut columns.attribute_errors;
            errors[into] = errors[into].max(errors[from]) + error;
        }
        let moves = &scratch.half_edge.moves;
        if shared.terms.wedges.are_several() {
            moves.apply(faces, corners, &scratch.half_edge.wedges.corners);
        }
        if let Some(collapses) = collapses {
            collapses.extend(moves.collapses(names));
        }
        moves.collapses(names).count()
    }
}

/// Gives the vertex `into` what lies `along` the way to it from the vertex `from`.
pub(crate) fn blend_attributes(
    normals: &mut [[f32; 3]],
    colors: &mut [[u8; 4]],
    uvs: &mut [[f32; 2]],
    [from, into]: [usize; 2],
    along: f32,
) {
    if !normals.is_empty() {
        let blend = Vec3::from(normals[from]).lerp(Vec3::from(normals[into]), along);
        // Opposite normals may cancel: then the target's stays.
        if let Some(unit) = blend.try_normalize() {
            normals[into] = unit.to_array();
        }
    }
    if !colors.is_empty() {
        let source = colors[from];
        for (into, from) in colors[into].iter_mut().zip(source) {
            *into = (f32::from(from) + along * (f32::from(*into) - f32::from(from))).round() as u8;
        }
    }
    if !uvs.is_empty() {
        uvs[into] = Vec2::from(uvs[from]).lerp(Vec2::from(uvs[into]), along).to_array();
    }
}
