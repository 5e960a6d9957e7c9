//! `cargo xtask study`: errors of designs under noise, smoothing, creep and drift.

use std::path::PathBuf;

use golden::output::renew_table;
use sptfra::arguments::design_file;
use sptfra::message;
use xtask::{confidence, drift, noise};

use super::named;

/// Writes the rows of a table of errors, on contacts that no calibration draws, as CSV.
#[derive(clap::Args)]
pub struct Args {
    /// What the errors depend on.
    of: Study,
    /// Design files (TOML).
    #[arg(required = true, value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// The table; its lines of comment stay.
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Study {
    /// Noise of a reading, on round sliding contacts.
    Noise,
    /// Frames averaged by sensor.smoothing, on the same contacts.
    Smoothing,
    /// Shares of errors within the standard error, by noise and kind of contact.
    Confidence,
    /// Creep and drift, by correction and time since the touch.
    Drift,
}

/// Writes the table.
pub fn run(arguments: &Args) -> message::Result {
    let designs = named(&arguments.designs)?;
    let (columns, rows) = match arguments.of {
        Study::Noise => (noise::COLUMNS, noise::rows(&designs)?),
        Study::Smoothing => (noise::SMOOTHING_COLUMNS, noise::smoothing_rows(&designs)?),
        Study::Confidence => (confidence::COLUMNS, confidence::rows(&designs)?),
        Study::Drift => (drift::COLUMNS, drift::rows(&designs)?),
    };
    renew_table(&arguments.out, &designs, columns, &rows)?;
    Ok(format!("{}: {} designs\n", arguments.out.display(), designs.len()).into())
}
