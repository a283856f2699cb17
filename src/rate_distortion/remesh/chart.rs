//! A surface that is refined step by step, from a base of few triangles back to all of its own, and points that
//! ride on it.
//!
//! In the spirit of MAPS (see `unfold.rs`), turned round: MAPS carries the vertices that go onto the base, and then
//! has to look up where a point of the base lies among them. Here nothing is carried down. Points start on the base
//! and are carried up, through the collapses in reverse: each turns the triangles that a vertex left behind back
//! into those around it, and both lie in one plane ([`unfold()`]). So points never leave the surface, and
//! each triangle of it belongs to one place of the base, however thin the limb is that it is on.

use glam::{DVec2, DVec3};

use super::unfold::{unfold, weights};
use crate::hqms::HalfEdge;
use crate::mesh::Mesh;

const NONE: u32 = u32::MAX;

/// A point on the surface: weights of the corners of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foot {
    pub(super) face: u32,
    /// Not negative; their sum is 1.
    pub(super) weights: [f64; 3],
}

/// A surface on which some collapses have been done and not yet undone.
pub(super) struct Chart {
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    is_there: Vec<bool>,
    /// The faces at each vertex; of a vertex that went, those at it when it did.
    around: Vec<Vec<u32>>,
    /// Those that are still to be undone, the last first.
    collapses: Vec<HalfEdge>,
    vertices: usize,
}

/// The vertices around a vertex, counter-clockwise, and the faces between each and the next.
struct Ring {
    vertices: Vec<u32>,
    faces: Vec<u32>,
    is_open: bool,
}

impl Chart {
    /// The surface of `mesh`, whose vertices are all used; or the first vertex with more than one fan of faces.
    pub(super) fn new(mesh: &Mesh) -> Result<Self, u32> {
        let positions: Vec<DVec3> =
            mesh.positions().iter().map(|&position| glam::Vec3::from(position).as_dvec3()).collect();
        let faces = mesh.triangles().to_vec();
        let mut around = vec![Vec::new(); positions.len()];
        for (face, corners) in (0..).zip(&faces) {
            for &corner in corners {
                around[corner as usize].push(face);
            }
        }
        let is_there = vec![true; faces.len()];
        let chart =
            Self { vertices: positions.len(), positions, faces, is_there, around, collapses: Vec::new() };
        match (0..chart.vertices as u32).find(|&vertex| chart.ring(vertex).is_none()) {
            Some(vertex) => Err(vertex),
            None => Ok(chart),
        }
    }

    /// Does a collapse that keeps the topology.
    pub(super) fn collapse(&mut self, collapse: HalfEdge) {
        let HalfEdge { source, target } = collapse;
        for face in self.around[source as usize].clone() {
            let corners = &mut self.faces[face as usize];
            if corners.contains(&target) {
                self.is_there[face as usize] = false;
                for corner in corners.iter().filter(|&&corner| corner != source) {
                    self.around[*corner as usize].retain(|&other| other != face);
                }
            } else {
                replace(corners, source, target);
                self.around[target as usize].push(face);
            }
        }
        self.vertices -= 1;
        self.collapses.push(collapse);
    }

    /// How many vertices there are at the moment.
    pub(super) fn vertices(&self) -> usize {
        self.vertices
    }

    /// The corners of the faces there are at the moment, with their numbers.
    pub(super) fn faces(&self) -> impl Iterator<Item = (u32, [u32; 3])> {
        let there = (0..).zip(&self.faces).zip(&self.is_there).filter(|&(_, &is_there)| is_there);
        there.map(|((face, &corners), _)| (face, corners))
    }

    pub(super) fn corners(&self, face: u32) -> [DVec3; 3] {
        self.faces[face as usize].map(|corner| self.positions[corner as usize])
    }

    pub(super) fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    pub(super) fn point(&self, foot: &Foot) -> DVec3 {
        let [a, b, c] = self.corners(foot.face);
        let [of_a, of_b, of_c] = foot.weights;
        a * of_a + b * of_b + c * of_c
    }

