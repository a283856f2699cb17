//! `decimesh_progressive`: every level between a mesh and its coarsest one.

use super::buffers::{IndexRoom, decimesh_index_type};
use super::entry::entry;
use super::levels::read_chain;
use super::mesh::{decimesh_mesh, text};
use super::simplify::decimesh_simplify_options;
use super::status::{DECIMESH_ERROR_OUT_OF_RANGE, DECIMESH_ERROR_OVERFLOW, Failure, decimesh_status};
use crate::lod::{Extent, Progressive};
use std::ffi::{c_char, c_void};
use std::sync::Arc;
use std::{ptr, slice};

/// A mesh as its coarsest level and the splits that refine it, one after the other: immutable.
///
/// A step is the number of splits done: 0 is the coarsest level, decimesh_progressive_steps() the finest. The
/// level at a step uses the first of the vertices and the first of the triangles; which vertex a corner of a
/// triangle names depends on the step. Triangles with two corners at one place, and vertices that are in no
/// other triangle, are left out of all levels.
///
/// A const decimesh_progressive* may be used from many threads at once. It is played by a decimesh_player.
pub struct decimesh_progressive {
    pub(super) progressive: Arc<Progressive>,
    /// That of `progressive`.
    vertices: decimesh_mesh,
}

impl decimesh_progressive {
    fn new(progressive: Progressive) -> Self {
        let progressive = Arc::new(progressive);
        // SAFETY: nobody changes what is shared, and this share lives as long as the handle of the vertices.
        let vertices = unsafe { decimesh_mesh::part_elsewhere(progressive.vertices()) };
        Self { progressive, vertices }
    }

    /// Hands a progressive mesh of its own to the caller.
    ///
    /// # Safety
    /// `place` is the caller's to write to.
    unsafe fn give(progressive: Progressive, place: *mut *mut Self) {
        // SAFETY: as the caller of this function promises.
        unsafe { place.write(Box::into_raw(Box::new(Self::new(progressive)))) };
    }
}

/// Simplifies a mesh by collapses that make no vertex and move none, to each of the targets in turn, from
/// fine to coarse, keeps all levels in between, and marks where each target is met.
///
/// target_values has count values, at least 1; each is what options->target_value is for one simplification,
/// which is not looked at here, as options->placement and options->topology are not: the topology is kept, so
/// that the coarsest level may be larger than asked for. options->origins and options->result_groups must be
/// NULL.
///
/// *progressive receives the progressive mesh, which the caller ends with decimesh_progressive_destroy().
/// Fails with _NULL, _EMPTY, _OVERFLOW, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS
/// or _OUT_OF_MEMORY.
///
/// n log n time in the vertices, otherwise linear; about 130 bytes of memory a triangle for three targets
/// that halve. The progressive mesh itself takes about 34, and the vertices. Any thread; progress is told on
/// the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_build(
    mesh: *const decimesh_mesh,
    options: *const decimesh_simplify_options,
    target_values: *const f64,
    count: usize,
    progressive: *mut *mut decimesh_progressive,
) -> decimesh_status {
    entry!([mesh, options, target_values, progressive] {
        // SAFETY: none is NULL, and the caller vouches for what they point to.
        unsafe {
            let mesh = (*mesh).mesh();
            let (own, targets, options) = read_chain(mesh, options, target_values, count)?;
            let built = Progressive::build(mesh, &targets, &options, &mut own.monitor())?;
            decimesh_progressive::give(built, progressive);
        }
        Ok(())
    })
}

/// Reads a progressive mesh from a file, as docs/progressive-format.md describes it, up to the finest level
/// with at most max_triangles triangles, or the coarsest if even that has more; SIZE_MAX: all of it. What
/// follows in the file is not looked at, and need not be there.
///
/// What was read is checked split by split, so that every level is a mesh. path is UTF-8. *progressive
/// receives the progressive mesh, which the caller ends with decimesh_progressive_destroy(). Fails with
/// _NULL, _UTF8, _IO, _FORMAT (the text says at which byte), _INDEX_RANGE, _NOT_FINITE or _OVERFLOW. Time
/// and memory are in proportion to what is read; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_read(
    path: *const c_char,
    max_triangles: usize,
    progressive: *mut *mut decimesh_progressive,
) -> decimesh_status {
    entry!([path, progressive] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let read = Progressive::read(text(path)?, extent(max_triangles))?;
            decimesh_progressive::give(read, progressive);
        }
        Ok(())
    })
}

/// The same from the bytes of such a file, which may be the beginning of it. They are not needed any more
/// afterwards.
///
/// *progressive receives the progressive mesh, which the caller ends with decimesh_progressive_destroy().
/// Fails with _NULL, _FORMAT (the text says at which byte), _INDEX_RANGE, _NOT_FINITE or _OVERFLOW. Time and
/// memory are in proportion to what is read; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_from_memory(
    bytes: *const c_void,
    size: usize,
    max_triangles: usize,
    progressive: *mut *mut decimesh_progressive,
) -> decimesh_status {
    entry!([bytes, progressive] {
        if isize::try_from(size).is_err() {
            let message = format!("size is {size}, more than the address space has room for");
            return Err(Failure::new(DECIMESH_ERROR_OVERFLOW, message));
        }
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let bytes = slice::from_raw_parts(bytes.cast::<u8>(), size);
            let read = Progressive::read_from_slice(bytes, extent(max_triangles))?;
            decimesh_progressive::give(read, progressive);
        }
        Ok(())
    })
}

fn extent(max_triangles: usize) -> Extent {
    if max_triangles == usize::MAX { Extent::Whole } else { Extent::Triangles(max_triangles) }
}

