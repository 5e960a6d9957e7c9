//! `testbench run`: a design and frames in, a [`Report`] out.

use std::path::{Path, PathBuf};

use golden::design::Design;
use golden::frames::FrameError;
use golden::output::OutputError;
use golden::scene::SceneError;
use golden::solver::{Solver, SolverError as SolveError};
use hdl_gen::emit::{EmitError, emit};
use hdl_gen::model::Model;
use hdl_gen::plan::{Plan, PlanError};
use thiserror::Error;

use crate::accuracy::{SolverError, StatusCounts, against_truth};
use crate::frame_set::FrameSet;
use crate::progress::Progress;
use crate::registers;
use crate::report::{Microseconds, ModeReport, Predicted, Report, describe, published_for};
use crate::simulate::{Job, Simulation, SimulationError, frames_to_simulate, simulate};
use crate::verilate::{BuildError, RtlSources, Trace, Verilate, verilator_version};
use crate::waves;
use crate::words::{Answer, decode, encode};

/// Why a run has no report.
#[derive(Debug, Error)]
pub enum RunError {
    /// The design cannot be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The plan cannot be printed.
    #[error(transparent)]
    Emit(#[from] EmitError),
    /// The RTL cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The simulation failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The f64 solver refused the design or a frame.
    #[error(transparent)]
    Solver(#[from] SolveError),
    /// The frames cannot be read.
    #[error(transparent)]
    Frames(#[from] FrameError),
    /// The standing scene cannot be computed.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A view of the trace cannot be written.
    #[error(transparent)]
    View(#[from] OutputError),
    /// A trace was asked for in a format that cannot be written here.
    #[error(
        "{}: the headers of zlib and LZ4 are missing, which FST needs; run `make tools` or name a .vcd file",
        .0.display()
    )]
    NoFst(PathBuf),
}

/// What to do besides comparing.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// File for the signals of the free-running mode: VCD if its name ends so, FST otherwise.
    pub trace: Option<&'a Path>,
    /// Decides the pauses of the streams and the registers' random start.
    pub seed: u32,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { trace: None, seed: 1 }
    }
}

/// The Verilog and ROM files of a plan.
///
/// # Errors
/// [`EmitError`] if the emitter fails.
pub fn rtl_sources(plan: &Plan) -> Result<RtlSources, EmitError> {
    Ok(RtlSources::new(&plan.design.name, &emit(plan)?))
}

/// What the integer model answers to packets sent one after the other from reset.
pub fn model_answers(plan: &Plan, packets: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let mut model = Model::new(plan);
    packets.iter().map(|packet| model.process(packet)).collect()
}

/// Cycles without a handshake after which a design of this plan is stuck.
pub fn timeout(plan: &Plan) -> u64 {
    10_000 + 4 * plan.timeline.latency_cycles
}

