//! Progress and cancel.

use crate::monitor::Monitor;
use std::ffi::c_void;
use std::ops::ControlFlow;

/// Is told how far a call has come: a fraction from 0 to 1 that never falls. What it returns ends the
/// call, unless it is 0: the call then fails with DECIMESH_ERROR_CANCELLED, and nothing of the
/// caller's has changed.
///
/// It is called on the thread that made the call, from a few times to some thousands, and may itself call
/// decimesh. It must not throw or jump out of the call: decimesh.hpp shows how to carry an
/// exception through.
pub type decimesh_progress = Option<unsafe extern "C" fn(user: *mut c_void, fraction: f32) -> i32>;

/// The monitor that asks `progress`.
///
/// # Safety
/// `progress`, if it is there, may be called with `user` on this thread for as long as the monitor is used.
pub(super) unsafe fn monitor(progress: decimesh_progress, user: *mut c_void) -> Monitor<'static> {
    let Some(progress) = progress else { return Monitor::silent() };
    Monitor::new(move |fraction| {
        // SAFETY: as the caller of this function promises.
        match unsafe { progress(user, fraction) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    })
}
