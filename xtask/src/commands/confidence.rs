//! `cargo xtask confidence`: how right standard errors are.

use std::path::PathBuf;

use golden::output::write_whole;
use sptfra::arguments::design_file;
use sptfra::message;
use xtask::confidence;

use super::named;

/// Writes shares of errors within the standard errors of designs, by noise and kind of contact, as CSV.
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
    write_whole(&arguments.out, confidence::csv(&designs)?.as_bytes())?;
    Ok(format!("{}: {} designs\n", arguments.out.display(), designs.len()).into())
}
