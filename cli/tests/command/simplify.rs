//! `decimesh simplify`.

use decimesh::mesh::verify;
use decimesh::{Mesh, Options, Target};

use crate::workbench::{Workbench, ball, count, number, sheet};

/// A workbench with a ball of 3,120 triangles in `ball.ply`.
fn bench() -> Workbench {
    Workbench::with("ball.ply", &ball(40, 40))
}

#[test]
fn every_target_is_met() {
    let bench = bench();
    let triangles = bench.read("ball.ply").triangles().len();
    for (option, most) in [("--triangles 500", 500), ("--ratio 0.1", triangles / 10)] {
        bench.run_well(&format!("simplify ball.ply out.ply {option}"));
        let met = bench.read("out.ply").triangles().len();
        assert!((most - 1..=most).contains(&met), "{option} made {met}");
    }
    bench.run_well("simplify ball.ply out.ply --vertices 300");
    assert!((299..=300).contains(&bench.read("out.ply").positions().len()));
}

#[test]
fn an_error_bound_is_kept_and_used() {
    let bench = bench();
    bench.run_well("simplify ball.ply out.ply --max-error 0.01 --report report.json");
    let report = bench.json("report.json");
    assert!(number(&report, "error") <= 0.01);
    assert!(count(&report, "triangles_out") < count(&report, "triangles_in") / 2);
    assert_eq!(report["stopped_by"], "error");
}

#[test]
fn a_certified_error_bound_is_proven() {
    let bench = bench();
    for engine in ["hqms", "indices"] {
        let line = "simplify ball.ply out.ply --max-error 0.01 --certify --verify --report report.json";
        let said = bench.run_well(&format!("{line} --engine {engine}"));
        assert!(said.contains("error at most"), "{said}");
        let report = bench.json("report.json");
        assert!(number(&report["bound"], "upper") <= 0.01);
        assert!(number(&report["bound"], "lower") <= number(&report["bound"], "upper"));
        assert!(count(&report, "triangles_out") < count(&report, "triangles_in") / 2);
        assert_eq!(report["stopped_by"], "error");
        let compared = bench.run_well("compare ball.ply out.ply --samples 1000 --bound --json --quiet");
        let compared: serde_json::Value = serde_json::from_str(&compared).unwrap();
        assert!(number(&compared["bound"], "lower") <= 0.01, "{compared}");
    }
    bench.run_badly("simplify ball.ply out.ply --ratio 0.5 --certify", 2, "--certify");
    bench.run_badly("simplify ball.ply out.ply --max-error -1 --certify", 5, "maximum error -1");
    let line = "simplify ball.ply out.ply --max-error 1 --certify --engine multiple-choice";
    bench.run_badly(line, 5, "--certify");
}

#[test]
fn a_share_of_the_diagonal_is_the_same_as_that_distance() {
    let bench = bench();
    let bound = 0.005 * bench.read("ball.ply").diagonal();
    bench.run_well("simplify ball.ply share.ply --max-error 0.5%");
    bench.run_well(&format!("simplify ball.ply distance.ply --max-error {bound}"));
    assert_eq!(bench.bytes("share.ply"), bench.bytes("distance.ply"));
}

#[test]
fn the_file_holds_what_the_library_makes() {
    let bench = bench();
    bench.run_well("simplify ball.ply out.ply --triangles 400 --keep-topology --verify");
    let original = bench.read("ball.ply");
    let options = Options { topology: decimesh::Topology::Keep, ..Options::new(Target::Triangles(400)) };
    let simplified = decimesh::simplify(&original, &options, &mut decimesh::Monitor::silent()).unwrap();
    let written = bench.read("out.ply");
    assert_eq!(written.positions(), simplified.mesh.positions());
    assert_eq!(written.triangles(), simplified.mesh.triangles());
    verify(&original, &written, true).unwrap();
}

#[test]
fn threads_do_not_change_the_bytes() {
    let bench = bench();
    for threads in [1, 2, 5] {
        bench.run_well(&format!("simplify ball.ply {threads}.ply --triangles 300 --threads {threads}"));
    }
    assert_eq!(bench.bytes("1.ply"), bench.bytes("2.ply"));
    assert_eq!(bench.bytes("1.ply"), bench.bytes("5.ply"));
}

#[test]
fn replacement_selection_is_another_engine_setting() {
    let bench = bench();
    bench.run_well("simplify ball.ply out.ply --triangles 300 --selection replacement --records 7");
    let options = Options {
        selection: decimesh::Selection::ReplacementSelection { records: 7 },
        ..Options::new(Target::Triangles(300))
    };
    let mut monitor = decimesh::Monitor::silent();
    let expected = decimesh::simplify(&bench.read("ball.ply"), &options, &mut monitor).unwrap().mesh;
    assert_eq!(bench.read("out.ply").positions(), expected.positions());
}

