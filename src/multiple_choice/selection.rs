//! Which vertex goes next.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::num::NonZeroU32;

use super::state::{State, flag};
use crate::collapse::queue::Queue;
use crate::random::SplitMix64;

/// How the next vertex is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selection {
    /// The paper's (section 3.3): the cheapest of a few drawn at random.
    MultipleChoice {
        /// How many are drawn; the paper's is 6.
        candidates: NonZeroU32,
        /// Where the generator starts: the same seed draws the same vertices on every machine.
        seed: u64,
    },
    /// The cheapest of all by what was last known, in a heap whose entries are brought up to date only when
    /// they come up: a vertex that has become cheaper waits until its old cost is reached.
    LazyHeap,
    /// The cheapest of all. Each vertex that a collapse has changed is evaluated, and moved in the heap, at
    /// once: what programs by Garland and Heckbert's and by Melax's papers do, and what this paper compares
    /// with.
    EagerHeap,
}

const SIX: NonZeroU32 = NonZeroU32::new(6).unwrap();

impl Default for Selection {
    fn default() -> Self {
        Self::MultipleChoice { candidates: SIX, seed: 0 }
    }
}

/// A [`Selection`] under way.
pub(super) enum Order {
    Drawn { vertices: Vec<u32>, candidates: NonZeroU32, generator: SplitMix64 },
    Lazy(BinaryHeap<Reverse<(u32, u32)>>),
    Eager(Queue),
}

impl Order {
    /// Over all vertices of `state` that can go anywhere.
    pub(super) fn new(selection: Selection, state: &mut State) -> Self {
        let mut able = Vec::new();
        for vertex in 0..state.choices.len() as u32 {
            if state.choices[vertex as usize].cost < f32::INFINITY {
                able.push(vertex);
            } else {
                state.flags[vertex as usize] |= flag::OUT;
            }
        }
        match selection {
            Selection::MultipleChoice { candidates, seed } => {
                Self::Drawn { vertices: able, candidates, generator: SplitMix64::at(seed, 0) }
            }
            Selection::LazyHeap => {
                let key = |vertex: u32| Reverse((state.choices[vertex as usize].cost.to_bits(), vertex));
                Self::Lazy(able.into_iter().map(key).collect())
            }
            Selection::EagerHeap => {
                let mut queue = Queue::new(state.choices.len());
                able.into_iter().for_each(|vertex| queue.set(vertex, state.choices[vertex as usize].cost));
                Self::Eager(queue)
            }
        }
    }

    /// The next vertex, its choice up to date and possible; `None` when there is none.
    pub(super) fn next(&mut self, state: &mut State) -> Option<u32> {
        match self {
            Self::Drawn { vertices, candidates, generator } => draw(vertices, *candidates, generator, state),
            Self::Lazy(heap) => pop(heap, state),
            Self::Eager(queue) => {
                let (_, vertex) = queue.first()?;
                queue.set(vertex, f32::INFINITY);
                Some(vertex)
            }
        }
    }

    /// Takes a vertex whose choice was not legal, and has been replaced by another.
    pub(super) fn put_back(&mut self, vertex: u32, state: &mut State) {
        match self {
            // Drawn vertices stay where they are, and leave when they are drawn.
            Self::Drawn { .. } => {}
            Self::Lazy(heap) => push(heap, vertex, state),
            Self::Eager(queue) => queue.set(vertex, state.choices[vertex as usize].cost),
        }
    }

    /// Takes note that the surroundings of `vertex` have changed. One that was left out is let in again: it
    /// may be able to go somewhere by now. Locked ones never are, and would only be drawn in vain.
    pub(super) fn follow(&mut self, vertex: u32, state: &mut State) {
        let flags = &mut state.flags[vertex as usize];
        if *flags & flag::LOCKED != 0 {
            return;
        }
        let was_out = *flags & flag::OUT != 0;
        *flags = (*flags | flag::DIRTY) & !flag::OUT;
        match self {
            Self::Drawn { vertices, .. } if was_out => vertices.push(vertex),
            Self::Lazy(heap) if was_out => heap.push(Reverse((0, vertex))),
            Self::Drawn { .. } | Self::Lazy(_) => {}
            Self::Eager(queue) => {
                state.bring_up_to_date(vertex);
                queue.set(vertex, state.choices[vertex as usize].cost);
            }
        }
    }
}

