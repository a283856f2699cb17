//! `decimesh simplify --memory`.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use decimesh::mesh::verify;

use crate::workbench::{Workbench, ball, count, number};

/// A workbench with a ball of 79,600 triangles in `ball.ply`.
fn bench() -> Workbench {
    Workbench::with("ball.ply", &ball(200, 200))
}

#[test]
fn a_file_larger_than_memory_is_simplified() {
    let bench = bench();
    bench.run_well("simplify ball.ply out.ply --ratio 0.1 --memory 4M --report report.json");
    let (report, original, written) =
        (bench.json("report.json"), bench.read("ball.ply"), bench.read("out.ply"));
    assert!((7959..=7960).contains(&written.triangles().len()));
    verify(&original, &written, true).unwrap();
    assert_eq!(count(&report, "triangles_in"), original.triangles().len());
    assert_eq!(count(&report, "vertices_in"), original.positions().len());
    assert_eq!(count(&report, "triangles_out"), written.triangles().len());
    assert_eq!(count(&report, "vertices_out"), written.positions().len());
    assert_eq!(count(&report, "memory"), 4 << 20);
    assert!((1 << 20..4 << 20).contains(&count(&report, "peak_bytes")), "{report}");
    assert!(count(&report, "blocks") >= 2 && count(&report, "rounds") >= 1, "{report}");
    assert!(number(&report, "error") > 0.0 && number(&report, "seconds") > 0.0);
    assert_eq!(report["stopped_by"], "target");
    assert_eq!(report["resumed"], false);
    assert_eq!(report.as_object().unwrap().len(), 14, "{report}");
    assert_eq!(bench.files(), ["ball.ply", "out.ply", "report.json"]);
}

#[test]
fn enough_memory_makes_no_difference() {
    let bench = bench();
    bench.run_well("simplify ball.ply one.ply --ratio 0.1");
    let line = bench.run_well("simplify ball.ply two.ply --ratio 0.1 --memory 1G");
    assert_eq!(bench.bytes("one.ply"), bench.bytes("two.ply"));
    assert_eq!(line.lines().count(), 1, "{line}");
    for part in ["79,600 -> 7,960 triangles in one run", "MB", "stopped by target", "topology kept"] {
        assert!(line.contains(part), "{part:?} is not in {line:?}");
    }
}

#[test]
fn threads_do_not_change_the_bytes() {
    let bench = bench();
    for threads in [1, 2] {
        let line = format!(
            "simplify ball.ply {threads}.ply --triangles 20000 --memory 4M --threads {threads} --quiet"
        );
        assert_eq!(bench.run_well(&line), "");
    }
    assert_eq!(bench.bytes("1.ply"), bench.bytes("2.ply"));
}

#[test]
fn a_killed_run_is_gone_on_with() {
    let bench = bench();
    let line = "simplify ball.ply out.ply --ratio 0.3 --memory 4M";
    bench.run_well(line);
    let expected = bench.bytes("out.ply");
    std::fs::remove_file(bench.path("out.ply")).unwrap();

    let mut killed = Command::new(env!("CARGO_BIN_EXE_decimesh"))
        .args(line.split(' '))
        .current_dir(bench.path(""))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    // The first block is through, or all of it.
    let begin = Instant::now();
    while !bench.path("out.ply.work/vertices-1").exists()
        && killed.try_wait().unwrap().is_none()
        && begin.elapsed() < Duration::from_secs(60)
    {
        std::thread::sleep(Duration::from_millis(1));
    }
    let was_killed = killed.try_wait().unwrap().is_none();
    killed.kill().unwrap();
    killed.wait().unwrap();

    let outcome = bench.run(line);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert_eq!(
        outcome.stderr.contains("going on with unfinished work in out.ply.work"),
        was_killed,
        "{outcome:?}"
    );
    assert!(bench.bytes("out.ply") == expected, "another result after a kill");
    assert_eq!(bench.files(), ["ball.ply", "out.ply"]);
}

#[test]
fn what_is_not_done_out_of_core_is_refused() {
    let bench = bench();
    for (options, code, part) in [
        ("--ratio 0.5 --memory much", 2, "a size is a number"),
        ("--vertices 9 --memory 8M", 5, "a number of triangles or a ratio"),
        ("--max-error 1% --memory 8M", 5, "a number of triangles or a ratio"),
        ("--ratio 2 --memory 8M", 5, "not between 0 and 1"),
        ("--ratio 0.5 --memory 8M --engine indices", 5, "--memory is for --engine hqms"),
        ("--ratio 0.5 --memory 8M --weld", 5, "--weld"),
        ("--ratio 0.5 --memory 8M --verify", 5, "--verify"),
        ("--ratio 0.5 --memory 8M --ascii", 5, "--ascii"),
        ("--ratio 0.5 --memory 1M", 5, "bytes of memory are too little for 39802 vertices"),
    ] {
        bench.run_badly(&format!("simplify ball.ply out.ply {options}"), code, part);
    }
    bench.run_badly("simplify ball.ply out.obj --ratio 0.5 --memory 8M", 5, "PLY alone");
    bench.run_badly("simplify missing.ply out.ply --ratio 0.5 --memory 8M", 3, "cannot read missing.ply");
    bench.run_badly("simplify ball.ply nowhere/out.ply --ratio 0.5 --memory 8M", 4, "nowhere/out.ply");
    std::fs::create_dir(bench.path("out.ply.work")).unwrap();
    std::fs::write(bench.path("out.ply.work/letter"), "dear").unwrap();
    bench.run_badly("simplify ball.ply out.ply --ratio 0.5 --memory 4M", 4, "out.ply.work");
}
