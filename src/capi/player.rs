//! `decimesh_player`: a level of a progressive mesh, and the way to those next to it.

use super::buffers::{IndexRoom, decimesh_index_type};
use super::entry::entry;
use super::progressive::decimesh_progressive;
use super::status::decimesh_status;
use crate::lod::{Player, Progressive};
use std::ffi::c_void;
use std::ptr;
use std::sync::Arc;

/// A level of a progressive mesh, and the way to those next to it: a step costs as much as it changes, so
/// that a program that follows a camera need not make a level anew.
///
/// Any number of players may play one progressive mesh, each in a thread of its own. A const
/// decimesh_player* may be used from many threads at once, as long as none makes a call that takes one that
/// is not const.
pub struct decimesh_player {
    player: Player<Arc<Progressive>>,
}

/// A player at the coarsest level. It has a share of the progressive mesh, which lives on for it when its own
/// handle is ended.
///
/// *player receives the player, which the caller ends with decimesh_player_destroy(). Fails with _NULL.
/// Linear in the coarsest level; 12 bytes of memory a triangle of the finest level it goes to. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_create(
    progressive: *const decimesh_progressive,
    player: *mut *mut decimesh_player,
) -> decimesh_status {
    entry!([progressive, player] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let share = Arc::clone(&(*progressive).progressive);
            player.write(Box::into_raw(Box::new(decimesh_player { player: Player::new(share) })));
        }
        Ok(())
    })
}

/// Ends a player. NULL is left alone.
///
/// No other thread may use it any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_destroy(player: *mut decimesh_player) {
    if !player.is_null() {
        // SAFETY: a handle that came from a box and has not been destroyed.
        drop(unsafe { Box::from_raw(player) });
    }
}

/// At which step a player is; 0 for NULL. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_step(player: *const decimesh_player) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { player.as_ref() }.map_or(0, |handle| handle.player.step())
}

/// How many vertices the player's level has, the first of decimesh_progressive_vertices(); 0 for NULL.
/// Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_vertex_count(player: *const decimesh_player) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { player.as_ref() }.map_or(0, |handle| handle.player.vertex_count())
}

/// How many triangles the player's level has; 0 for NULL. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_triangle_count(player: *const decimesh_player) -> usize {
    // SAFETY: NULL or a living handle.
    unsafe { player.as_ref() }.map_or(0, |handle| handle.player.triangles().len())
}

/// The indices of the player's level, three a triangle; NULL for NULL. They are what
/// decimesh_progressive_copy_indices() gives for the step.
///
/// They belong to the player and are valid until it goes to another step or ends. Without triangles there is
/// nothing to read. Constant time; any thread; never fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_indices(player: *const decimesh_player) -> *const u32 {
    // SAFETY: NULL or a living handle.
    unsafe { player.as_ref() }.map_or(ptr::null(), |handle| handle.player.triangles().as_ptr().cast())
}

/// Copies the indices of the player's level to destination, which has room for so many indices of
/// index_type, at least three for each of its triangles.
///
/// Fails with _NULL, _ENUM, or _TOO_LARGE: there are more indices than there is room for, or more vertices
/// than indices of 16 bits can name. Linear in the level; any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_copy_indices(
    player: *const decimesh_player,
    index_type: decimesh_index_type,
    destination: *mut c_void,
    room: usize,
) -> decimesh_status {
    entry!([player, destination] {
        // SAFETY: neither is NULL, and the caller vouches for what they point to.
        unsafe {
            let player = &(*player).player;
            IndexRoom { index_type, destination, room }.copy(player.triangles(), player.vertex_count())?;
        }
        Ok(())
    })
}

/// Does the next split; at the finest level nothing changes.
///
/// Fails with _NULL. In proportion to what changes. No other thread may use the player meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_finer(player: *mut decimesh_player) -> decimesh_status {
    entry!([player] {
        // SAFETY: it is not NULL, and nobody else uses it.
        unsafe { (*player).player.finer() };
        Ok(())
    })
}

/// Undoes the last split; at the coarsest level nothing changes.
///
/// Fails with _NULL. In proportion to what changes. No other thread may use the player meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_coarser(player: *mut decimesh_player) -> decimesh_status {
    entry!([player] {
        // SAFETY: it is not NULL, and nobody else uses it.
        unsafe { (*player).player.coarser() };
        Ok(())
    })
}

/// Goes to a step, or to the finest level where step is beyond that.
///
/// Fails with _NULL. In proportion to the splits in between. No other thread may use the player meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_player_go_to(player: *mut decimesh_player, step: usize) -> decimesh_status {
    entry!([player] {
        // SAFETY: it is not NULL, and nobody else uses it.
        unsafe { (*player).player.go_to(step) };
        Ok(())
    })
}
