//! What a mesh is made of, in numbers.

use super::entry::entry;
use super::mesh::decimesh_mesh;
use super::status::decimesh_status;
use super::structs::{self, Versioned};
use crate::mesh::{Flaws, Statistics, Topology};

/// What a mesh is made of and what is wrong with it. A face is a triangle with three different vertices.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct decimesh_statistics {
    /// sizeof(decimesh_statistics), as decimesh_statistics_init sets it.
    pub struct_size: u32,
    /// 1 if every edge has at least two faces.
    pub is_closed: i32,
    /// 1 if there is no non-manifold edge or vertex and no inconsistent edge.
    pub is_oriented_manifold: i32,
    /// Always 0.
    pub reserved: u32,
    /// Vertices, used or not.
    pub vertices: u64,
    /// Triangles, proper or not.
    pub triangles: u64,
    /// Vertices that no triangle uses.
    pub unreferenced_vertices: u64,
    /// Vertices at the position of an earlier one.
    pub duplicate_positions: u64,
    /// Triangles that name a vertex twice.
    pub degenerate_triangles: u64,
    /// Faces without area.
    pub zero_area_triangles: u64,
    /// Faces on the same three vertices as an earlier one.
    pub duplicate_triangles: u64,
    /// Edges, however many faces they have.
    pub edges: u64,
    /// Edges with one face.
    pub border_edges: u64,
    /// Closed chains of border edges: the holes of a surface.
    pub boundary_loops: u64,
    /// Edges with more than two faces.
    pub non_manifold_edges: u64,
    /// Edges with two faces that run the same way along it.
    pub inconsistent_edges: u64,
    /// Vertices at which several fans of faces touch.
    pub non_manifold_vertices: u64,
    /// Pieces of the surface.
    pub components: u64,
    /// Vertices that a face uses, minus edges, plus faces: 2 for a sphere, 0 for a torus.
    pub euler_characteristic: i64,
    /// Least coordinates over the vertices that a triangle uses; 0 without triangles.
    pub bounds_min: [f32; 3],
    /// Greatest coordinates over the vertices that a triangle uses; 0 without triangles.
    pub bounds_max: [f32; 3],
    /// Length of the diagonal of the bounds, in units of the positions.
    pub diagonal: f64,
    /// Sum of the areas of the triangles, in squared units of the positions.
    pub surface_area: f64,
}

// SAFETY: repr(C); integers and floats that leave no gap between them.
unsafe impl Versioned for decimesh_statistics {
    const NAME: &'static str = "decimesh_statistics";

    fn initial() -> Self {
        Self { struct_size: size_of::<Self>() as u32, ..Self::default() }
    }
}

impl From<Statistics> for decimesh_statistics {
    fn from(statistics: Statistics) -> Self {
        let Statistics { flaws, topology, bounds, diagonal, surface_area, .. } = statistics;
        let Flaws { degenerate_triangles, zero_area_triangles, duplicate_triangles } = flaws;
        let Topology { edges, border_edges, boundary_loops, components, .. } = topology;
        let (bounds_min, bounds_max) = bounds.unwrap_or_default();
        Self {
            is_closed: topology.is_closed().into(),
            is_oriented_manifold: topology.is_oriented_manifold().into(),
            vertices: statistics.vertices as u64,
            triangles: statistics.triangles as u64,
            unreferenced_vertices: statistics.unreferenced_vertices as u64,
            duplicate_positions: statistics.duplicate_positions as u64,
            degenerate_triangles: degenerate_triangles as u64,
            zero_area_triangles: zero_area_triangles as u64,
            duplicate_triangles: duplicate_triangles as u64,
            edges: edges as u64,
            border_edges: border_edges as u64,
            boundary_loops: boundary_loops as u64,
            non_manifold_edges: topology.non_manifold_edges as u64,
            inconsistent_edges: topology.inconsistent_edges as u64,
            non_manifold_vertices: topology.non_manifold_vertices as u64,
            components: components as u64,
            euler_characteristic: topology.euler_characteristic(),
            bounds_min,
            bounds_max,
            diagonal,
            surface_area,
            ..Self::initial()
        }
    }
}

/// Sets struct_size and makes all else 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_statistics), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_statistics_init(statistics: *mut decimesh_statistics, struct_size: usize) {
    // SAFETY: the caller\'s pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(statistics, struct_size) }
}

/// Counts what a mesh is made of, into *statistics, which decimesh_statistics_init has set up.
///
/// Fails with _NULL or _STRUCT_SIZE. n log n time, about 20 bytes of memory a triangle and 20 a vertex;
/// any thread, and all cores.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_statistics(
    mesh: *const decimesh_mesh,
    statistics: *mut decimesh_statistics,
) -> decimesh_status {
    entry!([mesh, statistics] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let size = structs::size(statistics)?;
            structs::write(statistics, size, &(*mesh).mesh().statistics().into());
        }
        Ok(())
    })
}
