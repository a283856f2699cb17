//! A set of vertices among many: a bit each, and how many come before.
//!
//! A block's vertices are a few of those of the whole mesh. Eight of these take a byte and a half, and the place
//! of one among the block's is found in one step, in the order that the mesh has them in.

use std::io::{Read, Write};
use std::ops::Range;

const BITS: usize = 64;

/// The words of `count` vertices.
fn words(count: usize) -> usize {
    count.div_ceil(BITS)
}

/// Vertices of a range, growing.
#[derive(Debug)]
pub(super) struct VertexBits {
    /// The word that the first one stands for.
    first: usize,
    words: Vec<u64>,
}

impl VertexBits {
    /// None of those in `range`, of which alone it is.
    pub(super) fn new(range: Range<usize>) -> Self {
        let first = range.start / BITS;
        Self { first, words: vec![0; words(range.end).saturating_sub(first)] }
    }

    pub(super) fn insert(&mut self, vertex: u32) {
        let vertex = vertex as usize;
        self.words[vertex / BITS - self.first] |= 1 << (vertex % BITS);
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Adds `others`, whose range lies in this one's; those that were there already go into `twice`, which has
    /// the same range.
    pub(super) fn add(&mut self, others: &Self, twice: &mut Self) {
        let from = others.first - self.first;
        let places = self.words[from..].iter_mut().zip(&mut twice.words[from..]);
        for ((word, twice), other) in places.zip(&others.words) {
            *twice |= *word & other;
            *word |= other;
        }
    }

    pub(super) fn write(&self, writer: &mut impl Write) -> std::io::Result<()> {
        self.words.iter().try_for_each(|word| writer.write_all(&word.to_le_bytes()))
    }

    /// Those of `0..count` that [`write`](Self::write) has written.
    pub(super) fn read(count: usize, reader: &mut impl Read) -> std::io::Result<Self> {
        let mut bits = Self::new(0..count);
        let mut bytes = [0; 8];
        for word in &mut bits.words {
            reader.read_exact(&mut bytes)?;
            *word = u64::from_le_bytes(bytes);
        }
        Ok(bits)
    }
}

/// Vertices that no more are added to.
#[derive(Debug)]
pub(super) struct VertexSet {
    bits: VertexBits,
    /// How many come before each word.
    before: Vec<u32>,
    count: usize,
}

impl VertexSet {
    pub(super) fn new(bits: VertexBits) -> Self {
        let mut count = 0;
        let before = bits.words.iter().map(|word| {
            let before = count as u32;
            count += word.count_ones() as usize;
            before
        });
        let before = before.collect();
        Self { bits, before, count }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// How many of the set come before `vertex`, if it is one of them.
    #[inline]
    pub(super) fn place(&self, vertex: u32) -> Option<u32> {
        let vertex = vertex as usize;
        let index = (vertex / BITS).checked_sub(self.bits.first)?;
        let word = self.bits.words.get(index)?;
        let bit = 1 << (vertex % BITS);
        (word & bit != 0).then(|| self.before[index] + (word & (bit - 1)).count_ones())
    }

    /// The vertices, ascending.
    pub(super) fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.bits.words.iter().enumerate().flat_map(move |(index, &word)| {
            let first = ((self.bits.first + index) * BITS) as u32;
            std::iter::successors(Some(word), |word| Some(word & word.wrapping_sub(1)))
                .take_while(|&word| word != 0)
                .map(move |word| first + word.trailing_zeros())
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_set_is_what_was_put_in(
            vertices in prop::collection::btree_set(100u32..1000, 0..200),
            others in prop::collection::btree_set(300u32..700, 0..200),
        ) {
            let mut bits = VertexBits::new(100..1000);
            vertices.iter().for_each(|&vertex| bits.insert(vertex));
            let mut more = VertexBits::new(300..700);
            others.iter().for_each(|&vertex| more.insert(vertex));
            prop_assert_eq!(bits.count(), vertices.len());
            let mut twice = VertexBits::new(100..1000);
            bits.add(&more, &mut twice);

            let check = |bits: VertexBits, expected: BTreeSet<u32>| {
                let set = VertexSet::new(bits);
                assert_eq!(set.iter().collect::<Vec<_>>(), expected.iter().copied().collect::<Vec<_>>());
                assert_eq!(set.count(), expected.len());
                for vertex in 0..1100 {
                    let place = expected.contains(&vertex).then(|| expected.range(..vertex).count() as u32);
                    assert_eq!(set.place(vertex), place);
                }
            };
            check(twice, &vertices & &others);
            check(bits, &vertices | &others);
        }

        #[test]
        fn a_stored_set_is_the_same(vertices in prop::collection::btree_set(0u32..500, 0..100)) {
            let mut bits = VertexBits::new(0..500);
            vertices.iter().for_each(|&vertex| bits.insert(vertex));
            let mut bytes = Vec::new();
            bits.write(&mut bytes).unwrap();
            let again = VertexSet::new(VertexBits::read(500, &mut &bytes[..]).unwrap());
            prop_assert_eq!(again.iter().collect::<BTreeSet<_>>(), vertices);
            prop_assert!(VertexBits::read(500, &mut &bytes[1..]).is_err());
        }
    }
}
