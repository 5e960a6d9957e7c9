//! `testbench cells`.

use std::path::PathBuf;

use clap::Args;
use golden::arguments::design_file;

use super::shown;
use testbench::bench::cells;

#[derive(Args)]
pub struct Arguments {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Its generated folder.
    folder: PathBuf,
    /// Yosys' statistics (JSON).
    statistics: PathBuf,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// Sums cells by block.
pub fn run(arguments: &Arguments) -> super::Result {
    let cells = cells::count(&arguments.design, &arguments.folder.join("metadata.json"), &arguments.statistics)?;
    Ok(shown(&cells, arguments.json, |cells| cells.table(&cells.design).text(0, 0))?.into())
}
