//! `decimesh info`: what is in a file.

use decimesh::Mesh;
use decimesh::mesh::Statistics;
use serde::Serialize;

use crate::arguments::InfoArguments;
use crate::failure::Failure;
use crate::files::read;
use crate::report::{self, grouped, significant};

pub(crate) fn run(arguments: &InfoArguments) -> Result<(), Failure> {
    let mesh = read(&arguments.input, None)?;
    let report = InfoReport::new(&mesh);
    report::print(&if arguments.json { report::json(&report)? } else { report.text() })
}

/// What `info --json` prints.
#[derive(Debug, Serialize)]
struct InfoReport {
    triangles: usize,
    vertices: usize,
    unreferenced_vertices: usize,
    /// Vertices at the position of an earlier one.
    duplicate_positions: usize,
    degenerate_triangles: usize,
    zero_area_triangles: usize,
    duplicate_triangles: usize,
    edges: usize,
    border_edges: usize,
    boundary_loops: usize,
    non_manifold_edges: usize,
    non_manifold_vertices: usize,
    inconsistent_edges: usize,
    components: usize,
    euler_characteristic: i64,
    closed: bool,
    oriented_manifold: bool,
    /// Least and greatest coordinates of what triangles use; null without a triangle.
    bounds: Option<[[f32; 3]; 2]>,
    diagonal: f64,
    surface_area: f64,
    normals: bool,
    colors: bool,
    uvs: bool,
}

impl InfoReport {
    fn new(mesh: &Mesh) -> Self {
        let Statistics {
            vertices,
            triangles,
            unreferenced_vertices,
            duplicate_positions,
            flaws,
            topology,
            bounds,
            diagonal,
            surface_area,
        } = mesh.statistics();
        let attributes = mesh.attributes();
        Self {
            triangles,
            vertices,
            unreferenced_vertices,
            duplicate_positions,
            degenerate_triangles: flaws.degenerate_triangles,
            zero_area_triangles: flaws.zero_area_triangles,
            duplicate_triangles: flaws.duplicate_triangles,
            edges: topology.edges,
            border_edges: topology.border_edges,
            boundary_loops: topology.boundary_loops,
            non_manifold_edges: topology.non_manifold_edges,
            non_manifold_vertices: topology.non_manifold_vertices,
            inconsistent_edges: topology.inconsistent_edges,
            components: topology.components,
            euler_characteristic: topology.euler_characteristic(),
            closed: topology.is_closed(),
            oriented_manifold: topology.is_oriented_manifold(),
            bounds: bounds.map(|(low, high)| [low, high]),
            diagonal,
            surface_area,
            normals: attributes.normals.is_some(),
            colors: attributes.colors.is_some(),
            uvs: attributes.uvs.is_some(),
        }
    }

    fn text(&self) -> String {
        let yes = |truth: bool| if truth { "yes" } else { "no" }.to_owned();
        let corner = |[x, y, z]: [f32; 3]| format!("({x}, {y}, {z})");
        let bounds = self
            .bounds
            .map_or_else(|| "none".to_owned(), |[low, high]| format!("{} to {}", corner(low), corner(high)));
        let attributes = [("normals", self.normals), ("colours", self.colors), ("uvs", self.uvs)];
        let attributes: Vec<&str> =
            attributes.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect();
        let attributes = if attributes.is_empty() { "none".to_owned() } else { attributes.join(", ") };
        let rows = [
            ("triangles", grouped(self.triangles)),
            ("vertices", grouped(self.vertices)),
            ("attributes", attributes),
            ("bounds", bounds),
            ("diagonal", significant(self.diagonal)),
            ("surface area", significant(self.surface_area)),
            ("components", grouped(self.components)),
            ("Euler characteristic", self.euler_characteristic.to_string()),
            ("closed", yes(self.closed)),
            ("oriented manifold", yes(self.oriented_manifold)),
            ("boundary loops", grouped(self.boundary_loops)),
            ("border edges", grouped(self.border_edges)),
            ("non-manifold edges", grouped(self.non_manifold_edges)),
            ("non-manifold vertices", grouped(self.non_manifold_vertices)),
            ("inconsistent edges", grouped(self.inconsistent_edges)),
            ("degenerate triangles", grouped(self.degenerate_triangles)),
            ("zero-area triangles", grouped(self.zero_area_triangles)),
            ("duplicate triangles", grouped(self.duplicate_triangles)),
            ("unreferenced vertices", grouped(self.unreferenced_vertices)),
            ("duplicate positions", grouped(self.duplicate_positions)),
        ];
        rows.map(|(name, value)| format!("{name:<22} {value}\n")).concat()
    }
}