#[test]
fn report_agrees_with_the_files() {
    let bench = bench();
    bench.run_well("simplify ball.ply out.ply --triangles 500 --threads 2 --report report.json");
    let (report, original, written) =
        (bench.json("report.json"), bench.read("ball.ply"), bench.read("out.ply"));
    assert_eq!(count(&report, "triangles_in"), original.triangles().len());
    assert_eq!(count(&report, "vertices_in"), original.positions().len());
    assert_eq!(count(&report, "triangles_out"), written.triangles().len());
    assert_eq!(count(&report, "vertices_out"), written.positions().len());
    assert_eq!(count(&report, "threads"), 2);
    for name in ["seconds", "seconds_read", "seconds_write", "error"] {
        assert!(number(&report, name) >= 0.0, "{name}");
    }
    // The result itself was allocated: 12 bytes a vertex, 12 a triangle.
    let least = 12 * (written.positions().len() + written.triangles().len());
    assert!(count(&report, "peak_bytes") >= least);
    assert!(count(&report, "passes") >= 1);
    assert_eq!(report["stopped_by"], "target");
    assert!(report["topology_changed"].is_boolean());
    assert_eq!(count(&report, "locked"), 0);
    assert_eq!(report.as_object().unwrap().len(), 15, "{report}");
    assert_eq!(bench.files(), ["ball.ply", "out.ply", "report.json"]);
}

#[test]
fn a_line_is_printed_unless_quiet() {
    let bench = bench();
    let line = bench.run_well("simplify ball.ply out.ply --triangles 500");
    assert_eq!(line.lines().count(), 1, "{line}");
    for part in ["3,120 -> 500 triangles", "Mtri/s", "stopped by target", "topology kept"] {
        assert!(line.contains(part), "{part:?} is not in {line:?}");
    }
    let outcome = bench.run("simplify ball.ply out.ply --triangles 500 --quiet");
    assert_eq!((outcome.code, outcome.stdout.as_str(), outcome.stderr.as_str()), (Some(0), "", ""));
}

#[test]
fn a_missed_target_is_a_warning() {
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let bench = Workbench::with("solid.ply", &Mesh::new(corners, tetrahedron.to_vec()).unwrap());
    let outcome = bench.run("simplify solid.ply out.ply --triangles 2 --keep-topology --report report.json");
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("out.ply has 4 triangles, more than asked for"), "{outcome:?}");
    assert_eq!(bench.json("report.json")["stopped_by"], "stuck");
    assert_eq!(bench.read("out.ply").triangles().len(), 4);
}

#[test]
fn a_locked_border_stays() {
    let bench = Workbench::with("sheet.ply", &sheet(8, 0.0));
    let on_border = |mesh: &Mesh| {
        let is_border = |p: &&[f32; 3]| p[..2].iter().any(|&x| x == 0.0 || x == 1.0);
        let mut border: Vec<_> =
            mesh.positions().iter().filter(is_border).map(|p| p.map(f32::to_bits)).collect();
        border.sort_unstable();
        border
    };
    bench.run_well("simplify sheet.ply out.ply --triangles 40 --lock-boundary");
    let (original, written) = (bench.read("sheet.ply"), bench.read("out.ply"));
    assert_eq!(on_border(&original), on_border(&written));
    assert!(written.triangles().len() <= 40);
}

