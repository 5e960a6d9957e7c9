//! The `testbench` command.

mod commands;

use std::error::Error;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, CommandFactory, Parser, Subcommand};
use golden::design::Design;
use golden::manual::Manual;
use golden::output::write_whole;

use testbench::bench::{self, BenchError, Scope};
use testbench::frame_set::FrameSet;
use testbench::mutants;
use testbench::progress::Progress;
use testbench::report::Report;
use testbench::run::{Options, run};
use testbench::stress;
use testbench::table;
use testbench::verilate::Trace;
use testbench::view;

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
    /// word is the model's, latency and interval are the predicted ones (with `skip_zeros`: no more), and every
    /// register of a design with `control = true` has the value that it should have.
    Run(RunArguments),
    /// Measure: time to generate, speed of the simulation, cycles against lanes and taxels.
    ///
    /// With --solver and --cells the page has the figures of `golden bench` and of Yosys too; `make bench` does all of
    /// it. No figure decides the exit code.
    Bench(BenchArguments),
    /// Speed against error: variants of designs on scenes with known forces, as JSON, CSV and a page to look at.
    ///
    /// Each point is a file in OUT/points, written whole; a sweep that was stopped goes on from there, and points that
    /// are there are not computed again. Without axes: filters with plans, and widths and lanes one at a time around
    /// each design. Axes that are named beside --filters, --plans, --estimators or --full are combined.
    Sweep(commands::sweep::Arguments),
    /// Sensors, contacts and frames at the limits, in f64, float32, the hardware's integers and the simulated RTL:
    /// condition numbers, backward errors, errors, statuses.
    ///
    /// The exit code is 0 only if no answer is wrong in silence, a NaN or a force beyond reason without a status bit,
    /// and every word of the RTL is the model's.
    Hard(commands::hard::Arguments),
    /// Send very many frames, good, short, long and with NaN, through streams that pause at random and resets.
    ///
    /// The exit code is 0 only if each answer is the model's, each bad frame is flagged, and none is lost but to a
    /// reset, doubled or out of order.
    Stress {
        #[command(flatten)]
        common: SeededArguments,
        /// Frames to send.
        #[arg(long, default_value_t = 100_000)]
        frames: u64,
    },
    /// Make copies of the RTL with one small fault each, and see whether the comparison catches them.
    ///
    /// Lists those that it does not catch. No figure decides the exit code.
    Mutants {
        #[command(flatten)]
        common: SeededArguments,
        /// Mutants to make.
        #[arg(long, default_value_t = 50)]
        count: usize,
    },
    /// Sum Yosys' cell counts of a generated design by block, beside the predicted ones.
    ///
    /// STATISTICS is what `stat -json` prints after a synthesis without -flatten; `tools/synth.sh` does both.
    Cells {
        /// Design file (TOML).
        design: PathBuf,
        /// Its generated folder.
        folder: PathBuf,
        /// Yosys' statistics (JSON).
        statistics: PathBuf,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Show the forces of a frame in the terminal.
    ///
    /// One cell a taxel, y upwards: an arrow for the direction of the shear, a digit for its share of the largest
    /// force, and a digit for that of the normal force. In colour on a terminal, unless `NO_COLOR` is set. The forces
    /// are the hardware's, from the integer model.
    View(ViewArguments),
    #[command(flatten)]
    Manual(Manual),
}

