//! The command as its users meet it: the real binary on real files.

mod compare;
mod demo;
mod help;
mod info;
mod levels;
mod out_of_core;
mod play;
mod remesh;
mod simplify;
mod terrain;
mod workbench;
