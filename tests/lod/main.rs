//! Levels of detail: nested, and progressive in memory and in files.

// Shapes that the tests of simplification use too; not all are wanted here.
#[allow(dead_code)]
#[path = "../simplify/meshes.rs"]
mod meshes;

mod collapses;
#[cfg(feature = "io")]
mod file;
#[cfg(feature = "io")]
mod glb;
mod nested;
mod progressive;
mod view;
