//! Disjoint sets of consecutive numbers.

/// A partition of `0..len` that starts as singletons; each set is named by its least member.
#[derive(Debug, Clone, Default)]
pub(crate) struct Partition {
    parents: Vec<u32>,
}

impl Partition {
    /// Singletons.
    pub(crate) fn new(len: usize) -> Self {
        Self { parents: (0..len as u32).collect() }
    }

    /// Starts over with `len` singletons, in the memory that is there.
    pub(crate) fn reset(&mut self, len: usize) {
        self.parents.clear();
        self.parents.extend(0..len as u32);
    }

    /// The least member of the set that `member` is in.
    pub(crate) fn find(&mut self, member: u32) -> u32 {
        let mut member = member;
        loop {
            let parent = self.parents[member as usize];
            if parent == member {
                return member;
            }
            let grandparent = self.parents[parent as usize];
            self.parents[member as usize] = grandparent;
            member = grandparent;
        }
    }

    /// Makes the sets of `a` and `b` one; whether they were two.
    pub(crate) fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// How many sets there are.
    pub(crate) fn sets(&self) -> usize {
        self.parents.iter().enumerate().filter(|&(member, &parent)| member == parent as usize).count()
    }
}
