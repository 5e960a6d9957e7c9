//! `cargo xtask`: tasks of developers.

mod commands;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use sptfra::message;

use commands::{bench, cells, corner_cases, luts, mutants, solver, stress, study};

/// Runs what only developers run.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Bench(bench::Args),
    Solver(solver::Args),
    CornerCases(corner_cases::Args),
    Stress(stress::Args),
    Mutants(mutants::Args),
    Study(study::Args),
    Cells(cells::Args),
    Luts(luts::Args),
}

fn main() -> ExitCode {
    ExitCode::from(message::show(match Arguments::parse().command {
        Command::Bench(args) => bench::run(&args),
        Command::Solver(args) => solver::run(&args),
        Command::CornerCases(args) => corner_cases::run(&args),
        Command::Stress(args) => stress::run(&args),
        Command::Mutants(args) => mutants::run(&args),
        Command::Study(args) => study::run(&args),
        Command::Cells(args) => cells::run(&args),
        Command::Luts(args) => luts::run(&args),
    }))
}
