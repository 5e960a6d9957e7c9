//! `cargo xtask drift`: errors under creep and drift.

use std::path::PathBuf;

use golden::output::write_whole;
use sptfra::arguments::design_file;
use sptfra::message;
use xtask::drift;

use super::named;

/// Writes errors of designs while readings creep or offsets drift, by correction and time since the touch, as CSV.
#[derive(clap::Args)]
pub struct Args {
    /// Design files (TOML).
    #[arg(required = true, value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// Where to write the table.
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
}

/// Writes the table.
pub fn run(arguments: &Args) -> message::Result {
    let designs = named(&arguments.designs)?;
    write_whole(&arguments.out, drift::csv(&designs)?.as_bytes())?;
    Ok(format!("{}: {} designs\n", arguments.out.display(), designs.len()).into())
}
