//! `cargo xtask cells`: Yosys' cells by block.

use sptfra::arguments::design_file;
use sptfra::message::{self, json_or};
use std::path::PathBuf;

use xtask::bench::cells;

/// Sums Yosys' cell counts of a generated design by block, beside the predicted ones.
///
/// STATISTICS is the output of `stat -json` after a synthesis without -flatten; `tools/synth.py` does both.
#[derive(clap::Args)]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Its generated folder.
    folder: PathBuf,
    /// Yosys' statistics (JSON).
    statistics: PathBuf,
    /// Yosys' netlist (`write_json`), not flattened, for the levels of logic of each block.
    #[arg(long)]
    netlist: Option<PathBuf>,
    /// Record of levels (TOML): a block that has more is an error.
    #[arg(long, requires = "netlist")]
    levels: Option<PathBuf>,
    /// Write the levels there instead.
    #[arg(long, requires = "levels")]
    record: bool,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// Sums cells and counts levels by block.
pub fn run(arguments: &Args) -> message::Result {
    let metadata = arguments.folder.join("metadata.json");
    let cells = cells::count(&arguments.design, &metadata, &arguments.statistics, arguments.netlist.as_deref())?;
    if let Some(record) = &arguments.levels {
        cells.hold_to(record, arguments.record)?;
    }
    let text = |cells: &cells::Cells| match &arguments.netlist {
        Some(_) => cells.table(&cells.design).text(0, 0) + "\n" + &cells.longest_ways().text(0, 0),
        None => cells.table(&cells.design).text(0, 0),
    };
    Ok(json_or(&cells, arguments.json, text)?.into())
}
