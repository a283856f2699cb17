//! What a mesh is made of and what is wrong with it, in numbers.

use std::collections::HashSet;

use rayon::prelude::*;

use super::topology::is_face;
use super::weld::first_equal;
use super::{Mesh, Rings, Topology};

/// The numbers of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Statistics {
    /// Vertices, used or not.
    pub vertices: usize,
    /// Triangles, proper or not.
    pub triangles: usize,
    /// Vertices that no triangle uses.
    pub unreferenced_vertices: usize,
    /// Vertices at the position of an earlier one (zero and negative zero are equal).
    pub duplicate_positions: usize,
    /// What the triangles themselves are like.
    pub flaws: Flaws,
    /// How they hang together.
    pub topology: Topology,
    /// Least and greatest coordinates, as [`Mesh::bounds`] has them.
    pub bounds: Option<([f32; 3], [f32; 3])>,
    /// Length of the diagonal of the bounds.
    pub diagonal: f64,
    /// Sum of the triangles' areas, in squared units of the positions.
    pub surface_area: f64,
}

/// How many triangles are no good on their own account.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Flaws {
    /// Triangles that name a vertex twice.
    pub degenerate_triangles: usize,
    /// Triangles with three different vertices, but no area: the cross product of two of their sides is
    /// zero as `f64` has it.
    pub zero_area_triangles: usize,
    /// Triangles on the same three different vertices as an earlier one, in any order.
    pub duplicate_triangles: usize,
}

impl Mesh {
    /// The numbers of the mesh. Takes n log n time and, besides the mesh, about 20 bytes a triangle and
    /// 20 a vertex.
    pub fn statistics(&self) -> Statistics {
        let rings = Rings::new(self);
        let first = first_equal(self.positions());
        Statistics {
            vertices: self.positions().len(),
            triangles: self.triangles().len(),
            unreferenced_vertices: (0..rings.vertices()).filter(|&v| rings.corners(v).is_empty()).count(),
            duplicate_positions: first.iter().zip(0..).filter(|&(&first, vertex)| first != vertex).count(),
            flaws: Flaws::new(self, &rings),
            topology: Topology::new(self, &rings),
            bounds: self.bounds(),
            diagonal: self.diagonal(),
            // Summed in order: a sum in parallel would depend on the threads.
            surface_area: self.triangles().iter().map(|triangle| doubled_area(self, triangle) / 2.0).sum(),
        }
    }
}

impl Flaws {
    /// The flaws of `mesh`; `rings` must be its own.
    pub(super) fn new(mesh: &Mesh, rings: &Rings) -> Self {
        let degenerate = mesh.triangles().par_iter().filter(|triangle| !is_face(triangle)).count();
        let zero_area = mesh.triangles().par_iter().filter(|triangle| has_zero_area(mesh, triangle)).count();
        // A triangle and its duplicates all have their least vertex in common.
        let duplicate = (0..rings.vertices())
            .into_par_iter()
            .map_init(Vec::new, |others, vertex| {
                others.clear();
                others.extend(
                    rings
                        .faces_around(vertex)
                        .map(|face| sorted(mesh.triangles()[face]))
                        .filter(|triangle| triangle[0] as usize == vertex && is_face(triangle))
                        .map(|triangle| [triangle[1], triangle[2]]),
                );
                others.sort_unstable();
                others.len() - others.chunk_by(|a, b| a == b).count()
            })
            .sum();
        Self {
            degenerate_triangles: degenerate,
            zero_area_triangles: zero_area,
            duplicate_triangles: duplicate,
        }
    }
}

/// Whether a triangle has three different vertices, but no area.
pub(super) fn has_zero_area(mesh: &Mesh, triangle: &[u32; 3]) -> bool {
    is_face(triangle) && doubled_area(mesh, triangle) == 0.0
}

/// The first triangle on the same three different vertices as an earlier one.
pub(super) fn first_duplicate(mesh: &Mesh) -> Option<usize> {
    let mut seen = HashSet::new();
    mesh.triangles().iter().position(|triangle| is_face(triangle) && !seen.insert(sorted(*triangle)))
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}

/// Length of the cross product of two sides. In `f64` neither the largest nor the smallest `f32`
/// overflow or vanish.
fn doubled_area(mesh: &Mesh, triangle: &[u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|vertex| mesh.positions()[vertex as usize].map(f64::from));
    let u: [f64; 3] = std::array::from_fn(|axis| b[axis] - a[axis]);
    let v: [f64; 3] = std::array::from_fn(|axis| c[axis] - a[axis]);
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    cross.map(|x| x * x).iter().sum::<f64>().sqrt()
}
