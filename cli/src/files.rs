//! Meshes from files and to files.

use std::io::ErrorKind;
use std::path::Path;

use decimesh::Mesh;
use decimesh::io::{self, Encoding, Format, WriteOptions};
use decimesh::mesh::Weld;

use crate::failure::Failure;

/// The mesh in the file at `path`, welded where that is asked for.
pub(crate) fn read(path: &Path, weld: Option<Weld>) -> Result<Mesh, Failure> {
    let mesh = io::read(path).map_err(Failure::Read)?;
    match weld {
        Some(weld) => Ok(mesh.weld(weld).map_err(|error| Failure::Options(error.to_string()))?.mesh),
        None => Ok(mesh),
    }
}

/// Writes `mesh` in the format that the extension of `path` names.
pub(crate) fn write(mesh: &Mesh, path: &Path, ascii: bool) -> Result<(), Failure> {
    let encoding = if ascii { Encoding::Ascii } else { Encoding::Binary };
    io::write(mesh, path, &WriteOptions { encoding }).map_err(Failure::Write)
}

/// Makes `directory` unless it is there.
pub(crate) fn make_directory(directory: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(directory).map_err(Failure::write(directory))
}

/// Fails where [`write()`] to `path` would fail only after long work: its extension names no format, or
/// its directory does not exist.
pub(crate) fn check_output(path: &Path) -> Result<(), Failure> {
    check_format(path)?;
    check_directory(path)
}

/// Fails where the extension of `path` names no format.
pub(crate) fn check_format(path: &Path) -> Result<(), Failure> {
    Format::from_path(path).map(|_| ()).map_err(Failure::Write)
}

/// The name of the file at `path`.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// How long the file at `path` is.
pub(crate) fn bytes(path: &Path) -> Result<u64, Failure> {
    Ok(std::fs::metadata(path).map_err(Failure::write(path))?.len())
}

/// Fails where `path` could not be made, for its directory does not exist.
pub(crate) fn check_directory(path: &Path) -> Result<(), Failure> {
    if directory_of(path).is_dir() {
        return Ok(());
    }
    let source = std::io::Error::new(ErrorKind::NotFound, "its directory does not exist");
    Err(Failure::write(path)(source))
}

/// The same, where `made` is a directory that is made later, and is as good as there.
pub(crate) fn check_directory_but(path: &Path, made: &Path) -> Result<(), Failure> {
    if directory_of(path) == made { Ok(()) } else { check_directory(path) }
}

/// The directory that a file at `path` is in.
pub(crate) fn directory_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
