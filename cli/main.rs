//! The command `texgraph`: from a `.tex` file to errors, shaders and pictures.
//!
//! [`args`] says what can be typed; each subcommand is a file of its name and does nothing but call
//! the libraries and pass on what they say. A subcommand ends in a [`problem::Problem`] or in
//! nothing; [`problem::Report`] shows problems on standard error and knows the exit code:
//!
//! | code | meaning |
//! | --- | --- |
//! | 0 | fine |
//! | 1 | the input is wrong: a program, a picture, a layout with `fmt --check` |
//! | 2 | the command line is wrong |
//! | 3 | the machine can't: no GPU, no memory, no place to write |

mod args;
mod build;
mod check;
mod cost;
mod explain;
mod fmt;
mod graph;
mod inspect;
mod output;
mod problem;
mod program;
mod render;
mod tiles;

use args::{Args, Command};
use clap::Parser;
use problem::Report;
use std::process::ExitCode;

/// Faster than the system's with the many small pieces of a graph.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let args = Args::parse();
    let mut report = Report::new(args.command.message_format());
    let ended = match &args.command {
        Command::Check(args) => check::run(args, &mut report),
        Command::Build(args) => build::run(args, &mut report),
        Command::Render(args) => render::run(args),
        Command::Cost(args) => cost::run(args, &mut report),
        Command::Graph(args) => graph::run(args),
        Command::Inspect(args) => inspect::run(args),
        Command::Tiles(args) => tiles::run(args, &mut report),
        Command::Fmt(args) => fmt::run(args, &mut report),
        Command::Explain(args) => explain::run(args),
    };
    if let Err(problem) = ended {
        report.show(&problem);
    }
    ExitCode::from(report.exit_code())
}
