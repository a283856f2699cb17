//! A run of vertices that one thread works on: what a pass may touch.
//!
//! A tile holds the points, flags and attributes of its own vertices alone. It sees all
//! faces, but changes only those with all three corners in the tile: these no other tile changes,
//! and a face between tiles nobody does. A ring that leaves the tile is not gathered at all. So
//! tiles can work side by side without locks, and what each does depends on nothing the others do.

use super::ring::Ring;
use super::surface::{Face, flag, is_alive, neighbours};
use super::{Collapse, Edge, Rules};
use crate::mesh::Attributes;
use glam::{Vec2, Vec3, Vec3A, Vec4};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Rings with more faces are left to the final heap: the pairwise comparison of two rings in the
/// link condition is quadratic.
const MAX_DEGREE: usize = 64;

/// A run of vertices, with the faces of the whole surface. See the [module](self).
pub(crate) struct Tile<'a> {
    first: u32,
    points: &'a mut [Vec4],
    flags: &'a mut [u8],
    merged: &'a mut [u32],
    normals: &'a mut [[f32; 3]],
    colors: &'a mut [[u8; 4]],
    uvs: &'a mut [[f32; 2]],
    faces: &'a [Face],
    offsets: &'a [u32],
    incidence: &'a [AtomicU32],
}

/// Room to work in, one a thread.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) source: Ring,
    pub(crate) target: Ring,
    neighbours: [Vec<u32>; 2],
}

impl<'a> Tile<'a> {
    /// A tile of all vertices.
    pub(crate) fn new(
        points: &'a mut [Vec4],
        flags: &'a mut [u8],
        merged: &'a mut [u32],
        attributes: &'a mut Attributes,
        faces: &'a [Face],
        offsets: &'a [u32],
        incidence: &'a [AtomicU32],
    ) -> Self {
        Self {
            first: 0,
            points,
            flags,
            merged,
            normals: attributes.normals.as_deref_mut().unwrap_or_default(),
            colors: attributes.colors.as_deref_mut().unwrap_or_default(),
            uvs: attributes.uvs.as_deref_mut().unwrap_or_default(),
            faces,
            offsets,
            incidence,
        }
    }

    /// Two tiles, the second from vertex `cut` on.
    pub(crate) fn split(self, cut: usize) -> [Self; 2] {
        let middle = cut - self.first as usize;
        let (points, points_after) = self.points.split_at_mut(middle);
        let (flags, flags_after) = self.flags.split_at_mut(middle);
        // What is not carried is empty on both sides.
        let (merged, merged_after) = self.merged.split_at_mut(middle.min(self.merged.len()));
        let (normals, normals_after) = self.normals.split_at_mut(middle.min(self.normals.len()));
        let (colors, colors_after) = self.colors.split_at_mut(middle.min(self.colors.len()));
        let (uvs, uvs_after) = self.uvs.split_at_mut(middle.min(self.uvs.len()));
        let (faces, offsets, incidence) = (self.faces, self.offsets, self.incidence);
        let first = cut as u32;
        [
            Self {
                first: self.first,
                points,
                flags,
                merged,
                normals,
                colors,
                uvs,
                faces,
                offsets,
                incidence,
            },
            Self {
                first,
                points: points_after,
                flags: flags_after,
                merged: merged_after,
                normals: normals_after,
                colors: colors_after,
                uvs: uvs_after,
                faces,
                offsets,
                incidence,
            },
        ]
    }

    /// The tile's vertices.
    pub(crate) fn vertices(&self) -> std::ops::Range<u32> {
        self.first..self.first + self.points.len() as u32
    }

    pub(crate) fn flags(&self, vertex: u32) -> u8 {
        self.flags[(vertex - self.first) as usize]
    }

    /// Whether `vertex` lies in the tile and has not been part of a collapse.
    #[inline(always)]
    pub(crate) fn is_unused(&self, vertex: u32) -> bool {
        let flags = self.flags.get(vertex.wrapping_sub(self.first) as usize);
        flags.is_some_and(|flags| flags & (flag::USED | flag::DEAD) == 0)
    }

