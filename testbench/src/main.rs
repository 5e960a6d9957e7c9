//! The `testbench` command.

mod commands;

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use golden::manual::Manual;

use commands::{Said, bench, build, cells, hard, mutants, run, stress, sweep, view};

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
    /// word is the model's, latency and interval are the predicted ones, and every
    /// register of a design with `control = true` has the value that it should have.
    Run(run::Arguments),
    /// Compile a design's RTL for a program of your own, and print the path of the shared object.
    ///
    /// `drivers/simulated` gives the drivers, and the programs above them, registers and memory of that core. It stays in
    /// the cache for as long as it is used.
    Build(build::Arguments),
    /// Measure: time to generate, speed of the simulation, cycles against lanes and taxels.
    ///
    /// With --solver and --cells the page has the figures of `golden bench` and of Yosys too; `make bench` does all of
    /// it. No figure decides the exit code.
    Bench(bench::Arguments),
    /// Speed against error: variants of designs on scenes with known forces, as JSON, CSV and a page to look at.
    ///
    /// Each point is a file in OUT/points, written whole; a sweep that was stopped goes on from there, and points that
    /// are there are not computed again. Without axes: filters with plans, and widths and lanes one at a time around
    /// each design. Axes that are named beside --filters, --plans, --estimators or --full are combined.
    Sweep(sweep::Arguments),
    /// Sensors, contacts and frames at the limits, in f64, float32, the hardware's integers and the simulated RTL:
    /// condition numbers, backward errors, errors, statuses.
    ///
    /// The exit code is 0 only if no answer is wrong in silence, a NaN or a force beyond reason without a status bit,
    /// and every word of the RTL is the model's.
    Hard(hard::Arguments),
    /// Send very many frames, good, short, long and with NaN, through streams that pause at random and resets.
    ///
    /// The exit code is 0 only if each answer is the model's, each bad frame is flagged, and none is lost but to a
    /// reset, doubled or out of order.
    Stress(stress::Arguments),
    /// Make copies of the RTL with one small fault each, and see whether the comparison catches them.
    ///
    /// Lists those that it does not catch. No figure decides the exit code.
    Mutants(mutants::Arguments),
    /// Sum Yosys' cell counts of a generated design by block, beside the predicted ones.
    ///
    /// STATISTICS is what `stat -json` prints after a synthesis without -flatten; `tools/synth.sh` does both.
    Cells(cells::Arguments),
    /// Show the forces of a frame in the terminal, or play several.
    ///
    /// One cell a taxel, y upwards: an arrow for the direction of the shear, a digit for its share of the largest
    /// force, and a digit for that of the normal force. In colour on a terminal, unless `NO_COLOR` is set. The forces
    /// are the hardware's, from the integer model.
    View(view::Arguments),
    #[command(flatten)]
    Manual(Manual),
}

fn main() -> ExitCode {
    let said = match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Build(arguments) => build::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments),
        Command::Hard(arguments) => hard::run(&arguments),
        Command::Stress(arguments) => stress::run(&arguments),
        Command::Mutants(arguments) => mutants::run(&arguments),
        Command::Cells(arguments) => cells::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Manual(manual) => manual.run(Arguments::command()).map(Said::from),
    };
    let faults = said.and_then(|Said { text, faults }| print(&text).map(|()| faults));
    let faults = faults.unwrap_or_else(|error| vec![error.to_string()]);
    for fault in &faults {
        eprintln!("error: {fault}");
    }
    if faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn print(text: &str) -> Result<(), Box<dyn Error>> {
    match io::stdout().write_all(text.as_bytes()) {
        // `testbench run … | head` is no failure.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other?),
    }
}
