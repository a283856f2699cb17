//! A balanced binary tree over the samples of a polyline: the paper's Figure 13.

use crate::rate_distortion::graph::Graph;

/// All samples between the ends. Numbers count from the first of them.
pub(super) struct Tree {
    /// The two samples between which each is the middle one.
    ends: Vec<[u32; 2]>,
    /// From 1, that of the middle of the whole, on.
    levels: Vec<u32>,
}

impl Tree {
    /// The tree over `samples` samples, two at least.
    pub(super) fn new(samples: usize) -> Self {
        let mut tree = Self { ends: vec![[0; 2]; samples - 2], levels: vec![0; samples - 2] };
        let mut pending = vec![([0, samples as u32 - 1], 1)];
        while let Some((ends, level)) = pending.pop() {
            if let Some(middle) = Self::middle(ends) {
                let vertex = middle as usize - 1;
                (tree.ends[vertex], tree.levels[vertex]) = (ends, level);
                pending.extend([([ends[0], middle], level + 1), ([middle, ends[1]], level + 1)]);
            }
        }
        tree
    }

    /// The sample that has a number.
    pub(super) fn sample(vertex: u32) -> u32 {
        vertex + 1
    }

    /// The samples that each vertex is the middle of, with itself between them.
    pub(super) fn spans(&self) -> impl Iterator<Item = [usize; 3]> {
        self.ends.iter().zip(1..).map(|(&[from, to], sample)| [from as usize, sample, to as usize])
    }

    fn middle([from, to]: [u32; 2]) -> Option<u32> {
        (to - from > 1).then(|| from + (to - from) / 2)
    }

    fn level_of(&self, sample: u32) -> u32 {
        sample.checked_sub(1).and_then(|vertex| self.levels.get(vertex as usize)).map_or(0, |&level| level)
    }
}

impl Graph for Tree {
    fn vertices(&self) -> usize {
        self.ends.len()
    }

    fn level(&self, vertex: usize) -> u32 {
        self.levels[vertex]
    }

    fn children(&self, vertex: usize) -> impl Iterator<Item = usize> {
        let ([from, to], sample) = (self.ends[vertex], vertex as u32 + 1);
        [[from, sample], [sample, to]].into_iter().filter_map(Self::middle).map(|middle| middle as usize - 1)
    }

    fn parents(&self, vertex: usize) -> impl Iterator<Item = usize> {
        // What halved last is what made this part.
        let finer = self.ends[vertex].into_iter().max_by_key(|&end| self.level_of(end));
        finer.filter(|_| self.levels[vertex] > 1).map(|end| end as usize - 1).into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::Tree;
    use crate::rate_distortion::graph::Graph;

    #[test]
    fn each_vertex_but_the_first_is_the_child_of_its_one_parent_a_level_up() {
        for samples in 2..70 {
            let tree = Tree::new(samples);
            assert_eq!(tree.vertices(), samples - 2);
            let mut roots = 0;
            for vertex in 0..samples - 2 {
                let parents: Vec<_> = tree.parents(vertex).collect();
                match parents[..] {
                    [] => roots += 1,
                    [parent] => {
                        assert_eq!(tree.level(parent) + 1, tree.level(vertex));
                        assert!(tree.children(parent).any(|child| child == vertex));
                    }
                    _ => panic!("{parents:?}"),
                }
                assert!(tree.children(vertex).all(|child| tree.parents(child).eq([vertex])));
            }
            assert_eq!(roots, usize::from(samples > 2));
            let deepest = (0..samples - 2).map(|vertex| tree.level(vertex)).max().unwrap_or(0);
            assert_eq!(deepest, (samples - 1).next_power_of_two().trailing_zeros());
        }
    }
}
