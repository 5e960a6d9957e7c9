//! `cargo xtask stress`: very many frames, good and bad, through streams that pause at random and resets at any moment.
//!
//! The frames go through in batches, each on a core of its own, with pauses and resets drawn from the seed and the
//! batch's number: the same options give the same cycles on every machine, however many threads there are.
//!
//! Beside a core with its calibration in RAM a processor writes banks, commits and tares meanwhile, right ones and wrong
//! ones.

mod banks;
mod job;
mod judge;
mod log;
mod packets;
mod processor;
#[path = "../../../testbench/tests/suite/support/banks.rs"]
mod random_banks;

use std::fmt;

use golden::design::Design;
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

pub use log::Commits;
use packets::Packets;
pub use packets::{Counts, Kind};
use processor::Processor;

use golden::progress::Progress;
use judge::judge;
use testbench::co_simulation::{self, CoSimulationError, planned, timeout};
use testbench::dut::Dut;
use testbench::stream::{Pacing, Pattern, Reset, StreamError, Traffic, exchange};

/// Frames of a batch.
pub const BATCH: u64 = 1000;
/// Batches between two looks at what went wrong.
const AT_A_TIME: usize = 32;
/// Frames between two resets, on average.
const FRAMES_PER_RESET: u64 = 100;

/// How much, and of what.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Frames to send.
    pub frames: u64,
    /// Decides everything that is random.
    pub seed: u64,
}

/// What was sent and what became of it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Report {
    /// The design's name.
    pub design: String,
    /// See [`Options`].
    pub seed: u64,
    /// Packets offered, whole or until a reset.
    pub sent: Counts,
    /// Packets answered: each with every word of the integer model, in the order in which they were sent.
    pub answered: Counts,
    /// Packets that found no room, in a core that drops them: none that did while fewer than two had no answer yet.
    pub dropped: Counts,
    /// Packets inside, or on their way in, when a reset came.
    pub lost_to_resets: Counts,
    /// Resets in the middle of the traffic.
    pub resets: u64,
    /// Cycles simulated.
    pub cycles: u64,
    /// What was asked of a calibration in RAM meanwhile: every answer is that of the one bank whose version it states.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Commits>,
}

impl Report {
    fn add(&mut self, other: &Self) {
        self.sent = self.sent.plus(other.sent);
        self.answered = self.answered.plus(other.answered);
        self.dropped = self.dropped.plus(other.dropped);
        self.lost_to_resets = self.lost_to_resets.plus(other.lost_to_resets);
        self.resets += other.resets;
        self.cycles += other.cycles;
        if let Some(commits) = other.calibration {
            self.calibration = Some(self.calibration.unwrap_or_default().plus(commits));
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            out,
            "{}: {} frames, {} resets, {} cycles, seed {}; every answer is the model's, none doubled or out of order",
            self.design,
            self.sent.total(),
            self.resets,
            self.cycles,
            self.seed
        )?;
        writeln!(out, "{:>16} {:>10} {:>10} {:>10} {:>10}", "", "good", "short", "long", "NaN")?;
        let rows = [
            ("sent", self.sent),
            ("answered", self.answered),
            ("dropped", self.dropped),
            ("lost to resets", self.lost_to_resets),
        ];
        // Only a core that may drop frames has that row.
        for (name, counts) in rows.into_iter().filter(|(name, counts)| *name != "dropped" || counts.total() > 0) {
            let Counts { good, short, long, not_finite } = counts;
            writeln!(out, "{name:>16} {good:>10} {short:>10} {long:>10} {not_finite:>10}")?;
        }
        let Some(Commits { banks, banks_refused, tares, tares_refused, lost_to_resets }) = self.calibration else {
            return Ok(());
        };
        writeln!(
            out,
            "meanwhile {banks} banks acted, {banks_refused} wrong ones were refused, {tares} tares acted, {tares_refused} \
             without rest\nwere refused, {lost_to_resets} were lost to resets; every answer is that of one whole bank"
        )
    }
}

