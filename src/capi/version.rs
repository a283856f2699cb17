//! Which decimesh this is.

use std::ffi::{CStr, c_char};

/// Changes when a call changes its meaning or goes away; with it the name of the shared library.
pub const DECIMESH_VERSION_MAJOR: u32 = 0;
/// Changes when calls come to it.
pub const DECIMESH_VERSION_MINOR: u32 = 1;
/// Changes with every release.
pub const DECIMESH_VERSION_PATCH: u32 = 0;

// The header's numbers are these; Cargo.toml's must be the same.
const _: () = {
    assert!(same(DECIMESH_VERSION_MAJOR, env!("CARGO_PKG_VERSION_MAJOR")));
    assert!(same(DECIMESH_VERSION_MINOR, env!("CARGO_PKG_VERSION_MINOR")));
    assert!(same(DECIMESH_VERSION_PATCH, env!("CARGO_PKG_VERSION_PATCH")));
};

const fn same(number: u32, digits: &str) -> bool {
    matches!(u32::from_str_radix(digits, 10), Ok(value) if value == number)
}

/// The version of the library, major << 16 | minor << 8 | patch: a program that was compiled with one
/// header and runs with another library can tell by comparing it with the macros.
///
/// Any thread; never fails.
#[unsafe(no_mangle)]
pub extern "C" fn decimesh_version() -> u32 {
    DECIMESH_VERSION_MAJOR << 16 | DECIMESH_VERSION_MINOR << 8 | DECIMESH_VERSION_PATCH
}

/// The version of the library as a text, such as "0.1.0". Static. Any thread; never fails.
#[unsafe(no_mangle)]
pub extern "C" fn decimesh_version_string() -> *const c_char {
    const TEXT: &[u8] = concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes();
    CStr::from_bytes_with_nul(TEXT).unwrap_or(c"").as_ptr()
}
