//! A directory of its own for each test, meshes to put there, and the command to run there.

use std::path::{Path, PathBuf};
use std::process::Command;

use decimesh::Mesh;
use decimesh::io::{self, WriteOptions};
use serde_json::Value;
use tempfile::TempDir;

pub(crate) struct Workbench {
    directory: TempDir,
}

/// How a run ended, and what it said.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Workbench {
    /// An empty workbench.
    pub(crate) fn new() -> Self {
        Self { directory: tempfile::tempdir().unwrap() }
    }

    /// A workbench with `mesh` in the file `name`.
    pub(crate) fn with(name: &str, mesh: &Mesh) -> Self {
        let bench = Self::new();
        bench.write(name, mesh);
        bench
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, mesh: &Mesh) {
        io::write(mesh, &self.path(name), &WriteOptions::default()).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Mesh {
        io::read(&self.path(name)).unwrap()
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).unwrap()
    }

    /// All files and directories here and below, hidden ones too, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut names = Vec::new();
        list(self.directory.path(), "", &mut names);
        names.sort();
        names
    }

    /// Runs the command with the words of `line` here.
    pub(crate) fn run(&self, line: &str) -> Outcome {
        let mut command = Command::new(env!("CARGO_BIN_EXE_decimesh"));
        let output =
            command.args(line.split_whitespace()).current_dir(self.directory.path()).output().unwrap();
        Outcome {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs the command, which must succeed, and answers with what it printed.
    pub(crate) fn run_well(&self, line: &str) -> String {
        let outcome = self.run(line);
        assert_eq!(outcome.code, Some(0), "{line}: {outcome:?}");
        outcome.stdout
    }

    /// Runs the command, which must fail with `code`, say something that contains `part`, and leave
    /// all files as they are.
    pub(crate) fn run_badly(&self, line: &str, code: i32, part: &str) {
        let before: Vec<_> = self.files();
        let contents = |names: &[String]| -> Vec<_> {
            names.iter().map(|name| std::fs::read(self.path(name)).ok()).collect()
        };
        let old = contents(&before);
        let outcome = self.run(line);
        assert_eq!(outcome.code, Some(code), "{line}: {outcome:?}");
        assert!(outcome.stderr.contains(part), "{line}: {:?} does not say {part:?}", outcome.stderr);
        assert_eq!(outcome.stdout, "", "{line}");
        assert_eq!(self.files(), before, "{line}");
        assert_eq!(contents(&before), old, "{line}");
    }
}

fn list(directory: &Path, prefix: &str, names: &mut Vec<String>) {
    for entry in std::fs::read_dir(directory).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().to_str().unwrap());
        if entry.file_type().unwrap().is_dir() {
            list(&entry.path(), &format!("{name}/"), names);
        }
        names.push(name);
    }
}

/// A closed, wavy ball of 2 * `rows` * `columns` - 2 * `columns` triangles.
pub(crate) fn ball(rows: u32, columns: u32) -> Mesh {
    let mut positions = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    for row in 1..rows {
        for column in 0..columns {
            let latitude = row as f32 / rows as f32 * std::f32::consts::PI;
            let longitude = column as f32 / columns as f32 * std::f32::consts::TAU;
            let radius = 1.0 + 0.05 * (5.0 * latitude).sin() * (4.0 * longitude).cos();
            let (sin, cos) = latitude.sin_cos();
            positions.push([
                radius * sin * longitude.cos(),
                radius * sin * longitude.sin(),
                cos * (1.0 + 0.05 * (radius - 1.0)),
            ]);
        }
    }
    let at = |row: u32, column: u32| match row {
        0 => 0,
        row if row == rows => 1,
        row => 2 + (row - 1) * columns + column % columns,
    };
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let corners =
                [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            if row + 1 < rows {
                triangles.push([corners[0], corners[1], corners[2]]);
            }
            if row > 0 {
                triangles.push([corners[0], corners[2], corners[3]]);
            }
        }
    }
    Mesh::new(positions, triangles).unwrap()
}

/// A flat square of 2 * `cells`² triangles in the unit square at this height.
pub(crate) fn sheet(cells: u32, height: f32) -> Mesh {
    let side = cells + 1;
    let place = |index: u32| index as f32 / cells as f32;
    let positions = (0..side * side).map(|k| [place(k % side), place(k / side), height]).collect();
    let corners = (0..cells * cells).map(|k| k / cells * side + k % cells);
    let triangles = corners.flat_map(|k| [[k, k + 1, k + side + 1], [k, k + side + 1, k + side]]).collect();
    Mesh::new(positions, triangles).unwrap()
}

/// The field `name` of a JSON object, which must be a number.
pub(crate) fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} is no number in {value}"))
}

/// The field `name` of a JSON object, which must be a whole number.
pub(crate) fn count(value: &Value, name: &str) -> usize {
    value[name].as_u64().unwrap_or_else(|| panic!("{name} is no count in {value}")) as usize
}
