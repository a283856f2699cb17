//! What every call that can fail goes through: checks of pointers, and the boundary for panics.

use super::status::{self, DECIMESH_ERROR_PANIC, DECIMESH_OK, Failure, decimesh_status};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The body of an entry: `entry!([mesh, report] { ... Ok(()) })`. A listed pointer that is NULL is a
/// failure that names it; the body gives `Result<(), Failure>`, and may panic.
macro_rules! entry {
    ([$($pointer:ident),*] $body:block) => {
        $crate::capi::entry::run(|| {
            $(
                if $pointer.is_null() {
                    return Err($crate::capi::entry::null(stringify!($pointer)));
                }
            )*
            $body
        })
    };
}
pub(super) use entry;

pub(super) fn null(name: &str) -> Failure {
    Failure::new(status::DECIMESH_ERROR_NULL, format!("{name} is NULL"))
}

/// Runs the body of an entry. Nothing that it was given is looked at again after a panic: most handles do not
/// change, those that do may only be destroyed then, and out-parameters are written last.
pub(super) fn run(body: impl FnOnce() -> Result<(), Failure>) -> decimesh_status {
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => DECIMESH_OK,
        Ok(Err(failure)) => status::keep(failure),
        Err(panic) => {
            let text = panic.downcast_ref::<&str>().copied();
            let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
            let message = format!("a bug in decimesh: {}", text.unwrap_or("a panic without a text"));
            // What a panic carries may panic when it is dropped.
            std::mem::forget(panic);
            status::keep(Failure::new(DECIMESH_ERROR_PANIC, message))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    #[test]
    fn a_panic_is_a_status() {
        assert_eq!(run(|| panic!("vertex {}", 7)), DECIMESH_ERROR_PANIC);
        // SAFETY: the text is this thread's own, and nothing has failed since.
        let message = unsafe { CStr::from_ptr(status::decimesh_last_error_message()) };
        assert_eq!(message.to_str(), Ok("a bug in decimesh: vertex 7"));
    }
}
