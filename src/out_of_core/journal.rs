//! What is done, in a file of JSON that is replaced whole after each step; and the directory it is in.
//!
//! Everything else in the directory follows from the journal: a file may be longer than the journal says, for
//! a step that was not finished, and is then cut off; or be left over from a round that is finished.

use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::OutOfCoreError;
use super::error::work;
use crate::io::ply::Carried;

/// What is asked for. Work can be gone on with only if it is the same.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Task {
    /// Changes when what is stored, or what is made of it, does.
    pub(super) version: u32,
    pub(super) input: PathBuf,
    pub(super) input_bytes: u64,
    /// Seconds and nanoseconds.
    pub(super) input_modified: (u64, u32),
    pub(super) target: String,
    pub(super) options: String,
    pub(super) memory: usize,
}

impl Task {
    /// What differs from another task, and how: none if nothing does.
    fn difference(&self, other: &Self) -> Option<String> {
        let differs = |what: &str, ours: &dyn std::fmt::Debug, other: &dyn std::fmt::Debug| {
            Some(format!("{what} was {other:?} there and is {ours:?} here"))
        };
        if self.version != other.version {
            differs("the version of the work", &self.version, &other.version)
        } else if self.input != other.input {
            differs("the input", &self.input, &other.input)
        } else if self.input_bytes != other.input_bytes {
            differs("the length of the input", &self.input_bytes, &other.input_bytes)
        } else if self.input_modified != other.input_modified {
            differs("the time of the input", &self.input_modified, &other.input_modified)
        } else if self.target != other.target {
            differs("the target", &self.target, &other.target)
        } else if self.options != other.options {
            differs("the set of options", &self.options, &other.options)
        } else if self.memory != other.memory {
            differs("the memory", &self.memory, &other.memory)
        } else {
            None
        }
    }
}

/// The input, as it was taken over.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Imported {
    /// As the file has them.
    pub(super) triangles_in: usize,
    pub(super) vertices: usize,
    /// Those with three different corners: the others are left behind.
    pub(super) triangles: usize,
    pub(super) carried: Carried,
    /// The box around all vertices, bit for bit.
    pub(super) low: [u32; 3],
    pub(super) high: [u32; 3],
}

/// A part of the mesh that fits the memory.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Block {
    pub(super) triangles: usize,
    /// Those that its triangles have, shared ones included.
    pub(super) vertices: usize,
    /// See [`shares`](super::shares::shares). Empty until they are known.
    pub(super) prices: Vec<(usize, f32)>,
    pub(super) done: Option<Done>,
}

/// What became of a block.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Done {
    pub(super) triangles: usize,
    /// Those that are of this block alone.
    pub(super) vertices: usize,
    pub(super) error: f32,
}

/// One time that the whole mesh was cut into blocks, and these simplified.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Round {
    /// How many triangles the mesh is to have after it.
    pub(super) goal: usize,
    /// How many vertices are of several blocks.
    pub(super) shared: usize,
    pub(super) blocks: Vec<Block>,
}

impl Round {
    fn done(&self) -> impl Iterator<Item = &Done> {
        self.blocks.iter().filter_map(|block| block.done.as_ref())
    }

    pub(super) fn is_finished(&self) -> bool {
        self.blocks.iter().all(|block| block.done.is_some())
    }

    /// How many triangles have been made so far.
    pub(super) fn triangles(&self) -> usize {
        self.done().map(|done| done.triangles).sum()
    }

    /// How many vertices there are so far, shared ones included.
    pub(super) fn vertices(&self) -> usize {
        self.shared + self.done().map(|done| done.vertices).sum::<usize>()
    }

    pub(super) fn error(&self) -> f32 {
        self.done().map(|done| done.error).fold(0.0, f32::max)
    }
}

/// What has been done.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Journal {
    pub(super) task: Task,
    pub(super) imported: Option<Imported>,
    /// All but the last are finished.
    pub(super) rounds: Vec<Round>,
}

const JOURNAL: &str = "journal.json";
const LOCK: &str = "lock";

/// What there is in the directory for each round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// The mesh that the round begins with.
    Vertices,
    Triangles,
    /// The cell of each triangle, while blocks are cut.
    Cells,
    /// The triangles, block by block.
    Blocks,
    /// Which vertices are of several blocks.
    Shared,
}

