//! Everything that can end the command early, and the exit code that says so.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use decimesh::deviation::DeviationError;
use decimesh::hqms::SimplifyError;
use decimesh::io::FileError;
use decimesh::mesh::Violation;
use decimesh::rate_distortion::{RemeshError, SemiRegularError};

#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error("{0}")]
    Unexpected(String),
    #[error("cannot read {0}")]
    Read(FileError),
    #[error("cannot write {0}")]
    Write(FileError),
    #[error("cannot write {}: {source}", path.display())]
    WriteOther { path: PathBuf, source: std::io::Error },
    #[error("{0}")]
    Occupied(String),
    #[error("{0}")]
    Options(String),
    #[error("the result is wrong, so nothing was written: {0}")]
    Verification(Violation),
}

impl Failure {
    /// That something other than a mesh could not be written to `path`.
    pub(crate) fn write(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        |source| Self::WriteOther { path: path.to_owned(), source }
    }

    /// The code the process ends with, as `--help` documents it. (2 is clap's.)
    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Unexpected(_) => 1,
            Self::Read(_) => 3,
            Self::Write(_) | Self::WriteOther { .. } | Self::Occupied(_) => 4,
            Self::Options(_) => 5,
            Self::Verification(_) => 6,
        })
    }
}

impl From<SimplifyError> for Failure {
    fn from(error: SimplifyError) -> Self {
        match error {
            SimplifyError::InvalidOption(_) | SimplifyError::Threads(_) => Self::Options(error.to_string()),
            other => Self::Unexpected(other.to_string()),
        }
    }
}

impl From<DeviationError> for Failure {
    fn from(error: DeviationError) -> Self {
        match error {
            DeviationError::Empty { .. } | DeviationError::Threads(_) => Self::Options(error.to_string()),
            other => Self::Unexpected(other.to_string()),
        }
    }
}

impl From<RemeshError> for Failure {
    fn from(error: RemeshError) -> Self {
        match error {
            RemeshError::Simplify(error) => error.into(),
            RemeshError::Cancelled(_) => Self::Unexpected(error.to_string()),
            // A mesh that is no surface, or an option that does not suit it.
            other => Self::Options(other.to_string()),
        }
    }
}

impl From<SemiRegularError> for Failure {
    fn from(error: SemiRegularError) -> Self {
        match error {
            SemiRegularError::Threads(_) => Self::Options(error.to_string()),
            other => Self::Unexpected(other.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_result_has_its_own_exit_code() {
        let failure = Failure::Verification(Violation::UnreferencedVertex { vertex: 3 });
        assert_eq!(failure.exit_code(), ExitCode::from(6));
    }
}
