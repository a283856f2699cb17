//! The engine from outside: what it promises of every mesh, and what it must do with particular ones.

mod cancel;
#[cfg(feature = "deviation")]
mod certified;
mod check;
mod determinism;
mod hostile;
mod invariants;
mod levels;
mod meshes;
mod metamorphic;
mod multiple_choice;
mod places;
#[cfg(feature = "deviation")]
mod refine;
mod seams;
mod zero_error;
