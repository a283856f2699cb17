//! Why a file was not simplified.

use std::io;
use std::path::{Path, PathBuf};

use crate::hqms::SimplifyError;
use crate::io::FileError;
use crate::mesh::MeshError;
use crate::monitor::Cancelled;
use crate::workers::ThreadsError;

/// Why a file was not simplified. What stood in the place of the output still does.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutOfCoreError {
    /// The monitor said so. The work done so far is kept.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The input cannot be read.
    #[error("cannot read {0}")]
    Read(FileError),
    /// The output cannot be written. The work done so far is kept.
    #[error("cannot write {0}")]
    Write(FileError),
    /// A file of the work directory cannot be read or written, for want of room on the disk for instance. The
    /// work done so far is kept.
    #[error("{}: {source}", path.display())]
    Work {
        /// The file or directory.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The work directory belongs to something else.
    #[error("{}: {reason}", path.display())]
    Occupied {
        /// The directory.
        path: PathBuf,
        /// What it holds, and what can be done.
        reason: String,
    },
    /// So much memory cannot do.
    #[error("{given} bytes of memory are too little for {vertices} vertices: {needed} are needed at least")]
    TooLittleMemory {
        /// How many bytes were allowed.
        given: usize,
        /// How many it takes, at least.
        needed: usize,
        /// How many vertices there are.
        vertices: usize,
    },
    /// An option has a value that it cannot have here.
    #[error("{0}")]
    InvalidOption(String),
    /// The threads asked for could not be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// A result does not make a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl From<SimplifyError> for OutOfCoreError {
    fn from(error: SimplifyError) -> Self {
        match error {
            SimplifyError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            SimplifyError::InvalidOption(reason) => Self::InvalidOption(reason),
            SimplifyError::Threads(error) => Self::Threads(error),
            SimplifyError::Mesh(error) => Self::Mesh(error),
        }
    }
}

/// That something went wrong with the file at `path` in the work directory.
pub(super) fn work(path: &Path) -> impl Fn(io::Error) -> OutOfCoreError {
    |source| {
        let source = match source.kind() {
            io::ErrorKind::UnexpectedEof => io::Error::new(
                io::ErrorKind::UnexpectedEof,
                "the file is shorter than it was left; remove the directory to start over",
            ),
            _ => source,
        };
        OutOfCoreError::Work { path: path.to_owned(), source }
    }
}
