//! `cargo xtask luts`: the fit of LUTs and flip-flops.

use std::path::{Path, PathBuf};
use std::process::Command;

use golden::design::Design;
use golden::output::write_whole;
use hdl_gen::plan::Plan;
use hdl_gen::plan::luts::FEATURES;
use rayon::prelude::*;
use sptfra::message;
use xtask::bench::cells;
use xtask::luts::{DRAWN, Row, SHIPPED, csv, draw, fit};

/// Counts LUTs and flip-flops of forty designs with Yosys, and fits the constants of hdl-gen/src/plan/luts.rs (an hour).
///
/// Counts that are in the folder already are not made again.
#[derive(clap::Args)]
pub struct Args {
    /// Where the designs and Yosys' counts go, and stay.
    #[arg(long, default_value = "target/synth")]
    work: PathBuf,
    /// Where to write the table (CSV).
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
}

/// Yosys' counts of a design.
fn counted(work: &Path, file: &Path, name: &str) -> Result<Row, String> {
    let design = Design::load(file).map_err(|error| error.to_string())?;
    let plan = Plan::new(&design).map_err(|error| format!("{name}: {error}"))?;
    let counts = work.join(format!("{}.cells.json", design.name));
    if !counts.exists() {
        let done = Command::new("tools/synth.sh").arg(file).env("COUNT_ONLY", "1").output();
        let done = done.map_err(|error| format!("tools/synth.sh: {error}; run it at the top of the checkout"))?;
        if !done.status.success() {
            return Err(format!("{name}: {}", String::from_utf8_lossy(&done.stderr)));
        }
    }
    let cells = cells::read(&counts).map_err(|error| error.to_string())?;
    Ok(Row::new(name, &plan, &cells.total.yosys))
}

/// Counts, fits, writes the table and prints the constants.
pub fn run(arguments: &Args) -> message::Result {
    let mut files = Vec::new();
    std::fs::create_dir_all(&arguments.work)?;
    for number in 0..DRAWN {
        let design = draw(number)?;
        let file = arguments.work.join(format!("{}.toml", design.name));
        write_whole(&file, design.to_toml().as_bytes())?;
        files.push((design.name, file));
    }
    files.extend(SHIPPED.map(|file| {
        let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
        (name.into_owned(), file.into())
    }));
    let rows: Vec<Row> =
        files.par_iter().map(|(name, file)| counted(&arguments.work, file, name)).collect::<Result<_, _>>()?;
    write_whole(&arguments.out, csv(&rows).as_bytes())?;
    let fitted = fit(&rows);
    let lines = FEATURES.iter().zip(fitted).map(|(name, [lut, ff])| format!("    [{lut:.1}, {ff:.1}], // {name}\n"));
    Ok(format!("{}: {} designs\n{}", arguments.out.display(), rows.len(), lines.collect::<String>()).into())
}
