//! `--help` and `--version`.

use crate::workbench::Workbench;

const SUBCOMMANDS: [&str; 10] =
    ["simplify", "levels", "play", "terrain", "decompose", "extract", "remesh", "compare", "info", "demo"];

#[test]
fn help_names_all_subcommands() {
    let help = Workbench::new().run_well("--help");
    for name in SUBCOMMANDS {
        assert!(help.contains(&format!("\n  {name} ")), "{name} is not in:\n{help}");
    }
}

#[test]
fn help_documents_every_exit_code() {
    let bench = Workbench::new();
    for name in std::iter::once("").chain(SUBCOMMANDS) {
        let help = bench.run_well(&format!("{name} --help"));
        for code in 0..=6 {
            assert!(help.contains(&format!("\n  {code}  ")), "{code} is not in:\n{help}");
        }
    }
}

#[test]
fn help_of_simplify_names_all_options() {
    let help = Workbench::new().run_well("simplify --help");
    for option in [
        "triangles",
        "vertices",
        "ratio",
        "max-error",
        "certify",
        "selection",
        "records",
        "lock-boundary",
        "memory",
        "refine",
        "keep-topology",
        "allow-topology",
        "weld",
        "ascii",
        "threads",
        "verify",
        "report",
        "quiet",
    ] {
        assert!(help.contains(&format!("--{option}")), "--{option} is not in:\n{help}");
    }
}

#[test]
fn version_is_the_package_s() {
    assert_eq!(Workbench::new().run_well("--version"), format!("decimesh {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn nonsense_is_a_matter_of_usage() {
    let bench = Workbench::new();
    for line in ["", "frobnicate", "info", "simplify a.ply b.ply", "compare a.ply"] {
        bench.run_badly(line, 2, "Usage");
    }
}