fn draw(
    vertices: &mut Vec<u32>,
    candidates: NonZeroU32,
    generator: &mut SplitMix64,
    state: &mut State,
) -> Option<u32> {
    loop {
        let mut best: Option<(f32, u32)> = None;
        let mut drawn = 0;
        while drawn < candidates.get() && !vertices.is_empty() {
            let index = generator.below(vertices.len());
            let vertex = vertices[index];
            if state.flags[vertex as usize] & flag::DEAD != 0 {
                vertices.swap_remove(index);
                continue;
            }
            state.bring_up_to_date(vertex);
            let cost = state.choices[vertex as usize].cost;
            drawn += 1;
            if cost == f32::INFINITY {
                vertices.swap_remove(index);
                state.flags[vertex as usize] |= flag::OUT;
            } else if best.is_none_or(|best| cost < best.0) {
                best = Some((cost, vertex));
            }
        }
        if best.is_some() || vertices.is_empty() {
            return best.map(|(_, vertex)| vertex);
        }
    }
}

fn pop(heap: &mut BinaryHeap<Reverse<(u32, u32)>>, state: &mut State) -> Option<u32> {
    loop {
        let Reverse((known, vertex)) = heap.pop()?;
        if state.flags[vertex as usize] & flag::DEAD != 0 {
            continue;
        }
        state.bring_up_to_date(vertex);
        if state.choices[vertex as usize].cost.to_bits() <= known {
            return Some(vertex);
        }
        push(heap, vertex, state);
    }
}

/// Costs are not negative, so their bits order as they do.
fn push(heap: &mut BinaryHeap<Reverse<(u32, u32)>>, vertex: u32, state: &mut State) {
    let cost = state.choices[vertex as usize].cost;
    if cost == f32::INFINITY {
        state.flags[vertex as usize] |= flag::OUT;
    } else {
        heap.push(Reverse((cost.to_bits(), vertex)));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{Cost, Decimation, HalfEdge};
    use super::*;
    use crate::mesh::{Mesh, shapes};
    use crate::monitor::Monitor;

    /// What is left to go, and its cost: the legal collapse that is cheapest, by a look at all of them.
    fn cheapest(state: &mut State) -> Option<HalfEdge> {
        let (choices, evaluations) = (state.choices.clone(), state.evaluations);
        let mut best: Option<(f32, HalfEdge)> = None;
        for source in 0..choices.len() as u32 {
            if state.flags[source as usize] & flag::DEAD == 0 {
                state.choose_again(source);
                let choice = state.choices[source as usize];
                if choice.cost < best.map_or(f32::INFINITY, |best| best.0) {
                    best = Some((choice.cost, HalfEdge { source, target: choice.target }));
                }
            }
        }
        (state.choices, state.evaluations) = (choices, evaluations);
        best.map(|(_, collapse)| collapse)
    }

    /// One collapse more, if there is one.
    fn step(decimation: &mut Decimation) -> Option<HalfEdge> {
        let before = decimation.collapses.len();
        let triangles = decimation.state.alive.saturating_sub(1);
        decimation.reduce_to(triangles, &mut Monitor::silent()).unwrap();
        decimation.collapses.get(before).copied()
    }

    fn jittered(shape: usize, jitter: &[[f32; 3]]) -> Mesh {
        let shape =
            [shapes::sphere(2), shapes::torus(6, 5), shapes::plane(5), shapes::cube(2)][shape].clone();
        let (mut positions, triangles, _) = shape.into_parts();
        for (position, offset) in positions.iter_mut().zip(jitter.iter().cycle()) {
            (0..3).for_each(|axis| position[axis] += offset[axis]);
        }
        Mesh::new(positions, triangles).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn heaps_take_the_cheapest(
            shape in 0usize..4,
            jitter in prop::collection::vec([-0.1f32..0.1, -0.1f32..0.1, -0.1f32..0.1], 1..40),
            cost in prop::sample::select(&[Cost::Visual, Cost::Melax, Cost::Quadric][..]),
            locked in prop::collection::vec(0u32..20, 0..6),
        ) {
            let mesh = jittered(shape, &jitter);
            let begin = |selection| Decimation::with_locked(&mesh, cost, selection, &locked).unwrap();
            let mut eager = begin(Selection::EagerHeap);
            loop {
                let expected = cheapest(&mut eager.state);
                prop_assert_eq!(step(&mut eager), expected);
                if expected.is_none() {
                    break;
                }
            }
            let mut lazy = begin(Selection::LazyHeap);
            while let Some(HalfEdge { source, .. }) = step(&mut lazy) {
                let State { choices, flags, .. } = &lazy.state;
                let taken = choices[source as usize].cost;
                let mut left = choices.iter().zip(flags).filter(|(_, flags)| **flags & flag::DEAD == 0);
                prop_assert!(left.all(|(choice, _)| taken <= choice.cost));
            }
            prop_assert_eq!(cheapest(&mut lazy.state), None);
        }
    }
}
