//! Mesh files: PLY, OBJ, STL, OFF and glTF, read and written. Files of [`heights`] are read too.
//!
//! | | positions and triangles | normals | colours | texture coordinates | encodings |
//! |---|---|---|---|---|---|
//! | PLY | exact | yes | yes | yes | binary (both byte orders), ASCII |
//! | OBJ | exact | yes | yes, without alpha | yes | text |
//! | STL | exact positions, no sharing | no | no | no | binary, ASCII |
//! | OFF | exact | yes | yes | yes | text |
//! | glTF, GLB | exact, unless there is no triangle | yes | yes | yes | JSON with base64, binary |
//!
//! Reading, in every format:
//! - Polygons become fans around their first corner; those of fewer than three corners are dropped.
//! - Strips lose the triangles that name a vertex twice: these only steer the strip. All other
//!   degenerate triangles stay.
//! - Where only a part of a file has colours or texture coordinates, the rest becomes white or
//!   (0, 0). Where only a part has normals, there are none. Normals are made unit length.
//! - Numbers of colours are taken as they are: none is moved between linear and sRGB.
//! - STL knows no shared vertices: corners at equal positions become one vertex, in order of first
//!   appearance.
//! - OBJ lets the faces around a position disagree in normal and texture coordinates: the position
//!   then becomes several vertices. The first stays in its place, the others follow at the end.
//! - glTF: all triangles of the default scene (the first, if none is named the default), moved by
//!   their nodes' transforms; without any scene, all meshes once, as they are. Skins and morph
//!   targets are at rest: what a skinned node shows is its mesh, untransformed.
//!
//! No file makes reading panic, or take more memory than in proportion to its size. A glTF scene that
//! repeats its meshes may mean 4 million vertices and corners, or 64 for each byte of its buffers,
//! whichever is more; what means more is refused.
//!
//! Writing glTF turns the texture coordinates' v over, as reading does, which may round its last bit;
//! a mesh without triangles becomes a document without a mesh.

mod gltf;
pub mod heights;
mod obj;
mod off;
pub(crate) mod ply;
mod replace;
pub(crate) mod source;
mod stl;
mod text;

use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub(crate) use gltf::LevelOfDetail;
pub(crate) use replace::replace;
use source::Source;

use crate::mesh::{Attributes, Mesh, MeshError};

/// A kind of mesh file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Stanford polygon format, `.ply`.
    Ply,
    /// Wavefront, `.obj`.
    Obj,
    /// Stereolithography, `.stl`.
    Stl,
    /// Geomview's object file format, `.off`.
    Off,
    /// glTF 2.0 as JSON, `.gltf`. Written with its buffer embedded.
    Gltf,
    /// glTF 2.0 in one binary file, `.glb`.
    Glb,
}

impl Format {
    /// The format that the extension of `path` names, in upper or lower case.
    pub fn from_path(path: &Path) -> Result<Self, FileError> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "ply" => Ok(Self::Ply),
            "obj" => Ok(Self::Obj),
            "stl" => Ok(Self::Stl),
            "off" => Ok(Self::Off),
            "gltf" => Ok(Self::Gltf),
            "glb" => Ok(Self::Glb),
            _ => Err(FileError::UnknownFormat { path: path.to_owned() }),
        }
    }
}

/// How numbers are written, in formats that leave the choice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Encoding {
    /// Binary, little endian.
    #[default]
    Binary,
    /// Binary, big endian: PLY only; elsewhere the same as [`Binary`](Self::Binary).
    BinaryBigEndian,
    /// Text, with as few digits as bring every number back bit for bit: PLY and STL.
    Ascii,
}

/// How to write a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WriteOptions {
    /// How numbers are written. Formats that leave no choice ignore it.
    pub encoding: Encoding,
}

/// Where in a file something is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// An object of a glTF document, such as `meshes[0].primitives[1]`, or a part of a file of heights, such
    /// as `row 12`.
    Object(String),
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(formatter, "line {line}"),
            Self::Byte(byte) => write!(formatter, "byte {byte}"),
            Self::Object(object) => formatter.write_str(object),
        }
    }
}

/// Why bytes do not make a mesh, or heights.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The bytes could not be had.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// They break the rules of the format.
    #[error("{place}: {problem}")]
    Malformed {
        /// Where.
        place: Place,
        /// What is wrong there.
        problem: String,
    },
    /// They keep the rules, but use a part of the format that is not read.
    #[error("{0} cannot be read")]
    Unsupported(String),
    /// They say something that no mesh can hold.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl ReadError {
    fn in_object(object: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Malformed { place: Place::Object(object.into()), problem: problem.into() }
    }

    /// The same error, said of `part`.
    fn within(self, part: impl fmt::Display) -> Self {
        match self {
            Self::Malformed { place, problem } => {
                Self::Malformed { place, problem: format!("{part}: {problem}") }
            }
            other => other,
        }
    }
}

/// Why a mesh could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The bytes could not be put where they belong.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A glTF buffer or a GLB file would exceed the 4 GiB it can count.
    #[error("the mesh takes {bytes} bytes, more than the 4 GiB of a glTF file; PLY has no such limit")]
    TooLarge {
        /// How many it would take.
        bytes: u64,
    },
}

