//! `decimesh remesh`.

use decimesh::Mesh;
use decimesh::mesh::verify;

use crate::workbench::{Workbench, ball, count, number, sheet};

#[test]
fn a_ball_is_remeshed_and_the_report_says_how_closely() {
    let original = ball(24, 32);
    let bench = Workbench::with("ball.ply", &original);
    let text = bench.run_well("remesh ball.ply out.ply --depth 3 --base-quads 60 --report report.json");
    assert!(text.contains("quads, subdivided to") && !text.contains("decimated"), "{text}");
    let mesh = bench.read("out.ply");
    assert_eq!(verify(&original, &mesh, true), Ok(()));
    let report = bench.json("report.json");
    assert_eq!(count(&report, "triangles_in"), original.triangles().len());
    assert_eq!(count(&report, "vertices_in"), original.positions().len());
    assert_eq!(count(&report, "vertices_out"), mesh.positions().len());
    assert_eq!(count(&report, "triangles_out"), mesh.triangles().len());
    assert_eq!(count(&report, "triangles_out"), count(&report, "base_quads") * 128);
    assert!(number(&report, "rms_rel") < 0.005 && number(&report, "max_rel") < 0.05, "{report}");
    assert!(report.get("decimation").is_none(), "{report}");
}

#[test]
fn a_decimated_remesh_has_as_many_vertices_as_asked_for() {
    let original = ball(24, 32);
    let bench = Workbench::with("ball.ply", &original);
    let line = "remesh ball.ply out.ply --depth 3 --base-quads 60 --report report.json";
    let text = bench.run_well(&format!("{line} --vertices 500"));
    assert!(text.contains("decimated to"), "{text}");
    let mesh = bench.read("out.ply");
    assert_eq!(mesh.positions().len(), 500);
    assert_eq!(verify(&original, &mesh, true), Ok(()));
    let decimation = bench.json("report.json")["decimation"].clone();
    assert_eq!(count(&decimation, "wanted_vertices"), 500);
    assert!(
        number(&decimation, "rms") > 0.0 && number(&decimation, "certified_gap_db") < 1.0,
        "{decimation}"
    );

    bench.run_well(&format!("{line} --ratio 0.5 --quiet"));
    let (all, half) =
        (count(&bench.json("report.json"), "vertices"), bench.read("out.ply").positions().len());
    assert_eq!(half, (all as f64 * 0.5).round() as usize);
    let bytes = bench.bytes("out.ply");
    assert_eq!(bench.run_well(&format!("{line} --ratio 0.5 --quiet --threads 1")), "");
    assert_eq!(bytes, bench.bytes("out.ply"));
}

#[test]
fn a_picture_shows_the_input_and_what_becomes_of_it() {
    let bench = Workbench::with("ball.ply", &ball(12, 16));
    let width = |picture: &str| u32::from_be_bytes(bench.bytes(picture)[16..20].try_into().unwrap());
    bench.run_well(
        "remesh ball.ply out.ply --depth 2 --base-quads 30 --ratio 0.3 --picture three.png --quiet",
    );
    bench.run_well("remesh ball.ply out.ply --depth 2 --base-quads 30 --picture two.png --quiet");
    assert!(bench.bytes("three.png").starts_with(b"\x89PNG") && width("three.png") == width("two.png"));
    assert_ne!(bench.bytes("three.png"), bench.bytes("two.png"));
    bench.run_badly("remesh ball.ply out.ply --depth 2 --picture no/a.png", 4, "no/a.png");
}

#[test]
fn failures_have_their_codes_and_change_nothing() {
    let bench = Workbench::with("sheet.ply", &sheet(4, 0.0));
    bench.run_badly("remesh sheet.ply out.ply", 2, "--depth");
    bench.run_badly("remesh sheet.ply out.ply --depth 2 --base-quads 0", 2, "--base-quads");
    bench.run_badly("remesh sheet.ply out.ply --depth 2 --ratio 0.5 --vertices 9", 2, "--vertices");
    bench.run_badly("remesh missing.ply out.ply --depth 2", 3, "cannot read missing.ply");
    bench.run_badly("remesh sheet.ply out.txt --depth 2", 4, "cannot write out.txt");
    bench.run_badly("remesh sheet.ply no/out.ply --depth 2", 4, "does not exist");
    bench.run_badly("remesh sheet.ply out.ply --depth 0", 5, "cannot be subdivided 0 times");
    bench.run_badly("remesh sheet.ply out.ply --depth 40", 5, "cannot be subdivided 40 times");
    for ratio in ["0", "-1", "1.5", "NaN"] {
        bench.run_badly(&format!("remesh sheet.ply out.ply --depth 2 --ratio {ratio}"), 5, "ratio");
    }
    let positions = (0..5).map(|i| [i as f32, (i * i) as f32, (i * i * i) as f32]).collect();
    let pages = Mesh::new(positions, vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap();
    bench.write("pages.ply", &pages);
    bench.run_badly("remesh pages.ply out.ply --depth 2", 5, "more than two triangles");
}
