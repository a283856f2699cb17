//! Where the vertices of a regular 4-8 hierarchy lie: level by level, without a pointer.
//!
//! Balmelli, Vetterli and Liebling, "Mesh Optimization Using Global Error with Application to Geometry
//! Simplification", section 1.4 and Figures 3 and 4. The paper starts from one quad; here there may be a grid of
//! `base` quads, so that a field that is not square needs little filling up. Each quad is `side` = 2^d samples
//! wide. Its corners are the base mesh and never go; all other vertices are numbered by level and, in a level,
//! row by row:
//!
//! - an odd level holds the *centres* of squares, `side >> (l - 1) / 2` wide;
//! - an even level holds the midpoints of their edges, on the *axes*: rows of horizontal edges (even rows) take
//!   turns with rows of vertical edges (odd rows, one entry longer).
//!
//! The root diagonals of the quads take turns, as the finer ones do.

/// The levels of a hierarchy over `base[0]` times `base[1]` quads.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    base: [usize; 2],
    /// The side of a quad is 2 to the power of this.
    depth: u32,
    /// Where each level starts, from level 1 on; the end of the last is the number of vertices.
    starts: Vec<usize>,
}

/// A vertex that may go, by its place: its children are on the level below, its parents on the one above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Site {
    pub(crate) x: usize,
    pub(crate) y: usize,
    pub(crate) level: u32,
}

impl Layout {
    pub(crate) fn new(base: [usize; 2], depth: u32) -> Self {
        let mut layout = Self { base, depth, starts: vec![0] };
        for level in 1..=layout.levels() {
            let [columns, rows] = layout.squares(level);
            let count = if level % 2 == 1 { columns * rows } else { (2 * columns + 1) * rows + columns };
            layout.starts.push(layout.starts[level as usize - 1] + count);
        }
        layout
    }

    /// The layout that a grid of samples fits in: squares as large as they can be without filling it up to
    /// more than about a quarter beyond its size.
    pub(crate) fn covering(columns: usize, rows: usize) -> Self {
        let edges = [columns - 1, rows - 1];
        let finest = edges[0].max(edges[1]).next_power_of_two().trailing_zeros();
        let covering = |depth: u32| edges.map(|edge| edge.div_ceil(1 << depth));
        let fits = |depth: &u32| {
            let [across, down] = covering(*depth);
            let filled = (across << depth) as u128 * (down << depth) as u128;
            filled * 4 <= edges[0] as u128 * edges[1] as u128 * 5
        };
        // A square a sample wide fits exactly.
        let depth = (0..=finest).rev().find(fits).unwrap_or(0);
        Self::new(covering(depth), depth)
    }

    /// How many levels of vertices there are: two for each halving.
    pub(crate) fn levels(&self) -> u32 {
        2 * self.depth
    }

    pub(crate) fn base(&self) -> [usize; 2] {
        self.base
    }

    /// The side of a base quad is 2 to the power of this.
    pub(crate) fn depth(&self) -> u32 {
        self.depth
    }

    /// The side of a base quad, in samples.
    pub(crate) fn side(&self) -> usize {
        1 << self.depth
    }

    /// The largest `x` and the largest `y`.
    pub(crate) fn extent(&self) -> [usize; 2] {
        self.base.map(|quads| quads << self.depth)
    }

    /// How many vertices may go: all but the corners of the base quads.
    pub(crate) fn vertices(&self) -> usize {
        self.starts[self.levels() as usize]
    }

    /// The vertices of a level.
    pub(crate) fn level(&self, level: u32) -> std::ops::Range<usize> {
        self.starts[level as usize - 1]..self.starts[level as usize]
    }

    /// How many squares there are across and down whose centres are on an odd level, or whose edges are halved
    /// on an even one.
    pub(crate) fn squares(&self, level: u32) -> [usize; 2] {
        self.base.map(|quads| quads << ((level - 1) / 2))
    }

    /// Half the side of the squares of [`Layout::squares`], in samples: how far a vertex is from its children
    /// (on an odd level) or they are across (on an even one).
    pub(crate) fn half(&self, level: u32) -> usize {
        1 << (self.depth - level.div_ceil(2))
    }

