//! `cargo xtask luts`: the fit of LUTs and flip-flops.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use golden::output::write_whole;
use sptfra::arguments::design_file;
use sptfra::message;
use xtask::luts::{count, fit, read};

/// Fits LUTs and flip-flops to Yosys' counts: writes results/luts.csv, prints the constants of hdl-gen/src/plan/luts.rs.
///
/// Whole designs are those of results/cells.csv. Run it at the top of the checkout, or `make luts`.
#[derive(clap::Args)]
pub struct Args {
    /// Design file (TOML) with what the whole designs do not have.
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Yosys' statistics of it (JSON); without them its counts are those of results/luts.csv.
    statistics: Option<PathBuf>,
}

/// Fits.
pub fn run(Args { design, statistics }: &Args) -> message::Result {
    let table = Path::new("results/luts.csv");
    let name = design.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let counts = |path: &Path| read(&fs::read_to_string(path).unwrap_or_default()).unwrap_or_default();
    let parts = match statistics {
        Some(statistics) => BTreeMap::from([(name, count(design, statistics)?)]),
        None => counts(table),
    };
    let folder = design.parent().unwrap_or(Path::new(""));
    let fit = fit((&counts(Path::new("results/cells.csv")), Path::new("designs")), (&parts, folder))?;
    write_whole(table, fit.table.as_bytes())?;
    let [lut, ff] = fit.fitted;
    Ok(format!("ERROR_PERCENT: {:?}\nFITTED: [\n{lut:?},\n{ff:?},\n]\n", fit.error_percent).into())
}