#[derive(Args)]
struct ViewArguments {
    /// Design file (TOML).
    design: PathBuf,
    /// Frames (CSV), as for `testbench run`.
    #[arg(long)]
    frames: Option<PathBuf>,
    /// Columns of labels before the values of a frame; the file may then have a header.
    #[arg(long, default_value_t = 0, requires = "frames")]
    labels: usize,
    /// Which frame, from 0.
    #[arg(long, default_value_t = 0, value_name = "N")]
    frame: usize,
    /// All values as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct SeededArguments {
    /// Design file (TOML).
    design: PathBuf,
    /// Decides everything that is random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct BenchArguments {
    /// Design files (TOML) to generate and simulate.
    designs: Vec<PathBuf>,
    /// Largest side of the square sensors in the tables of cycles.
    #[arg(long, default_value_t = 32)]
    largest: usize,
    /// What `golden bench --json` printed.
    #[arg(long, value_name = "FILE.json")]
    solver: Option<PathBuf>,
    /// What `testbench cells --json` printed; once for each design.
    #[arg(long, value_name = "FILE.json")]
    cells: Vec<PathBuf>,
    /// Where to write the page (Markdown).
    #[arg(long, value_name = "PAGE.md")]
    page: Option<PathBuf>,
    /// Where to write the plot of latency against taxels (SVG).
    #[arg(long, value_name = "PLOT.svg")]
    plot: Option<PathBuf>,
    /// Report as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct RunArguments {
    /// Design file (TOML).
    design: PathBuf,
    /// Frames (CSV): one frame a line, stresses in pascals, compression negative, or counts if the design has
    /// `pa_per_count`. Without it, the ground-truth frames made for the sensor.
    #[arg(long)]
    frames: Option<PathBuf>,
    /// Columns of labels before the values of a frame; the file may then have a header.
    #[arg(long, default_value_t = 0, requires = "frames")]
    labels: usize,
    /// True forces of the frames (CSV, as `golden scene` writes them), to report the errors.
    #[arg(long, requires = "frames")]
    reference: Option<PathBuf>,
    /// Write all signals of the free-running mode, FST or (by its ending) VCD; without a name, NAME.fst or NAME.vcd
    /// after the design, in the current folder. Beside it go views of the streams and blocks: .gtkw for `GTKWave`,
    /// .sucl for Surfer.
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
    let result = match Arguments::parse().command {
        Command::Run(arguments) => simulate(&arguments)
            .and_then(|report| print(&report_text(&report, arguments.json)?).map(|()| complain(&report))),
        Command::Bench(arguments) => bench(&arguments).map(|()| true),
        Command::Sweep(arguments) => commands::sweep::run(&arguments).and_then(|text| print(&text)).map(|()| true),
        Command::View(arguments) => view(&arguments).map(|()| true),
        Command::Manual(manual) => manual.run(Arguments::command()).and_then(|text| print(&text)).map(|()| true),
        Command::Hard(arguments) => {
            commands::hard::run(&arguments).and_then(|(text, sound)| print(&text).map(|()| sound))
        }
        Command::Stress { common, frames } => stress_design(&common, frames).map(|()| true),
        Command::Mutants { common, count } => make_mutants(&common, count).map(|()| true),
        Command::Cells { design, folder, statistics, json } => {
            cells(&design, &folder, &statistics, json).map(|()| true)
        }
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn bench(arguments: &BenchArguments) -> Result<(), Box<dyn Error>> {
    let load = |path: &PathBuf| Ok((path.display().to_string(), Design::load(path)?));
    let scope = Scope {
        designs: arguments.designs.iter().map(load).collect::<Result<_, BenchError>>()?,
        largest: arguments.largest,
        solver: arguments.solver.clone(),
        cells: arguments.cells.clone(),
    };
    let figures = bench::measure(&scope, &Progress::new())?;
    if let Some(plot) = &arguments.plot {
        write_whole(plot, bench::plot::render(&figures.cycles).as_bytes())?;
    }
    let page = bench::page::render(&figures, &command(&scope), arguments.plot.as_deref().and_then(file_name));
    if let Some(path) = &arguments.page {
        write_whole(path, page.as_bytes())?;
    }
    if arguments.json {
        print(&(serde_json::to_string_pretty(&figures)? + "\n"))
    } else if let Some(path) = &arguments.page {
        print(&format!("written: {}\n", path.display()))
    } else {
        print(&page)
    }
}

/// The command that measures the same again.
fn command(scope: &Scope) -> String {
    let designs: Vec<&str> = scope.designs.iter().map(|(path, _)| path.as_str()).collect();
    format!("testbench bench {} --largest {}", designs.join(" "), scope.largest)
}

/// The plot lies beside the page.
fn file_name(path: &Path) -> Option<&str> {
    path.file_name()?.to_str()
}

fn cells(design: &Path, folder: &Path, statistics: &Path, json: bool) -> Result<(), Box<dyn Error>> {
    let cells = bench::cells::count(design, &folder.join("metadata.json"), statistics)?;
    print(&if json { serde_json::to_string_pretty(&cells)? + "\n" } else { bench::cells::render(&cells) })
}

/// Frames of a file, with so many columns of labels, or the standing ones.
fn frames(
    file: Option<(&Path, usize)>,
    reference: Option<&Path>,
    design: &Design,
    progress: &Progress,
) -> Result<FrameSet, Box<dyn Error>> {
    if let Some((path, labels)) = file {
        return Ok(FrameSet::load(path, labels, reference, &design.sensor)?);
    }
    progress.stage("making ground-truth frames");
    Ok(FrameSet::standing(&design.sensor)?.as_delivered(design))
}

fn view(arguments: &ViewArguments) -> Result<(), Box<dyn Error>> {
    let design = Design::load(&arguments.design)?;
    let view = {
        let progress = Progress::new();
        let file = arguments.frames.as_deref().map(|path| (path, arguments.labels));
        let frames = frames(file, None, &design, &progress)?;
        view::frame(&design, &frames, arguments.frame, &progress)?
    };
    print(&if arguments.json { view.json()? } else { view.page(view::wants_colour()) })
}

fn stress_design(arguments: &SeededArguments, frames: u64) -> Result<(), Box<dyn Error>> {
    let design = Design::load(&arguments.design)?;
    let report = stress::stress(&design, &stress::Options { frames, seed: arguments.seed }, &Progress::new())?;
    print(&if arguments.json { serde_json::to_string_pretty(&report)? + "\n" } else { report.to_string() })
}

fn make_mutants(arguments: &SeededArguments, count: usize) -> Result<(), Box<dyn Error>> {
    let design = Design::load(&arguments.design)?;
    let report = mutants::mutants(&design, &mutants::Options { count, seed: arguments.seed }, &Progress::new())?;
    print(&if arguments.json { serde_json::to_string_pretty(&report)? + "\n" } else { report.to_string() })
}

fn simulate(arguments: &RunArguments) -> Result<Report, Box<dyn Error>> {
    let design = Design::load(&arguments.design)?;
    let progress = Progress::new();
    let frames = frames(
        arguments.frames.as_deref().map(|path| (path, arguments.labels)),
        arguments.reference.as_deref(),
        &design,
        &progress,
    )?;
    let trace = arguments.trace.as_ref().map(|file| match file {
        Some(file) => file.clone(),
        None => Path::new(&design.name).with_extension(Trace::best().extension()),
    });
    let options = Options { trace: trace.as_deref(), seed: arguments.seed };
    Ok(run(&design, &frames, &options, &progress)?)
}

fn report_text(report: &Report, json: bool) -> Result<String, serde_json::Error> {
    if json { Ok(serde_json::to_string_pretty(report)? + "\n") } else { Ok(table::render(report)) }
}

/// Says on standard error what is wrong; whether nothing is.
fn complain(report: &Report) -> bool {
    for fault in &report.faults {
        eprintln!("error: {}: {fault}", report.design);
    }
    report.is_right()
}

fn print(text: &str) -> Result<(), Box<dyn Error>> {
    match io::stdout().write_all(text.as_bytes()) {
        // `testbench run … | head` is no failure.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other?),
    }
}
