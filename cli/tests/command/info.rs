//! `decimesh info`.

use crate::workbench::{Workbench, ball, count, number, sheet};

#[test]
fn json_is_the_mesh_s_statistics() {
    let bench = Workbench::with("sheet.ply", &sheet(4, 0.5));
    let value: serde_json::Value = serde_json::from_str(&bench.run_well("info sheet.ply --json")).unwrap();
    for (name, expected) in [
        ("triangles", 32),
        ("vertices", 25),
        ("edges", 56),
        ("border_edges", 16),
        ("boundary_loops", 1),
        ("components", 1),
        ("euler_characteristic", 1),
        ("unreferenced_vertices", 0),
        ("duplicate_positions", 0),
        ("degenerate_triangles", 0),
        ("zero_area_triangles", 0),
        ("duplicate_triangles", 0),
        ("non_manifold_edges", 0),
        ("non_manifold_vertices", 0),
        ("inconsistent_edges", 0),
    ] {
        assert_eq!(count(&value, name), expected, "{name}");
    }
    assert!((number(&value, "surface_area") - 1.0).abs() < 1e-6);
    assert!((number(&value, "diagonal") - 2.0_f64.sqrt()).abs() < 1e-6);
    assert_eq!(value["bounds"], serde_json::json!([[0.0, 0.0, 0.5], [1.0, 1.0, 0.5]]));
    for (name, expected) in [
        ("closed", false),
        ("oriented_manifold", true),
        ("normals", false),
        ("colors", false),
        ("uvs", false),
    ] {
        assert_eq!(value[name], expected, "{name}");
    }
}

#[test]
fn table_is_for_people() {
    let bench = Workbench::with("ball.ply", &ball(40, 40));
    let text = bench.run_well("info ball.ply");
    for line in ["triangles              3,120", "Euler characteristic   2", "closed                 yes"] {
        assert!(text.lines().any(|found| found == line), "{line:?} is not in:\n{text}");
    }
}

#[test]
fn failures_have_their_codes() {
    let bench = Workbench::new();
    std::fs::write(bench.path("broken.ply"), "ply\nthis is not one\n").unwrap();
    bench.run_badly("info", 2, "<IN>");
    bench.run_badly("info missing.ply", 3, "cannot read missing.ply");
    bench.run_badly("info broken.ply", 3, "cannot read broken.ply");
}
