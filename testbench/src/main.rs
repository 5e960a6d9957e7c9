//! The `testbench` command.

use std::error::Error;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use golden::design::Design;

use testbench::frame_set::FrameSet;
use testbench::progress::Progress;
use testbench::report::Report;
use testbench::run::{Options, run};
use testbench::table;
use testbench::verilate::Trace;

/// Simulates generated hardware and compares it with software.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run frames through a design's RTL, word by word against the integer model and the f64 solver.
    ///
    /// The streams run free, with an idle source, with a stalled sink, and with both. The exit code is 0 only if every
    /// word is the model's.
    Run(RunArguments),
}

#[derive(Args)]
struct RunArguments {
    /// Design file (TOML).
    design: PathBuf,
    /// Frames (CSV): one frame a line, stresses in pascals, compression negative. Without it, the ground-truth frames
    /// made for the sensor.
    #[arg(long)]
    frames: Option<PathBuf>,
    /// True forces of the frames (CSV, as `golden scene` writes them), to report the errors.
    #[arg(long, requires = "frames")]
    reference: Option<PathBuf>,
    /// Write all signals of the free-running mode, FST or (by its ending) VCD; without a name, NAME.fst or NAME.vcd
    /// after the design, in the current folder.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    #[allow(clippy::option_option, reason = "absent, without a name, with one: how clap tells them apart")]
    trace: Option<Option<PathBuf>>,
    /// Seed of the streams' pauses and of the registers' random start.
    #[arg(long, default_value_t = Options::default().seed)]
    seed: u32,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    let Command::Run(arguments) = Arguments::parse().command;
    match simulate(&arguments).and_then(|report| print(&report, arguments.json).map(|()| report.bit_exact)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn simulate(arguments: &RunArguments) -> Result<Report, Box<dyn Error>> {
    let design = Design::load(&arguments.design)?;
    let progress = Progress::new();
    let frames = if let Some(path) = &arguments.frames {
        FrameSet::load(path, arguments.reference.as_deref(), &design.sensor)?
    } else {
        progress.stage("making ground-truth frames");
        FrameSet::standing(&design.sensor)?
    };
    let trace = arguments.trace.as_ref().map(|file| match file {
        Some(file) => file.clone(),
        None => Path::new(&design.name).with_extension(Trace::best().extension()),
    });
    let options = Options { trace: trace.as_deref(), seed: arguments.seed };
    Ok(run(&design, &frames, &options, &progress)?)
}

fn print(report: &Report, json: bool) -> Result<(), Box<dyn Error>> {
    let text = if json { serde_json::to_string_pretty(report)? + "\n" } else { table::render(report) };
    match io::stdout().write_all(text.as_bytes()) {
        // `testbench run … | head` is no failure.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other?),
    }
}
