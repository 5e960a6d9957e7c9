//! `sptfra run`: a design and frames in, a [`Report`] out.

pub mod page;
pub mod report;

use std::path::{Path, PathBuf};

use golden::design::{Design, Estimator, Filter, Tension};
use golden::output::OutputError;
use golden::solver::{Solution, Solver, SolverError as SolveError};
use hdl_gen::plan::Plan;
use thiserror::Error;

use crate::accuracy::{SolverError, StatusCounts, against_truth};
use crate::co_simulation::{CoSimulation, CoSimulationError, planned, rtl_sources};
use crate::frame_set::FrameSet;
use crate::registers;
use crate::simulate::frames_to_simulate;
use crate::stream_words::{as_received, decode, packets};
use crate::verilate::{Trace, Verilate, verilator_version};
use crate::waves;
use golden::progress::Progress;
use report::Report;

/// Why a run has no report.
#[derive(Debug, Error)]
pub enum RunError {
    /// The design cannot be planned, built or simulated.
    #[error(transparent)]
    CoSimulation(#[from] CoSimulationError),
    /// The f64 solver refused the design or a frame.
    #[error(transparent)]
    Solver(#[from] SolveError),
    /// A view of the trace cannot be written.
    #[error(transparent)]
    View(#[from] OutputError),
    /// A trace was asked for in a format that cannot be written here.
    #[error("{}: the headers of zlib and LZ4 are missing, which FST needs; run `make tools` or name a .vcd file", .0.display())]
    NoFst(PathBuf),
}

/// What to do besides comparing.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// File for the signals of the free-running mode: VCD or SAIF if its name ends so, FST otherwise.
    pub trace: Option<&'a Path>,
    /// Decides the pauses of the streams and the registers' random start.
    pub seed: u32,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { trace: None, seed: 1 }
    }
}

/// Plans, emits, builds, simulates and judges a design.
///
/// # Errors
/// [`RunError`]; words and cycles that are wrong are no error but part of the report.
pub fn run(design: &Design, frames: &FrameSet, options: &Options<'_>, progress: &Progress) -> Result<Report, RunError> {
    progress.stage("planning");
    run_plan(&planned(design)?, frames, options, progress)
}

/// The same of a plan.
///
/// # Errors
/// [`RunError`].
pub fn run_plan(
    plan: &Plan,
    frames: &FrameSet,
    options: &Options<'_>,
    progress: &Progress,
) -> Result<Report, RunError> {
    let sources = rtl_sources(plan)?;
    progress.stage("computing what the hardware must answer");
    let co_simulation = CoSimulation::new(plan, packets(plan.streams(), &frames.stress), options.seed);
    let solved = |design: &Design| {
        Solver::new(design)?
            .solve_in_order(co_simulation.packets.iter().map(|packet| as_received(plan.streams(), packet)))
    };
    let solutions = solved(&plan.design.solved_as_one())?;

    progress.stage("building the simulation with Verilator");
    let verilate = Verilate::default().with_trace(trace_format(options.trace)?);
    let built = verilate.build(&sources).map_err(CoSimulationError::from)?;
    let frame_count = co_simulation.packets.len();
    progress.counted("simulating", frames_to_simulate(frame_count));
    let verdict =
        co_simulation.simulate(&built, options.trace, &|| progress.step()).map_err(CoSimulationError::from)?;
    let registers = if plan.design.hardware.control {
        progress.counted("simulating with register accesses", frame_count as u64);
        Some(registers::check(&co_simulation, &built, || progress.step()).map_err(CoSimulationError::from)?)
    } else {
        None
    };

    // Answers of another length are mismatches already; here they count as missing.
    let answers: Vec<Solution> = verdict.simulation.answers.iter().filter_map(|words| decode(words)).collect();
    let simulator = verilator_version().map_err(CoSimulationError::from)?;
    let mut report = Report::new(plan, &verdict, registers, simulator);
    report.frames_from.clone_from(&frames.origin);
    report.error = SolverError::new(&answers, &solutions);
    if let Some(trace) = options.trace {
        report.traces.push(trace.to_owned());
        if format_of(trace) != Trace::Saif {
            report.traces.extend(waves::write(trace, &sources)?);
        }
    }
    report.status_counts = StatusCounts::new(&answers);
    if let Some(truth) = &frames.truth {
        report.true_force_errors = Some(against_truth(&answers, truth));
        if let Some(design) = paper_method(&plan.design) {
            report.paper_errors = Some(against_truth(&solved(&design)?, truth));
        }
    }
    Ok(report)
}

/// The design with the paper's estimator, which needs tension, if it has another one.
fn paper_method(design: &Design) -> Option<Design> {
    let mut design = design.solved_as_one();
    if !design.algorithm.estimator.is_calibrated() || design.input.tension == Tension::Clipped {
        return None;
    }
    design.algorithm.estimator = Estimator::Line;
    design.algorithm.filter = Filter::None;
    Some(design)
}

fn trace_format(file: Option<&Path>) -> Result<Trace, RunError> {
    let Some(file) = file else {
        return Ok(Trace::Off);
    };
    let format = format_of(file);
    if format == Trace::Fst && Trace::best() != Trace::Fst { Err(RunError::NoFst(file.to_owned())) } else { Ok(format) }
}

/// By the ending of a file's name.
fn format_of(file: &Path) -> Trace {
    let named = |format: &Trace| file.extension().is_some_and(|ending| ending == format.extension());
    [Trace::Vcd, Trace::Saif].into_iter().find(named).unwrap_or(Trace::Fst)
}
