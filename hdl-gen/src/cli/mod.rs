//! Command line.

mod inspect;
mod new;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use golden::design::Design;
use hdl_gen::emit::emit;
use hdl_gen::plan::Plan;
use hdl_gen::write::write_folder;

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
    New {
        /// Name of the design: a Verilog identifier
        name: String,
        /// Folder for the file
        #[arg(long, default_value = ".")]
        dir: PathBuf,
    },
    /// Shows geometry, condition numbers, Nnz per matrix, ROM bits, predicted cycles, DSP and BRAM
    Inspect {
        /// Design file (TOML)
        design: PathBuf,
        /// For machines
        #[arg(long)]
        json: bool,
    },
    /// Writes RTL, ROM files, MCSR listings and metadata.json
    Generate {
        /// Design file (TOML)
        design: PathBuf,
        /// Folder to write; default: rtl-out/NAME
        #[arg(long)]
        out: Option<PathBuf>,
    },
}

pub fn main() -> ExitCode {
    match run(Arguments::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: Command) -> Result<(), Box<dyn Error>> {
    match command {
        Command::New { name, dir } => new::write(&name, &dir),
        Command::Inspect { design, json } => {
            let text = inspect::report(&load(&design)?, json)?;
            print(&text)
        }
        Command::Generate { design, out } => generate(&design, out),
    }
}

fn load(path: &Path) -> Result<Plan, Box<dyn Error>> {
    let design = Design::load(path)?;
    Plan::new(&design).map_err(|error| format!("{}: {error}", path.display()).into())
}

fn generate(path: &Path, out: Option<PathBuf>) -> Result<(), Box<dyn Error>> {
    let plan = load(path)?;
    let files = emit(&plan)?;
    let folder = out.unwrap_or_else(|| Path::new("rtl-out").join(&plan.design.name));
    write_folder(&folder, &files)?;
    let bytes: usize = files.values().map(Vec::len).sum();
    let timeline = &plan.timeline;
    print(&format!(
        "{}: {} files, {} KiB\n{} taxels, {} lanes: latency {} cycles, interval {} cycles, {} DSP, {} RAMB36\n",
        folder.display(),
        files.len(),
        bytes / 1024,
        plan.taxels(),
        plan.design.hardware.lanes,
        timeline.latency_cycles,
        timeline.interval_cycles,
        plan.resources.dsp,
        plan.resources.bram36,
    ))
}

/// Prints to standard output; a reader that has gone away is no error.
fn print(text: &str) -> Result<(), Box<dyn Error>> {
    use std::io::{ErrorKind, Write};
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
