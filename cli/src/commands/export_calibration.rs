//! `sptfra export-calibration`: the calibration that a board loads into its bank.

use std::path::PathBuf;

use golden::bank;
use golden::design::Design;
use golden::output::write_whole;
use golden::resolved::keep_apart;
use serde_json::{Value, json};

use crate::arguments::design_file;
use crate::message::{self, json_or};

const EXAMPLE: &str = "Example:\n  sptfra export-calibration pad --out pad.bank.csv";

const BANK_FILE: &str = include_str!("../help/export-calibration.txt");

/// Writes the calibration that a board loads into its bank, as CSV.
///
/// For a design with [hardware] calibration = "ram": each taxel's gain and offset. With `room` for dead taxels, also its
/// weights in their stress. `load_calibration` of the Python driver reads the file. Nothing is synthesized again.
#[derive(clap::Args)]
#[command(after_help = EXAMPLE, after_long_help = format!("{EXAMPLE}\n\n{}", BANK_FILE.trim_end()))]
pub struct Args {
    /// Design file (TOML), with the calibration and the dead taxels of today.
    #[arg(value_parser = design_file())]
    design: PathBuf,
    /// Where to write the bank (CSV).
    #[arg(long, value_name = "BANK.csv")]
    out: PathBuf,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// Writes the bank of a design.
pub fn run(args: &Args) -> message::Result {
    let Args { design: path, out, json } = args;
    keep_apart(out, &Design::inputs_at(path)?)?;
    let design = Design::load(path)?;
    let text = bank::to_csv(&design)?;
    write_whole(out, text.as_bytes())?;
    let replaced: &[usize] = if design.input.room == 0 { &[] } else { &design.input.dead };
    let taxels = design.sensor.taxels();
    let (name, out) = (&design.name, out.to_string_lossy());
    let report = json!({ "design": name, "bank": out, "taxels": taxels, "replaced": replaced });
    let text = |_: &Value| {
        let dead = match replaced {
            [] => "no taxel replaced".to_owned(),
            replaced => format!("taxels {replaced:?} replaced"),
        };
        format!(
            "{name}: {taxels} gains and offsets, {dead}: {out}\nnext: load_calibration(\"{out}\") of the board's driver\n"
        )
    };
    Ok(json_or(&report, *json, text)?.into())
}
