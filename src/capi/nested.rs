//! `decimesh_nested`: levels of detail that are prefixes of one vertex buffer.

use super::bound::decimesh_bound_options;
use super::buffers::{IndexRoom, decimesh_index_type};
use super::entry::entry;
use super::levels::read_chain;
use super::mesh::{decimesh_mesh, text};
use super::simplify::{decimesh_simplify_options, decimesh_stopped_by, stopped_by};
use super::status::{DECIMESH_ERROR_NOT_FINITE, DECIMESH_ERROR_OUT_OF_RANGE, Failure, decimesh_status};
use super::structs::{self, Versioned};
use crate::deviation::{BoundOptions, DeviationError};
use crate::lod::{Level, NestedLevels};
use crate::monitor::Monitor;
use std::ffi::{c_char, c_void};
use std::ptr;
use std::sync::Arc;

/// Levels of detail, from fine to coarse, that share one vertex buffer: level 0 is the mesh that they were
/// made of, and each level names vertices below a number that falls from level to level.
///
/// A const decimesh_nested* may be used from many threads at once. decimesh_nested_certify() alone changes
/// it, and needs it for itself.
pub struct decimesh_nested {
    /// Its own share alone. Unlike a box it may move while its contents are pointed to.
    levels: Arc<NestedLevels>,
    /// That of `levels`.
    mesh: decimesh_mesh,
}

impl decimesh_nested {
    fn new(levels: NestedLevels) -> Self {
        let levels = Arc::new(levels);
        // SAFETY: the levels end with the handle of their mesh, and `certify` makes that anew.
        let mesh = unsafe { decimesh_mesh::part_elsewhere(levels.mesh()) };
        Self { levels, mesh }
    }

    fn certify(&mut self, options: &BoundOptions, monitor: &mut Monitor) -> Result<(), DeviationError> {
        let certified = Arc::make_mut(&mut self.levels).certify(options, monitor);
        // SAFETY: as in `new`.
        self.mesh = unsafe { decimesh_mesh::part_elsewhere(self.levels.mesh()) };
        certified.map(drop)
    }

    /// # Errors
    /// If there is no such level.
    fn level(&self, level: usize) -> Result<&Level, Failure> {
        let levels = self.levels.levels();
        levels.get(level).ok_or_else(|| {
            let message = format!("level {level} of {} does not exist", levels.len());
            Failure::new(DECIMESH_ERROR_OUT_OF_RANGE, message)
        })
    }
}

/// A level. decimesh_nested_level_init() sets it up.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct decimesh_nested_level {
    /// sizeof(decimesh_nested_level), as decimesh_nested_level_init sets it.
    pub struct_size: u32,
    /// Why it is as large as it is: a DECIMESH_STOPPED_BY_ value; for level 0 always _TARGET.
    pub stopped_by: decimesh_stopped_by,
    /// Its vertices are so many, the first of the buffer: every index is below.
    pub vertices: u64,
    /// Its indices: three a triangle.
    pub indices: u64,
    /// Largest distance from level 0, in units of the positions: estimated, or guaranteed once
    /// decimesh_nested_certify() has said so. Never less than that of the level before.
    pub error: f32,
    /// 1 if holes, handles or components had to be given up, here or on a finer level.
    pub topology_changed: i32,
}

// SAFETY: repr(C); integers and a float that leave no gap between them.
unsafe impl Versioned for decimesh_nested_level {
    const NAME: &'static str = "decimesh_nested_level";

    fn initial() -> Self {
        Self { struct_size: size_of::<Self>() as u32, ..Self::default() }
    }
}

/// Sets struct_size and makes all else 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_nested_level), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_level_init(level: *mut decimesh_nested_level, struct_size: usize) {
    // SAFETY: the caller's pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(level, struct_size) }
}

