//! `cargo xtask luts`: the fit of LUTs and flip-flops.

use std::path::{Path, PathBuf};
use std::process::Command;

use golden::design::Design;
use golden::output::write_whole;
use hdl_gen::plan::Plan;
use hdl_gen::plan::luts::FEATURES;
use rayon::prelude::*;
use sptfra::message;
use xtask::bench::cells::{self, Count};
use xtask::luts::{DRAWN, Row, SHIPPED, csv, draw, fit, read};

/// Counts LUTs and flip-flops of forty designs with Yosys, and fits the constants of hdl-gen/src/plan/luts.rs.
///
/// A design takes minutes. Counts that the table has are not made again: remove its rows after a change of the hardware.
#[derive(clap::Args)]
pub struct Args {
    /// Where the designs and Yosys' counts go.
    #[arg(long, default_value = "target/synth")]
    work: PathBuf,
    /// The table (CSV), read and written.
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
    /// Counts at most so many designs more.
    #[arg(long, value_name = "N", default_value_t = usize::MAX)]
    most: usize,
}

/// Yosys' counts of a design.
fn counted(work: &Path, file: &Path, design: &str) -> Result<[f64; 2], String> {
    let counts = work.join(format!("{design}.cells.json"));
    if !counts.exists() {
        let done = Command::new("tools/synth.sh").arg(file).env("COUNT_ONLY", "1").output();
        let done = done.map_err(|error| format!("tools/synth.sh: {error}; run it at the top of the checkout"))?;
        if !done.status.success() {
            return Err(format!("{design}: {}", String::from_utf8_lossy(&done.stderr)));
        }
    }
    let Count { lut, ff, .. } = cells::read(&counts).map_err(|error| error.to_string())?.total.yosys;
    Ok([lut as f64, ff as f64])
}

/// Counts, fits, writes the table and prints the constants.
pub fn run(arguments: &Args) -> message::Result {
    let Args { work, out, most } = arguments;
    let mut files = Vec::new();
    std::fs::create_dir_all(work)?;
    for number in 0..DRAWN {
        let design = draw(number)?;
        let file = work.join(format!("{}.toml", design.name));
        write_whole(&file, design.to_toml().as_bytes())?;
        files.push(file);
    }
    files.extend(SHIPPED.map(PathBuf::from));
    let table = std::fs::read_to_string(out).unwrap_or_default();
    let known = read(&table).ok_or_else(|| format!("{}: no table of this command; remove the file", out.display()))?;
    let name = |file: &Path| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let is_counted = |file: &PathBuf| {
        let name = name(file);
        known.contains_key(&name) || work.join(format!("{}.cells.json", name.replace('-', "_"))).exists()
    };
    let (here, missing): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(is_counted);
    let files: Vec<&PathBuf> = here.iter().chain(missing.iter().take(*most)).collect();
    let row = |file: &&PathBuf| {
        let design = Design::load(file).map_err(|error| error.to_string())?;
        let plan = Plan::new(&design).map_err(|error| format!("{}: {error}", file.display()))?;
        let name = name(file);
        let counted = known.get(&name).map_or_else(|| counted(work, file, &design.name), |known| Ok(*known))?;
        Ok(Row::new(&name, &plan, counted))
    };
    let mut rows: Vec<Row> = files.par_iter().map(row).collect::<Result<_, String>>()?;
    rows.sort_by(|a, b| a.name.cmp(&b.name));
    write_whole(out, csv(&rows).as_bytes())?;
    let fitted = fit(&rows);
    let lines = FEATURES.iter().zip(fitted).map(|(name, [lut, ff])| format!("    [{lut:.1}, {ff:.1}], // {name}\n"));
    Ok(format!("{}: {} designs\n{}", out.display(), rows.len(), lines.collect::<String>()).into())
}
