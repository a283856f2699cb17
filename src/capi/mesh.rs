//! `decimesh_mesh`: a mesh that decimesh holds.

use super::buffers::{decimesh_buffers, read_mesh};
use super::entry::entry;
use super::status::{DECIMESH_ERROR_ENUM, DECIMESH_ERROR_UTF8, Failure, decimesh_status};
use super::structs;
use crate::io::{self, Encoding, WriteOptions};
use crate::mesh::{Mesh, Weld};
use std::ffi::{CStr, c_char};
use std::path::Path;
use std::ptr::{self, NonNull};

/// A triangle mesh: positions, triangles and attributes, validated when it was made and immutable since.
///
/// A const decimesh_mesh* may be used from many threads at once. It is ended by decimesh_mesh_destroy(),
/// unless it belongs to another handle, such as a decimesh_levels.
pub struct decimesh_mesh {
    held: Held,
    /// It belongs to other memory, and ends with it.
    is_borrowed: bool,
}

enum Held {
    Here(Mesh),
    /// In the handle that this one is a part of.
    Elsewhere(NonNull<Mesh>),
}

impl decimesh_mesh {
    /// A mesh that is a part of another handle, and ends with it.
    pub(super) fn part(mesh: Mesh) -> Self {
        Self { held: Held::Here(mesh), is_borrowed: true }
    }

    /// The same, where the other handle needs the mesh in a place of its own.
    ///
    /// # Safety
    /// The mesh stays where it is, and unchanged, for as long as this handle is used.
    pub(super) unsafe fn part_elsewhere(mesh: &Mesh) -> Self {
        Self { held: Held::Elsewhere(NonNull::from(mesh)), is_borrowed: true }
    }

    pub(super) fn mesh(&self) -> &Mesh {
        match &self.held {
            Held::Here(mesh) => mesh,
            // SAFETY: as whoever called `part_elsewhere` promised.
            Held::Elsewhere(mesh) => unsafe { mesh.as_ref() },
        }
    }

    /// Hands a mesh of its own to the caller.
    ///
    /// # Safety
    /// `place` is the caller's to write to.
    pub(super) unsafe fn give(mesh: Mesh, place: *mut *mut Self) {
        let handle = Box::into_raw(Box::new(Self { held: Held::Here(mesh), is_borrowed: false }));
        // SAFETY: as the caller of this function promises.
        unsafe { place.write(handle) };
    }
}

/// How numbers are written to a file, where its format leaves the choice.
pub type decimesh_encoding = i32;
/// Binary, little endian.
pub const DECIMESH_ENCODING_BINARY: decimesh_encoding = 0;
/// Binary, big endian: PLY alone; elsewhere the same as DECIMESH_ENCODING_BINARY.
pub const DECIMESH_ENCODING_BINARY_BIG_ENDIAN: decimesh_encoding = 1;
/// Text, with as few digits as bring every number back bit for bit: PLY and STL.
pub const DECIMESH_ENCODING_ASCII: decimesh_encoding = 2;

/// Makes a mesh of a copy of the caller's buffers, which are not needed any more afterwards.
///
/// Nothing is welded, dropped or moved: duplicate and degenerate triangles, vertices that no triangle
/// uses, non-manifold edges and any number of components are welcome.
///
/// *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy().
/// Fails with _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _EMPTY, _STRIDE, _OVERFLOW, _INDEX_COUNT,
/// _INDEX_RANGE, _NOT_FINITE or _OUT_OF_MEMORY. Linear in the mesh; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_from_buffers(
    buffers: *const decimesh_buffers,
    mesh: *mut *mut decimesh_mesh,
) -> decimesh_status {
    entry!([buffers, mesh] {
        // SAFETY: neither is NULL, and the caller vouches for what they and the buffers point to.
        unsafe {
            let buffers = structs::read(buffers)?;
            decimesh_mesh::give(read_mesh(&buffers)?, mesh);
        }
        Ok(())
    })
}

/// Reads a mesh from a file: PLY, OBJ, STL, OFF, glTF or GLB, as the extension of the path says.
///
/// Polygons become fans of triangles; the corners of an STL file that lie at one place become one
/// vertex; vertices of an OBJ file are as many as there are pairs of position, normal and texture
/// coordinate; a glTF scene becomes one mesh, its nodes' transforms applied.
///
/// path is UTF-8. *mesh receives the mesh, which the caller ends with decimesh_mesh_destroy(); one without
/// triangles is possible. Fails with _NULL, _UTF8, _IO, _FORMAT (the text says at which line or byte),
/// _INDEX_RANGE, _NOT_FINITE or _OVERFLOW. Time and memory are in proportion to the file; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_read(
    path: *const c_char,
    mesh: *mut *mut decimesh_mesh,
) -> decimesh_status {
    entry!([path, mesh] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let read = io::read(text(path)?)?;
            decimesh_mesh::give(read, mesh);
        }
        Ok(())
    })
}

