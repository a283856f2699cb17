//! The fewest vertices with which no sample is farther from the surface than a bound.
//!
//! Not in the paper, whose error is of squares; what Lindstrom et al. and others of its references [20, 23] bound.
//! A triangle of a mesh that keeps the bound, or one that it was cut from, covers each sample. So a triangle that
//! breaks the bound, and whose corners must all be there, must be cut: its midpoint is in every mesh that keeps the
//! bound, and with it all of the midpoint's ancestors. What follows from that, from the base mesh down, keeps the
//! bound itself and is thus the least mesh that does.

use super::distortion::{Half, VALID};
use super::lattice::Lattice;

/// A set of vertices, by number.
pub(crate) struct Left {
    bits: Vec<u64>,
}

impl Left {
    fn new(vertices: usize) -> Self {
        Self { bits: vec![0; vertices.div_ceil(64)] }
    }

    pub(crate) fn contains(&self, vertex: usize) -> bool {
        self.bits[vertex / 64] >> (vertex % 64) & 1 == 1
    }

    fn insert(&mut self, vertex: usize) {
        self.bits[vertex / 64] |= 1 << (vertex % 64);
    }

    fn remove(&mut self, vertex: usize) -> bool {
        let was = self.contains(vertex);
        self.bits[vertex / 64] &= !(1 << (vertex % 64));
        was
    }
}

/// The fewest vertices with which no sample is farther than `bound` from the surface, vertically, among those sets
/// that have all vertices of `start`, which holds with each vertex its parents.
///
/// Each sample is looked at once a level: time n log n.
pub(crate) fn least(lattice: &Lattice, bound: f64, start: impl Fn(usize) -> bool) -> Left {
    let layout = lattice.layout();
    let vertices = layout.vertices();
    let mut left = Left::new(vertices);
    (0..vertices).filter(|&vertex| start(vertex)).for_each(|vertex| left.insert(vertex));
    // Triangles that keep the bound, by the vertex that would split them and their side of it.
    let mut kept = [Left::new(vertices), Left::new(vertices)];
    let mut stack = lattice.roots();
    let mut ancestors = Vec::new();
    while let Some(triangle) = stack.pop() {
        if triangle.level > layout.levels() {
            continue;
        }
        let midpoint = layout.index(triangle.midpoint());
        if left.contains(midpoint) {
            stack.extend(triangle.halves());
            continue;
        }
        if !breaks(lattice, &triangle, bound) {
            kept[triangle.side()].insert(midpoint);
            continue;
        }
        stack.extend(triangle.halves());
        left.insert(midpoint);
        ancestors.push(triangle.midpoint());
        while let Some(site) = ancestors.pop() {
            // The triangles that it splits, if they had been found good enough.
            for [apex, from, to] in layout.split(site) {
                let [apex, from, to] = [apex, from, to].map(|(x, y)| [x as u32, y as u32]);
                let split = Half { apex, from, to, level: site.level };
                if kept[split.side()].remove(layout.index(site)) {
                    stack.push(split);
                }
            }
            for parent in layout.parents(site) {
                let vertex = layout.index(parent);
                if !left.contains(vertex) {
                    left.insert(vertex);
                    ancestors.push(parent);
                }
            }
        }
    }
    left
}

/// Whether a sample of a triangle is farther than `bound` from its plane.
fn breaks(lattice: &Lattice, triangle: &Half, bound: f64) -> bool {
    let Half { apex, from, to, .. } = *triangle;
    let [at, on_from, on_to] = [apex, from, to].map(|place| f64::from(lattice.height(place)));
    let signed = |place: [u32; 2]| place.map(i64::from);
    let ([ax, ay], [fx, fy], [tx, ty]) = (signed(apex), signed(from), signed(to));
    let (first, second) = ([fx - ax, fy - ay], [tx - ax, ty - ay]);
    // The edges at the apex are as long as each other and at right angles.
    let square = (first[0] * first[0] + first[1] * first[1]) as f64;
    let slope =
        |axis: usize| (first[axis] as f64 * (on_from - at) + second[axis] as f64 * (on_to - at)) / square;
    let (across, down) = (slope(0), slope(1));
    let field = lattice.field();
    let last = [field.columns() as i64 - 1, field.rows() as i64 - 1];
    for y in ay.min(fy).min(ty)..=ay.max(fy).max(ty).min(last[1]) {
        let (low, high) = span(y, [ax, ay], [fx, fy], [tx, ty]);
        for x in low..=high.min(last[0]) {
            let place = [x as u32, y as u32];
            let plane = at + across * (x - ax) as f64 + down * (y - ay) as f64;
            if (f64::from(lattice.height(place)) - plane).abs() > bound && lattice.known(place) == VALID {
                return true;
            }
        }
    }
    false
}

/// The first and the last sample that a triangle has in a row: its edges run along rows, columns and diagonals.
fn span(y: i64, apex: [i64; 2], from: [i64; 2], to: [i64; 2]) -> (i64, i64) {
    let edges = [(apex, from), (from, to), (to, apex)];
    let crossings = edges.into_iter().filter_map(|(a, b)| {
        let ([ax, ay], [bx, by]) = (a, b);
        let crosses = ay.min(by) <= y && y <= ay.max(by);
        (crosses && ay != by).then(|| ax + (bx - ax) * (y - ay) / (by - ay))
    });
    crossings.fold((i64::MAX, i64::MIN), |(low, high), x| (low.min(x), high.max(x)))
}
