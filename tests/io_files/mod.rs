//! Small valid files as other programs write them, and what must come of them.

use decimesh::Mesh;
use decimesh::io::{Format, ReadError, read_from_slice};

mod gltf;
mod obj;
mod off;
mod ply;
mod stl;

/// Every valid text file of this module.
pub(crate) const ALL: &[(Format, &str)] = &[
    (Format::Ply, ply::RICH),
    (Format::Ply, ply::STRIPS),
    (Format::Obj, obj::SEAM),
    (Format::Obj, obj::COLORED),
    (Format::Stl, stl::TWO_SOLIDS),
    (Format::Off, off::COMMENTED),
    (Format::Off, off::COLORED),
    (Format::Gltf, gltf::SCENE),
    (Format::Gltf, gltf::SPARSE),
];

fn read(format: Format, bytes: impl AsRef<[u8]>) -> Mesh {
    read_from_slice(bytes.as_ref(), format).unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(format: Format, bytes: impl AsRef<[u8]>) -> String {
    match read_from_slice(bytes.as_ref(), format) {
        Ok(mesh) => panic!("read as {mesh:?}"),
        Err(error @ ReadError::Io(_)) => panic!("not the fault of the disk: {error}"),
        Err(error) => error.to_string(),
    }
}

/// Joins a text header and binary values.
fn with_body(header: &str, parts: &[&[u8]]) -> Vec<u8> {
    [header.as_bytes(), &parts.concat()].concat()
}
