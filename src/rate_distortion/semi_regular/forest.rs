//! Where the vertices of a semi-regular 4-8 mesh lie: a forest of quadtrees, level by level, without a pointer.
//!
//! Balmelli, Vetterli and Liebling, sections 1.4 and 2.1: each quad of the base complex is subdivided as the one
//! quad of Figure 3, and quads share the vertices on their common edges. A place is given by a quad and
//! coordinates in it, `0..=side` (2^depth) along and up from its first corner. Vertices are numbered: first the
//! corners of the complex, then level by level,
//!
//! - on an odd level the *centres* of squares, quad by quad and row by row;
//! - on an even level the midpoints of the squares' sides: first those on the edges of the complex, edge by edge
//!   as the edge runs, then quad by quad those inside, on horizontal sides and then on vertical ones.
//!
//! So the vertices of each uniform subdivision are a prefix. From level 3 on the diagonals of squares take turns
//! alike however a quad is turned, so that quads meet as they come; only on level 1 it matters where a quad starts.

use super::super::distortion::{Half, Place};
use super::SemiRegularError;
use super::complex::{BaseComplex, Side};
use crate::Mesh;

/// A place in a quad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Spot {
    pub(crate) quad: u32,
    pub(crate) place: Place,
}

/// The numbering of the vertices over a complex, each quad of which is halved `depth` times.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Forest {
    complex: BaseComplex,
    depth: u32,
    /// Where each level starts, from level 1 on; the end of the last is the number of vertices.
    starts: Vec<usize>,
}

impl Forest {
    pub(crate) fn new(complex: BaseComplex, depth: u32) -> Result<Self, SemiRegularError> {
        let quads = complex.quads().len();
        let limit = (1..31u32).take_while(|&depth| fits(quads, depth)).last().unwrap_or(0);
        if depth == 0 || depth > limit {
            return Err(SemiRegularError::Depth { depth, quads, limit });
        }
        let mut starts = vec![complex.corners()];
        for level in 1..=2 * depth {
            let squares = 1 << ((level - 1) / 2);
            let count = match level % 2 {
                1 => quads * squares * squares,
                _ => complex.edges() * squares + quads * inner(squares),
            };
            starts.push(starts[level as usize - 1] + count);
        }
        Ok(Self { complex, depth, starts })
    }

    pub(crate) fn complex(&self) -> &BaseComplex {
        &self.complex
    }

    pub(crate) fn depth(&self) -> u32 {
        self.depth
    }

    pub(crate) fn levels(&self) -> u32 {
        2 * self.depth
    }

    /// How long the sides of a quad are.
    pub(crate) fn side(&self) -> u32 {
        1 << self.depth
    }

    /// How many vertices there are, corners included.
    pub(crate) fn vertices(&self) -> usize {
        self.starts[self.levels() as usize]
    }

    /// The vertices of a level; level 0 are the corners.
    pub(crate) fn level(&self, level: u32) -> std::ops::Range<usize> {
        match level {
            0 => 0..self.starts[0],
            _ => self.starts[level as usize - 1]..self.starts[level as usize],
        }
    }

    /// The level that a vertex is on.
    pub(crate) fn level_of(&self, vertex: usize) -> u32 {
        self.starts.partition_point(|&start| start <= vertex) as u32
    }

