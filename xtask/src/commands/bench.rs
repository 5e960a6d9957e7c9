//! `cargo xtask bench`: figures of results/README.md.

use sptfra::arguments::design_file;
use sptfra::message::{self, json_or};
use std::path::{Path, PathBuf};

use golden::design::Design;
use golden::output::write_whole;

use golden::progress::Progress;
use xtask::bench::{self, BenchError, Scope};

/// Measures time to generate, speed of the simulation, and cycles against lanes and taxels.
///
/// With --solver and --cells the page has the solver's and Yosys' figures too; `make bench` does all of it. No figure
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
    /// Where to write the page (Markdown).
    #[arg(long, value_name = "PAGE.md")]
    page: Option<PathBuf>,
    /// Where to write the plot of latency against taxels (SVG).
    #[arg(long, value_name = "PLOT.svg")]
    plot: Option<PathBuf>,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
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
    if let Some(plot) = &arguments.plot {
        write_whole(plot, bench::plot::render(&figures.cycles).as_bytes())?;
    }
    // The plot lies beside the page.
    let plot = arguments.plot.as_deref().and_then(Path::file_name).and_then(|name| name.to_str());
    let page = bench::page::render(&figures, &again(&scope), plot);
    let written = arguments.page.as_ref().map(|path| format!("written: {}\n", path.display()));
    if let Some(path) = &arguments.page {
        write_whole(path, page.as_bytes())?;
    }
    Ok(json_or(&figures, arguments.json, |_| written.unwrap_or(page))?.into())
}

/// The command that measures the same again.
fn again(scope: &Scope) -> String {
    let designs: Vec<&str> = scope.designs.iter().map(|(path, _)| path.as_str()).collect();
    format!("cargo xtask bench {} --largest {}", designs.join(" "), scope.largest)
}
