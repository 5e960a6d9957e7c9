//! One design's frames through the simulated core: all stream modes, then the timing.

use std::fmt;
use std::path::Path;
use std::thread;

use hdl_gen::timing::INTERVAL_FRAMES;
use serde::Serialize;

use crate::compare::{Comparison, Mismatch};
use crate::dut::{Dut, DutError};
use crate::stream::{Mode, Outcome, Pacing, StreamError, Traffic, exchange};
use crate::verilate::Built;

/// Frames sent one at a time for the latency.
const LATENCY_FRAMES: usize = 3;

/// What to send and what must come back.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The design.
    pub built: &'a Built,
    /// Input packets.
    pub packets: &'a [Vec<u32>],
    /// Those whose cycles are predicted.
    pub timed: &'a [Vec<u32>],
    /// The answers of the integer model, one for each packet, its frame counter starting at 0.
    pub expected: &'a [Vec<u32>],
    /// Columns of the sensor, to name words.
    pub columns: usize,
    /// When packets follow each other, where they are not sent one at a time.
    pub pacing: Pacing,
    /// Of a core that drops frames, the distance of their beginnings at which it must lose none.
    pub spacing: Option<u64>,
    /// See [`Traffic::timeout`].
    pub timeout: u64,
    /// Decides the pauses and the registers' random start.
    pub seed: u32,
    /// Where to write the signals of the free-running mode.
    pub trace: Option<&'a Path>,
    /// Half a period of the clock in a trace, ps.
    pub half_period: u64,
}

/// One stream mode against the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeResult {
    /// Which ends pause.
    pub mode: &'static str,
    /// Whether every word is the model's.
    pub bit_exact: bool,
    /// Words compared.
    pub words: u64,
    /// Words that differ.
    pub mismatches: u64,
    /// Cycles simulated.
    pub cycles: u64,
    /// The first words that differ.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub first_mismatches: Vec<Mismatch>,
}

/// Latency and interval in clock cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Cycles {
    /// First beat in to last beat out of a frame alone, both counted.
    pub latency: u64,
    /// Distance of the frames' last beats, back to back. Of a core that drops frames: least distance of their beginnings at
    /// which it loses none.
    pub interval: u64,
}

impl fmt::Display for Cycles {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} / {}", self.latency, self.interval)
    }
}

/// What the simulation showed.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The modes in the order of [`Mode::all`].
    pub modes: Vec<ModeResult>,
    /// The core's answers in the free-running mode.
    pub answers: Vec<Vec<u32>>,
    /// Of a frame.
    pub cycles: Cycles,
}

impl Simulation {
    /// True if no word of any mode differs from the model.
    pub fn is_exact(&self) -> bool {
        self.modes.iter().all(|result| result.bit_exact)
    }

    /// Words that differ, over all modes.
    pub fn mismatches(&self) -> u64 {
        self.modes.iter().map(|result| result.mismatches).sum()
    }
}

/// Why a simulation gave no result.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// There is nothing to send.
    #[error("no frames to simulate")]
    NoFrames,
    /// The core cannot be loaded or traced.
    #[error(transparent)]
    Dut(#[from] DutError),
    /// The streams failed.
    #[error("{mode}: {source}")]
    Stream {
        /// In which mode.
        mode: &'static str,
        /// How.
        source: StreamError,
    },
}

/// Runs all modes and the timing, each on a core and a thread of its own. `progress` is called once a frame answered,
/// in all [`frames_to_simulate`] times.
///
/// # Errors
/// The first [`SimulationError`] in the order of the modes.
pub fn simulate(job: &Job<'_>, progress: &(impl Fn() + Sync)) -> Result<Simulation, SimulationError> {
    if job.packets.is_empty() {
        return Err(SimulationError::NoFrames);
    }
    thread::scope(|scope| {
        let running = Mode::all(u64::from(job.seed)).map(|mode| scope.spawn(move || run_mode(job, mode, progress)));
        let timing = scope.spawn(|| measure(job, progress));
        let mut modes = Vec::new();
        let mut answers = Vec::new();
        for thread in running {
            let (result, words) = join(thread)?;
            if modes.is_empty() {
                answers = words;
            }
            modes.push(result);
        }
        let cycles = join(timing)?;
        Ok(Simulation { modes, answers, cycles })
    })
}

