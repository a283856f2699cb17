//! Work that was ended is gone on with, and leads to the same bytes.

use std::fs::{self, OpenOptions};
use std::io::Write;

use decimesh::mesh::shapes;
use decimesh::out_of_core::{OutOfCoreError, is_unfinished, work_directory};
use decimesh::{Options, Target, Topology};

use crate::workbench::{MEGABYTE, Workbench};

const MEMORY: usize = 4 * MEGABYTE;

/// A stone of 69,312 triangles, which makes several blocks, and whose result at this ratio takes several rounds
/// or one.
fn bench() -> Workbench {
    Workbench::with(&shapes::bumpy_sphere(76, 5))
}

fn options(ratio: f64) -> Options {
    Options { threads: 1, ..Options::new(Target::Ratio(ratio)) }
}

#[test]
fn a_run_can_be_ended_anywhere_and_gone_on_with() {
    for ratio in [0.6, 0.1] {
        let bench = bench();
        let options = options(ratio);
        let reports = bench.reports(&options, MEMORY);
        let expected = bench.output();
        fs::write(bench.path("out.ply"), "what was there").unwrap();
        // Ended again and again, each time a little later than where it was gone on with.
        let mut ended = 0;
        for allowed in (0..).map(|run| run * 5 + run % 3) {
            match bench.try_simplify(&options, MEMORY, allowed) {
                Ok(outcome) => {
                    assert!(outcome.resumed);
                    break;
                }
                Err(OutOfCoreError::Cancelled(_)) => ended += 1,
                Err(error) => panic!("{error}"),
            }
            assert_eq!(bench.output(), b"what was there");
            // Before the first step there is nothing to go on with.
            assert!(is_unfinished(&bench.path("out.ply")) || allowed == 0);
        }
        assert!(ended >= 5, "ended {ended} times of {reports} reports");
        assert!(bench.output() == expected, "another result at {ratio} after being ended {ended} times");
        assert_eq!(bench.files(), ["in.ply", "out.ply"]);
        assert!(!is_unfinished(&bench.path("out.ply")));
    }
}

#[test]
fn each_step_can_be_the_last_before_a_kill() {
    let bench = bench();
    let options = options(0.1);
    let reports = bench.reports(&options, MEMORY);
    let expected = bench.output();
    for allowed in (1..reports - 1).step_by(reports / 12) {
        let error = bench.try_simplify(&options, MEMORY, allowed).unwrap_err();
        assert!(matches!(error, OutOfCoreError::Cancelled(_)), "{error}");
        // A kill leaves files with a part of what was to come, and a journal half replaced.
        let directory = work_directory(&bench.path("out.ply"));
        for round in 1..3 {
            for part in ["vertices", "triangles"] {
                let path = directory.join(format!("{part}-{round}"));
                if let Ok(mut file) = OpenOptions::new().append(true).open(path) {
                    file.write_all(b"half a trian").unwrap();
                }
            }
        }
        fs::write(directory.join("journal.json.new"), "{\"task\":").unwrap();
        let outcome = bench.try_simplify(&options, MEMORY, usize::MAX).unwrap();
        assert!(outcome.resumed);
        assert!(bench.output() == expected, "another result after report {allowed} of {reports}");
    }
}

#[test]
fn the_work_of_others_is_left_alone() {
    let bench = bench();
    let reports = bench.reports(&options(0.1), MEMORY);
    let refused = |options: &Options, memory: usize, part: &str| {
        let error = bench.try_simplify(options, memory, usize::MAX).unwrap_err();
        assert!(matches!(error, OutOfCoreError::Occupied { .. }), "{error}");
        assert!(error.to_string().contains(part), "{error} does not say {part}");
    };
    bench.try_simplify(&options(0.1), MEMORY, reports / 2).unwrap_err();
    refused(&options(0.2), MEMORY, "the target was \"Ratio(0.1)\" there and is \"Ratio(0.2)\" here");
    refused(&options(0.1), MEMORY + 1, "the memory was");
    refused(&Options { topology: Topology::Keep, ..options(0.1) }, MEMORY, "the set of options was");
    // Threads make no difference to the result.
    bench.try_simplify(&Options { threads: 2, ..options(0.1) }, MEMORY, 3).unwrap_err();

    let input = fs::read(bench.path("in.ply")).unwrap();
    fs::write(bench.path("in.ply"), &input[..input.len() - 1]).unwrap();
    refused(&options(0.1), MEMORY, "the length of the input was");
    fs::write(bench.path("in.ply"), &input).unwrap();
    refused(&options(0.1), MEMORY, "the time of the input was");

    let directory = work_directory(&bench.path("out.ply"));
    fs::write(directory.join("journal.json"), "{}").unwrap();
    refused(&options(0.1), MEMORY, "journal.json is damaged");
    fs::remove_file(directory.join("journal.json")).unwrap();
    fs::write(directory.join("letters"), "dear").unwrap();
    refused(&options(0.1), MEMORY, "holds");
    assert_eq!(fs::read(directory.join("letters")).unwrap(), b"dear");
}

#[test]
fn two_do_not_work_in_one_place() {
    let bench = bench();
    let mut reports = 0;
    let mut monitor = decimesh::Monitor::new(|_| {
        reports += 1;
        if reports == 4 {
            let error = bench.try_simplify(&options(0.1), MEMORY, usize::MAX).unwrap_err();
            assert!(error.to_string().contains("another process is working here"), "{error}");
        }
        std::ops::ControlFlow::Continue(())
    });
    let (from, to) = (bench.path("in.ply"), bench.path("out.ply"));
    decimesh::out_of_core::simplify_file(&from, &to, &options(0.1), MEMORY, &mut monitor).unwrap();
}

#[test]
fn files_that_went_missing_are_named() {
    let bench = bench();
    let directory = work_directory(&bench.path("out.ply"));
    // The blocks are cut, and have taken the triangles over.
    let is_cut = || directory.join("blocks-0").exists() && !directory.join("triangles-0").exists();
    for allowed in 1.. {
        bench.try_simplify(&options(0.1), MEMORY, allowed).unwrap_err();
        if is_cut() {
            break;
        }
    }
    let cut = |name: &str, bytes: u64| {
        let file = OpenOptions::new().write(true).open(directory.join(name)).unwrap();
        let old = file.metadata().unwrap().len();
        file.set_len(bytes.min(old)).unwrap();
    };
    cut("vertices-0", 1000);
    let error = bench.try_simplify(&options(0.1), MEMORY, usize::MAX).unwrap_err();
    assert!(error.to_string().contains("vertices-0: the file is shorter than it was left"), "{error}");
    fs::remove_file(directory.join("blocks-0")).unwrap();
    let error = bench.try_simplify(&options(0.1), MEMORY, usize::MAX).unwrap_err();
    assert!(error.to_string().contains("blocks-0"), "{error}");
    assert!(matches!(error, OutOfCoreError::Work { .. }));
}
