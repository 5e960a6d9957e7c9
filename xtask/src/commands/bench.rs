//! `cargo xtask bench`: the figures that `tools/results.py bench` writes into results/.

use sptfra::arguments::design_file;
use sptfra::message;
use std::path::PathBuf;

use golden::design::Design;
use golden::progress::Progress;
use xtask::bench::{self, BenchError, Scope};

/// Measures time to generate, speed of the simulation, and cycles against lanes and taxels; prints JSON.
///
/// With --solver and --cells the solver's and Yosys' figures are among them; `make bench` does all of it. No figure
/// decides the exit code.
#[derive(clap::Args)]
pub struct Args {
    /// Design files (TOML) to generate and simulate.
    #[arg(value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// Largest side of the square sensors in the tables of cycles.
    #[arg(long, default_value_t = 32)]
    largest: usize,
    /// What `cargo xtask solver --json` printed.
    #[arg(long, value_name = "FILE.json")]
    solver: Option<PathBuf>,
    /// What `cargo xtask cells --json` printed; once for each design.
    #[arg(long, value_name = "FILE.json")]
    cells: Vec<PathBuf>,
}

/// Measures.
pub fn run(arguments: &Args) -> message::Result {
    let load = |path: &PathBuf| Ok((path.display().to_string(), Design::load(path)?));
    let scope = Scope {
        designs: arguments.designs.iter().map(load).collect::<Result<_, BenchError>>()?,
        largest: arguments.largest,
        solver: arguments.solver.clone(),
        cells: arguments.cells.clone(),
    };
    let figures = bench::measure(&scope, &Progress::new())?;
    Ok((serde_json::to_string_pretty(&figures)? + "\n").into())
}
