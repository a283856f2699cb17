//! Collapses that change the topology, without making anything non-manifold.
//!
//! The paper's operator knows no topology, and a run that ignores it leaves edges with three and more
//! faces behind. Here, once the link condition is given up, faces that come to lie on each other
//! vanish at the price of what they covered, edges keep at most a face on each side, and vertices at
//! which surfaces only touch are split: holes close, thin necks part, small components go whole.

use super::Finish;
use super::candidates::IMPOSSIBLE;
use crate::collapse::ring::Ring;
use crate::collapse::surface::{NONE, flag};
use crate::mesh::partition::Partition;
use crate::quadric::Quadric;
use glam::Vec3A;
use std::sync::atomic::Ordering::Relaxed;

impl Finish<'_> {
    /// What it costs that faces vanish: the sum over them of the squared distance to what is left,
    /// taken to be their edge away from the collapsed one. No quadric knows this: two faces that
    /// come to lie on each other are on the same plane, however far they reach.
    pub(super) fn loss(&self, doomed: &[u32], position: Vec3A, collapsed: [u32; 2]) -> f32 {
        let of_face = |&face: &u32| {
            let corners = self.surface.faces[face as usize].each_ref().map(|corner| corner.load(Relaxed));
            let [a, b, c] = corners
                .map(|vertex| if collapsed.contains(&vertex) { position } else { self.position(vertex) });
            let longest =
                (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
            // The mean squared distance of a triangle's points from one of its edges is a sixth of
            // its squared height.
            (b - a).cross(c - a).length() * longest / 12.0
        };
        doomed.iter().map(of_face).sum()
    }

    /// Whether a collapse takes the last face off an edge that lies on others, nobody knows how: these would
    /// be left with a crack. `corners` are those of both rings.
    pub(super) fn lays_bare(
        &self,
        source: &Ring,
        target: &Ring,
        [source_corners, target_corners]: [&[u32]; 2],
        doomed: &[u32],
    ) -> bool {
        let is_tangled = |vertex: u32| self.surface.flags[vertex as usize] & flag::TANGLED == flag::TANGLED;
        let is_doomed = |corner: &u32| doomed.binary_search(&(corner >> 2)).is_ok();
        // The faces of a ring, and whether they are there after the collapse into, or of, `other`.
        let faces = |ring: &Ring, corners: &[u32], other: u32| -> Vec<([u32; 2], bool)> {
            let names = ring.names().zip(corners);
            names
                .map(|((next, previous), corner)| {
                    let survives = next != other && previous != other && !is_doomed(corner);
                    ([next, previous], survives)
                })
                .collect()
        };
        let of_source = faces(source, source_corners, target.vertex);
        let lies_across = |&(names, survives): &([u32; 2], bool)| {
            !survives && !names.contains(&target.vertex) && names.into_iter().all(is_tangled)
        };
        if of_source.iter().any(lies_across) {
            return true;
        }
        if !is_tangled(target.vertex) {
            return false;
        }
        let of_target = faces(target, target_corners, source.vertex);
        let keeps = |vertex: u32| {
            let mut all = of_source.iter().chain(&of_target);
            all.any(|(names, survives)| *survives && names.contains(&vertex))
        };
        let vanishing = of_target.iter().filter(|(_, survives)| !survives).flat_map(|(names, _)| names);
        vanishing.copied().any(|vertex| vertex != source.vertex && is_tangled(vertex) && !keeps(vertex))
    }

    /// Gives each fan of faces around `vertex` but the first a vertex of its own: a collapse that
    /// closes a hole or joins two borders leaves vertices behind at which surfaces only touch. The
    /// new vertices are added to `around`.
    pub(super) fn split_fans(&mut self, vertex: u32, around: &mut Vec<u32>) {
        let mut scratch = std::mem::take(&mut self.scratch);
        self.gather_source(vertex, &mut scratch);
        let mut fans = Partition::new(scratch.half_edge.wedges.corners.len());
        let names = (0..).zip(scratch.source.names());
        let mut ends: Vec<(u32, u32)> =
            names.flat_map(|(face, (next, previous))| [(next, face), (previous, face)]).collect();
        ends.sort_unstable();
        for pair in ends.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            fans.unite(pair[0].1, pair[1].1);
        }
        if fans.sets() > 1 {
            let names_before = self.count_names(&[vertex]);
            // A fan is named by its first face.
            let mut owners = Vec::with_capacity(scratch.half_edge.wedges.corners.len());
            for face in 0..scratch.half_edge.wedges.corners.len() as u32 {
                let fan = fans.find(face);
                owners.push(match fan {
                    0 => vertex,
                    _ if fan < face => owners[fan as usize],
                    _ => self.copy_vertex(vertex),
                });
                around.extend((fan == face && fan > 0).then_some(owners[face as usize]));
            }
            self.gathered = None;
            self.first[vertex as usize] = NONE;
            self.degrees[vertex as usize] = 0;
            for (&corner, &owner) in scratch.half_edge.wedges.corners.iter().zip(&owners).rev() {
                self.surface.faces[(corner >> 2) as usize][(corner & 3) as usize].store(owner, Relaxed);
                self.next[corner as usize] = std::mem::replace(&mut self.first[owner as usize], corner);
                self.degrees[owner as usize] += 1;
            }
            owners.sort_unstable();
            owners.dedup();
            self.counts.vertices += if self.surface.wedges.is_empty() {
                owners.len() - 1
            } else {
                self.count_names(&owners) - names_before
            };
        }
        self.scratch = scratch;
    }

    /// A new vertex where `vertex` is, without faces.
    fn copy_vertex(&mut self, vertex: u32) -> u32 {
        fn copy<T: Copy>(values: &mut Vec<T>, index: usize) {
            values.push(values[index]);
        }
        let index = vertex as usize;
        let name = self.first.len() as u32;
        let surface = &mut *self.surface;
        copy(&mut surface.points, index);
        copy(&mut surface.flags, index);
        surface.attributes.normals.iter_mut().for_each(|normals| copy(normals, index));
        surface.attributes.colors.iter_mut().for_each(|colors| copy(colors, index));
        surface.attributes.uvs.iter_mut().for_each(|uvs| copy(uvs, index));
        if !surface.merged.is_empty() {
            surface.merged.push(name);
        }
        surface.sources.iter_mut().for_each(|sources| copy(sources, index));
        if !surface.absorbed.is_empty() {
            surface.absorbed.push(NONE);
        }
        if !surface.attribute_errors.is_empty() {
            copy(&mut surface.attribute_errors, index);
        }
        self.first.push(NONE);
        self.degrees.push(0);
        self.quadrics.push(Quadric::default());
        self.candidates.push(IMPOSSIBLE);
        self.stale.push(false);
        self.changed.push(0);
        name
    }
}

