//! The engine of Jia, Tang and Pan.

use super::buffers::write_elements;
use super::entry::{entry, null};
use super::mesh::decimesh_mesh;
use super::progress::{decimesh_progress, monitor};
use super::simplify::{
    DECIMESH_STOPPED_BY_STUCK, DECIMESH_STOPPED_BY_TARGET, decimesh_stopped_by, read_locked,
};
use super::status::{DECIMESH_ERROR_CANCELLED, DECIMESH_ERROR_OPTION, Failure, decimesh_status};
use super::structs::{self, Versioned};
use crate::monitor::Cancelled;
use crate::multiple_choice::{Cost, Decimation, NoSuchVertex, Selection};
use std::ffi::c_void;
use std::num::NonZeroU32;
use std::ptr;

/// How to choose. decimesh_multiple_choice_options_init() sets the defaults.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct decimesh_multiple_choice_options {
    /// sizeof(decimesh_multiple_choice_options), as decimesh_multiple_choice_options_init sets it.
    pub struct_size: u32,
    /// Of how many vertices drawn at random the cheapest goes: at least 1; by default 6.
    pub candidates: u32,
    /// Where the random numbers start; by default 0.
    pub seed: u64,
    /// Indices of input vertices that stay; NULL for none.
    pub locked_vertices: *const u32,
    /// How many locked_vertices there are.
    pub locked_count: usize,
    /// Is told of progress, and can cancel; NULL for none.
    pub progress: decimesh_progress,
    /// Handed to progress as it is.
    pub progress_user: *mut c_void,
    /// NULL, or room for one index a vertex of the input. It receives, for each vertex of the result, the one of the
    /// input that it is, ascending; nothing is written beyond.
    pub sources: *mut u32,
}

// SAFETY: repr(C); integers and pointers that leave no gap between them; a function pointer may have any
// bits but those of no function, which the caller vouches for.
unsafe impl Versioned for decimesh_multiple_choice_options {
    const NAME: &'static str = "decimesh_multiple_choice_options";

    fn initial() -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            candidates: 6,
            seed: 0,
            locked_vertices: ptr::null(),
            locked_count: 0,
            progress: None,
            progress_user: ptr::null_mut(),
            sources: ptr::null_mut(),
        }
    }
}

impl decimesh_multiple_choice_options {
    fn selection(&self) -> Result<Selection, Failure> {
        let candidates = NonZeroU32::new(self.candidates).ok_or_else(|| {
            Failure::new(DECIMESH_ERROR_OPTION, "candidates is 0: at least one vertex must be drawn")
        })?;
        Ok(Selection::MultipleChoice { candidates, seed: self.seed })
    }

    /// # Safety
    /// locked_vertices is NULL or points to so many indices.
    unsafe fn locked(&self) -> Result<Vec<u32>, Failure> {
        match (self.locked_vertices.is_null(), self.locked_count) {
            (_, 0) => Ok(Vec::new()),
            (true, _) => Err(null("locked_vertices")),
            // SAFETY: as the caller of this function promises.
            (false, count) => unsafe { read_locked(self.locked_vertices, count) },
        }
    }
}

impl From<NoSuchVertex> for Failure {
    fn from(error: NoSuchVertex) -> Self {
        Self::new(DECIMESH_ERROR_OPTION, error.to_string())
    }
}

impl From<Cancelled> for Failure {
    fn from(error: Cancelled) -> Self {
        Self::new(DECIMESH_ERROR_CANCELLED, error.to_string())
    }
}

/// Sets the defaults: the cheapest of six, seed 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_multiple_choice_options), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_multiple_choice_options_init(
    options: *mut decimesh_multiple_choice_options,
    struct_size: usize,
) {
    // SAFETY: the caller's pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(options, struct_size) }
}

/// Simplifies a mesh as Jia, Tang and Pan do: time and again some vertices are drawn at random, and the one with the
/// least visual cost goes into a neighbour. No vertex is made or moved.
///
/// It is there to compare with: decimesh_simplify() with DECIMESH_PLACEMENT_EXISTING is faster and closer. At most
/// triangles are left, this many or one fewer, unless nothing more can go before that: topology is kept, no face turns
/// by a right angle, and where there are attributes, vertices that share their place with another stay.
///
/// *simplified receives a new mesh, which the caller ends with decimesh_mesh_destroy(), without the vertices that no
/// triangle uses. *stopped_by, if it is not NULL, receives DECIMESH_STOPPED_BY_TARGET or _STUCK. options may be NULL: the
/// defaults. Fails with _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _OPTION (no candidates, or a locked vertex that does not
/// exist) or _CANCELLED.
///
/// Linear time, on one thread; about 115 bytes of memory a vertex. The same mesh and options give the same bytes on
/// every machine. Any thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_multiple_choice(
    mesh: *const decimesh_mesh,
    triangles: usize,
    options: *const decimesh_multiple_choice_options,
    simplified: *mut *mut decimesh_mesh,
    stopped_by: *mut decimesh_stopped_by,
) -> decimesh_status {
    entry!([mesh, simplified] {
        // SAFETY: neither is NULL, and the caller vouches for what the pointers point to.
        unsafe {
            let mesh = (*mesh).mesh();
            let options = match options.is_null() {
                true => decimesh_multiple_choice_options::initial(),
                false => structs::read(options)?,
            };
            let (selection, locked) = (options.selection()?, options.locked()?);
            let mut monitor = monitor(options.progress, options.progress_user);
            let mut decimation = Decimation::with_locked(mesh, Cost::Visual, selection, &locked)?;
            let is_met = decimation.reduce_to(triangles, &mut monitor)?;
            let (result, sources) = mesh.of_triangles(&decimation.triangles())?;
            if !stopped_by.is_null() {
                stopped_by.write(if is_met { DECIMESH_STOPPED_BY_TARGET } else { DECIMESH_STOPPED_BY_STUCK });
            }
            write_elements(options.sources, &sources);
            decimesh_mesh::give(result, simplified);
        }
        Ok(())
    })
}