    /// The normal of a face, twice its area long.
    pub(super) fn normal(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a)
    }

    /// The vertices of a face.
    pub(super) fn names(&self, face: u32) -> [u32; 3] {
        self.faces[face as usize]
    }

    /// The faces at a vertex.
    pub(super) fn faces_at(&self, vertex: u32) -> &[u32] {
        &self.around[vertex as usize]
    }

    /// The face on the other side of the edge of `face` opposite its corner `place`.
    pub(super) fn across(&self, face: u32, place: usize) -> Option<u32> {
        let corners = self.faces[face as usize];
        let (a, b) = (corners[(place + 1) % 3], corners[(place + 2) % 3]);
        let beside = |&&other: &&u32| other != face && self.faces[other as usize].contains(&b);
        self.around[a as usize].iter().find(beside).copied()
    }

    /// Undoes collapses until there are at least `vertices` vertices or none is left to undo, and carries `feet`
    /// along.
    pub(super) fn refine(&mut self, vertices: usize, feet: &mut [Foot]) {
        let mut riders = Riders::new(self.faces.len(), feet);
        while self.vertices < vertices
            && let Some(collapse) = self.collapses.pop()
        {
            self.vertices += 1;
            self.undo(collapse, &mut riders, feet);
        }
    }

    fn undo(&mut self, HalfEdge { source, target }: HalfEdge, riders: &mut Riders, feet: &mut [Foot]) {
        let mut carried = Vec::new();
        for face in self.around[source as usize].clone() {
            if self.is_there[face as usize] {
                riders.take(face, |foot| carried.push((foot, self.faces[face as usize])));
                replace(&mut self.faces[face as usize], target, source);
                self.around[target as usize].retain(|&other| other != face);
            } else {
                self.is_there[face as usize] = true;
                for corner in self.faces[face as usize].into_iter().filter(|&corner| corner != source) {
                    self.around[corner as usize].push(face);
                }
            }
        }
        let ring = self.ring(source).expect("a vertex had a ring before it went, as the topology was kept");
        let place_in_ring = |vertex: u32| ring.vertices.iter().position(|&other| other == vertex);
        if let [face] = ring.faces[..] {
            self.grow_ear(face, source, riders, feet);
            return;
        }
        let around: Vec<DVec3> = ring.vertices.iter().map(|&vertex| self.position(vertex)).collect();
        let heir = place_in_ring(target).unwrap_or(0);
        let plane = unfold(self.position(source), &around, ring.is_open, heir);
        for (foot, names) in carried {
            let of = |corner: usize| {
                let place = place_in_ring(names[corner]).map_or(DVec2::ZERO, |index| plane[index]);
                place * feet[foot as usize].weights[corner]
            };
            let place = of(0) + of(1) + of(2);
            let triangles = ring.faces.iter().enumerate();
            let inside = triangles.map(|(i, &face)| {
                let next = (i + 1) % plane.len();
                let weights = weights(place, plane[i], plane[next]);
                (face, [source, ring.vertices[i], ring.vertices[next]], weights)
            });
            let least = |weights: &[f64; 3]| weights[0].min(weights[1]).min(weights[2]);
            let (face, corners, weights) = inside
                .reduce(|best, other| if least(&other.2) > least(&best.2) { other } else { best })
                .unwrap_or((feet[foot as usize].face, names, feet[foot as usize].weights));
            feet[foot as usize] = self.foot(face, corners, weights);
            riders.put(foot, face);
        }
    }

    /// A vertex comes back with one face: what was on the edge that becomes that face's inner one goes to the two
    /// new edges of the border.
    fn grow_ear(&self, face: u32, source: u32, riders: &mut Riders, feet: &mut [Foot]) {
        let Some(place) = self.faces[face as usize].iter().position(|&corner| corner == source) else {
            return;
        };
        let Some(inner) = self.across(face, place) else { return };
        let ends = [1, 2].map(|further| self.faces[face as usize][(place + further) % 3]);
        let [first, second] =
            ends.map(|end| self.faces[inner as usize].iter().position(|&corner| corner == end));
        let (Some(first), Some(second)) = (first, second) else { return };
        let third = 3 - first - second;
        let mut all = Vec::new();
        riders.take(inner, |foot| all.push(foot));
        for foot in all {
            let weights = feet[foot as usize].weights;
            if weights[third] > 0.0 || weights[first] == 0.0 || weights[second] == 0.0 {
                riders.put(foot, inner);
                continue;
            }
            // The middle of the old edge becomes the new vertex.
            let towards = weights[second] - weights[first];
            let weights = [1.0 - towards.abs(), (-towards).max(0.0), towards.max(0.0)];
            feet[foot as usize] = self.foot(face, [source, ends[0], ends[1]], weights);
            riders.put(foot, face);
        }
    }

    /// The foot in `face` with `weights` for `corners`, in whatever order these are, with rounding made good.
    fn foot(&self, face: u32, corners: [u32; 3], weights: [f64; 3]) -> Foot {
        let weights = weights.map(|weight| weight.max(0.0));
        let sum: f64 = weights.iter().sum();
        let of = |name: u32| (0..3).find(|&i| corners[i] == name).map_or(0.0, |i| weights[i] / sum);
        Foot { face, weights: self.faces[face as usize].map(of) }
    }

    /// The ring of a vertex, if it is one.
    fn ring(&self, vertex: u32) -> Option<Ring> {
        let faces = &self.around[vertex as usize];
        let mut links: Vec<(u32, u32, u32)> = Vec::with_capacity(faces.len());
        for &face in faces {
            let corners = self.faces[face as usize];
            let place = corners.iter().position(|&corner| corner == vertex)?;
            links.push((corners[(place + 1) % 3], corners[(place + 2) % 3], face));
        }
        let start = links.iter().position(|&(from, ..)| links.iter().all(|&(_, to, _)| to != from));
        let (mut vertices, mut ordered) =
            (Vec::with_capacity(links.len() + 1), Vec::with_capacity(links.len()));
        let mut index = start.unwrap_or(0);
        loop {
            let (from, to, face) = links.swap_remove(index);
            vertices.push(from);
            ordered.push(face);
            match links.iter().position(|&(from, ..)| from == to) {
                Some(next) => index = next,
                None => {
                    let is_open = start.is_some();
                    if is_open {
                        vertices.push(to);
                    }
                    // What is left over is another fan, or a second face on the same side of an edge.
                    let is_one = links.is_empty() && (is_open || vertices[0] == to);
                    return is_one.then_some(Ring { vertices, faces: ordered, is_open });
                }
            }
        }
    }
}

