//! `testbench run`.

use std::path::{Path, PathBuf};

use clap::Args;
use golden::arguments::design_file;
use golden::design::Design;

use super::frames::FrameArguments;
use super::{Said, shown};
use golden::progress::Progress;
use testbench::run::{self, Options, page};
use testbench::verilate::Trace;

#[derive(Args)]
pub struct Arguments {
    /// Design file (TOML).
    #[arg(value_parser = design_file())]
    design: PathBuf,
    #[command(flatten)]
    frames: FrameArguments,
    /// True forces of the frames (CSV, as `golden scene` writes them), to report the errors.
    #[arg(long, requires = "frames")]
    reference: Option<PathBuf>,
    /// Write all signals of the free-running mode, FST or (by its ending) VCD; without a name, NAME.fst or NAME.vcd
    /// after the design, in the current folder. Beside it go views of the streams and blocks: .gtkw for `GTKWave`,
    /// .sucl for Surfer.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    #[allow(clippy::option_option, reason = "absent, without a name, with one: how clap tells them apart")]
    trace: Option<Option<PathBuf>>,
    /// Write how often each net changes in the free-running mode at the design's clock (SAIF), from which Vivado estimates
    /// power (`vivado/power.tcl`); without a name NAME.saif, in the current folder.
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
pub fn run(arguments: &Arguments) -> super::Result {
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
    Ok(Said { text: shown(&report, arguments.json, page::render)?, faults: report.faults })
}
