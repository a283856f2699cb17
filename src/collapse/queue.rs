//! A priority queue of vertices whose costs change.

const ABSENT: u32 = u32::MAX;

/// Vertices in ascending order of cost, ties by index. A binary heap that knows where each vertex
/// stands, so that a changed cost moves its entry and nothing stale is left behind.
pub(crate) struct Queue {
    heap: Vec<(f32, u32)>,
    places: Vec<u32>,
}

impl Queue {
    /// An empty queue for `vertices` vertices.
    pub(crate) fn new(vertices: usize) -> Self {
        Self { heap: Vec::new(), places: vec![ABSENT; vertices] }
    }

    /// Gives `vertex` this cost; an infinite one takes it out.
    pub(crate) fn set(&mut self, vertex: u32, cost: f32) {
        if self.places.len() <= vertex as usize {
            self.places.resize(vertex as usize + 1, ABSENT);
        }
        let place = self.places[vertex as usize];
        if cost == f32::INFINITY {
            if place != ABSENT {
                self.remove(place as usize);
            }
        } else if place == ABSENT {
            self.heap.push((cost, vertex));
            self.rise(self.heap.len() - 1);
        } else {
            self.heap[place as usize].0 = cost;
            self.settle(place as usize);
        }
    }

    /// The cheapest vertex, which stays.
    pub(crate) fn first(&self) -> Option<(f32, u32)> {
        self.heap.first().copied()
    }

    fn remove(&mut self, place: usize) {
        let (_, vertex) = self.heap.swap_remove(place);
        self.places[vertex as usize] = ABSENT;
        if place < self.heap.len() {
            self.settle(place);
        }
    }

    fn settle(&mut self, place: usize) {
        let vertex = self.heap[place].1;
        self.rise(place);
        self.sink(self.places[vertex as usize] as usize);
    }

    fn before(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.heap[a], self.heap[b]);
        a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).is_lt()
    }

    fn rise(&mut self, mut place: usize) {
        while place > 0 && self.before(place, (place - 1) / 2) {
            self.swap(place, (place - 1) / 2);
            place = (place - 1) / 2;
        }
        self.places[self.heap[place].1 as usize] = place as u32;
    }

    fn sink(&mut self, mut place: usize) {
        loop {
            let mut least = place;
            for child in [2 * place + 1, 2 * place + 2] {
                if child < self.heap.len() && self.before(child, least) {
                    least = child;
                }
            }
            if least == place {
                break;
            }
            self.swap(place, least);
            place = least;
        }
        self.places[self.heap[place].1 as usize] = place as u32;
    }

    fn swap(&mut self, a: usize, b: usize) {
        self.heap.swap(a, b);
        self.places[self.heap[a].1 as usize] = a as u32;
        self.places[self.heap[b].1 as usize] = b as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against a plain list, after any sequence of changes.
        #[test]
        fn first_is_the_least(changes in prop::collection::vec((0u32..20, 0u8..40), 0..200)) {
            let mut queue = Queue::new(20);
            let mut list = [f32::INFINITY; 20];
            for (vertex, cost) in changes {
                let cost = if cost < 30 { f32::from(cost) } else { f32::INFINITY };
                queue.set(vertex, cost);
                list[vertex as usize] = cost;
                let least = (0..20).filter(|&v| list[v as usize] < f32::INFINITY)
                    .map(|v| (list[v as usize], v))
                    .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                prop_assert_eq!(queue.first(), least);
            }
        }
    }
}