impl Part {
    const ALL: [Self; 5] = [Self::Vertices, Self::Triangles, Self::Cells, Self::Blocks, Self::Shared];

    fn name(self) -> &'static str {
        match self {
            Self::Vertices => "vertices",
            Self::Triangles => "triangles",
            Self::Cells => "cells",
            Self::Blocks => "blocks",
            Self::Shared => "shared",
        }
    }
}

/// The directory of one task, which no other process has in its hands.
pub(super) struct Directory {
    path: PathBuf,
    /// Held open for its lock.
    _lock: File,
}

/// Whether there is a journal in a work directory.
pub(super) fn has_journal(path: &Path) -> bool {
    path.join(JOURNAL).is_file()
}

impl Directory {
    /// Makes the directory at `path` for `task`, or goes on with what is there, and says so.
    pub(super) fn open(path: &Path, task: Task) -> Result<(Self, Journal, bool), OutOfCoreError> {
        match fs::create_dir(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists && path.is_dir() => {}
            other => other.map_err(work(path))?,
        }
        let occupied = |reason: String| OutOfCoreError::Occupied { path: path.to_owned(), reason };
        let is_known = |name: &str| name == LOCK || name.starts_with(JOURNAL);
        if !has_journal(path) {
            for entry in fs::read_dir(path).map_err(work(path))? {
                let name = entry.map_err(work(path))?.file_name();
                if !is_known(&name.to_string_lossy()) {
                    return Err(occupied(format!(
                        "the directory is wanted to work in, but holds {name:?} and no {JOURNAL}"
                    )));
                }
            }
        }
        let lock_path = path.join(LOCK);
        let lock = File::create(&lock_path).map_err(work(&lock_path))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(occupied("another process is working here".to_owned()));
            }
            // A file system without locks takes the user's word.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(work(&lock_path)(error)),
        }
        let directory = Self { path: path.to_owned(), _lock: lock };
        if !has_journal(path) {
            let journal = Journal { task, imported: None, rounds: Vec::new() };
            directory.save(&journal)?;
            return Ok((directory, journal, false));
        }
        let journal_path = path.join(JOURNAL);
        let bytes = fs::read(&journal_path).map_err(work(&journal_path))?;
        let journal: Journal = serde_json::from_slice(&bytes).map_err(|error| {
            occupied(format!("{JOURNAL} is damaged ({error}); remove the directory to start over"))
        })?;
        if let Some(difference) = task.difference(&journal.task) {
            return Err(occupied(format!(
                "this is the unfinished work of another run: {difference}. Repeat that run to go on with it, or \
                 remove the directory"
            )));
        }
        Ok((directory, journal, true))
    }

    /// Replaces the journal. What it speaks of must be on disk already.
    pub(super) fn save(&self, journal: &Journal) -> Result<(), OutOfCoreError> {
        let path = self.path.join(JOURNAL);
        let new = self.path.join(format!("{JOURNAL}.new"));
        let write = || {
            let mut file = File::create(&new)?;
            file.write_all(&serde_json::to_vec(journal)?)?;
            file.sync_data()?;
            fs::rename(&new, &path)
        };
        write().map_err(work(&path))
    }

    /// Where a part of a round is.
    pub(super) fn path(&self, part: Part, round: usize) -> PathBuf {
        self.path.join(format!("{}-{round}", part.name()))
    }

    /// Removes a part of a round, if it is there.
    pub(super) fn remove(&self, part: Part, round: usize) -> Result<(), OutOfCoreError> {
        let path = self.path(part, round);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(work(&path)(error)),
            _ => Ok(()),
        }
    }

    /// Removes all parts of a round.
    pub(super) fn remove_round(&self, round: usize) -> Result<(), OutOfCoreError> {
        Part::ALL.iter().try_for_each(|&part| self.remove(part, round))
    }

    /// Removes the directory, whose work is done, with what was made in it.
    pub(super) fn remove_all(self, rounds: usize) -> Result<(), OutOfCoreError> {
        (0..=rounds).try_for_each(|round| self.remove_round(round))?;
        // Without the journal, what is left is nobody's work.
        for name in [JOURNAL.to_owned(), format!("{JOURNAL}.new"), LOCK.to_owned()] {
            let path = self.path.join(name);
            match fs::remove_file(&path) {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(work(&path)(error)),
                _ => {}
            }
        }
        fs::remove_dir(&self.path).map_err(work(&self.path))
    }
}