    /// Where row `row` of an even level starts, counted from the level's first vertex, if `columns` squares lie
    /// side by side.
    pub(crate) fn axis_row(columns: usize, row: usize) -> usize {
        (row / 2) * (2 * columns + 1) + (row % 2) * columns
    }

    /// The number of a vertex.
    pub(crate) fn index(&self, Site { x, y, level }: Site) -> usize {
        let start = self.starts[level as usize - 1];
        let [columns, _] = self.squares(level);
        let shift = self.depth - level.div_ceil(2);
        if level % 2 == 1 {
            start + (y >> (shift + 1)) * columns + (x >> (shift + 1))
        } else {
            start + Self::axis_row(columns, y >> shift) + (x >> (shift + 1))
        }
    }

    /// Where the vertex with a number lies.
    pub(crate) fn site(&self, vertex: usize) -> Site {
        let level = self.starts.partition_point(|&start| start <= vertex) as u32;
        let place = vertex - self.starts[level as usize - 1];
        let [columns, _] = self.squares(level);
        let half = self.half(level);
        if level % 2 == 1 {
            return Site {
                x: (2 * (place % columns) + 1) * half,
                y: (2 * (place / columns) + 1) * half,
                level,
            };
        }
        let (pair, rest) = (place / (2 * columns + 1), place % (2 * columns + 1));
        match rest.checked_sub(columns) {
            None => Site { x: (2 * rest + 1) * half, y: 2 * pair * half, level },
            Some(column) => Site { x: 2 * column * half, y: (2 * pair + 1) * half, level },
        }
    }

    /// The level of the vertex at a place; 0 for corners of base quads.
    pub(crate) fn level_at(&self, x: usize, y: usize) -> u32 {
        let halvings = |value: usize| value.trailing_zeros().min(self.depth);
        let (across, down) = (halvings(x), halvings(y));
        let least = across.min(down);
        match least == self.depth {
            true => 0,
            false => 2 * (self.depth - least) - u32::from(across == down),
        }
    }

    /// The vertices that must go before this one: they split the triangles that it is a corner of.
    pub(crate) fn children(&self, site: Site) -> impl Iterator<Item = Site> {
        let Site { x, y, level } = site;
        let [right, bottom] = self.extent();
        let offsets: [(isize, isize); 4] = if level % 2 == 1 {
            let half = self.half(level) as isize;
            [(0, -half), (0, half), (-half, 0), (half, 0)]
        } else {
            let quarter = (self.half(level) / 2) as isize;
            [(-quarter, -quarter), (quarter, -quarter), (-quarter, quarter), (quarter, quarter)]
        };
        let exist = level < self.levels();
        offsets.into_iter().filter(move |_| exist).filter_map(move |(dx, dy)| {
            let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
            (x <= right && y <= bottom).then_some(Site { x, y, level: level + 1 })
        })
    }

    /// The vertices that can only go after this one; none on level 1, and one at the rim of the grid.
    pub(crate) fn parents(&self, site: Site) -> impl Iterator<Item = Site> {
        let Site { x, y, level } = site;
        let [right, bottom] = self.extent();
        let half = self.half(level) as isize;
        let offsets: [(isize, isize); 2] = if level % 2 == 0 {
            match self.is_on_horizontal_edge(site) {
                true => [(0, -half), (0, half)],
                false => [(-half, 0), (half, 0)],
            }
        } else if self.falls(site) {
            [(half, -half), (-half, half)]
        } else {
            [(-half, -half), (half, half)]
        };
        let exist = level > 1;
        offsets.into_iter().filter(move |_| exist).filter_map(move |(dx, dy)| {
            let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
            (x <= right && y <= bottom).then_some(Site { x, y, level: level - 1 })
        })
    }

    /// The ends of the edge that a vertex splits.
    pub(crate) fn edge(&self, site: Site) -> [(usize, usize); 2] {
        let Site { x, y, level } = site;
        let half = self.half(level);
        if level % 2 == 0 {
            match self.is_on_horizontal_edge(site) {
                true => [(x - half, y), (x + half, y)],
                false => [(x, y - half), (x, y + half)],
            }
        } else if self.falls(site) {
            [(x - half, y - half), (x + half, y + half)]
        } else {
            [(x + half, y - half), (x - half, y + half)]
        }
    }