fn replace(corners: &mut [u32; 3], old: u32, new: u32) {
    for corner in corners.iter_mut().filter(|corner| **corner == old) {
        *corner = new;
    }
}

/// Which feet are in a face: a list for each.
struct Riders {
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Riders {
    fn new(faces: usize, feet: &[Foot]) -> Self {
        let mut riders = Self { first: vec![NONE; faces], next: vec![NONE; feet.len()] };
        for (index, foot) in (0..).zip(feet) {
            riders.put(index, foot.face);
        }
        riders
    }

    fn put(&mut self, foot: u32, face: u32) {
        self.next[foot as usize] = std::mem::replace(&mut self.first[face as usize], foot);
    }

    /// Empties a face.
    fn take(&mut self, face: u32, mut visit: impl FnMut(u32)) {
        let mut foot = std::mem::replace(&mut self.first[face as usize], NONE);
        while foot != NONE {
            visit(foot);
            foot = self.next[foot as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::collapses;
    use super::*;
    use crate::mesh::shapes;
    use crate::monitor::Monitor;

    /// The chart of a mesh, coarse, with points all over it.
    fn ridden(mesh: &Mesh, base_quads: usize) -> (Chart, Vec<Foot>) {
        let mut chart = Chart::new(mesh).unwrap();
        let collapses = collapses(mesh, base_quads, 1, &mut Monitor::silent()).unwrap();
        assert!(!collapses.is_empty());
        collapses.into_iter().for_each(|collapse| chart.collapse(collapse));
        let steps = (0..=20).flat_map(|i| (0..=20 - i).map(move |j| [i, j, 20 - i - j]));
        let weights = steps.map(|steps| steps.map(|step| f64::from(step) / 20.0));
        let of = |face| weights.clone().map(move |weights| Foot { face, weights });
        let feet = chart.faces().flat_map(|(face, _)| of(face)).collect();
        (chart, feet)
    }

    #[test]
    fn where_all_is_flat_nothing_moves() {
        let sheet = shapes::plane(6);
        let (mut chart, mut feet) = ridden(&sheet, 8);
        let before: Vec<DVec3> = feet.iter().map(|foot| chart.point(foot)).collect();
        chart.refine(usize::MAX, &mut feet);
        assert!(chart.faces().eq((0..).zip(sheet.triangles().iter().copied())));
        for (foot, before) in feet.iter().zip(before) {
            assert!(chart.point(foot).distance(before) < 1e-9, "{before} {}", chart.point(foot));
        }
    }

    #[test]
    fn all_of_the_surface_is_ridden_to() {
        let stone = shapes::bumpy_sphere(6, 1);
        let (mut chart, mut feet) = ridden(&stone, 40);
        let vertices = chart.vertices();
        for more in [2 * vertices, usize::MAX] {
            chart.refine(more, &mut feet);
            let mut reached = vec![false; stone.triangles().len()];
            for foot in &feet {
                assert!(foot.weights.iter().all(|&weight| weight >= 0.0));
                assert!((foot.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                reached[foot.face as usize] = true;
            }
            assert!(chart.faces().all(|(face, _)| reached[face as usize]));
        }
        assert_eq!(chart.vertices(), stone.positions().len());
    }

    #[test]
    fn vertices_with_two_fans_are_found() {
        let positions = (0..5).map(|i| [i as f32, (i * i) as f32, 0.0]).collect();
        let tie = Mesh::new(positions, vec![[0, 1, 2], [2, 3, 4]]).unwrap();
        assert_eq!(Chart::new(&tie).err(), Some(2));
    }
}
