//! The end of a run: a heap of exact costs over what little is left.
//!
//! Where few triangles remain, each collapse matters and the cost at the neighbour is too crude.
//! Here every edge costs what its optimal placement costs (equation 5 of the paper, solved for each
//! edge), quadrics come from the faces as they are at that moment (memoryless, as in Lindstrom and
//! Turk), and a queue of vertices gives the globally cheapest edge each time. About 5 µs a collapse,
//! ten times a pass: so it begins near the target only.
//!
//! This is also where a run ends that is stuck: with [`Rules::any_topology`] the link condition no
//! longer holds, holes close, and small components vanish whole.

mod candidates;
mod names;
mod relax;

use super::goal::Goal;
use crate::collapse::half_edge::{self, Terms};
use crate::collapse::queue::Queue;
use crate::collapse::ring::Ring;
use crate::collapse::surface::{NONE, Surface, flag, is_alive, is_open, neighbours};
use crate::collapse::tile::blend_attributes;
use crate::collapse::{Collapse, Counts, Edge, HalfEdge, Rules};
use crate::monitor::Cancelled;
use crate::quadric::Quadric;
use candidates::{Candidate, FREE, IMPOSSIBLE};
use glam::Vec3A;
use std::sync::atomic::Ordering::Relaxed;

/// A vertex with more faces is a hub, and waits until its neighbours have gone: to update it at each
/// collapse around it would take time quadratic in its size.
const MAX_DEGREE: u32 = 512;
/// Collapses between two looks at the monitor.
const BATCH: usize = 1024;

/// What became of an attempt.
enum Outcome {
    Done,
    /// The rules do not allow it.
    Illegal,
    /// It costs this, which is more than it was thought to.
    Dearer(f32),
}

/// A surface with rings that follow each collapse, and the queue of its vertices.
pub(crate) struct Finish<'a> {
    surface: &'a mut Surface,
    rules: &'a Rules,
    /// The first corner of each vertex, as `face << 2 | corner`, and for each corner the next one
    /// of its vertex: rings as linked lists, which join in no time.
    first: Vec<u32>,
    next: Vec<u32>,
    /// How many faces each vertex has.
    degrees: Vec<u32>,
    quadrics: Vec<Quadric>,
    candidates: Vec<Candidate>,
    queue: Queue,
    /// Whether what is known about a vertex is to be renewed before it is collapsed.
    stale: Vec<bool>,
    /// The collapse in which a vertex was last among those whose quadrics changed.
    changed: Vec<u32>,
    stamp: u32,
    counts: Counts,
    scratch: Scratch,
    /// The vertex whose ring `scratch.source` is, with its corners, if nothing has changed since it was gathered.
    gathered: Option<u32>,
    around: Vec<u32>,
}

#[derive(Default)]
struct Scratch {
    source: Ring,
    target: Ring,
    /// With the corners of the source.
    half_edge: half_edge::Scratch,
    target_corners: Vec<u32>,
    neighbours: [Vec<u32>; 2],
}

impl<'a> Finish<'a> {
    /// Takes over a surface whose dead have left its faces, and which has `counts`.
    pub(crate) fn new(surface: &'a mut Surface, counts: Counts, rules: &'a Rules) -> Self {
        let vertices = surface.points.len();
        let mut first = vec![NONE; vertices];
        let mut next = vec![NONE; 4 * surface.faces.len()];
        let mut degrees = vec![0; vertices];
        // Backwards, so that the lists are in face order.
        for (index, face) in surface.faces.iter().enumerate().rev() {
            for (corner, vertex) in face.iter().enumerate() {
                let name = index << 2 | corner;
                let vertex = vertex.load(Relaxed) as usize;
                next[name] = std::mem::replace(&mut first[vertex], name as u32);
                degrees[vertex] += 1;
            }
        }
        let mut finish = Self {
            surface,
            rules,
            first,
            next,
            degrees,
            quadrics: vec![Quadric::default(); vertices],
            candidates: vec![IMPOSSIBLE; vertices],
            queue: Queue::new(vertices),
            stale: vec![false; vertices],
            changed: vec![0; vertices],
            stamp: 0,
            counts,
            scratch: Scratch::default(),
            gathered: None,
            around: Vec::new(),
        };
        for vertex in 0..vertices as u32 {
            if !finish.renew(vertex) {
                finish.bury(vertex);
            }
        }
        for vertex in 0..vertices as u32 {
            finish.choose(vertex, None);
        }
        finish
    }