/// Writes a progressive mesh to a file, as docs/progressive-format.md describes it. The usual extension is
/// .dpm.
///
/// The file appears whole or not at all, as by decimesh_mesh_write(). path is UTF-8. Fails with _NULL, _UTF8
/// or _IO. Linear in the mesh; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_write(
    progressive: *const decimesh_progressive,
    path: *const c_char,
) -> decimesh_status {
    entry!([progressive, path] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let handle = &*progressive;
            handle.progressive.write(text(path)?)?;
        }
        Ok(())
    })
}

/// Ends a progressive mesh and the mesh of its vertices; players of it go on. NULL is left alone.
///
/// No other thread may use it any more, but for its players.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_destroy(progressive: *mut decimesh_progressive) {
    if !progressive.is_null() {
        // SAFETY: a handle that came from a box and has not been destroyed.
        drop(unsafe { Box::from_raw(progressive) });
    }
}

/// How many splits lead from the coarsest level to the finest; 0 for NULL. Constant time; any thread; never
/// fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_steps(progressive: *const decimesh_progressive) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { progressive.as_ref() }.map_or(0, |handle| handle.progressive.steps())
}

/// How many vertices the level at a step has, or the finest where step is beyond that; 0 for NULL. Constant
/// time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_vertex_count(
    progressive: *const decimesh_progressive,
    step: usize,
) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { progressive.as_ref() }.map_or(0, |handle| handle.progressive.vertex_count(step))
}

/// How many triangles the level at a step has, or the finest where step is beyond that; 0 for NULL. Constant
/// time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_triangle_count(
    progressive: *const decimesh_progressive,
    step: usize,
) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { progressive.as_ref() }.map_or(0, |handle| handle.progressive.triangle_count(step))
}

/// The step of the finest level with at most so many triangles: 0, the coarsest, if none has so few, and for
/// NULL. Logarithmic time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_step_within(
    progressive: *const decimesh_progressive,
    triangles: usize,
) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { progressive.as_ref() }.map_or(0, |handle| handle.progressive.step_within(triangles))
}

/// The vertices of all levels, the last to go first, as a mesh without triangles; NULL for NULL.
///
/// It belongs to the progressive mesh and ends with it: decimesh_mesh_destroy() leaves it alone. Constant
/// time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_vertices(
    progressive: *const decimesh_progressive,
) -> *const decimesh_mesh {
    // SAFETY: NULL or a living handle.
    unsafe { progressive.as_ref() }.map_or(ptr::null(), |handle| &raw const handle.vertices)
}

/// For each vertex the one of the input that it is; NULL where the progressive mesh comes from a file, and
/// for NULL.
///
/// It belongs to the progressive mesh and is valid until it ends. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_order(progressive: *const decimesh_progressive) -> *const u32 {
    // SAFETY: NULL or a living handle.
    let order = unsafe { progressive.as_ref() }.and_then(|handle| handle.progressive.order());
    order.map_or(ptr::null(), <[u32]>::as_ptr)
}

/// Copies the indices of the level at a step, or of the finest where step is beyond that, to destination,
/// which has room for so many indices of index_type, at least three for each of its triangles.
///
/// Fails with _NULL, _ENUM, or _TOO_LARGE: there are more indices than there is room for, or more vertices
/// than indices of 16 bits can name. Linear in the level and the corners changed on the way, whose memory it
/// takes once more meanwhile; a decimesh_player goes from level to level for less. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_copy_indices(
    progressive: *const decimesh_progressive,
    step: usize,
    index_type: decimesh_index_type,
    destination: *mut c_void,
    room: usize,
) -> decimesh_status {
    entry!([progressive, destination] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let progressive = &(*progressive).progressive;
            let room = IndexRoom { index_type, destination, room };
            room.copy(&progressive.triangles_at(step), progressive.vertex_count(step))?;
        }
        Ok(())
    })
}

/// The level at a step, or the finest where step is beyond that, as a mesh of its own.
///
/// *mesh receives a new mesh, which the caller ends with decimesh_mesh_destroy(). Fails with _NULL. Linear in
/// the level and the corners changed on the way; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_mesh(
    progressive: *const decimesh_progressive,
    step: usize,
    mesh: *mut *mut decimesh_mesh,
) -> decimesh_status {
    entry!([progressive, mesh] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let handle = &*progressive;
            decimesh_mesh::give(handle.progressive.mesh_at(step), mesh);
        }
        Ok(())
    })
}

/// How many levels have a mark: each target of decimesh_progressive_build() that could be met without a
/// change of the topology; 0 for NULL. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_mark_count(progressive: *const decimesh_progressive) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { progressive.as_ref() }.map_or(0, |handle| handle.progressive.marks().len())
}

/// A level that has a mark, 0 being the finest: at which step it is, into *step, and its estimated error, in
/// units of the positions, into *error. Errors do not fall from mark to mark.
///
/// Fails with _NULL or _OUT_OF_RANGE. Constant time; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_progressive_mark(
    progressive: *const decimesh_progressive,
    mark: usize,
    step: *mut usize,
    error: *mut f32,
) -> decimesh_status {
    entry!([progressive, step, error] {
        // SAFETY: none is NULL, and the caller vouches for what they point to.
        unsafe {
            let handle = &*progressive;
            let marks = handle.progressive.marks();
            let Some(found) = marks.get(mark) else {
                let message = format!("mark {mark} of {} does not exist", marks.len());
                return Err(Failure::new(DECIMESH_ERROR_OUT_OF_RANGE, message));
            };
            step.write(found.step);
            error.write(found.error);
        }
        Ok(())
    })
}