    /// The vertex at a place.
    pub(crate) fn vertex(&self, Spot { quad, place: [x, y] }: Spot) -> usize {
        let side = self.side();
        let rim = [(y == 0, x), (x == side, y), (y == side, side - x), (x == 0, side - y)];
        if let Some(which) = rim.iter().position(|&(is_on, along)| is_on && along < side) {
            let along = rim[which].1;
            if along == 0 {
                return self.complex.quads()[quad as usize][which] as usize;
            }
            let on_edge = self.complex.on_edge(quad, which);
            let along = if on_edge.reversed { side - along } else { along };
            let halvings = along.trailing_zeros();
            let level = 2 * (self.depth - halvings);
            let squares = 1 << (self.depth - halvings - 1);
            return self.starts[level as usize - 1]
                + on_edge.edge as usize * squares
                + (along >> (halvings + 1)) as usize;
        }
        let (across, up) = (x.trailing_zeros(), y.trailing_zeros());
        let least = across.min(up);
        let (i, j) = ((x >> (least + 1)) as usize, (y >> (least + 1)) as usize);
        let squares = 1 << (self.depth - least - 1);
        let quad = quad as usize;
        if across == up {
            let level = 2 * (self.depth - least) - 1;
            return self.starts[level as usize - 1] + quad * squares * squares + j * squares + i;
        }
        let level = 2 * (self.depth - least);
        let start = self.starts[level as usize - 1] + self.complex.edges() * squares + quad * inner(squares);
        match up > across {
            true => start + (j - 1) * squares + i,
            false => start + (squares - 1) * squares + (i - 1) * squares + j,
        }
    }

    /// Where a vertex that is no corner lies; for one on an edge of the complex, in the edge's first quad.
    pub(crate) fn spot(&self, vertex: usize) -> Spot {
        let level = self.level_of(vertex);
        let index = vertex - self.starts[level as usize - 1];
        let squares = 1usize << ((level - 1) / 2);
        let half = self.half(level);
        let odd = |index: usize| (2 * index as u32 + 1) * half;
        let even = |index: usize| 2 * index as u32 * half;
        if level % 2 == 1 {
            let (quad, rest) = (index / (squares * squares), index % (squares * squares));
            return Spot { quad: quad as u32, place: [odd(rest % squares), odd(rest / squares)] };
        }
        let on_edges = self.complex.edges() * squares;
        if index < on_edges {
            let (first, _) = self.complex.sides_of(index / squares);
            return Spot { quad: first.quad, place: self.on_side(first, odd(index % squares)) };
        }
        let (quad, rest) = ((index - on_edges) / inner(squares), (index - on_edges) % inner(squares));
        let place = match rest.checked_sub((squares - 1) * squares) {
            None => [odd(rest % squares), even(rest / squares + 1)],
            Some(rest) => [even(rest / squares + 1), odd(rest % squares)],
        };
        Spot { quad: quad as u32, place }
    }

    /// Half the side of the squares whose centres are on a level, or whose sides are halved on it.
    fn half(&self, level: u32) -> u32 {
        1 << (self.depth - level.div_ceil(2))
    }

    fn on_side(&self, side: Side, along: u32) -> Place {
        let end = self.side();
        match side.side {
            0 => [along, 0],
            1 => [end, along],
            2 => [end - along, end],
            _ => [0, end - along],
        }
    }

    /// The two triangles that a vertex splits, each with its quad; one on a border.
    pub(crate) fn split(&self, vertex: usize) -> [Option<(u32, Half)>; 2] {
        let level = self.level_of(vertex);
        let half = self.half(level) as i32;
        let on_edge = (vertex - self.starts[level as usize - 1]) >> ((level - 1) / 2);
        if level.is_multiple_of(2) && on_edge < self.complex.edges() {
            let Spot { place, .. } = self.spot(vertex);
            let (first, second) = self.complex.sides_of(on_edge);
            let beside = |side: Side, place: Place| {
                let direction = [[half, 0], [0, half], [-half, 0], [0, -half]][usize::from(side.side)];
                (side.quad, triangle(place, direction, level))
            };
            let other = |second: Side| {
                let along = [place[0], place[1], self.side() - place[0], self.side() - place[1]];
                let along = self.side() - along[usize::from(first.side)];
                beside(second, self.on_side(second, along))
            };
            return [Some(beside(first, place)), second.map(other)];
        }
        let Spot { quad, place: [x, y] } = self.spot(vertex);
        let double = 2 * self.half(level);
        let direction = match level % 2 {
            1 if (x / double + y / double).is_multiple_of(2) => [half, half],
            1 => [-half, half],
            _ if y.is_multiple_of(double) => [-half, 0],
            _ => [0, half],
        };
        [direction, direction.map(|way| -way)].map(|way| Some((quad, triangle([x, y], way, level))))
    }