    /// Collapses edges until the goal is met or nothing is left that the rules allow; what the
    /// surface then has. It is to be compacted afterwards.
    pub(crate) fn run(
        mut self,
        goal: Goal,
        report: &mut dyn FnMut(Counts) -> Result<(), Cancelled>,
    ) -> Result<Counts, Cancelled> {
        loop {
            self.empty_queue(goal, report)?;
            if !self.settle_hubs() {
                self.renew_flags();
                return Ok(self.counts);
            }
        }
    }

    /// Brings up to date what passes to come want to know of the vertices whose rings have changed, and which
    /// did not come up again. Only where the topology is given up do borders come and go.
    fn renew_flags(&mut self) {
        if !self.rules.half_edge || !self.rules.any_topology {
            return;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        for vertex in 0..self.stale.len() as u32 {
            if self.stale[vertex as usize] {
                self.gather_source(vertex, &mut scratch);
                self.flags_of(&scratch.source);
            }
        }
        self.scratch = scratch;
    }

    fn empty_queue(
        &mut self,
        goal: Goal,
        report: &mut dyn FnMut(Counts) -> Result<(), Cancelled>,
    ) -> Result<(), Cancelled> {
        let mut collapses = 0;
        let mut around = Vec::new();
        while goal.excess(self.counts) > 0
            && let Some((_, vertex)) = self.queue.first()
        {
            if std::mem::take(&mut self.stale[vertex as usize]) {
                self.choose(vertex, None);
                continue;
            }
            let candidate = self.candidates[vertex as usize];
            match self.try_collapse(vertex, candidate.partner, goal) {
                Outcome::Done => {
                    collapses += 1;
                    if collapses % BATCH == 0 {
                        report(self.counts)?;
                    }
                }
                Outcome::Illegal => self.choose(vertex, Some(candidate)),
                Outcome::Dearer(cost) => {
                    let other = self.cheapest(vertex, Some(candidate), &mut around);
                    let dearer = Candidate { cost, ..candidate };
                    self.set(vertex, if dearer.order() < other.order() { dearer } else { other });
                }
            }
        }
        Ok(())
    }

    /// What decides where vertices go. What gives up the topology gives up seams as well, but does not
    /// open them.
    fn terms(&self) -> Terms<'_> {
        let terms = self.surface.terms();
        Terms { cross_seams: terms.cross_seams || self.rules.any_topology, ..terms }
    }

    fn is_hub(&self, vertex: u32) -> bool {
        self.degrees[vertex as usize] > MAX_DEGREE
    }

    /// Does at the hubs what was put off; whether any of them was split.
    fn settle_hubs(&mut self) -> bool {
        let mut hubs: Vec<u32> =
            (0..self.degrees.len() as u32).filter(|&vertex| self.is_hub(vertex)).collect();
        let count = hubs.len();
        if self.rules.any_topology {
            for index in 0..count {
                self.split_fans(hubs[index], &mut hubs);
            }
        }
        for &hub in &hubs {
            self.renew(hub);
        }
        let is_split = hubs.len() > count;
        if is_split {
            self.update(&hubs);
        }
        is_split
    }

