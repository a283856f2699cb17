//! A directory with a mesh in it, to be simplified there.

use std::ops::ControlFlow;
use std::path::PathBuf;

use decimesh::io::{self, WriteOptions};
use decimesh::out_of_core::{OutOfCoreError, Outcome, simplify_file};
use decimesh::{Mesh, Monitor, Options};
use tempfile::TempDir;

pub(crate) const MEGABYTE: usize = 1 << 20;

/// A number that looks random and is the same for the same arguments (SplitMix64).
pub(crate) fn noise(seed: u64, index: usize) -> u64 {
    let mut x = seed.wrapping_add((index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}

/// A directory with `in.ply`.
pub(crate) struct Workbench {
    directory: TempDir,
}

impl Workbench {
    pub(crate) fn new(bytes: &[u8]) -> Self {
        let bench = Self { directory: tempfile::tempdir().unwrap() };
        std::fs::write(bench.path("in.ply"), bytes).unwrap();
        bench
    }

    pub(crate) fn with(mesh: &Mesh) -> Self {
        let bench = Self { directory: tempfile::tempdir().unwrap() };
        io::write(mesh, &bench.path("in.ply"), &WriteOptions::default()).unwrap();
        bench
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// The names of all that is here, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.directory.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Simplifies `in.ply` to `out.ply`.
    pub(crate) fn simplify(&self, options: &Options, memory: usize) -> (Outcome, Mesh) {
        let outcome = self.try_simplify(options, memory, usize::MAX).unwrap();
        (outcome, io::read(&self.path("out.ply")).unwrap())
    }

    /// The same, cancelled at the report after `allowed` ones.
    pub(crate) fn try_simplify(
        &self,
        options: &Options,
        memory: usize,
        allowed: usize,
    ) -> Result<Outcome, OutOfCoreError> {
        let (mut reports, mut last) = (0, 0.0);
        let mut monitor = Monitor::new(|fraction| {
            assert!(fraction >= last && fraction <= 1.0, "{fraction} after {last}");
            (reports, last) = (reports + 1, fraction);
            if reports > allowed { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        simplify_file(&self.path("in.ply"), &self.path("out.ply"), options, memory, &mut monitor)
    }

    /// How many reports there are.
    pub(crate) fn reports(&self, options: &Options, memory: usize) -> usize {
        let mut reports = 0;
        let mut monitor = Monitor::new(|_| {
            reports += 1;
            ControlFlow::Continue(())
        });
        let (from, to) = (self.path("in.ply"), self.path("out.ply"));
        simplify_file(&from, &to, options, memory, &mut monitor).unwrap();
        drop(monitor);
        reports
    }

    /// What is in `out.ply`.
    pub(crate) fn output(&self) -> Vec<u8> {
        std::fs::read(self.path("out.ply")).unwrap()
    }
}