    /// The two triangles (one at the rim of the grid) that a vertex splits, each as its right-angled corner and
    /// the two ends of the edge that is split, in the order that makes them wind from `x` to `y`.
    pub(crate) fn split(&self, site: Site) -> impl Iterator<Item = [(usize, usize); 3]> {
        let [right, bottom] = self.extent();
        let [from, to] = self.edge(site);
        let Site { x, y, .. } = site;
        // A quarter turn from the edge's direction leads to the corner of the triangle on that side.
        let (dx, dy) = (to.0 as isize - x as isize, to.1 as isize - y as isize);
        [((-dy, dx), from, to), ((dy, -dx), to, from)].into_iter().filter_map(move |((dx, dy), from, to)| {
            let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
            (x <= right && y <= bottom).then_some([(x, y), from, to])
        })
    }

    /// Whether the diagonal that a centre splits runs down to the right.
    fn falls(&self, Site { x, y, level }: Site) -> bool {
        let shift = self.depth - level.div_ceil(2) + 1;
        ((x >> shift) + (y >> shift)).is_multiple_of(2)
    }

    /// Whether a vertex of an even level halves an edge along a row.
    fn is_on_horizontal_edge(&self, Site { y, level, .. }: Site) -> bool {
        (y >> (self.depth - level / 2)).is_multiple_of(2)
    }
}

#[cfg(test)]
mod tests {
    use super::{Layout, Site};

    const LAYOUTS: [([usize; 2], u32); 6] =
        [([1, 1], 0), ([1, 1], 1), ([1, 1], 4), ([3, 2], 2), ([2, 5], 3), ([4, 1], 0)];

    #[test]
    fn every_sample_but_the_base_corners_has_one_number() {
        for (base, depth) in LAYOUTS {
            let layout = Layout::new(base, depth);
            let [right, bottom] = layout.extent();
            let mut seen = vec![false; layout.vertices()];
            for y in 0..=bottom {
                for x in 0..=right {
                    let level = layout.level_at(x, y);
                    if level == 0 {
                        assert!(x % layout.side() == 0 && y % layout.side() == 0);
                        continue;
                    }
                    let site = Site { x, y, level };
                    let vertex = layout.index(site);
                    assert!(layout.level(level).contains(&vertex));
                    assert_eq!(layout.site(vertex), site);
                    assert!(!std::mem::replace(&mut seen[vertex], true));
                }
            }
            assert!(seen.iter().all(|&seen| seen));
        }
    }

    #[test]
    fn parents_are_those_that_have_one_as_a_child_and_split_the_other_edges() {
        for (base, depth) in LAYOUTS {
            let layout = Layout::new(base, depth);
            for site in (0..layout.vertices()).map(|vertex| layout.site(vertex)) {
                for child in layout.children(site) {
                    assert_eq!(layout.level_at(child.x, child.y), child.level);
                    assert!(layout.parents(child).any(|parent| parent == site), "{site:?} {child:?}");
                }
                for parent in layout.parents(site) {
                    assert!(layout.children(parent).any(|child| child == site));
                }
                // The corners of the triangles that it splits are its parents, or corners of the base.
                let corners: Vec<_> = layout.split(site).map(|[corner, ..]| corner).collect();
                let parents: Vec<_> = layout.parents(site).map(|parent| (parent.x, parent.y)).collect();
                assert_eq!(corners.len(), if site.level == 1 { 2 } else { parents.len() });
                assert!(parents.iter().all(|parent| corners.contains(parent)));
            }
        }
    }

    #[test]
    fn a_power_of_two_and_one_is_covered_by_one_quad() {
        assert_eq!(Layout::covering(1025, 1025), Layout::new([1, 1], 10));
        assert_eq!(Layout::covering(2, 2), Layout::new([1, 1], 0));
        for (columns, rows) in
            [(3, 2), (640, 480), (2161, 2161), (1201, 1201), (2401, 1201), (2, 5000), (1197, 643)]
        {
            let [right, bottom] = Layout::covering(columns, rows).extent();
            assert!(right >= columns - 1 && bottom >= rows - 1);
            assert!(right * bottom * 4 <= (columns - 1) * (rows - 1) * 5);
        }
    }
}
