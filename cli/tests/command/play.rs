//! `decimesh play`.

use crate::workbench::{Workbench, ball, count, number};

/// A ball of 3120 triangles, its levels 1 and 2, and all in between.
fn bench() -> Workbench {
    let bench = Workbench::with("ball.ply", &ball(40, 40));
    bench.run_well(
        "levels ball.ply . --count 2 --ratio 0.3 --no-measure --nested --progressive ball.dpm --quiet",
    );
    bench
}

#[test]
fn levels_are_those_of_the_chain() {
    let bench = bench();
    let sorted = |name: &str| {
        let mesh = bench.read(name);
        let corner = |vertex: u32| mesh.positions()[vertex as usize].map(f32::to_bits);
        let mut triangles: Vec<_> = mesh.triangles().iter().map(|triangle| triangle.map(corner)).collect();
        triangles.iter_mut().for_each(|triangle| {
            let least = (0..3).min_by_key(|&place| triangle[place]).unwrap();
            triangle.rotate_left(least);
        });
        triangles.sort_unstable();
        triangles
    };
    for (level, name) in ["ball.ply", "ball_1.ply", "ball_2.ply"].into_iter().enumerate() {
        let text = bench.run_well(&format!("play ball.dpm out.ply --level {level} --report report.json"));
        assert!(text.contains("error about"), "{text}");
        assert_eq!(sorted("out.ply"), sorted(name));
        let report = bench.json("report.json");
        assert_eq!(count(&report, "triangles"), bench.read("out.ply").triangles().len());
        assert_eq!(count(&report, "vertices"), bench.read("out.ply").positions().len());
        assert!(number(&report, "error") >= 0.0);
    }
}

#[test]
fn any_level_can_be_asked_for() {
    let bench = bench();
    bench.run_well("play ball.dpm out.obj --triangles 1000 --report report.json");
    assert!((999..=1000).contains(&bench.read("out.obj").triangles().len()));
    let report = bench.json("report.json");
    // What is finer was not read.
    assert_eq!(count(&report, "step"), count(&report, "steps"));
    assert!(report.get("error").is_none());
    bench.run_well("play ball.dpm out.ply --ratio 0.5");
    assert!((1559..=1560).contains(&bench.read("out.ply").triangles().len()));
    let outcome = bench.run("play ball.dpm out.ply --triangles 5 --quiet");
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""));
    assert!(outcome.stderr.contains("more than asked for"), "{outcome:?}");
    assert_eq!(bench.read("out.ply").triangles().len(), bench.read("ball_2.ply").triangles().len());
}

#[test]
fn failures_have_their_codes_and_change_nothing() {
    let bench = bench();
    let bytes = bench.bytes("ball.dpm");
    std::fs::write(bench.path("cut.dpm"), &bytes[..bytes.len() / 2]).unwrap();
    bench.run_badly("play ball.dpm out.ply", 2, "--triangles");
    bench.run_badly("play ball.dpm out.ply --level 1 --ratio 1", 2, "--ratio");
    bench.run_badly("play missing.dpm out.ply --level 0", 3, "cannot read missing.dpm");
    bench.run_badly("play ball.ply out.ply --level 0", 3, "no progressive mesh");
    bench.run_badly("play cut.dpm out.ply --level 0", 3, "cut.dpm");
    bench.run_badly("play ball.dpm out.xyz --level 0", 4, "out.xyz");
    bench.run_badly("play ball.dpm nowhere/out.ply --level 0", 4, "nowhere/out.ply");
    bench.run_badly("play ball.dpm out.ply --level 3", 5, "there is no level 3");
    bench.run_badly("play ball.dpm out.ply --ratio 1.5", 5, "between 0 and 1");
}
