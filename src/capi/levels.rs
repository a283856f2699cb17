//! `decimesh_levels`: a chain of levels of detail.

use super::buffers::gather;
use super::entry::entry;
use super::mesh::decimesh_mesh;
use super::simplify::{ReportPlace, decimesh_simplify_options, decimesh_simplify_report};
use super::status::{
    DECIMESH_ERROR_EMPTY, DECIMESH_ERROR_NOT_FINITE, DECIMESH_ERROR_OUT_OF_RANGE, Failure, decimesh_status,
};
use super::structs;
use crate::hqms::{Options, Target, build_levels};
use crate::lod::coarsest_within;
use crate::mesh::Mesh;
use std::ptr;

/// Levels of detail of one mesh, from fine to coarse: immutable.
///
/// A const decimesh_levels* may be used from many threads at once.
pub struct decimesh_levels {
    meshes: Vec<decimesh_mesh>,
    reports: Vec<decimesh_simplify_report>,
    groups: Vec<Option<Vec<u32>>>,
    origins: Vec<Option<Vec<u32>>>,
}

impl decimesh_levels {
    fn check(&self, level: usize) -> Result<(), Failure> {
        let count = self.meshes.len();
        if level < count {
            return Ok(());
        }
        Err(Failure::new(DECIMESH_ERROR_OUT_OF_RANGE, format!("level {level} of {count} does not exist")))
    }
}

/// What levels of `mesh` are to be made with: the caller's options, the targets, and the library's options.
///
/// # Safety
/// Neither pointer is NULL; they point to a struct as long as its first field says, whose pointers are good,
/// and to `count` values.
pub(super) unsafe fn read_chain(
    mesh: &Mesh,
    options: *const decimesh_simplify_options,
    target_values: *const f64,
    count: usize,
) -> Result<(decimesh_simplify_options, Vec<Target>, Options), Failure> {
    if count == 0 {
        return Err(Failure::new(DECIMESH_ERROR_EMPTY, "count is 0: there is no level to make"));
    }
    // SAFETY: as the caller of this function promises.
    unsafe {
        let own: decimesh_simplify_options = structs::read(options)?;
        let values = gather("target_values", target_values, 0, count)?;
        let targets = values.iter().map(|&[value]| own.target(value)).collect::<Result<Vec<_>, _>>()?;
        let options = own.with_target(targets[0])?;
        own.refuse_elements()?;
        let options = own.complete(options, mesh)?;
        Ok((own, targets, options))
    }
}

/// Makes levels of a mesh, each from the one before: a chain costs little more than its coarsest level.
///
/// target_values has count values, at least 1, from fine to coarse; each is what options->target_value is
/// for one simplification, which is not looked at here. options->origins and options->result_groups must be
/// NULL. A level that cannot be met is the same mesh as the one before, and its report says why.
///
/// *levels receives the chain, which the caller ends with decimesh_levels_destroy(). Fails with _NULL,
/// _EMPTY, _OVERFLOW, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
///
/// Linear time; about 24 bytes of memory a triangle, and the levels; with options->level_origins 4 bytes more for
/// each vertex of the input and each level. Any thread; progress is told on the
/// calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_build(
    mesh: *const decimesh_mesh,
    options: *const decimesh_simplify_options,
    target_values: *const f64,
    count: usize,
    levels: *mut *mut decimesh_levels,
) -> decimesh_status {
    entry!([mesh, options, target_values, levels] {
        // SAFETY: none is NULL, and the caller vouches for what they point to.
        unsafe {
            let mesh = (*mesh).mesh();
            let (own, targets, mut options) = read_chain(mesh, options, target_values, count)?;
            options.track_origins = own.keeps_level_origins()?;
            let mut results = build_levels(mesh, &targets, &options, &mut own.monitor())?;
            let reports = results.iter().map(Into::into).collect();
            let groups = results.iter_mut().map(|result| result.groups.take()).collect();
            let origins = results.iter_mut().map(|result| result.origins.take()).collect();
            let meshes = results.into_iter().map(|result| decimesh_mesh::part(result.mesh));
            let chain = decimesh_levels { meshes: meshes.collect(), reports, groups, origins };
            levels.write(Box::into_raw(Box::new(chain)));
        }
        Ok(())
    })
}