/// Why a mesh file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The extension names no format.
    #[error("{}: the extension is none of ply, obj, stl, off, gltf, glb", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The extension names no format of heights.
    #[error("{}: the extension is none of png, tif, tiff, npy, raw, bin, f32, i16, u16", path.display())]
    UnknownHeightFormat {
        /// The file.
        path: PathBuf,
    },
    /// Reading failed.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why, and where.
        source: ReadError,
    },
    /// Writing failed; what stood at `path` before still does.
    #[error("{}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: WriteError,
    },
}

/// The mesh in the file at `path`; its extension says the format.
///
/// The [module](self) tells what becomes of polygons, strips, scenes and missing attributes.
pub fn read(path: &Path) -> Result<Mesh, FileError> {
    let format = Format::from_path(path)?;
    open_and_read(path, format).map_err(|source| FileError::Read { path: path.to_owned(), source })
}

fn open_and_read(path: &Path, format: Format) -> Result<Mesh, ReadError> {
    let mut file = File::open(path)?;
    let metadata = file.metadata()?;
    let length = metadata.is_file().then_some(metadata.len());
    read_source(&mut Source::new(&mut file, length), format, path.parent())
}

/// The mesh in `bytes`. A glTF document must not name other files.
pub fn read_from_slice(mut bytes: &[u8], format: Format) -> Result<Mesh, ReadError> {
    let length = bytes.len() as u64;
    read_source(&mut Source::new(&mut bytes, Some(length)), format, None)
}

fn read_source(source: &mut Source, format: Format, directory: Option<&Path>) -> Result<Mesh, ReadError> {
    if source.peek(1)?.is_empty() {
        return Err(source.error_here("the file is empty"));
    }
    match format {
        Format::Ply => ply::read(source),
        Format::Obj => obj::read(source),
        Format::Stl => stl::read(source),
        Format::Off => off::read(source),
        Format::Gltf | Format::Glb => gltf::read(source, directory),
    }
}

/// Writes `mesh` to the file at `path`; its extension says the format.
///
/// The file appears whole or not at all: it is written under another name in the same directory
/// and renamed at the end, and keeps the permissions of the file that it replaces. On an error
/// nothing is left behind.
pub fn write(mesh: &Mesh, path: &Path, options: &WriteOptions) -> Result<(), FileError> {
    let format = Format::from_path(path)?;
    replace(path, |file| write_to(mesh, format, options, file))
}

/// Writes `mesh` to `writer` and flushes it. `writer` need not be buffered.
pub fn write_to(
    mesh: &Mesh,
    format: Format,
    options: &WriteOptions,
    writer: impl Write,
) -> Result<(), WriteError> {
    let mut writer = BufWriter::with_capacity(1 << 18, writer);
    match format {
        Format::Ply => ply::write(mesh, options.encoding, &mut writer)?,
        Format::Obj => obj::write(mesh, &mut writer)?,
        Format::Stl => stl::write(mesh, options.encoding, &mut writer)?,
        Format::Off => off::write(mesh, &mut writer)?,
        Format::Gltf => gltf::write_document(mesh, &mut writer)?,
        Format::Glb => gltf::write_binary(mesh, &mut writer)?,
    }
    writer.flush()?;
    Ok(())
}

/// Writes the levels of `mesh` to the file at `path` as GLB.
pub(crate) fn write_levels(mesh: &Mesh, levels: &[LevelOfDetail], path: &Path) -> Result<(), FileError> {
    replace(path, |file| {
        let mut writer = BufWriter::with_capacity(1 << 18, file);
        gltf::write_binary_levels(mesh, levels, &mut writer)?;
        Ok(writer.flush()?)
    })
}

/// The last step of every reader.
fn finish(
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    mut attributes: Attributes,
) -> Result<Mesh, ReadError> {
    for normal in attributes.normals.iter_mut().flatten() {
        *normal = unit(*normal).unwrap_or(*normal);
    }
    Ok(Mesh::with_attributes(positions, triangles, attributes)?)
}

/// `vector` at unit length, untouched where it is so to rounding; `None` if it has no direction.
pub(crate) fn unit(vector: [f32; 3]) -> Option<[f32; 3]> {
    let wide = glam::Vec3::from(vector).as_dvec3();
    let squared = wide.length_squared();
    if (squared - 1.0).abs() < 1e-6 { Some(vector) } else { Some(wide.try_normalize()?.as_vec3().into()) }
}

/// Cuts a polygon into a fan of triangles, corner by corner.
#[derive(Default)]
struct Fan {
    first: Option<u32>,
    previous: Option<u32>,
}

impl Fan {
    /// The triangle that `corner` completes, if it does.
    #[inline]
    fn push(&mut self, corner: u32) -> Option<[u32; 3]> {
        let Some(first) = self.first else {
            self.first = Some(corner);
            return None;
        };
        self.previous.replace(corner).map(|previous| [first, previous, corner])
    }
}

/// Cuts a strip into triangles, corner by corner, all of one orientation.
#[derive(Default)]
struct Strip {
    corners: [u32; 2],
    count: usize,
}

impl Strip {
    /// The triangle that `corner` completes, unless it names a vertex twice.
    fn push(&mut self, corner: u32) -> Option<[u32; 3]> {
        let [a, b] = self.corners;
        self.corners = [b, corner];
        self.count += 1;
        let triangle = if self.count % 2 == 1 { [a, b, corner] } else { [b, a, corner] };
        (self.count > 2 && a != b && b != corner && a != corner).then_some(triangle)
    }
}
