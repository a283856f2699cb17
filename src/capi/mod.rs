//! The C ABI: what `include/decimesh.h` declares, and the only unsafe code of the library.
//!
//! A file a handle, besides the machinery all share: `status` (statuses and texts), `entry` (NULL checks
//! and the boundary for panics), `structs` (structs of other versions), `buffers` (the caller's memory).
//! The comments on public items become the header's; `tests/header.rs` regenerates it and fails when
//! the two differ. Rust programs use the crate's own API, which this one is made of.
//!
//! Rules that hold for all of it:
//! - `const` handles may be used from many threads at once; a call that takes one that is not `const`
//!   changes or ends it, and needs it for itself. Few change: a player, and levels that are certified.
//! - A call that can fail gives a status, and writes through its out-parameters last, once nothing can
//!   fail any more.
//! - What makes a call unsafe is the same for all: a pointer that is not NULL points to what the call's
//!   comment says, as much of it as the counts and strides say, and a handle has not been destroyed.
//! - Enumerations are integers, and checked. No value of the caller's is trusted but its pointers.

#![allow(unsafe_code, non_camel_case_types)]
#![allow(clippy::missing_safety_doc, reason = "said once, above: the comments are the C header's")]

mod bound;
mod buffers;
mod certified;
mod deviation;
mod engine;
mod entry;
mod hierarchy;
mod levels;
mod mesh;
mod multiple_choice;
mod nested;
mod player;
mod progress;
mod progressive;
mod simplify;
mod statistics;
mod status;
mod structs;
mod version;

pub use bound::*;
pub use buffers::*;
pub use certified::*;
pub use deviation::*;
pub use engine::*;
pub use hierarchy::*;
pub use levels::*;
pub use mesh::*;
pub use multiple_choice::*;
pub use nested::*;
pub use player::*;
pub use progress::decimesh_progress;
pub use progressive::*;
pub use simplify::*;
pub use statistics::*;
pub use status::*;
pub use version::*;
