//! The mesh while half-edges are collapsed, and what each vertex would do next.

use glam::Vec3A;

use super::corners::{Corners, is_alive, neighbours};
use super::cost::{Bends, Cost};
use super::fan::Fan;
use crate::collapse::surface::unit_scale;
use crate::mesh::Mesh;
use crate::mesh::topology::is_face;
use crate::mesh::weld::seams;

/// What is known about a vertex: bits of [`State::flags`].
pub(super) mod flag {
    /// The choice is not what it would be now.
    pub(crate) const DIRTY: u8 = 1;
    /// Gone.
    pub(crate) const DEAD: u8 = 2;
    /// Left out of the selection, as there was no legal choice.
    pub(crate) const OUT: u8 = 4;
    /// Must stay.
    pub(crate) const LOCKED: u8 = 8;
}

/// Where a vertex would go, and at what cost: infinite if nowhere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    pub(super) cost: f32,
    pub(super) target: u32,
}

const NOWHERE: Choice = Choice { cost: f32::INFINITY, target: u32::MAX };

pub(super) struct State {
    /// Positions, scaled to edges of about 1.
    points: Vec<Vec3A>,
    /// The input's normals, of unit length; zero where it has none.
    facing: Vec<Vec3A>,
    pub(super) faces: Vec<[u32; 3]>,
    /// Faces that live.
    pub(super) alive: usize,
    corners: Corners,
    pub(super) flags: Vec<u8>,
    pub(super) choices: Vec<Choice>,
    pub(super) evaluations: usize,
    cost: Cost,
    fan: Fan,
    bends: Bends,
    costs: Vec<f32>,
    around_target: Vec<u32>,
}

/// For each vertex the mean of its faces' normals, weighted by their areas.
fn normals(points: &[Vec3A], faces: &[[u32; 3]]) -> Vec<Vec3A> {
    let mut normals = vec![Vec3A::ZERO; points.len()];
    for face in faces {
        let [a, b, c] = face.map(|vertex| points[vertex as usize]);
        let cross = (b - a).cross(c - a);
        face.iter().for_each(|&vertex| normals[vertex as usize] += cross);
    }
    normals.iter_mut().for_each(|normal| *normal = normal.normalize_or_zero());
    normals
}

impl State {
    /// A state in which no vertex has made its choice yet.
    pub(super) fn new(mesh: &Mesh, cost: Cost) -> Self {
        let scale = unit_scale(mesh);
        let vertices = mesh.positions().len();
        let faces: Vec<[u32; 3]> = mesh.triangles().iter().copied().filter(is_face).collect();
        let mut flags = vec![flag::DIRTY; vertices];
        seams(mesh).into_iter().for_each(|vertex| flags[vertex as usize] |= flag::LOCKED);
        let points: Vec<Vec3A> = mesh.positions().iter().map(|&point| Vec3A::from(point) * scale).collect();
        Self {
            facing: normals(&points, &faces),
            points,
            alive: faces.len(),
            corners: Corners::new(vertices, &faces),
            faces,
            flags,
            choices: vec![NOWHERE; vertices],
            evaluations: 0,
            cost,
            fan: Fan::default(),
            bends: Bends::default(),
            costs: Vec::new(),
            around_target: Vec::new(),
        }
    }

    /// Lets every vertex make its choice.
    pub(super) fn choose_all(&mut self) {
        (0..self.choices.len() as u32).for_each(|vertex| self.bring_up_to_date(vertex));
    }

    /// Renews the choice of `vertex`, if something around it has changed. Whether it keeps the topology is
    /// looked at when it is executed: that takes longer, and mostly it does.
    pub(super) fn bring_up_to_date(&mut self, vertex: u32) {
        if self.flags[vertex as usize] & flag::DIRTY != 0 {
            self.flags[vertex as usize] &= !flag::DIRTY;
            self.choose(vertex, false);
        }
    }

    /// Replaces a choice that does not keep the topology by the cheapest one that does.
    pub(super) fn choose_again(&mut self, vertex: u32) {
        self.choose(vertex, true);
    }

    fn gather(&mut self, vertex: u32) -> bool {
        self.fan.gather(vertex, &self.corners, &self.faces, &self.points)
    }