    /// Gathers the ring of `vertex` but for its quadric, and the corners it consists of. Faces that have died
    /// leave the list. Whether the ring is a border's is decided anew, as holes close and open here.
    fn gather(&mut self, vertex: u32, ring: &mut Ring, corners: &mut Vec<u32>) {
        corners.clear();
        let (mut corner, mut last) = (self.first[vertex as usize], NONE);
        while corner != NONE {
            let after = self.next[corner as usize];
            if is_alive(&self.surface.faces[(corner >> 2) as usize]) {
                corners.push(corner);
                last = corner;
            } else if last == NONE {
                self.first[vertex as usize] = after;
            } else {
                self.next[last as usize] = after;
            }
            corner = after;
        }
        let boundary = is_open(&self.surface.faces, corners.iter().copied());
        let origin = self.position(vertex);
        let mut gathering = ring.begin(corners.len());
        for &corner in &*corners {
            let names = neighbours(&self.surface.faces, corner);
            gathering.push(names, self.position(names.0) - origin, self.position(names.1) - origin);
        }
        let count = gathering.count();
        ring.complete_names(vertex, boundary, count);
    }

    /// Gathers the ring of `vertex` as the source of `scratch`, if it is not there as it is.
    fn gather_source(&mut self, vertex: u32, scratch: &mut Scratch) {
        if self.gathered != Some(vertex) {
            self.gather(vertex, &mut scratch.source, &mut scratch.half_edge.wedges.corners);
            scratch.source.complete_quadric();
            self.gathered = Some(vertex);
        }
    }

    /// Gathers the rings of both ends of an edge. Where vertices move their quadrics are known, and where they stay
    /// nobody asks for that of the target.
    fn gather_ends(&mut self, [source, target]: [u32; 2], scratch: &mut Scratch) {
        if self.rules.half_edge {
            self.gather_source(source, scratch);
        } else if self.gathered != Some(source) {
            self.gather(source, &mut scratch.source, &mut scratch.half_edge.wedges.corners);
            scratch.source.quadric = self.quadrics[source as usize];
            self.gathered = Some(source);
        }
        self.gather(target, &mut scratch.target, &mut scratch.target_corners);
        scratch.target.quadric = self.quadrics[target as usize];
    }

    fn position(&self, vertex: u32) -> Vec3A {
        Vec3A::from_vec4(self.surface.points[vertex as usize])
    }