/// Plans, emits, builds, simulates and judges a design.
///
/// # Errors
/// [`RunError`]; a word that differs from the model is no error but part of the report.
pub fn run(design: &Design, frames: &FrameSet, options: &Options<'_>, progress: &Progress) -> Result<Report, RunError> {
    progress.stage("planning");
    let plan = Plan::new(design)?;
    let sources = rtl_sources(&plan)?;
    let packets: Vec<Vec<u32>> = frames.stress.iter().map(|stress| encode(stress)).collect();
    progress.stage("computing what the hardware must answer");
    let expected = model_answers(&plan, &packets);
    let solver = Solver::new(design)?;
    let solutions = packets.iter().map(|packet| solver.solve(&as_received(packet))).collect::<Result<Vec<_>, _>>()?;

    progress.stage("building the simulation with Verilator");
    let built = Verilate::default().with_trace(trace_format(options.trace)?).build(&sources)?;
    progress.counted("simulating", frames_to_simulate(packets.len()));
    let job = Job {
        built: &built,
        packets: &packets,
        expected: &expected,
        columns: design.sensor.columns,
        timeout: timeout(&plan),
        seed: options.seed,
        trace: options.trace,
    };
    let simulation = simulate(&job, &|| progress.step())?;
    let registers = if design.hardware.control {
        progress.counted("simulating with register accesses", packets.len() as u64);
        let seed = options.seed;
        Some(registers::check(&plan, &built, &packets, &expected, job.timeout, seed, || progress.step())?)
    } else {
        None
    };

    // Answers of another length are mismatches already; here they count as missing.
    let answers: Vec<Answer> = simulation.answers.iter().filter_map(|words| decode(words)).collect();
    let error = SolverError::new(&answers, &solutions);
    let simulator = verilator_version()?;
    let mut report = summarise(&plan, &simulation, simulator);
    report.frames_from.clone_from(&frames.origin);
    report.frames = packets.len();
    report.error = error;
    report.registers = registers;
    if let Some(trace) = options.trace {
        report.traces = [trace.to_owned()].into_iter().chain(waves::write(trace, &sources)?).collect();
    }
    report.status_counts = StatusCounts::new(&answers);
    report.true_force_errors = frames.truth.as_ref().map(|truth| against_truth(&answers, truth));
    Ok(report)
}

/// The stresses as the core gets them. The solver is given the same ones, so that its difference to the core is the
/// core's alone.
pub fn as_received(packet: &[u32]) -> Vec<f64> {
    packet.iter().map(|&word| f64::from(f32::from_bits(word))).collect()
}

fn trace_format(file: Option<&Path>) -> Result<Trace, RunError> {
    let Some(file) = file else {
        return Ok(Trace::Off);
    };
    if file.extension().is_some_and(|ending| ending == "vcd") {
        return Ok(Trace::Vcd);
    }
    if Trace::best() == Trace::Fst { Ok(Trace::Fst) } else { Err(RunError::NoFst(file.to_owned())) }
}

fn summarise(plan: &Plan, simulation: &Simulation, simulator: String) -> Report {
    let microseconds = |cycles: u64| cycles as f64 / plan.design.hardware.clock_mhz;
    let modes = simulation
        .modes
        .iter()
        .map(|result| ModeReport {
            mode: result.mode.name,
            bit_exact: result.comparison.is_exact(),
            words: result.comparison.words,
            mismatches: result.comparison.mismatches,
            cycles: result.cycles,
            first_mismatches: result.comparison.first.clone(),
        })
        .collect();
    Report {
        design: plan.design.name.clone(),
        description: describe(plan),
        frames_from: String::new(),
        frames: simulation.answers.len(),
        bit_exact: simulation.is_exact(),
        mismatches: simulation.mismatches(),
        latency_cycles: simulation.latency_cycles,
        interval_cycles: simulation.interval_cycles,
        predicted: Predicted {
            latency_cycles: plan.timeline.latency_cycles,
            interval_cycles: plan.timeline.interval_cycles,
            dsp: plan.resources.dsp,
            bram36: plan.resources.bram36,
            worst_case: plan.design.hardware.skip_zeros,
        },
        microseconds: Microseconds {
            latency: microseconds(simulation.latency_cycles),
            interval: microseconds(simulation.interval_cycles),
        },
        error: SolverError::default(),
        true_force_errors: None,
        status_counts: StatusCounts::default(),
        modes,
        registers: None,
        traces: Vec::new(),
        dsp: plan.resources.dsp,
        bram36: plan.resources.bram36,
        rom_bits: plan.resources.rom_bits,
        macs: plan.macs(),
        nnz: plan.nnz.0.iter().map(|&(name, count)| (name.to_string(), count)).collect(),
        lanes: plan.design.hardware.lanes,
        lanes_busy: plan.schedule.busy_fraction(),
        clock_mhz: plan.design.hardware.clock_mhz,
        published: published_for(plan),
        simulator,
    }
}
