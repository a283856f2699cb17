//! The decimesh command.
fn main() {}
