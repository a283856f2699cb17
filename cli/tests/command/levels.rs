//! `decimesh levels`.

use crate::workbench::{Workbench, ball, count, number};

#[test]
fn each_level_is_a_file_as_the_report_says() {
    let bench = Workbench::with("ball.ply", &ball(40, 40));
    let text = bench.run_well("levels ball.ply out --count 3 --ratio 0.25 --format obj --report report.json");
    assert_eq!(text.lines().count(), 4, "{text}");
    assert!(text.lines().next().unwrap().contains("measured RMS"), "{text}");
    let names = ["ball.ply", "out", "out/ball_1.obj", "out/ball_2.obj", "out/ball_3.obj", "report.json"];
    assert_eq!(bench.files(), names);

    let report = bench.json("report.json");
    assert_eq!(count(&report, "triangles_in"), bench.read("ball.ply").triangles().len());
    assert!(number(&report, "seconds") >= 0.0);
    let levels = report["levels"].as_array().unwrap();
    assert_eq!(levels.len(), 3);
    for (level, number_of_level) in levels.iter().zip(1..) {
        assert_eq!(count(level, "level"), number_of_level);
        let written = bench.read(&format!("out/{}", level["file"].as_str().unwrap()));
        assert_eq!(count(level, "triangles"), written.triangles().len());
        assert_eq!(count(level, "vertices"), written.positions().len());
        let most = (3120.0 * 0.25_f64.powi(number_of_level as i32)) as usize;
        assert!((most - 1..=most).contains(&written.triangles().len()), "{level}");
        assert!(0.0 <= number(level, "rms") && number(level, "rms") <= number(level, "max"), "{level}");
    }
    for pair in levels.windows(2) {
        assert!(number(&pair[0], "error") <= number(&pair[1], "error"), "{report}");
        assert!(number(&pair[0], "rms") < number(&pair[1], "rms"), "{report}");
    }
}

#[test]
fn measuring_can_be_left_out() {
    let bench = Workbench::with("ball.ply", &ball(10, 10));
    let text = bench.run_well("levels ball.ply . --count 1 --ratio 0.5 --no-measure --report report.json");
    assert!(!text.contains("measured"), "{text}");
    let level = &bench.json("report.json")["levels"][0];
    assert!(level.get("rms").is_none() && level.get("max").is_none(), "{level}");
    assert_eq!(bench.files(), ["ball.ply", "ball_1.ply", "report.json"]);
}

#[test]
fn nested_levels_are_one_file_too() {
    let bench = Workbench::with("ball.ply", &ball(40, 40));
    let text = bench.run_well(
        "levels ball.ply out --count 2 --ratio 0.3 --no-measure --nested --progressive out/ball.dpm --report r.json",
    );
    let names =
        ["ball.ply", "out", "out/ball.dpm", "out/ball_1.ply", "out/ball_2.ply", "out/ball_levels.glb"];
    assert_eq!(bench.files(), [&names[..], &["r.json"]].concat());
    let report = bench.json("r.json");
    let (nested, progressive) = (&report["nested"], &report["progressive"]);
    assert!(text.contains("ball_levels.glb: ") && text.contains("ball.dpm: "), "{text}");
    assert_eq!(nested["file"], "ball_levels.glb");
    assert_eq!(count(nested, "bytes"), bench.bytes("out/ball_levels.glb").len());
    assert_eq!(progressive["file"], "ball.dpm");
    assert_eq!(count(progressive, "bytes"), bench.bytes("out/ball.dpm").len());
    let ends: Vec<usize> =
        nested["vertices"].as_array().unwrap().iter().map(|end| end.as_u64().unwrap() as usize).collect();
    assert_eq!(ends.len(), 3);
    assert!(ends.is_sorted_by(|finer, coarser| finer > coarser), "{ends:?}");
    // No vertex is made: those of each level are the input's, bit for bit.
    let bits = |position: &[f32; 3]| position.map(f32::to_bits);
    let input: Vec<_> = bench.read("ball.ply").positions().iter().map(bits).collect();
    assert_eq!(ends[0], input.len());
    for (level, end) in (1..).zip(&ends[1..]) {
        let mesh = bench.read(&format!("out/ball_{level}.ply"));
        assert_eq!(mesh.positions().len(), *end);
        assert!(mesh.positions().iter().all(|position| input.contains(&bits(position))));
    }
    // Any viewer that knows nothing of levels shows the input.
    assert_eq!(bench.read("out/ball_levels.glb").triangles().len(), 3120);
}