/// Makes levels of a mesh by collapses that make no vertex and move none, and puts its vertices in order:
/// those of the coarsest level first, in the order they had, then what each finer level adds, then those
/// that no triangle uses. So one vertex buffer serves all levels, and a program that draws a coarse one need
/// have loaded the beginning of it alone.
///
/// target_values has count values, at least 1, from fine to coarse, and becomes the levels after 0; each is
/// what options->target_value is for one simplification, which is not looked at here, as options->placement
/// is not. options->origins and options->result_groups must be NULL. A level that cannot be met is the same
/// as the one before, and says why.
///
/// *nested receives the levels, which the caller ends with decimesh_nested_destroy(). Fails with _NULL,
/// _EMPTY, _OVERFLOW, _STRUCT_SIZE, _UNKNOWN_OPTION, _ENUM, _OPTION, _CANCELLED, _THREADS or _OUT_OF_MEMORY.
///
/// Linear time; about 62 bytes of memory a triangle for three levels that halve, what they hold included. Any
/// thread; progress is told on the calling one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_build(
    mesh: *const decimesh_mesh,
    options: *const decimesh_simplify_options,
    target_values: *const f64,
    count: usize,
    nested: *mut *mut decimesh_nested,
) -> decimesh_status {
    entry!([mesh, options, target_values, nested] {
        // SAFETY: none is NULL, and the caller vouches for what they point to.
        unsafe {
            let mesh = (*mesh).mesh();
            let (own, targets, options) = read_chain(mesh, options, target_values, count)?;
            let levels = NestedLevels::build(mesh, &targets, &options, &mut own.monitor())?;
            nested.write(Box::into_raw(Box::new(decimesh_nested::new(levels))));
        }
        Ok(())
    })
}

/// Ends levels and their mesh. NULL is left alone.
///
/// No other thread may use them or their mesh any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_destroy(nested: *mut decimesh_nested) {
    if !nested.is_null() {
        // SAFETY: a handle that came from a box and has not been destroyed.
        drop(unsafe { Box::from_raw(nested) });
    }
}

/// How many levels there are, level 0 included; 0 for NULL. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_count(nested: *const decimesh_nested) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { nested.as_ref() }.map_or(0, |nested| nested.levels.levels().len())
}

/// The vertex buffer of all levels, as a mesh whose triangles are those of level 0; NULL for NULL.
///
/// It belongs to the levels and ends with them: decimesh_mesh_destroy() leaves it alone. Constant time; any
/// thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_mesh(nested: *const decimesh_nested) -> *const decimesh_mesh {
    // SAFETY: NULL or a living handle.
    unsafe { nested.as_ref() }.map_or(ptr::null(), |nested| &raw const nested.mesh)
}

/// For each vertex of the buffer the vertex of the input that it is, every one once: further streams of the
/// input's vertices go to the same order by it. NULL for NULL.
///
/// It belongs to the levels and is valid until they end. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_order(nested: *const decimesh_nested) -> *const u32 {
    // SAFETY: NULL or a living handle.
    unsafe { nested.as_ref() }.map_or(ptr::null(), |nested| nested.levels.order().as_ptr())
}

/// What a level is, 0 being the finest: into *description, which decimesh_nested_level_init has set up.
///
/// Fails with _NULL, _OUT_OF_RANGE or _STRUCT_SIZE. Constant time; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_describe(
    nested: *const decimesh_nested,
    level: usize,
    description: *mut decimesh_nested_level,
) -> decimesh_status {
    entry!([nested, description] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let nested = &*nested;
            let found = nested.level(level)?;
            let size = structs::size(description)?;
            let own = decimesh_nested_level {
                stopped_by: stopped_by(found.stopped_by),
                vertices: found.vertices as u64,
                indices: nested.levels.triangles(level).as_flattened().len() as u64,
                error: found.error,
                topology_changed: found.topology_changed.into(),
                ..decimesh_nested_level::initial()
            };
            structs::write(description, size, &own);
        }
        Ok(())
    })
}

/// The indices of a level, three a triangle; how many there are decimesh_nested_describe() says.
///
/// They belong to the levels and are valid until these end. Fails with _NULL or _OUT_OF_RANGE. Constant time;
/// any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_indices(
    nested: *const decimesh_nested,
    level: usize,
    indices: *mut *const u32,
) -> decimesh_status {
    entry!([nested, indices] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let nested = &*nested;
            nested.level(level)?;
            indices.write(nested.levels.triangles(level).as_flattened().as_ptr());
        }
        Ok(())
    })
}

