//! `sptfra run`: frames through the simulated hardware.

use std::path::{Path, PathBuf};

use crate::arguments::design_file;
use crate::message::{self, Message, json_or};
use golden::design::Design;

use super::frames::FrameArguments;
use golden::progress::Progress;
use testbench::run::{self, Options, page};
use testbench::verilate::Trace;

/// Simulates a design's hardware and compares every word with the models.
///
/// The streams run freely, with an idle source, with a stalled sink, and with both. The exit code is 0 only if every
/// word is the model's, latency and interval are the predicted ones, and every register has its expected value.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  sptfra run pad --frames frames.csv --reference frames.forces.csv")]
pub struct Args {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    #[command(flatten)]
    frames: FrameArguments,
    /// True forces of the frames (CSV of `sptfra scene`), to report the errors.
    #[arg(long, value_name = "FORCES.csv", requires = "frames")]
    reference: Option<PathBuf>,
    /// Write all signals of the free-running mode (FST or VCD) [default: NAME.fst]
    ///
    /// Beside it go views of the streams and blocks: .gtkw for `GTKWave`, .sucl for Surfer.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    #[allow(clippy::option_option, reason = "absent, without a name, with one: how clap separates them")]
    trace: Option<Option<PathBuf>>,
    /// Write how often each net changes (SAIF) [default: NAME.saif]
    ///
    /// For Vivado's estimate of power.
    #[arg(long, value_name = "FILE", num_args = 0..=1, conflicts_with = "trace")]
    #[allow(clippy::option_option, reason = "as above")]
    saif: Option<Option<PathBuf>>,
    /// Seed of the streams' pauses and of the registers' random start.
    #[arg(long, default_value_t = Options::default().seed)]
    seed: u32,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

/// Simulates a design and compares it.
pub fn run(arguments: &Args) -> message::Result {
    let design = Design::load(&arguments.design)?;
    let progress = Progress::new();
    let frames = arguments.frames.load(arguments.reference.as_deref(), &design, &progress)?;
    let named = |file: &Option<PathBuf>, format: Trace| match file {
        Some(file) => file.clone(),
        None => Path::new(&design.name).with_extension(format.extension()),
    };
    let activity = arguments.saif.as_ref().map(|file| named(file, Trace::Saif));
    if let Some(file) = &activity
        && file.extension().is_none_or(|ending| ending != "saif")
    {
        return Err(format!("{}: the name of a SAIF file ends in .saif", file.display()).into());
    }
    let trace = activity.or_else(|| arguments.trace.as_ref().map(|file| named(file, Trace::best())));
    let options = Options { trace: trace.as_deref(), seed: arguments.seed };
    let report = run::run(&design, &frames, &options, &progress)?;
    Ok(Message { text: json_or(&report, arguments.json, page::render)?, faults: report.faults })
}