    /// Which of the two triangles of [`Forest::split`] a triangle in a quad is.
    pub(crate) fn slot(&self, quad: u32, triangle: &Half) -> usize {
        let middle = [0, 1].map(|axis| (triangle.from[axis] + triangle.to[axis]) / 2);
        let side = self.side();
        let rim = [middle[1] == 0, middle[0] == side, middle[1] == side, middle[0] == 0];
        match rim.iter().position(|&is_on| is_on) {
            Some(which) => usize::from(self.complex.on_edge(quad, which).reversed),
            None => usize::from(triangle.apex > middle),
        }
    }

    /// Whether the edge between two places of a quad is on a border of the complex.
    pub(crate) fn is_border(&self, quad: u32, from: Place, to: Place) -> bool {
        let side = self.side();
        let both = |axis: usize, at: u32| from[axis] == at && to[axis] == at;
        let rim = [both(1, 0), both(0, side), both(1, side), both(0, 0)];
        rim.iter().position(|&is_on| is_on).is_some_and(|which| {
            let on_edge = self.complex.on_edge(quad, which);
            self.complex.sides_of(on_edge.edge as usize).1.is_none()
        })
    }

    /// The two triangles that a quad is where all else is gone.
    pub(crate) fn roots(&self) -> [Half; 2] {
        let side = self.side();
        let [a, b, c, d] = [[0, 0], [side, 0], [side, side], [0, side]];
        [Half { apex: b, from: c, to: a, level: 1 }, Half { apex: d, from: a, to: c, level: 1 }]
    }

    /// The vertex that splits a triangle of a quad.
    pub(crate) fn midpoint(&self, quad: u32, triangle: &Half) -> usize {
        let place = [0, 1].map(|axis| (triangle.from[axis] + triangle.to[axis]) / 2);
        self.vertex(Spot { quad, place })
    }

    /// Calls `visit` with the corners of each triangle that is left where `is_kept` says which vertices are:
    /// with a vertex both of its parents must be kept. Time linear in the triangles.
    pub(crate) fn visit_triangles(&self, is_kept: impl Fn(usize) -> bool, mut visit: impl FnMut([usize; 3])) {
        let mut waiting = Vec::with_capacity(self.levels() as usize + 2);
        for quad in 0..self.complex.quads().len() as u32 {
            let [first, second] = self.roots();
            waiting.extend([second, first]);
            while let Some(triangle) = waiting.pop() {
                if triangle.level <= self.levels() && is_kept(self.midpoint(quad, &triangle)) {
                    let [first, second] = triangle.halves();
                    waiting.extend([second, first]);
                } else {
                    let Half { apex, from, to, .. } = triangle;
                    visit([apex, from, to].map(|place| self.vertex(Spot { quad, place })));
                }
            }
        }
    }
}

/// Whether so many quads have no more triangles at a depth than a mesh can have. There are at most nine vertices for
/// each eight of them, so that twice the number of a vertex fits into 32 bits.
fn fits(quads: usize, depth: u32) -> bool {
    (quads as u128) << (2 * depth + 1) <= Mesh::MAX_TRIANGLES as u128
}

/// How many midpoints of sides of `squares` by `squares` squares are inside of a quad.
fn inner(squares: usize) -> usize {
    2 * squares * (squares - 1)
}

/// The triangle to the left of the edge through `middle` whose half is `way`.
fn triangle(middle: Place, way: [i32; 2], level: u32) -> Half {
    let at = |by: [i32; 2]| [0, 1].map(|axis| middle[axis].wrapping_add_signed(by[axis]));
    let [along, up] = way;
    Half { apex: at([-up, along]), from: at([-along, -up]), to: at(way), level }
}