/// How many frames [`simulate`] sends for a set of `frames`.
pub fn frames_to_simulate(frames: usize) -> u64 {
    (Mode::COUNT * frames + LATENCY_FRAMES + INTERVAL_FRAMES) as u64
}

fn join<T>(thread: thread::ScopedJoinHandle<'_, T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

fn run_mode(job: &Job<'_>, mode: Mode, progress: &impl Fn()) -> Result<(ModeResult, Vec<Vec<u32>>), SimulationError> {
    let mut core = job.built.load(job.seed)?;
    if let (Some(path), true) = (job.trace, mode.is_free()) {
        core.trace(path, job.half_period)?;
    }
    let traffic = Traffic::new(job.packets, job.timeout).with_mode(&mode).with_pacing(job.pacing);
    let outcome = exchange(&mut core, &traffic, |_| progress())
        .map_err(|source| SimulationError::Stream { mode: mode.name, source })?;
    let answers: Vec<Vec<u32>> = outcome.exchanges.into_iter().map(|exchange| exchange.words).collect();
    let comparison = Comparison::new(job.expected, answers.iter().map(Vec::as_slice), job.columns);
    let bit_exact = comparison.is_exact();
    let Comparison { words, mismatches, first: first_mismatches } = comparison;
    let (mode, cycles) = (mode.name, outcome.cycles);
    Ok((ModeResult { mode, bit_exact, words, mismatches, cycles, first_mismatches }, answers))
}

/// The smallest distance of beginnings at which a core that drops frames loses none, if none is lost at the predicted one:
/// that at which frames leave it when they pile up, or when they begin a cycle sooner than predicted, whichever is less.
fn spacing_without_loss(job: &Job<'_>, spacing: u64, progress: &impl Fn()) -> Result<u64, StreamError> {
    /// Beginnings for each frame that finds room, where they pile up.
    const OFFERED: u64 = 4;
    /// More intervals than a frame can spend in the core and its ingress FIFO.
    const HELD: u64 = 8;
    let run = |count: usize, cycles: u64, progress: &dyn Fn()| {
        let mut core: Dut = job.built.load(job.seed)?;
        let packets: Vec<Vec<u32>> = job.timed.iter().cycle().take(count).cloned().collect();
        let pacing = Pacing::Spaced { cycles, inside: usize::MAX };
        exchange(&mut core, &Traffic::new(&packets, job.timeout).with_pacing(pacing).with_drops(), |_| progress())
    };
    let interval = |outcome: &Outcome| outcome.interval().unwrap_or_default();
    let at_spacing = run(INTERVAL_FRAMES, spacing, &|| progress())?;
    if !at_spacing.dropped.is_empty() {
        return Ok(interval(&at_spacing).max(spacing + 1));
    }
    let piled_up = run(OFFERED as usize * INTERVAL_FRAMES, spacing / OFFERED, &|| ())?;
    let mut frames = INTERVAL_FRAMES;
    let sooner = loop {
        let outcome = run(frames, spacing - 1, &|| ())?;
        // Each frame waits a cycle longer than the last one: that shows when all that can wait does.
        if !outcome.dropped.is_empty() || interval(&outcome) >= spacing || frames as u64 > HELD * spacing {
            break interval(&outcome);
        }
        frames *= 4;
    };
    Ok(interval(&piled_up).min(sooner))
}

/// Latency and interval, on frames repeated as often as needed.
fn measure(job: &Job<'_>, progress: &impl Fn()) -> Result<Cycles, SimulationError> {
    let failed = |source| SimulationError::Stream { mode: "timing", source };
    let mut core: Dut = job.built.load(job.seed)?;
    let mut run = |count, pacing| {
        let packets: Vec<Vec<u32>> = job.timed.iter().cycle().take(count).cloned().collect();
        let traffic = Traffic::new(&packets, job.timeout).with_pacing(pacing);
        exchange(&mut core, &traffic, |_| progress()).map_err(failed)
    };
    // Both are there: more than one frame was answered, or `run` had failed.
    let latency = run(LATENCY_FRAMES, Pacing::OneAtATime)?.latency().unwrap_or_default();
    let interval = if let Some(spacing) = job.spacing {
        spacing_without_loss(job, spacing, progress).map_err(failed)?
    } else {
        run(INTERVAL_FRAMES, job.pacing)?.interval().unwrap_or_default()
    };
    Ok(Cycles { latency, interval })
}
