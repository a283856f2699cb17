//! What the distance between two surfaces is guaranteed to lie between.

use super::entry::entry;
use super::mesh::decimesh_mesh;
use super::progress::{decimesh_progress, monitor};
use super::status::{Failure, decimesh_status};
use super::structs::{self, Versioned};
use crate::deviation::{Bound, BoundOptions, bound};
use crate::monitor::Monitor;
use std::ffi::c_void;
use std::ptr;

/// How close bounds shall come, and how much work that may be. decimesh_bound_options_init() sets the
/// defaults.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct decimesh_bound_options {
    /// sizeof(decimesh_bound_options), as decimesh_bound_options_init sets it.
    pub struct_size: u32,
    /// Threads to use, 0: all that the machine has. The result is the same, bit for bit; by default 0.
    pub threads: u32,
    /// How far above the lower bound the upper may be, as a share of it: finite, not negative; by default
    /// 0.01. A millionth of the larger diagonal is allowed in any case.
    pub tolerance: f64,
    /// Pieces of triangles to look at before giving up on the tolerance: some microseconds each, and at most
    /// about 120 bytes; by default 5000000.
    pub pieces: u64,
    /// Is told of progress, and can cancel; NULL for none.
    pub progress: decimesh_progress,
    /// Handed to progress as it is.
    pub progress_user: *mut c_void,
}

// SAFETY: repr(C); integers, a double and pointers that leave no gap between them; a function pointer may
// have any bits but those of no function, which the caller vouches for.
unsafe impl Versioned for decimesh_bound_options {
    const NAME: &'static str = "decimesh_bound_options";

    fn initial() -> Self {
        let BoundOptions { tolerance, pieces, threads } = BoundOptions::default();
        Self {
            struct_size: size_of::<Self>() as u32,
            threads: threads as u32,
            tolerance,
            pieces: pieces as u64,
            progress: None,
            progress_user: ptr::null_mut(),
        }
    }
}

impl decimesh_bound_options {
    /// The options of `pointer`, or the defaults where it is NULL.
    ///
    /// # Safety
    /// `pointer` is NULL or points to a struct as long as its first field says; progress may be called on
    /// this thread with its user's pointer.
    pub(super) unsafe fn read(pointer: *const Self) -> Result<(BoundOptions, Monitor<'static>), Failure> {
        // SAFETY: as the caller of this function promises.
        let (own, monitor) = unsafe {
            let own = if pointer.is_null() { Self::initial() } else { structs::read(pointer)? };
            (own, monitor(own.progress, own.progress_user))
        };
        let options = BoundOptions {
            tolerance: own.tolerance,
            pieces: usize::try_from(own.pieces).unwrap_or(usize::MAX),
            threads: own.threads as usize,
        };
        Ok((options, monitor))
    }
}

/// What the two-sided Hausdorff distance lies between, in units of the positions.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct decimesh_bound_result {
    /// sizeof(decimesh_bound_result), as decimesh_bound_result_init sets it.
    pub struct_size: u32,
    /// Always 0.
    pub reserved: u32,
    /// The largest distance found, at corners and inside of triangles.
    pub lower: f64,
    /// No point of either surface is farther from the other than this.
    pub upper: f64,
    /// Diagonal of the box around the triangles of the first mesh.
    pub diagonal: f64,
    /// Pieces that were looked at, other than the triangles themselves.
    pub pieces: u64,
}

// SAFETY: repr(C); two 32-bit integers, then doubles and an integer of 8 bytes.
unsafe impl Versioned for decimesh_bound_result {
    const NAME: &'static str = "decimesh_bound_result";

    fn initial() -> Self {
        Self { struct_size: size_of::<Self>() as u32, ..Self::default() }
    }
}

impl From<Bound> for decimesh_bound_result {
    fn from(Bound { lower, upper, diagonal, pieces }: Bound) -> Self {
        Self { lower, upper, diagonal, pieces: pieces as u64, ..Self::initial() }
    }
}

/// Sets the defaults: a tolerance of 1 %, 5000000 pieces, all threads. NULL is left alone.
///
/// struct_size is sizeof(decimesh_bound_options), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_bound_options_init(
    options: *mut decimesh_bound_options,
    struct_size: usize,
) {
    // SAFETY: the caller's pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(options, struct_size) }
}

/// Sets struct_size and makes all else 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_bound_result), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_bound_result_init(result: *mut decimesh_bound_result, struct_size: usize) {
    // SAFETY: the caller's pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(result, struct_size) }
}

/// Bounds the two-sided Hausdorff distance between the surfaces of two meshes: over all points, where
/// decimesh_deviation() looks at samples.
///
/// result->upper holds whatever the options. Whether it is as close to result->lower as asked for is for the
/// caller to see: if not, the pieces did not suffice.
///
/// options may be NULL: the defaults. *result has been set up by decimesh_bound_result_init. Fails with
/// _NULL, _STRUCT_SIZE, _UNKNOWN_OPTION, _OPTION (the tolerance), _EMPTY (a mesh without triangles),
/// _CANCELLED or _THREADS.
///
/// n log n time for the trees and the triangles, and then some microseconds a piece: a scan beside its tenth
/// takes about seven a triangle. About 130 bytes of memory a triangle, and the pieces. Any thread; progress is
/// told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_bound(
    a: *const decimesh_mesh,
    b: *const decimesh_mesh,
    options: *const decimesh_bound_options,
    result: *mut decimesh_bound_result,
) -> decimesh_status {
    entry!([a, b, result] {
        // SAFETY: none is NULL but perhaps the options, and the caller vouches for what they point to.
        unsafe {
            let (options, mut monitor) = decimesh_bound_options::read(options)?;
            let size = structs::size(result)?;
            let found = bound((*a).mesh(), (*b).mesh(), &options, &mut monitor)?;
            structs::write(result, size, &found.into());
        }
        Ok(())
    })
}
