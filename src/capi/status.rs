//! Statuses, and the text that goes with a thread's last failure.

use crate::deviation::DeviationError;
use crate::hqms::SimplifyError;
use crate::io::{FileError, ReadError, WriteError};
use crate::lod::ProgressiveError;
use crate::mesh::{MeshError, WeldError};
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};

/// What became of a call: DECIMESH_OK, or why it failed. A value is never given a second meaning.
///
/// Where it is not DECIMESH_OK, nothing was written through any out-parameter, and
/// decimesh_last_error_message() says what is wrong and where.
pub type decimesh_status = i32;

/// The call did what it says.
pub const DECIMESH_OK: decimesh_status = 0;
/// A pointer that must not be NULL is NULL.
pub const DECIMESH_ERROR_NULL: decimesh_status = 1;
/// A struct_size is 0 (the init function was not called), too small, no multiple of 8, or absurdly large.
pub const DECIMESH_ERROR_STRUCT_SIZE: decimesh_status = 2;
/// A struct of a newer decimesh sets something that this one does not know.
pub const DECIMESH_ERROR_UNKNOWN_OPTION: decimesh_status = 3;
/// An enumerated option has a value that does not exist.
pub const DECIMESH_ERROR_ENUM: decimesh_status = 4;
/// An option is out of its range, such as a ratio of 1.5 or a locked vertex that does not exist.
pub const DECIMESH_ERROR_OPTION: decimesh_status = 5;
/// There are no vertices, no indices, or no triangles where there must be some.
pub const DECIMESH_ERROR_EMPTY: decimesh_status = 6;
/// A stride is shorter than an element.
pub const DECIMESH_ERROR_STRIDE: decimesh_status = 7;
/// Count times stride exceeds the address space, or a count exceeds what a mesh can hold.
pub const DECIMESH_ERROR_OVERFLOW: decimesh_status = 8;
/// The number of indices is no multiple of three.
pub const DECIMESH_ERROR_INDEX_COUNT: decimesh_status = 9;
/// An index names a vertex that does not exist.
pub const DECIMESH_ERROR_INDEX_RANGE: decimesh_status = 10;
/// A coordinate or an attribute is infinite or not a number.
pub const DECIMESH_ERROR_NOT_FINITE: decimesh_status = 11;
/// A level, or a mark, that does not exist was asked for.
pub const DECIMESH_ERROR_OUT_OF_RANGE: decimesh_status = 12;
/// The system refused to read or to write a file.
pub const DECIMESH_ERROR_IO: decimesh_status = 13;
/// A file breaks the rules of its format, uses a part of it that is not read, or has an extension that names none.
pub const DECIMESH_ERROR_FORMAT: decimesh_status = 14;
/// The progress callback ended the call.
pub const DECIMESH_ERROR_CANCELLED: decimesh_status = 15;
/// The threads asked for could not be started.
pub const DECIMESH_ERROR_THREADS: decimesh_status = 16;
/// A path is not UTF-8.
pub const DECIMESH_ERROR_UTF8: decimesh_status = 17;
/// The result does not fit where it is to go, such as a mesh of more than 4 GiB into a glTF file, or indices
/// into less room than they take.
pub const DECIMESH_ERROR_TOO_LARGE: decimesh_status = 18;
/// There is not enough memory for a copy of the buffers or lists.
pub const DECIMESH_ERROR_OUT_OF_MEMORY: decimesh_status = 19;
/// A bug in decimesh. The handles that the call was given must only be destroyed after that.
pub const DECIMESH_ERROR_PANIC: decimesh_status = 100;

/// Every status with its name; `tests/header.rs` holds this to the header.
const NAMES: [(decimesh_status, &CStr); 21] = [
    (DECIMESH_OK, c"DECIMESH_OK"),
    (DECIMESH_ERROR_NULL, c"DECIMESH_ERROR_NULL"),
    (DECIMESH_ERROR_STRUCT_SIZE, c"DECIMESH_ERROR_STRUCT_SIZE"),
    (DECIMESH_ERROR_UNKNOWN_OPTION, c"DECIMESH_ERROR_UNKNOWN_OPTION"),
    (DECIMESH_ERROR_ENUM, c"DECIMESH_ERROR_ENUM"),
    (DECIMESH_ERROR_OPTION, c"DECIMESH_ERROR_OPTION"),
    (DECIMESH_ERROR_EMPTY, c"DECIMESH_ERROR_EMPTY"),
    (DECIMESH_ERROR_STRIDE, c"DECIMESH_ERROR_STRIDE"),
    (DECIMESH_ERROR_OVERFLOW, c"DECIMESH_ERROR_OVERFLOW"),
    (DECIMESH_ERROR_INDEX_COUNT, c"DECIMESH_ERROR_INDEX_COUNT"),
    (DECIMESH_ERROR_INDEX_RANGE, c"DECIMESH_ERROR_INDEX_RANGE"),
    (DECIMESH_ERROR_NOT_FINITE, c"DECIMESH_ERROR_NOT_FINITE"),
    (DECIMESH_ERROR_OUT_OF_RANGE, c"DECIMESH_ERROR_OUT_OF_RANGE"),
    (DECIMESH_ERROR_IO, c"DECIMESH_ERROR_IO"),
    (DECIMESH_ERROR_FORMAT, c"DECIMESH_ERROR_FORMAT"),
    (DECIMESH_ERROR_CANCELLED, c"DECIMESH_ERROR_CANCELLED"),
    (DECIMESH_ERROR_THREADS, c"DECIMESH_ERROR_THREADS"),
    (DECIMESH_ERROR_UTF8, c"DECIMESH_ERROR_UTF8"),
    (DECIMESH_ERROR_TOO_LARGE, c"DECIMESH_ERROR_TOO_LARGE"),
    (DECIMESH_ERROR_OUT_OF_MEMORY, c"DECIMESH_ERROR_OUT_OF_MEMORY"),
    (DECIMESH_ERROR_PANIC, c"DECIMESH_ERROR_PANIC"),
];

