//! In which order the vertices of a hierarchy go.

/// All vertices of a hierarchy in the order in which they go. Children come before their parents, so that what
/// is left after any number of them is conforming.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Removals {
    /// Numbers of vertices, the first to go first.
    pub(super) order: Vec<u32>,
    /// How many vertices are gone after each step: a method that takes several at once means no mesh between.
    pub(super) steps: Vec<usize>,
}

impl Removals {
    /// The distortion after 0, 1, 2, ... removals, if that of each vertex is `deltas`: it is additive
    /// (see [`merging`](super::merging)). Linear.
    pub(super) fn distortions(&self, deltas: &[impl Copy + Into<f64>]) -> Vec<f64> {
        let mut distortion = 0.0;
        let gone = self.order.iter().map(|&vertex| {
            distortion += deltas[vertex as usize].into();
            distortion
        });
        std::iter::once(0.0).chain(gone).collect()
    }
}