    /// Renews what others look at of a vertex whose ring has changed; `false` if no face is left. Where vertices
    /// stay, that is nothing: a vertex gathers what it needs when its own cost is asked for.
    fn renew(&mut self, vertex: u32) -> bool {
        if self.rules.half_edge {
            return self.degrees[vertex as usize] > 0;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        self.gather_source(vertex, &mut scratch);
        let ring = &scratch.source;
        self.flags_of(ring);
        self.quadrics[vertex as usize] = ring.quadric;
        let alive = ring.count() > 0;
        self.scratch = scratch;
        alive
    }

    fn is_locked(&self, vertex: u32) -> bool {
        self.surface.flags[vertex as usize] & flag::LOCKED != 0
    }

    /// The flags of a ring's vertex, brought up to date.
    fn flags_of(&mut self, ring: &Ring) -> u8 {
        let flags = &mut self.surface.flags[ring.vertex as usize];
        *flags = *flags & !flag::BOUNDARY | if ring.boundary { flag::BOUNDARY } else { 0 };
        *flags
    }

    /// Collapses the edge, if the rules allow it and the goal is not overshot (but for one triangle,
    /// where there must be two), and brings all around up to date.
    fn try_collapse(&mut self, vertex: u32, partner: u32, goal: Goal) -> Outcome {
        if self.is_hub(vertex) || self.is_hub(partner) {
            return Outcome::Illegal;
        }
        let ends = if self.is_locked(vertex) { [partner, vertex] } else { [vertex, partner] };
        let price = self.candidates[vertex as usize].cost;
        let mut around = std::mem::take(&mut self.around);
        self.gather_neighbours(vertex, &mut around);
        let may_join = self.may_join(vertex, &around, partner);
        self.around = around;
        if !may_join {
            return Outcome::Illegal;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        self.gather_ends(ends, &mut scratch);
        let outcome = self.collapse_gathered(ends, price, goal, &mut scratch);
        let Outcome::Done = outcome else {
            self.scratch = scratch;
            return outcome;
        };
        let around = &mut scratch.neighbours[0];
        around.clear();
        for ring in [&scratch.source, &scratch.target] {
            around.extend(ring.names().flat_map(|(next, previous)| [next, previous]));
        }
        around.retain(|&vertex| vertex != ends[0]);
        around.push(ends[1]);
        around.sort_unstable();
        around.dedup();
        let mut around = std::mem::take(around);
        self.scratch = scratch;

        self.set(ends[0], IMPOSSIBLE);
        if self.rules.half_edge && !self.rules.any_topology {
            // No vertex is left without a face, and nothing else is to be known before it comes up.
            self.update(&around);
            self.scratch.neighbours[0] = around;
            return Outcome::Done;
        }
        if self.rules.any_topology {
            for index in 0..around.len() {
                if !self.is_hub(around[index]) {
                    self.split_fans(around[index], &mut around);
                }
            }
        }
        around.retain(|&vertex| {
            let alive = self.is_hub(vertex) || self.renew(vertex);
            if !alive {
                self.bury(vertex);
            }
            alive
        });
        self.update(&around);
        self.scratch.neighbours[0] = around;
        Outcome::Done
    }

    fn collapse_gathered(
        &mut self,
        [source, target]: [u32; 2],
        price: f32,
        goal: Goal,
        scratch: &mut Scratch,
    ) -> Outcome {
        let Scratch { source: source_ring, target: target_ring, half_edge, target_corners, neighbours } =
            scratch;
        let edge = Edge {
            source: source_ring,
            target: target_ring,
            source_point: self.surface.points[source as usize],
            target_point: self.surface.points[target as usize],
            target_locked: self.is_locked(target),
        };
        let mut doomed = Vec::new();
        if self.rules.any_topology {
            match relax::coincident(source_ring, target_ring, &half_edge.wedges.corners, target_corners) {
                Some(faces) => doomed = faces,
                None => return Outcome::Illegal,
            }
        }
        let Some(collapse) = edge.collapse(self.rules, neighbours) else { return Outcome::Illegal };
        // What gives up the topology has folds of its own to close.
        if !self.rules.any_topology && edge.buckles(&collapse) {
            return Outcome::Illegal;
        }
        if self.rules.any_topology {
            let corners = [&half_edge.wedges.corners[..], target_corners];
            if self.lays_bare(source_ring, target_ring, corners, &doomed) {
                return Outcome::Illegal;
            }
        }
        let (after, before) = source_ring.occurrences(target);
        let faces = (after + before) as usize + doomed.len();
        if matches!(goal, Goal::Faces(_)) && faces > goal.excess(self.counts) + 1 {
            return Outcome::Illegal;
        }
        let own_flags = self.surface.flags[source as usize];
        let terms = self.terms();
        let is_plain = !self.rules.half_edge || terms.are_none();
        let edge = self.position(target) - self.position(source);
        let error = if is_plain {
            0.0
        } else {
            match terms.settle(source_ring, own_flags, target, edge, half_edge) {
                Some(error) => error,
                None => return Outcome::Illegal,
            }
        };
        let loss = self.loss(&doomed, Vec3A::from_vec4(collapse.point), [source, target]);
        if loss > price {
            return Outcome::Dearer(loss);
        }
        let is_counted = matches!(goal, Goal::Vertices(_)) && !self.surface.wedges.is_empty();
        let losing =
            if is_counted { self.losing_names([source, target], source_ring, &doomed) } else { Vec::new() };
        let names_before = self.count_names(&losing);
        for face in doomed {
            self.kill(face);
        }
        self.execute(source, target, &collapse, &half_edge.wedges.corners);
        if !is_plain {
            self.execute_wedges(source, target, error, half_edge);
        }
        let vertices = if losing.is_empty() { 1 } else { names_before - self.count_names(&losing) };
        self.counts.remove(Counts { faces, vertices });
        Outcome::Done
    }

    fn kill(&mut self, face: u32) {
        let face = &self.surface.faces[face as usize];
        for corner in face {
            self.degrees[corner.load(Relaxed) as usize] -= 1;
        }
        face[1].store(face[0].load(Relaxed), Relaxed);
    }

    fn execute(&mut self, source: u32, target: u32, collapse: &Collapse, source_corners: &[u32]) {
        let (from, into) = (source as usize, target as usize);
        for &corner in source_corners {
            let face = &self.surface.faces[(corner >> 2) as usize];
            if !is_alive(face) {
                continue;
            }
            let (next, previous) = neighbours(&self.surface.faces, corner);
            if next == target || previous == target {
                self.kill(corner >> 2);
            } else {
                face[(corner & 3) as usize].store(target, Relaxed);
                self.next[corner as usize] = std::mem::replace(&mut self.first[into], corner);
                self.degrees[into] += 1;
            }
        }
        self.gathered = None;
        self.first[from] = NONE;
        self.degrees[from] = 0;
        let surface = &mut *self.surface;
        if let (true, Some(sources)) = (surface.wedges.is_empty(), &surface.sources) {
            let done = HalfEdge { source: sources[from], target: sources[into] };
            surface.collapses.iter_mut().for_each(|collapses| collapses.push(done));
        }
        surface.points[into] = collapse.point;
        surface.flags[from] |= flag::DEAD;
        if let Some(merged) = surface.merged.get_mut(from) {
            *merged = target;
        }
        let attributes = &mut surface.attributes;
        blend_attributes(
            attributes.normals.as_deref_mut().unwrap_or_default(),
            attributes.colors.as_deref_mut().unwrap_or_default(),
            attributes.uvs.as_deref_mut().unwrap_or_default(),
            [from, into],
            collapse.along,
        );
    }

    /// Takes a vertex without faces off the surface.
    fn bury(&mut self, vertex: u32) {
        let flags = &mut self.surface.flags[vertex as usize];
        // Where there are wedges, their names have been counted as they went.
        let counts = self.surface.wedges.is_empty() && *flags & flag::DEAD == 0;
        self.counts.vertices -= usize::from(counts);
        *flags |= flag::DEAD;
        if let Some(merged) = self.surface.merged.get_mut(vertex as usize) {
            *merged = NONE;
        }
        self.set(vertex, IMPOSSIBLE);
    }

    /// Renews the candidates after the rings of `around` have changed: theirs, and those of the
    /// vertices beyond whose cheapest edge led here or should now. Where vertices stay, nothing beyond has
    /// changed, and costs mostly rise: they are renewed when they come up.
    fn update(&mut self, around: &[u32]) {
        if self.rules.half_edge {
            for &vertex in around {
                self.stale[vertex as usize] = true;
                // What had nowhere to go may have now.
                if self.candidates[vertex as usize] == IMPOSSIBLE && !self.is_locked(vertex) {
                    self.set(vertex, FREE);
                }
            }
            return;
        }
        self.stamp += 1;
        for &vertex in around {
            self.changed[vertex as usize] = self.stamp;
        }
        let mut ring = Vec::new();
        let mut beyond = Vec::new();
        for &vertex in around {
            self.gather_neighbours(vertex, &mut ring);
            let best = self.cheapest_edge(vertex, &ring, None, |candidate| {
                if self.changed[candidate.partner as usize] != self.stamp {
                    beyond.push((candidate.partner, Candidate { partner: vertex, ..candidate }));
                }
            });
            self.set(vertex, best);
        }
        for (outer, candidate) in beyond {
            let partner = self.candidates[outer as usize].partner;
            let led_here = partner != NONE
                && (self.changed[partner as usize] == self.stamp
                    || self.surface.flags[partner as usize] & flag::DEAD != 0);
            if led_here {
                self.choose(outer, None);
            } else if candidate.order() < self.candidates[outer as usize].order() {
                self.set(outer, candidate);
            }
        }
    }
}
