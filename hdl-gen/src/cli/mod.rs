//! Command line.

mod generate;
mod inspect;
mod new;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use golden::arguments::design_file;
use golden::design::Design;
use golden::manual::Manual;
use hdl_gen::plan::{Plan, PlanError};

use golden::progress::Progress;

/// Turns a tactile sensor's geometry and a sparse filter into Verilog that reconstructs triaxial contact forces.
#[derive(Parser)]
#[command(name = "hdl-gen", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Writes a commented design file NAME.toml to start from
    New(new::New),
    /// Shows geometry, condition numbers, Nnz per matrix, ROM bits, predicted cycles, DSP and BRAM
    Inspect {
        /// Design file (TOML)
        #[arg(value_parser = design_file())]
        design: PathBuf,
        /// For machines
        #[arg(long)]
        json: bool,
        /// Latency in microseconds that a frame may take: the fewest lanes that meet it, in place of the design's
        #[arg(long, value_name = "US", value_parser = microseconds)]
        target_us: Option<f64>,
    },
    /// Writes RTL, ROM files, MCSR listings and metadata.json
    Generate {
        /// Design file (TOML)
        #[arg(value_parser = design_file())]
        design: PathBuf,
        /// Folder to write; default: rtl-out/NAME
        #[arg(long)]
        out: Option<PathBuf>,
        /// A file of your own board, for block design and device tree; its keys are those of hdl-gen/boards/zcu102.toml
        #[arg(long = "board", value_name = "FILE")]
        boards: Vec<PathBuf>,
        /// Latency in microseconds that a frame may take: the fewest lanes that meet it, in place of the design's
        #[arg(long, value_name = "US", value_parser = microseconds)]
        target_us: Option<f64>,
        /// Mark nets for a logic analyser in the FPGA, and write the script that attaches it
        #[arg(long)]
        debug: bool,
    },
    #[command(flatten)]
    Manual(Manual),
}

pub fn main() -> ExitCode {
    match run(Arguments::parse().command) {
        Ok(text) => print(&text),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// What the command has to say on success.
fn run(command: Command) -> Result<String, Box<dyn Error>> {
    let progress = Progress::new();
    match command {
        Command::New(new) => new::write(&new, &progress),
        Command::Inspect { design, json, target_us } => {
            let loaded = Design::load(&design)?;
            let plan = planned(&loaded, &design, &progress, target_us, Plan::new)?;
            inspect::report(&plan, json)
        }
        Command::Manual(manual) => manual.run(Arguments::command()),
        Command::Generate { design, out, boards, target_us, debug } => {
            generate::generate(&design, out, &boards, (target_us, debug), &progress)
        }
    }
}

/// A time of the command line.
fn microseconds(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| *time > 0.0 && time.is_finite());
    time.ok_or_else(|| "a time in microseconds, greater than 0, such as 15".to_owned())
}

/// A design of file `path`, planned on lanes that meet `target_us`, or without one in a `way` that there is.
fn planned(
    design: &Design,
    path: &Path,
    progress: &Progress,
    target_us: Option<f64>,
    way: impl Fn(&Design) -> Result<Plan, PlanError>,
) -> Result<Plan, Box<dyn Error>> {
    progress.stage(format!("matrices and plan of {} taxels", design.sensor.taxels()));
    let plan = target_us.map_or_else(|| way(design), |target_us| Plan::meeting(design, target_us));
    plan.map_err(|error| format!("{}: {error}", path.display()).into())
}

/// Prints to standard output; a reader that has gone away is no error.
fn print(text: &str) -> ExitCode {
    use std::io::{ErrorKind, Write};
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            eprintln!("error: standard output: {error}");
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}