/// Why there is no report.
#[derive(Debug, Error)]
pub enum StressError {
    /// There is nothing to send.
    #[error("--frames is 0: give the number of frames to send")]
    NoFrames,
    /// The design cannot be planned, built or loaded.
    #[error(transparent)]
    CoSimulation(#[from] CoSimulationError),
    /// The streams failed.
    #[error("batch {batch}: {source}")]
    Stream {
        /// Which batch.
        batch: u64,
        /// How.
        source: StreamError,
    },
    /// An answer is not what it should be, or what became of a bank.
    #[error("batch {batch}: {what}")]
    Wrong {
        /// Which batch.
        batch: u64,
        /// Which packet or bank, and how it is wrong.
        what: String,
    },
}

/// Plans, builds and stresses a design.
///
/// # Errors
/// [`StressError`]: the design cannot be simulated, or the first batch that is wrong, by its number.
pub fn stress(design: &Design, options: &Options, progress: &Progress) -> Result<Report, StressError> {
    if options.frames == 0 {
        return Err(StressError::NoFrames);
    }
    progress.stage("planning");
    let plan = planned(design)?;
    progress.stage("building the simulation with Verilator");
    let built = co_simulation::build(&plan)?;
    progress.counted("simulating", options.frames);
    let batches = options.frames.div_ceil(BATCH);
    let one = |batch: u64| {
        let frames = BATCH.min(options.frames - batch * BATCH);
        let core =
            built.load((options.seed ^ batch) as u32).map_err(|error| StressError::CoSimulation(error.into()))?;
        run_batch(&plan, core, batch, frames, options.seed, &|| progress.step())
    };
    let mut report = Report { design: plan.design.name.clone(), seed: options.seed, ..Report::default() };
    // Some at a time, so that a wrong one ends it soon.
    for first in (0..batches).step_by(AT_A_TIME) {
        let some = first..batches.min(first + AT_A_TIME as u64);
        let results: Vec<Result<Report, StressError>> = some.into_par_iter().map(one).collect();
        results.into_iter().try_for_each(|result| result.map(|batch| report.add(&batch)))?;
    }
    Ok(report)
}

/// Sends the frames of a batch through a core and judges what comes out. `progress` is called once an answer.
///
/// # Errors
/// [`StressError::Stream`] or [`StressError::Wrong`].
pub fn run_batch(
    plan: &Plan,
    core: Dut,
    batch: u64,
    frames: u64,
    seed: u64,
    progress: &impl Fn(),
) -> Result<Report, StressError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(batch);
    let mixed = Packets::new(plan, &mut random);
    let mut packets: Vec<(Kind, Vec<u32>)> = (0..frames).map(|_| mixed.next(&mut random)).collect();
    if plan.calibration.is_some() {
        packets::with_rests(plan, &mut packets, &mut random);
    }
    let (kinds, packets): (Vec<Kind>, Vec<Vec<u32>>) = packets.into_iter().unzip();
    let resets = resets(plan, frames, &mut random);
    let pacing = if plan.streams().drops { scanner(plan, &mut random) } else { Pacing::BackToBack };
    let traffic = Traffic {
        source: if batch % 3 == 1 { paced(plan, &mut random) } else { pattern(&mut random) },
        sink: pattern(&mut random),
        drops: plan.streams().drops,
        pacing,
        ..Traffic::new(&packets, 20 * timeout(plan))
    };
    let traffic = traffic.with_resets(&resets);
    let stream = |source| StressError::Stream { batch, source };
    let wrong = |what| StressError::Wrong { batch, what };
    let Some(of) = &plan.calibration else {
        let outcome = exchange(&mut { core }, &traffic, |_| progress()).map_err(stream)?;
        return judge(plan, &kinds, &packets, &outcome, None).map_err(wrong);
    };
    let mut processor = Processor::new(plan, of, core, random).map_err(|error| stream(error.into()))?;
    let outcome = exchange(&mut processor, &traffic, |_| progress());
    // What it saw first is nearer to the fault than what the streams or the answers make of it.
    if let Some(what) = processor.wrong() {
        return Err(wrong(what.to_owned()));
    }
    let outcome = outcome.map_err(stream)?;
    let log = processor.finish().map_err(wrong)?;
    judge(plan, &kinds, &packets, &outcome, Some(&log)).map_err(wrong)
}

/// Moments anywhere in the batch, some of them close to each other. Not in its last tenth: resets lose frames, and the
/// batch ends the sooner.
fn resets(plan: &Plan, frames: u64, random: &mut ChaCha8Rng) -> Vec<Reset> {
    let end = frames * plan.timeline.interval_cycles * 9 / 10;
    let mut cycles: Vec<u64> = (0..frames / FRAMES_PER_RESET).map(|_| random.random_range(0..end)).collect();
    cycles.sort_unstable();
    cycles.into_iter().map(|cycle| Reset { cycle, length: random.random_range(1..=4) }).collect()
}

/// A scanner that is a little slower than the core, or up to as fast as beats can follow each other.
fn scanner(plan: &Plan, random: &mut ChaCha8Rng) -> Pacing {
    Pacing::Spaced { cycles: random.random_range(0..=plan.timeline.interval_cycles * 5 / 4), inside: usize::MAX }
}

/// A source that pauses about once a frame, for up to as long as the core has a frame: so frames meet each other
/// everywhere inside.
fn paced(plan: &Plan, random: &mut ChaCha8Rng) -> Pattern {
    let longest_run = 2 * plan.taxels() as u32;
    Pattern::Bursts { seed: random.random(), longest_run, longest_pause: plan.timeline.interval_cycles as u32 }
}

fn pattern(random: &mut ChaCha8Rng) -> Pattern {
    let seed = random.random();
    match random.random_range(0..4) {
        0 => Pattern::Free,
        1 => Pattern::Random { seed, willing: random.random_range(0.08..1.0) },
        2 => {
            Pattern::Bursts { seed, longest_run: random.random_range(1..12), longest_pause: random.random_range(1..12) }
        }
        _ => Pattern::Bursts { seed, longest_run: random.random_range(50..2000), longest_pause: 2000 },
    }
}