#[test]
fn certified_levels_are_no_farther_than_they_say() {
    let bench = Workbench::with("ball.ply", &ball(12, 12));
    let text = bench.run_well("levels ball.ply . --count 2 --ratio 0.4 --nested --certify --report r.json");
    assert!(text.contains("no level is farther from the input than "), "{text}");
    let report = bench.json("r.json");
    let errors = report["nested"]["errors"].as_array().unwrap();
    assert_eq!((errors.len(), errors[0].as_f64()), (3, Some(0.0)));
    assert_eq!(report["nested"]["certified"], true);
    for (error, level) in errors[1..].iter().zip(report["levels"].as_array().unwrap()) {
        assert!(error.as_f64().unwrap() >= number(level, "max"), "{report}");
    }
}

#[test]
fn a_progressive_file_ends_where_the_topology_changes() {
    let wheel = decimesh::mesh::shapes::torus(24, 12);
    let bench = Workbench::with("wheel.ply", &wheel);
    let line =
        "levels wheel.ply . --count 3 --ratio 0.1 --no-measure --nested --progressive wheel.dpm --quiet";
    let outcome = bench.run(line);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(outcome.stderr.contains("warning: wheel.dpm ends at level 1"), "{outcome:?}");
    bench.run_well("play wheel.dpm level.ply --level 1");
    bench.run_badly(
        "play wheel.dpm level.ply --level 2",
        5,
        "there is no level 2: the file has levels 0 to 1",
    );
}

#[test]
fn quiet_is_silent() {
    let bench = Workbench::with("ball.ply", &ball(20, 20));
    let outcome = bench.run("levels ball.ply out --count 2 --ratio 0.5 --quiet");
    assert_eq!((outcome.code, outcome.stdout.as_str(), outcome.stderr.as_str()), (Some(0), "", ""));
}

#[test]
fn failures_have_their_codes_and_change_nothing() {
    let bench = Workbench::with("ball.ply", &ball(10, 10));
    std::fs::write(bench.path("file"), "in the way").unwrap();
    bench.run_badly("levels ball.ply out --ratio 0.5", 2, "--count");
    bench.run_badly("levels ball.ply out --ratio 0.5 --count 0", 2, "--count");
    bench.run_badly("levels missing.ply out --ratio 0.5 --count 2", 3, "cannot read missing.ply");
    bench.run_badly("levels ball.ply file --ratio 0.5 --count 2", 4, "cannot write file");
    bench.run_badly(
        "levels ball.ply out --ratio 0.5 --count 2 --format xyz",
        4,
        "cannot write out/ball_1.xyz",
    );
    bench.run_badly("levels ball.ply out --ratio 0.5 --count 2 --report nowhere/r.json", 4, "nowhere/r.json");
    bench.run_badly("levels ball.ply out --ratio 0.5 --count 2 --progressive b.dpm", 2, "--nested");
    bench.run_badly("levels ball.ply out --ratio 0.5 --count 2 --certify", 2, "--nested");
    let line = "levels ball.ply out --ratio 0.5 --count 2 --nested --progressive nowhere/b.dpm";
    bench.run_badly(line, 4, "nowhere/b.dpm");
    for ratio in ["0", "1", "-0.5", "nan"] {
        bench.run_badly(&format!("levels ball.ply out --ratio {ratio} --count 2"), 5, "ratio");
    }
}
