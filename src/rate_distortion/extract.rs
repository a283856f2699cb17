//! The mesh of the vertices that are left, in time linear in their number.
//!
//! The triangles of a conforming 4-8 mesh are found from the base mesh down: one is cut in two where its midpoint is
//! left. As each vertex that is left has all of its ancestors with it, no triangle has a vertex on an edge.

use hashbrown::HashMap;

use super::distortion::{Half, Place, VOID};
use super::height_field::{Grid, HeightField};
use super::lattice::Lattice;
use crate::mesh::{Attributes, Mesh};

/// Vertices of a mesh over a field, by their places, and its triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Extract {
    pub(crate) places: Vec<Place>,
    pub(crate) heights: Vec<f32>,
    /// Counter-clockwise from above.
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Calls `visit` with each triangle of the mesh of the vertices, by number, that `is_left` says are left; with the
/// names of its corners apex, from and to, which `name` gives: once to each place, though asked twice at most.
fn leaves(
    lattice: &Lattice,
    is_left: &impl Fn(usize) -> bool,
    name: &mut impl FnMut(Place) -> u32,
    visit: &mut impl FnMut(&Half, [u32; 3]),
) {
    let layout = lattice.layout();
    let levels = layout.levels();
    // Midpoints that one of the two triangles beside them has split so far.
    let mut half_known: HashMap<usize, u32> = HashMap::new();
    let corner = |place: Place| {
        place[1] / layout.side() as u32 * (layout.base()[0] as u32 + 1) + place[0] / layout.side() as u32
    };
    let mut corners = HashMap::new();
    let mut stack = Vec::new();
    for root in lattice.roots() {
        let names = [root.apex, root.from, root.to]
            .map(|place| *corners.entry(corner(place)).or_insert_with(|| name(place)));
        stack.push((root, names));
        while let Some((triangle, names)) = stack.pop() {
            if triangle.level <= levels {
                let midpoint = triangle.midpoint();
                let vertex = layout.index(midpoint);
                if is_left(vertex) {
                    let place = [midpoint.x as u32, midpoint.y as u32];
                    let middle = match half_known.remove(&vertex) {
                        Some(known) => known,
                        None => {
                            let new = name(place);
                            half_known.insert(vertex, new);
                            new
                        }
                    };
                    let [apex, from, to] = names;
                    let [first, second] = triangle.halves();
                    stack.push((second, [middle, to, apex]));
                    stack.push((first, [middle, apex, from]));
                    continue;
                }
            }
            visit(&triangle, names);
        }
    }
}

/// The mesh of the vertices, by number, that `is_left` says are left, cut off at the edges of the field and without
/// the triangles that touch a void. Time and memory linear in what is left.
pub(crate) fn extract(lattice: &Lattice, is_left: impl Fn(usize) -> bool) -> Extract {
    let mut places = Vec::new();
    let mut triangles = Vec::new();
    let is_whole = lattice.fits();
    let mut name = |place| {
        places.push(place);
        places.len() as u32 - 1
    };
    if is_whole {
        leaves(lattice, &is_left, &mut name, &mut |_, names| triangles.push(names));
        let heights = places.iter().map(|&place| lattice.height(place)).collect();
        return Extract { places, heights, triangles };
    }
    let mut whole = Vec::new();
    leaves(lattice, &is_left, &mut name, &mut |_, names| whole.push(names));
    let heights = places.iter().map(|&place| lattice.height(place)).collect();
    let mut cutting =
        Cutting { lattice, extract: Extract { places, heights, triangles }, cuts: HashMap::new() };
    for corners in whole {
        cutting.add(corners);
    }
    cutting.extract.used()
}

/// The vertices that an extraction has, but for those that no triangle uses.
impl Extract {
    fn used(self) -> Self {
        let mut numbers = vec![u32::MAX; self.places.len()];
        let mut used = Self { triangles: self.triangles, ..Self::default() };
        for corner in used.triangles.as_flattened_mut() {
            let vertex = *corner as usize;
            if numbers[vertex] == u32::MAX {
                numbers[vertex] = used.places.len() as u32;
                used.places.push(self.places[vertex]);
                used.heights.push(self.heights[vertex]);
            }
            *corner = numbers[vertex];
        }
        used
    }