#[test]
fn welding_joins_what_the_file_keeps_apart() {
    let whole = sheet(4, 0.0);
    let corners: Vec<[f32; 3]> =
        whole.triangles().as_flattened().iter().map(|&v| whole.positions()[v as usize]).collect();
    let soup = (0..whole.triangles().len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let bench = Workbench::with("soup.ply", &Mesh::new(corners, soup).unwrap());
    bench.run_well("simplify soup.ply out.ply --ratio 1 --weld --report exact.json");
    assert_eq!(count(&bench.json("exact.json"), "vertices_in"), whole.positions().len());
    bench.run_well("simplify soup.ply out.ply --ratio 1 --weld=0.001 --report near.json");
    assert_eq!(count(&bench.json("near.json"), "vertices_in"), whole.positions().len());
    bench.run_well("simplify soup.ply out.ply --ratio 1 --report apart.json");
    assert_eq!(count(&bench.json("apart.json"), "vertices_in"), 3 * whole.triangles().len());
}

#[test]
fn ascii_is_text() {
    let bench = bench();
    bench.run_well("simplify ball.ply binary.ply --triangles 100");
    bench.run_well("simplify ball.ply text.ply --triangles 100 --ascii");
    assert!(bench.bytes("text.ply").starts_with(b"ply\nformat ascii"));
    assert!(bench.bytes("binary.ply").starts_with(b"ply\nformat binary"));
    assert_eq!(bench.read("text.ply"), bench.read("binary.ply"));
}

#[test]
fn an_output_may_be_the_input() {
    let bench = bench();
    bench.run_well("simplify ball.ply ball.ply --triangles 200");
    assert_eq!(bench.read("ball.ply").triangles().len(), 200);
    assert_eq!(bench.files(), ["ball.ply"]);
}

#[test]
fn failures_have_their_codes_and_change_nothing() {
    let bench = bench();
    bench.write("out.ply", &sheet(1, 0.0));
    std::fs::write(bench.path("broken.ply"), "ply\nthis is not one\n").unwrap();
    std::fs::write(bench.path("notes.txt"), "not a mesh\n").unwrap();

    bench.run_badly("simplify ball.ply out.ply", 2, "--triangles");
    bench.run_badly("simplify ball.ply out.ply --triangles 9 --ratio 0.5", 2, "--ratio");
    bench.run_badly("simplify ball.ply out.ply --triangles nine", 2, "nine");
    bench.run_badly("simplify ball.ply out.ply --max-error tiny", 2, "tiny");
    bench.run_badly(
        "simplify ball.ply out.ply --ratio 0.5 --keep-topology --allow-topology",
        2,
        "--allow-topology",
    );

    bench.run_badly("simplify missing.ply out.ply --ratio 0.5", 3, "cannot read missing.ply");
    bench.run_badly("simplify broken.ply out.ply --ratio 0.5", 3, "cannot read broken.ply");
    bench.run_badly("simplify notes.txt out.ply --ratio 0.5", 3, "cannot read notes.txt");

    bench.run_badly("simplify ball.ply nowhere/out.ply --ratio 0.5", 4, "cannot write nowhere/out.ply");
    bench.run_badly("simplify ball.ply out.xyz --ratio 0.5", 4, "cannot write out.xyz");
    bench.run_badly("simplify ball.ply out.ply --ratio 0.5 --report nowhere/r.json", 4, "nowhere/r.json");

    bench.run_badly("simplify ball.ply out.ply --max-error -1", 5, "error");
    bench.run_badly("simplify ball.ply out.ply --max-error -1%", 5, "error");
    bench.run_badly("simplify ball.ply out.ply --max-error nan", 5, "error");
    bench.run_badly("simplify ball.ply out.ply --ratio 1.5", 5, "ratio");
    bench.run_badly("simplify ball.ply out.ply --ratio -0.5", 5, "ratio");
    bench.run_badly("simplify ball.ply out.ply --ratio 0.5 --weld=-1", 5, "weld");
}

#[test]
fn the_engine_of_indices_makes_and_moves_no_vertex() {
    let bench = bench();
    let original = bench.read("ball.ply");
    for engine in ["indices", "multiple-choice"] {
        bench.run_well(&format!("simplify ball.ply out.ply --triangles 400 --engine {engine} --verify"));
        let written = bench.read("out.ply");
        assert!((399..=400).contains(&written.triangles().len()), "{engine}");
        assert!(
            written.positions().iter().all(|position| original.positions().contains(position)),
            "{engine}"
        );
    }
}

#[test]
fn the_seed_of_multiple_choice_says_what_is_drawn() {
    let bench = bench();
    for (name, options) in [("a", ""), ("b", "--seed 0"), ("c", "--seed 1"), ("d", "--candidates 20")] {
        let line = format!("simplify ball.ply {name}.ply --triangles 400 --engine multiple-choice {options}");
        bench.run_well(&line);
    }
    assert_eq!(bench.bytes("a.ply"), bench.bytes("b.ply"));
    assert_ne!(bench.bytes("a.ply"), bench.bytes("c.ply"));
    assert_ne!(bench.bytes("a.ply"), bench.bytes("d.ply"));
}

#[test]
fn what_an_engine_does_not_do_is_refused() {
    let bench = bench();
    let part = "goes by --triangles or --ratio";
    bench.run_badly("simplify ball.ply out.ply --vertices 9 --engine multiple-choice", 5, part);
    bench.run_badly("simplify ball.ply out.ply --ratio 2 --engine multiple-choice", 5, "between 0 and 1");
    bench.run_badly("simplify ball.ply out.ply --ratio 0.5 --uv-weight 1", 5, "--engine indices");
    let negative = "simplify ball.ply out.ply --ratio 0.5 --engine indices --uv-weight=-1";
    bench.run_badly(negative, 5, "the weight of uvs");
}