/// Writes a mesh to a file: PLY, OBJ, STL, OFF, glTF or GLB, as the extension of the path says.
///
/// The file appears whole or not at all: it is written under another name beside its place and renamed
/// at the end. path is UTF-8; encoding is a DECIMESH_ENCODING_ value.
/// Fails with _NULL, _UTF8, _ENUM, _IO, _FORMAT (no such extension) or _TOO_LARGE (glTF ends at 4 GiB).
/// Linear in the mesh; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_write(
    mesh: *const decimesh_mesh,
    path: *const c_char,
    encoding: decimesh_encoding,
) -> decimesh_status {
    entry!([mesh, path] {
        let encoding = match encoding {
            DECIMESH_ENCODING_BINARY => Encoding::Binary,
            DECIMESH_ENCODING_BINARY_BIG_ENDIAN => Encoding::BinaryBigEndian,
            DECIMESH_ENCODING_ASCII => Encoding::Ascii,
            _ => return Err(Failure::new(DECIMESH_ERROR_ENUM, format!("encoding is {encoding}, which is none"))),
        };
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe { io::write((*mesh).mesh(), text(path)?, &WriteOptions { encoding })? };
        Ok(())
    })
}

/// Makes one vertex of all that lie at one place, or within a tolerance of an earlier one: the seams of
/// a game asset become one surface, whose attributes are those of the first vertex of each place.
///
/// tolerance is a distance in the units of the positions: finite, not negative; 0 takes equal positions
/// alone. Triangles left with fewer than three vertices are dropped.
///
/// *welded receives a new mesh, which the caller ends with decimesh_mesh_destroy(). Fails with _NULL or
/// _OPTION. n log n time; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_weld(
    mesh: *const decimesh_mesh,
    tolerance: f32,
    welded: *mut *mut decimesh_mesh,
) -> decimesh_status {
    entry!([mesh, welded] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let result = (*mesh).mesh().weld(Weld::Tolerance(tolerance))?;
            decimesh_mesh::give(result.mesh, welded);
        }
        Ok(())
    })
}

/// Ends a mesh: its memory is given back, and pointers into it are void. NULL is left alone, as is a mesh
/// that belongs to another handle.
///
/// No other thread may use the mesh any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_destroy(mesh: *mut decimesh_mesh) {
    // SAFETY: NULL, or a handle that has not been destroyed; one that is not borrowed came from a box.
    unsafe {
        if !mesh.is_null() && !(*mesh).is_borrowed {
            drop(Box::from_raw(mesh));
        }
    }
}

/// How many vertices a mesh has; 0 for NULL. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_vertex_count(mesh: *const decimesh_mesh) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { mesh.as_ref() }.map_or(0, |handle| handle.mesh().positions().len())
}

/// How many triangles a mesh has; 0 for NULL. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_triangle_count(mesh: *const decimesh_mesh) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { mesh.as_ref() }.map_or(0, |handle| handle.mesh().triangles().len())
}

/// The positions: x, y and z of each vertex, without a gap; NULL for NULL.
///
/// They belong to the mesh and are valid until it ends. Without vertices there is nothing to read.
/// Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_positions(mesh: *const decimesh_mesh) -> *const f32 {
    // SAFETY: NULL or a living handle.
    unsafe { mesh.as_ref() }.map_or(ptr::null(), |handle| handle.mesh().positions().as_ptr().cast())
}

/// The indices: three a triangle, counter-clockwise from outside; NULL for NULL.
///
/// They belong to the mesh and are valid until it ends. Without triangles there is nothing to read.
/// Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_indices(mesh: *const decimesh_mesh) -> *const u32 {
    // SAFETY: NULL or a living handle.
    unsafe { mesh.as_ref() }.map_or(ptr::null(), |handle| handle.mesh().triangles().as_ptr().cast())
}

/// The normals: x, y and z of each vertex, without a gap; NULL where there are none, and for NULL.
///
/// They belong to the mesh and are valid until it ends. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_normals(mesh: *const decimesh_mesh) -> *const f32 {
    // SAFETY: NULL or a living handle.
    let handle = unsafe { mesh.as_ref() };
    first(handle.and_then(|handle| handle.mesh().attributes().normals.as_deref()))
}

/// The texture coordinates: u and v of each vertex, without a gap; NULL where there are none, and for NULL.
///
/// They belong to the mesh and are valid until it ends. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_uvs(mesh: *const decimesh_mesh) -> *const f32 {
    // SAFETY: NULL or a living handle.
    let handle = unsafe { mesh.as_ref() };
    first(handle.and_then(|handle| handle.mesh().attributes().uvs.as_deref()))
}

/// The colours: red, green, blue and alpha of each vertex, without a gap; NULL where there are none, and for
/// NULL.
///
/// They belong to the mesh and are valid until it ends. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mesh_colors(mesh: *const decimesh_mesh) -> *const u8 {
    // SAFETY: NULL or a living handle.
    let handle = unsafe { mesh.as_ref() };
    first(handle.and_then(|handle| handle.mesh().attributes().colors.as_deref()))
}

fn first<T, const N: usize>(values: Option<&[[T; N]]>) -> *const T {
    values.map_or(ptr::null(), |values| values.as_ptr().cast())
}

/// The path that a C string names.
///
/// # Safety
/// `path` is not NULL and ends with a NUL.
pub(super) unsafe fn text<'a>(path: *const c_char) -> Result<&'a Path, Failure> {
    // SAFETY: as the caller of this function promises.
    match unsafe { CStr::from_ptr(path) }.to_str() {
        Ok(path) => Ok(Path::new(path)),
        Err(error) => Err(Failure::new(DECIMESH_ERROR_UTF8, format!("path is not UTF-8: {error}"))),
    }
}