/// Ends a chain of levels and all of its meshes. NULL is left alone.
///
/// No other thread may use the chain or a mesh of it any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_destroy(levels: *mut decimesh_levels) {
    if !levels.is_null() {
        // SAFETY: a handle that came from a box and has not been destroyed.
        drop(unsafe { Box::from_raw(levels) });
    }
}

/// How many levels there are; 0 for NULL. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_count(levels: *const decimesh_levels) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { levels.as_ref() }.map_or(0, |levels| levels.meshes.len())
}

/// The mesh of a level, 0 being the finest. It belongs to the chain and ends with it:
/// decimesh_mesh_destroy() leaves it alone.
///
/// Fails with _NULL or _OUT_OF_RANGE. Constant time; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_mesh(
    levels: *const decimesh_levels,
    level: usize,
    mesh: *mut *const decimesh_mesh,
) -> decimesh_status {
    entry!([levels, mesh] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            (*levels).check(level)?;
            mesh.write(&raw const (&(*levels).meshes)[level]);
        }
        Ok(())
    })
}

/// How a level came about, 0 being the finest: into *report, which decimesh_simplify_report_init has set up.
/// Errors are those of the whole chain up to the level.
///
/// Fails with _NULL, _OUT_OF_RANGE or _STRUCT_SIZE. Constant time; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_report(
    levels: *const decimesh_levels,
    level: usize,
    report: *mut decimesh_simplify_report,
) -> decimesh_status {
    entry!([levels, report] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            (*levels).check(level)?;
            ReportPlace::new(report)?.write(&(&(*levels).reports)[level]);
        }
        Ok(())
    })
}

/// The group of each triangle of a level, 0 being the finest, if options->triangle_groups were given: into
/// *groups, which becomes NULL if not.
///
/// They belong to the chain and are valid until it ends. Fails with _NULL or _OUT_OF_RANGE. Constant time;
/// any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_groups(
    levels: *const decimesh_levels,
    level: usize,
    groups: *mut *const u32,
) -> decimesh_status {
    entry!([levels, groups] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let levels = &*levels;
            levels.check(level)?;
            groups.write(levels.groups[level].as_deref().map_or(ptr::null(), <[u32]>::as_ptr));
        }
        Ok(())
    })
}

/// For each vertex of the input the vertex of a level, 0 being the finest, that it went into, UINT32_MAX where it
/// vanished, if options->level_origins was 1: into *origins, which becomes NULL if not. By it go what attributes
/// decimesh does not know.
///
/// They belong to the chain and are valid until it ends. Fails with _NULL or _OUT_OF_RANGE. Constant time;
/// any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_origins(
    levels: *const decimesh_levels,
    level: usize,
    origins: *mut *const u32,
) -> decimesh_status {
    entry!([levels, origins] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let levels = &*levels;
            levels.check(level)?;
            origins.write(levels.origins[level].as_deref().map_or(ptr::null(), <[u32]>::as_ptr));
        }
        Ok(())
    })
}

/// The coarsest level whose error is at most max_error, in units of the positions: into *level, which
/// becomes the number of levels where none is so good and the original is to be drawn.
///
/// Seen by a perspective camera from a distance d, with a vertical field of view of f radians on a screen
/// h pixels high, an error of p pixels on the screen is one of p * d * 2 * tan(f / 2) / h.
///
/// Fails with _NULL, or _NOT_FINITE if max_error is not a number. Linear in the levels; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_levels_select(
    levels: *const decimesh_levels,
    max_error: f32,
    level: *mut usize,
) -> decimesh_status {
    entry!([levels, level] {
        if max_error.is_nan() {
            return Err(Failure::new(DECIMESH_ERROR_NOT_FINITE, "max_error is not a number"));
        }
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let reports = &(*levels).reports;
            let chosen = coarsest_within(reports.iter().map(|report| report.error), max_error);
            level.write(chosen.unwrap_or(reports.len()));
        }
        Ok(())
    })
}