    fn choose(&mut self, vertex: u32, keeping_topology: bool) {
        self.choices[vertex as usize] = NOWHERE;
        if self.flags[vertex as usize] & flag::LOCKED != 0 || !self.gather(vertex) {
            return;
        }
        self.evaluations += 1;
        let mut costs = std::mem::take(&mut self.costs);
        self.cost.of_all(&self.fan, &mut self.bends, &mut costs);
        loop {
            let order = |&place: &usize| (costs[place].to_bits(), self.fan.rim[place]);
            let cheapest = (0..costs.len()).min_by_key(order);
            let Some(place) = cheapest.filter(|&place| costs[place] < f32::INFINITY) else { break };
            if !self.fan.folds(vertex, place, &self.facing)
                && (!keeping_topology || self.links_allow(vertex, place))
            {
                self.choices[vertex as usize] = Choice { cost: costs[place], target: self.fan.rim[place] };
                break;
            }
            costs[place] = f32::INFINITY;
        }
        self.costs = costs;
    }

    /// The link condition for the gathered fan of `vertex` and its neighbour `place`: both have the corners
    /// opposite the edge in common, and no other neighbour; no inner edge joins two borders, and nothing
    /// vanishes whole.
    fn links_allow(&mut self, vertex: u32, place: usize) -> bool {
        let target = self.fan.rim[place];
        let Some(of_target) = self.corners.of(target) else { return false };
        let around = &mut self.around_target;
        around.clear();
        let mut shared = 0;
        for &corner in of_target {
            let (next, previous) = neighbours(&self.faces, corner);
            shared += usize::from(next == vertex || previous == vertex);
            // There are few: to look through them is faster than to sort them.
            for neighbour in [next, previous] {
                if !around.contains(&neighbour) {
                    around.push(neighbour);
                }
            }
        }
        let rim = self.fan.neighbours();
        let common = rim.iter().filter(|vertex| around.contains(vertex)).count();
        let beside = self.fan.beside(place).iter().flatten().count();
        // Both counts have the other end in them.
        let others = (rim.len() - 1) + (around.len() - 1) - common;
        // In a fan of three faces the one that is not beside the edge may come to lie on one of the target's.
        let joins_faces = self.fan.closed && self.fan.faces() == 3 && {
            let opposite = [self.fan.rim[(place + 1) % 3], self.fan.rim[(place + 2) % 3]];
            of_target.iter().any(|&corner| {
                let (next, previous) = neighbours(&self.faces, corner);
                opposite.contains(&next) && opposite.contains(&previous)
            })
        };
        shared == beside && common == shared && others > shared && !joins_faces
    }

    /// Executes the choice of `vertex`, if it keeps the topology: where it went. `touched` is filled with
    /// the vertices whose surroundings have changed, each once.
    pub(super) fn collapse(&mut self, vertex: u32, touched: &mut Vec<u32>) -> Option<u32> {
        let target = self.choices[vertex as usize].target;
        let gathered = self.gather(vertex);
        let place = self.fan.rim.iter().position(|&neighbour| neighbour == target);
        let place = place.filter(|_| gathered)?;
        if !self.links_allow(vertex, place) {
            return None;
        }
        let around = &self.around_target;
        touched.clear();
        touched.extend(around.iter().filter(|&&other| other != vertex));
        touched.extend(self.fan.neighbours().iter().filter(|other| !around.contains(other)));
        for &corner in self.corners.of(vertex)? {
            let (next, previous) = neighbours(&self.faces, corner);
            let face = &mut self.faces[(corner >> 2) as usize];
            if next == target || previous == target {
                face[1] = face[0];
                self.alive -= 1;
            } else {
                face[(corner & 3) as usize] = target;
            }
        }
        for face in self.fan.beside(place).into_iter().flatten() {
            let [a, b] = [self.fan.rim[face], self.fan.rim[face + 1]];
            self.corners.lose_face(if a == target { b } else { a }, &self.faces);
        }
        self.corners.merge(vertex, target, &self.faces);
        self.flags[vertex as usize] |= flag::DEAD;
        Some(target)
    }

    /// The faces that live, in the order they had in the input.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        self.faces.iter().copied().filter(is_alive).collect()
    }
}
