//! The `decimesh` command. [`arguments`] says what can be asked; each subcommand has its own module.

mod allocation;
mod arguments;
mod compare;
mod demo;
mod engine;
mod failure;
mod files;
mod info;
mod levels;
mod out_of_core;
mod play;
mod progress;
mod remesh;
mod render;
mod report;
mod simplify;
mod terrain;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

fn main() -> ExitCode {
    let result = match &Arguments::parse().command {
        Command::Simplify(arguments) => simplify::run(arguments),
        Command::Levels(arguments) => levels::run(arguments),
        Command::Terrain(arguments) => terrain::run(arguments),
        Command::TerrainTiles(arguments) => terrain::tiles(arguments),
        Command::Decompose(arguments) => terrain::decompose(arguments),
        Command::Extract(arguments) => terrain::extract(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Play(arguments) => play::run(arguments),
        Command::Remesh(arguments) => remesh::run(arguments),
        Command::Info(arguments) => info::run(arguments),
        Command::Demo(arguments) => demo::run(arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("decimesh: {failure}");
            failure.exit_code()
        }
    }
}
