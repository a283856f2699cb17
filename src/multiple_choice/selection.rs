//! Which vertex goes next.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::num::NonZeroU32;

use super::state::{State, flag};
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
    /// The cheapest of all, by a heap whose entries are brought up to date only when they come up.
    LazyHeap,
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
    Heap(BinaryHeap<Reverse<(u32, u32)>>),
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
                Self::Heap(able.into_iter().map(key).collect())
            }
        }
    }

    /// The next vertex, its choice up to date and possible; `None` when there is none.
    pub(super) fn next(&mut self, state: &mut State) -> Option<u32> {
        match self {
            Self::Drawn { vertices, candidates, generator } => draw(vertices, *candidates, generator, state),
            Self::Heap(heap) => pop(heap, state),
        }
    }

    /// Takes a vertex whose choice was not legal, and has been replaced by another.
    pub(super) fn put_back(&mut self, vertex: u32, state: &mut State) {
        // Drawn vertices stay where they are, and leave when they are drawn.
        if let Self::Heap(heap) = self {
            push(heap, vertex, state);
        }
    }

    /// Lets a vertex in again that was left out, and may be able to go somewhere by now.
    pub(super) fn readmit(&mut self, vertex: u32) {
        match self {
            Self::Drawn { vertices, .. } => vertices.push(vertex),
            Self::Heap(heap) => heap.push(Reverse((0, vertex))),
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