/// A status and what it is about.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) status: decimesh_status,
    pub(super) message: String,
}

impl Failure {
    pub(super) fn new(status: decimesh_status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }
}

impl From<MeshError> for Failure {
    fn from(error: MeshError) -> Self {
        let status = match error {
            MeshError::IncompleteTriangle { .. } => DECIMESH_ERROR_INDEX_COUNT,
            MeshError::IndexOutOfRange { .. } => DECIMESH_ERROR_INDEX_RANGE,
            MeshError::NotFinite { .. } => DECIMESH_ERROR_NOT_FINITE,
            MeshError::AttributeCount { .. } => DECIMESH_ERROR_OPTION,
            MeshError::TooLarge { .. } => DECIMESH_ERROR_OVERFLOW,
        };
        Self::new(status, error.to_string())
    }
}

impl From<WeldError> for Failure {
    fn from(error: WeldError) -> Self {
        Self::new(DECIMESH_ERROR_OPTION, error.to_string())
    }
}

impl From<SimplifyError> for Failure {
    fn from(error: SimplifyError) -> Self {
        match error {
            SimplifyError::Mesh(error) => error.into(),
            SimplifyError::Cancelled(_) => Self::new(DECIMESH_ERROR_CANCELLED, error.to_string()),
            SimplifyError::InvalidOption(message) => Self::new(DECIMESH_ERROR_OPTION, message),
            SimplifyError::Threads(_) => Self::new(DECIMESH_ERROR_THREADS, error.to_string()),
        }
    }
}

impl From<DeviationError> for Failure {
    fn from(error: DeviationError) -> Self {
        let status = match error {
            DeviationError::Empty { .. } => DECIMESH_ERROR_EMPTY,
            DeviationError::InvalidTolerance(_) => DECIMESH_ERROR_OPTION,
            DeviationError::Threads(_) => DECIMESH_ERROR_THREADS,
            DeviationError::Cancelled(_) => DECIMESH_ERROR_CANCELLED,
        };
        Self::new(status, error.to_string())
    }
}

impl From<ProgressiveError> for Failure {
    fn from(error: ProgressiveError) -> Self {
        match error {
            ProgressiveError::Simplify(error) => error.into(),
            ProgressiveError::Mesh(error) => error.into(),
            ProgressiveError::VertexOutOfRange { .. }
            | ProgressiveError::IntoItself { .. }
            | ProgressiveError::VertexGone { .. }
            | ProgressiveError::Mark { .. }
            | ProgressiveError::NotTracked => Self::new(DECIMESH_ERROR_OPTION, error.to_string()),
        }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        let message = error.to_string();
        let status = match error {
            ReadError::Io(_) => DECIMESH_ERROR_IO,
            ReadError::Malformed { .. } | ReadError::Unsupported(_) => DECIMESH_ERROR_FORMAT,
            ReadError::Mesh(error) => Self::from(error).status,
        };
        Self::new(status, message)
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        let message = error.to_string();
        let status = match error {
            FileError::UnknownFormat { .. } | FileError::UnknownHeightFormat { .. } => DECIMESH_ERROR_FORMAT,
            FileError::Read { source, .. } => Self::from(source).status,
            FileError::Write { source, .. } => match source {
                WriteError::Io(_) => DECIMESH_ERROR_IO,
                WriteError::TooLarge { .. } => DECIMESH_ERROR_TOO_LARGE,
            },
        };
        Self::new(status, message)
    }
}

thread_local! {
    static LAST_MESSAGE: RefCell<CString> = RefCell::default();
}

/// Keeps the message of `failure` for this thread, and gives its status.
pub(super) fn keep(failure: Failure) -> decimesh_status {
    // A text may quote a file name, which may hold anything but a NUL; other parts hold none.
    let message = CString::new(failure.message.replace('\0', " ")).unwrap_or_default();
    // A thread that is ending has no place for it left.
    let _ = LAST_MESSAGE.try_with(|last| *last.borrow_mut() = message);
    failure.status
}

/// What was wrong in this thread's last call that failed, in English, without a line end; "" before the first.
///
/// The text is UTF-8 and belongs to decimesh: it is valid until this thread's next call that fails,
/// or its end. Each thread has its own. Constant time; never fails.
#[unsafe(no_mangle)]
pub extern "C" fn decimesh_last_error_message() -> *const c_char {
    LAST_MESSAGE.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// The name of a status, such as "DECIMESH_ERROR_NULL"; "unknown status" for a value that is none.
///
/// The text is static. Any thread; never fails.
#[unsafe(no_mangle)]
pub extern "C" fn decimesh_status_name(status: decimesh_status) -> *const c_char {
    let name = NAMES.iter().find(|(value, _)| *value == status).map(|(_, name)| *name);
    name.unwrap_or(c"unknown status").as_ptr()
}
