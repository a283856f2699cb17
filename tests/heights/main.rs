//! Files of heights: what other programs write is understood, and what nobody should have written is refused.

#![cfg(feature = "io")]

mod encode;
mod hostile;
mod read;