/// Copies the indices of a level to destination, which has room for so many indices of index_type, at least
/// as many as the level has.
///
/// Fails with _NULL, _OUT_OF_RANGE, _ENUM, or _TOO_LARGE: there are more indices than there is room for, or
/// more vertices than indices of 16 bits can name. Linear in the level; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_copy_indices(
    nested: *const decimesh_nested,
    level: usize,
    index_type: decimesh_index_type,
    destination: *mut c_void,
    room: usize,
) -> decimesh_status {
    entry!([nested, destination] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let nested = &*nested;
            let vertices = nested.level(level)?.vertices;
            let room = IndexRoom { index_type, destination, room };
            room.copy(nested.levels.triangles(level), vertices)?;
        }
        Ok(())
    })
}

/// The group of each triangle of a level, if options->triangle_groups were given: into *groups, which becomes
/// NULL if not, and for level 0. The triangles of that are those of the input, in their order, and its groups
/// are those given.
///
/// They belong to the levels and are valid until these end. Fails with _NULL or _OUT_OF_RANGE. Constant time;
/// any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_groups(
    nested: *const decimesh_nested,
    level: usize,
    groups: *mut *const u32,
) -> decimesh_status {
    entry!([nested, groups] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let nested = &*nested;
            nested.level(level)?;
            groups.write(nested.levels.groups(level).map_or(ptr::null(), <[u32]>::as_ptr));
        }
        Ok(())
    })
}

/// For each vertex of a level the one that it goes into on the next coarser level: itself where it stays, and
/// where what surrounds it vanishes. A vertex drawn on the way from its own place to that one's hides the
/// change of levels. *morphs becomes NULL on the coarsest level.
///
/// They belong to the levels and are valid until these end. Fails with _NULL or _OUT_OF_RANGE. Constant time;
/// any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_morphs(
    nested: *const decimesh_nested,
    level: usize,
    morphs: *mut *const u32,
) -> decimesh_status {
    entry!([nested, morphs] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let nested = &*nested;
            let targets = &nested.level(level)?.morphs;
            let is_coarsest = level + 1 == nested.levels.levels().len();
            morphs.write(if is_coarsest { ptr::null() } else { targets.as_ptr() });
        }
        Ok(())
    })
}

/// The coarsest level whose error is at most max_error, in units of the positions: into *level, which becomes
/// 0 where none but the input is so good. decimesh_levels_select() says which error can be seen.
///
/// Fails with _NULL, or _NOT_FINITE if max_error is not a number. Linear in the levels; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_select(
    nested: *const decimesh_nested,
    max_error: f32,
    level: *mut usize,
) -> decimesh_status {
    entry!([nested, level] {
        if max_error.is_nan() {
            return Err(Failure::new(DECIMESH_ERROR_NOT_FINITE, "max_error is not a number"));
        }
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let nested = &*nested;
            level.write(nested.levels.coarsest_within(max_error));
        }
        Ok(())
    })
}

/// Puts a guaranteed bound in the place of each level's estimated error: no point of the level is farther
/// from level 0 than that, and none of level 0 from the level.
///
/// options may be NULL: the defaults. Fails as decimesh_bound() does, also for a level without triangles;
/// then nothing has changed. As long as that for each level, which is far longer than
/// decimesh_nested_build(). No other thread may use the levels meanwhile; progress is told on the calling
/// thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_certify(
    nested: *mut decimesh_nested,
    options: *const decimesh_bound_options,
) -> decimesh_status {
    entry!([nested] {
        // SAFETY: it is not NULL, and the caller vouches for what the pointers point to.
        unsafe {
            let (options, mut monitor) = decimesh_bound_options::read(options)?;
            (*nested).certify(&options, &mut monitor)?;
        }
        Ok(())
    })
}

/// Writes all levels to a GLB file, with the vertex buffer there once.
///
/// Each level is a node and a mesh, whose accessors end where the level's vertices do; the node's extras hold
/// its error. The scene shows the first, which names the others by the extension MSFT_lod. Levels without
/// triangles and vertices that no triangle uses are left out.
///
/// The file appears whole or not at all, as by decimesh_mesh_write(). path is UTF-8; its extension is not
/// looked at. Fails with _NULL, _UTF8, _IO or _TOO_LARGE (GLB ends at 4 GiB). Linear in the levels; any
/// thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_nested_write_glb(
    nested: *const decimesh_nested,
    path: *const c_char,
) -> decimesh_status {
    entry!([nested, path] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let nested = &*nested;
            nested.levels.write_glb(text(path)?)?;
        }
        Ok(())
    })
}