/// Whether the collapse leaves every edge it joins with at most one face on each side; and
/// the faces that would then lie on each other: both go if they face each other, one if not.
pub(super) fn coincident<'r>(
    source: &'r Ring,
    target: &'r Ring,
    source_corners: &'r [u32],
    target_corners: &'r [u32],
) -> Option<Vec<u32>> {
    let faces =
        |ring: &'r Ring, corners: &'r [u32]| ring.names().zip(corners.iter().map(|corner| corner >> 2));
    let mut doomed = Vec::new();
    for ((next, previous), face) in faces(source, source_corners) {
        for (names, other) in faces(target, target_corners) {
            if names == (next, previous) || names == (previous, next) {
                doomed.push(face);
            }
            if names == (previous, next) {
                doomed.push(other);
            }
        }
    }
    doomed.sort_unstable();
    doomed.dedup();
    // In how many of the faces that stay `vertex` comes after the ring's vertex, and before.
    let count = |ring: &'r Ring, corners: &'r [u32], vertex: u32, avoid: u32| {
        let stays = |face: &u32, names: (u32, u32)| {
            names.0 != avoid && names.1 != avoid && doomed.binary_search(face).is_err()
        };
        let left = faces(ring, corners).filter(|(names, face)| stays(face, *names));
        left.fold((0, 0), |(after, before), ((next, previous), _)| {
            (after + u32::from(next == vertex), before + u32::from(previous == vertex))
        })
    };
    let overfull = |vertex: u32| {
        let of_source = count(source, source_corners, vertex, target.vertex);
        let of_target = count(target, target_corners, vertex, source.vertex);
        let joined = of_source != (0, 0) && of_target != (0, 0);
        joined && (of_source.0 + of_target.0 > 1 || of_source.1 + of_target.1 > 1)
    };
    let mut around = source.names().flat_map(|(next, previous)| [next, previous]);
    let manifold = around.all(|vertex| vertex == target.vertex || !overfull(vertex));
    manifold.then_some(doomed)
}
