//! `testbench bench`.

use std::path::{Path, PathBuf};

use clap::Args;
use golden::arguments::design_file;
use golden::design::Design;
use golden::output::write_whole;

use super::shown;
use golden::progress::Progress;
use testbench::bench::{self, BenchError, Scope};

#[derive(Args)]
pub struct Arguments {
    /// Design files (TOML) to generate and simulate.
    #[arg(value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// Largest side of the square sensors in the tables of cycles.
    #[arg(long, default_value_t = 32)]
    largest: usize,
    /// What `golden bench --json` printed.
    #[arg(long, value_name = "FILE.json")]
    solver: Option<PathBuf>,
    /// What `testbench cells --json` printed; once for each design.
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
pub fn run(arguments: &Arguments) -> super::Result {
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
    Ok(shown(&figures, arguments.json, |_| written.unwrap_or(page))?.into())
}

/// The command that measures the same again.
fn again(scope: &Scope) -> String {
    let designs: Vec<&str> = scope.designs.iter().map(|(path, _)| path.as_str()).collect();
    format!("testbench bench {} --largest {}", designs.join(" "), scope.largest)
}
