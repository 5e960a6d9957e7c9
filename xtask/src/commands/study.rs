//! `cargo xtask study`: tables of errors.

use std::error::Error;
use std::path::PathBuf;

use clap::ValueEnum;
use golden::output::renew_table;
use sptfra::arguments::design_file;
use sptfra::message;
use xtask::studies::{Study, Table};

use super::named;

/// Writes the rows of a table of errors, on contacts that no calibration draws, as CSV.
///
/// Run it at the top of the checkout.
#[derive(clap::Args)]
pub struct Args {
    /// What the errors depend on.
    #[arg(value_name = "STUDY")]
    of: Study,
    /// Design files (TOML) of the studies of noise, smoothing, confidence and drift; all others have their own.
    #[arg(value_parser = design_file())]
    designs: Vec<PathBuf>,
    /// The table, whose lines of comment stay [default: results/STUDY.csv].
    #[arg(long, value_name = "OUT.csv")]
    out: Option<PathBuf>,
}

/// Writes the table.
pub fn run(Args { of, designs, out }: &Args) -> message::Result {
    let name = of.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
    if of.takes_designs() == designs.is_empty() {
        let message = if designs.is_empty() { "name its design files" } else { "it has its own designs; name none" };
        return Err(format!("{name}: {message}").into());
    }
    let Table { designs, columns, rows } = of.table(named(designs)?).map_err(|error| -> Box<dyn Error> { error })?;
    let out = out.clone().unwrap_or_else(|| PathBuf::from(format!("results/{name}.csv")));
    renew_table(&out, &designs, columns, &rows)?;
    Ok(format!("{}: {} rows\n", out.display(), rows.lines().count()).into())
}