    pub(crate) fn unblock(&mut self, vertex: u32) {
        self.flags[(vertex - self.first) as usize] &= !flag::BLOCKED;
    }

    #[inline(always)]
    fn position(&self, vertex: u32) -> Option<Vec3A> {
        self.points.get(vertex.wrapping_sub(self.first) as usize).map(|&point| Vec3A::from_vec4(point))
    }

    #[inline(always)]
    fn corners(&self, vertex: u32) -> &'a [AtomicU32] {
        &self.incidence[self.offsets[vertex as usize] as usize..self.offsets[vertex as usize + 1] as usize]
    }

    /// How many faces the ring of `vertex` had when the pass began.
    pub(crate) fn degree(&self, vertex: u32) -> usize {
        self.corners(vertex).len()
    }

    /// Gathers the ring of `vertex`; `false` if it leaves the tile or is too large.
    #[inline(always)]
    pub(crate) fn gather(&self, vertex: u32, ring: &mut Ring) -> bool {
        let corners = self.corners(vertex);
        let (Some(origin), true) = (self.position(vertex), corners.len() <= MAX_DEGREE) else {
            return false;
        };
        let boundary = self.flags(vertex) & flag::BOUNDARY != 0;
        ring.gather(vertex, boundary, corners.len(), |ring| {
            for corner in corners {
                let corner = corner.load(Relaxed);
                if !is_alive(&self.faces[(corner >> 2) as usize]) {
                    continue;
                }
                let (next, previous) = neighbours(self.faces, corner);
                let (Some(to_next), Some(to_previous)) = (self.position(next), self.position(previous))
                else {
                    return false;
                };
                ring.push(next, previous, to_next - origin, to_previous - origin);
            }
            true
        })
    }

    /// Collapses `scratch.source`, which has been gathered and is unused, into `target`, if the
    /// rules allow it: the number of faces that this removed. Where they do not, the source is
    /// blocked.
    #[inline(always)]
    pub(crate) fn collapse(&mut self, target: u32, rules: &Rules, scratch: &mut Scratch) -> Option<usize> {
        let source = scratch.source.vertex;
        let (from, into) = ((source - self.first) as usize, (target - self.first) as usize);
        if self.flags[into] & flag::USED != 0 || !self.gather(target, &mut scratch.target) {
            return None;
        }
        let edge = Edge {
            source: &scratch.source,
            target: &scratch.target,
            source_point: self.points[from],
            target_point: self.points[into],
            target_locked: self.flags[into] & flag::LOCKED != 0,
        };
        let collapse = edge.collapse(rules, &mut scratch.neighbours);
        if collapse.is_none() {
            self.flags[from] |= flag::BLOCKED;
        }
        collapse.map(|collapse| self.execute(source, target, &collapse))
    }

    fn execute(&mut self, source: u32, target: u32, collapse: &Collapse) -> usize {
        let (from, into) = ((source - self.first) as usize, (target - self.first) as usize);
        let mut removed = 0;
        for corner in self.corners(source) {
            let corner = corner.load(Relaxed);
            let face = &self.faces[(corner >> 2) as usize];
            if !is_alive(face) {
                continue;
            }
            let (next, previous) = neighbours(self.faces, corner);
            if next == target || previous == target {
                face[1].store(face[0].load(Relaxed), Relaxed);
                removed += 1;
            } else {
                face[(corner & 3) as usize].store(target, Relaxed);
            }
        }
        self.points[into] = collapse.point;
        self.flags[into] |= self.flags[from] & flag::BOUNDARY | flag::USED;
        self.flags[from] |= flag::DEAD;
        if let Some(merged) = self.merged.get_mut(from) {
            *merged = target;
        }
        blend_attributes(self.normals, self.colors, self.uvs, [from, into], collapse.along);
        removed
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