    /// As a mesh in space, with texture coordinates.
    pub(crate) fn to_mesh(&self, field: &HeightField) -> Mesh {
        mesh_over(field.grid(), &self.places, &self.heights, self.triangles.clone())
    }
}

/// A mesh in space, with texture coordinates, of vertices that stand over samples of a grid.
pub(crate) fn mesh_over(grid: Grid, places: &[Place], heights: &[f32], triangles: Vec<[u32; 3]>) -> Mesh {
    let positions = places.iter().zip(heights).map(|(&place, &height)| grid.position(place, height));
    let uvs = places.iter().map(|&place| grid.uv(place));
    let attributes = Attributes { uvs: Some(uvs.collect()), ..Attributes::default() };
    Mesh::with_attributes(positions.collect(), triangles, attributes)
        .expect("heights and spacing are finite, and triangles name vertices there are")
}

/// Cuts triangles off at the edges of the field.
///
/// Edges run along rows, columns and diagonals, so that they are cut at samples; the heights there are those of the
/// edges, whose ends need not lie on the field.
struct Cutting<'a> {
    lattice: &'a Lattice,
    extract: Extract,
    /// The vertices made on edges, by their places.
    cuts: HashMap<Place, u32>,
}

impl Cutting<'_> {
    fn add(&mut self, corners: [u32; 3]) {
        let field = self.lattice.field();
        let limits = [field.columns() as u32 - 1, field.rows() as u32 - 1];
        let mut polygon = corners.to_vec();
        for (axis, limit) in limits.into_iter().enumerate() {
            polygon = self.cut(&polygon, axis, limit);
            // What only touches the edge is a point or a line.
            if polygon.len() < 3 {
                return;
            }
        }
        let is_void = |&vertex: &u32| self.lattice.known(self.extract.places[vertex as usize]) == VOID;
        if polygon.iter().any(is_void) {
            return;
        }
        let fan = polygon[1..].windows(2).map(|pair| [polygon[0], pair[0], pair[1]]);
        self.extract.triangles.extend(fan);
    }

    /// What a convex polygon has on this side of a column (axis 0) or a row (axis 1), or on it.
    fn cut(&mut self, polygon: &[u32], axis: usize, limit: u32) -> Vec<u32> {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, &vertex) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()];
            let [at, then] = [vertex, next].map(|vertex| self.extract.places[vertex as usize][axis]);
            if at <= limit {
                kept.push(vertex);
            }
            // Ends that lie on the limit are corners already.
            if (at < limit && then > limit) || (at > limit && then < limit) {
                kept.push(self.cut_edge(vertex, next, axis, limit));
            }
        }
        kept
    }

    fn cut_edge(&mut self, a: u32, b: u32, axis: usize, limit: u32) -> u32 {
        let places = [a, b].map(|vertex| self.extract.places[vertex as usize]);
        let heights = [a, b].map(|vertex| f64::from(self.extract.heights[vertex as usize]));
        // From both of its triangles an edge is cut from the same end.
        let [(low, below), (high, above)] = match places[0] <= places[1] {
            true => [(places[0], heights[0]), (places[1], heights[1])],
            false => [(places[1], heights[1]), (places[0], heights[0])],
        };
        let part = (f64::from(limit) - f64::from(low[axis])) / (f64::from(high[axis]) - f64::from(low[axis]));
        let other = 1 - axis;
        let along = f64::from(low[other]) + part * (f64::from(high[other]) - f64::from(low[other]));
        let mut place = [0; 2];
        place[axis] = limit;
        place[other] = along.round() as u32;
        let Extract { places, heights, .. } = &mut self.extract;
        *self.cuts.entry(place).or_insert_with(|| {
            places.push(place);
            heights.push((below + part * (above - below)) as f32);
            places.len() as u32 - 1
        })
    }
}
