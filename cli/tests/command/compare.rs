//! `decimesh compare`.

use crate::workbench::{Workbench, ball, number, sheet};

const FIELDS: [&str; 7] = ["rms", "mean", "max", "rms_rel", "mean_rel", "max_rel", "normal_rms_degrees"];

#[test]
fn a_mesh_is_at_no_distance_from_itself() {
    let bench = Workbench::with("ball.ply", &ball(20, 20));
    let value: serde_json::Value =
        serde_json::from_str(&bench.run_well("compare ball.ply ball.ply --samples 2000 --json")).unwrap();
    for name in FIELDS {
        assert!(number(&value, name).abs() < 1e-5, "{value}");
    }
    assert_eq!(value.as_object().unwrap().len(), FIELDS.len(), "{value}");
}

#[test]
fn parallel_sheets_are_at_their_distance() {
    let bench = Workbench::with("low.ply", &sheet(3, 0.0));
    bench.write("high.ply", &sheet(5, 0.25));
    let line = "compare low.ply high.ply --samples 1000 --threads 1 --seed 7 --json";
    let text = bench.run_well(line);
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    for name in ["rms", "mean", "max"] {
        assert!((number(&value, name) - 0.25).abs() < 1e-6, "{value}");
        let relative = number(&value, &format!("{name}_rel"));
        assert!((relative - 0.25 / 2.0_f64.sqrt()).abs() < 1e-6, "{value}");
    }
    assert!(number(&value, "normal_rms_degrees") < 0.1, "{value}");
    assert_eq!(text, bench.run_well(line));
    assert_eq!(text, bench.run_well(&line.replace("--threads 1", "--threads 3")));
}

#[test]
fn a_bound_is_printed_where_it_is_asked_for() {
    let bench = Workbench::with("low.ply", &sheet(3, 0.0));
    bench.write("high.ply", &sheet(5, 0.25));
    let line = "compare low.ply high.ply --samples 1000 --bound";
    let value: serde_json::Value = serde_json::from_str(&bench.run_well(&format!("{line} --json"))).unwrap();
    assert_eq!(value.as_object().unwrap().len(), FIELDS.len() + 1, "{value}");
    let (lower, upper) = (number(&value["bound"], "lower"), number(&value["bound"], "upper"));
    assert!((lower - 0.25).abs() < 1e-6 && (0.25..0.2526).contains(&upper), "{value}");
    assert!((number(&value["bound"], "upper_rel") - upper / 2.0_f64.sqrt()).abs() < 1e-6, "{value}");
    let text = bench.run_well(line);
    assert!(text.contains("at least") && text.contains("at most"), "{text}");
}

#[test]
fn table_is_for_people() {
    let bench = Workbench::with("low.ply", &sheet(3, 0.0));
    bench.write("high.ply", &sheet(5, 0.25));
    let text = bench.run_well("compare low.ply high.ply --samples 1000");
    for part in ["RMS", "mean", "maximum", "0.250", "17.7 %", "normals"] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
}

#[test]
fn failures_have_their_codes_and_change_nothing() {
    let bench = Workbench::with("ball.ply", &ball(10, 10));
    bench.run_badly("compare ball.ply", 2, "<B>");
    bench.run_badly("compare ball.ply ball.ply --samples 0", 2, "--samples");
    bench.run_badly("compare missing.ply ball.ply", 3, "cannot read missing.ply");
    bench.run_badly("compare ball.ply missing.ply", 3, "cannot read missing.ply");
}
