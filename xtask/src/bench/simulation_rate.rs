//! Speed of the simulation itself: Verilator's code and the streams' driver, free-running.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::{BenchError, Scope, median};
use golden::progress::Progress;
use testbench::co_simulation::{self, CoSimulationError, pacing, planned, timeout};
use testbench::frame_set::FrameSet;
use testbench::simulate::SimulationError;
use testbench::stream::{Traffic, exchange};
use testbench::stream_words::packets;

/// Repetitions behind a median.
pub const REPETITIONS: usize = 5;
/// A repetition takes about this time.
const ENOUGH: Duration = Duration::from_millis(500);
/// Frames of the first run, which decides how many frames a repetition has.
const FIRST_FRAMES: usize = 4;
const MOST_FRAMES: usize = 10_000;
const SEED: u32 = 1;

/// One design's simulation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// The design file.
    pub design: String,
    /// The design's hash.
    pub hash: String,
    /// Its lanes.
    pub lanes: usize,
    /// Frames in a repetition.
    pub frames: usize,
    /// Simulated clock cycles a second, median.
    pub cycles_per_second: f64,
    /// The slowest and the fastest repetition.
    pub range: [f64; 2],
    /// Simulated frames a second.
    pub frames_per_second: f64,
}

/// Measures the scope's designs on one core.
pub(super) fn measure(scope: &Scope, progress: &Progress) -> Result<Vec<Rate>, BenchError> {
    let mut rows = Vec::new();
    for (path, design) in &scope.designs {
        progress.stage(format!("building the simulation of {path}"));
        let plan = planned(design)?;
        let set = FrameSet::standing(&design.sensor)?.as_delivered(design);
        let packets = packets(plan.streams(), &set.stress);
        let built = co_simulation::build(&plan)?;
        let mut core = built.load(SEED).map_err(CoSimulationError::from)?;
        progress.stage(format!("simulating {path}"));
        let mut run = |count: usize| -> Result<(u64, f64), BenchError> {
            let packets: Vec<Vec<u32>> = packets.iter().cycle().take(count).cloned().collect();
            let start = Instant::now();
            let traffic = Traffic::new(&packets, timeout(&plan)).with_pacing(pacing(&plan));
            let outcome = exchange(&mut core, &traffic, |_| ())
                .map_err(|source| CoSimulationError::from(SimulationError::Stream { mode: "free-running", source }))?;
            Ok((outcome.cycles, start.elapsed().as_secs_f64()))
        };
        let (_, seconds) = run(FIRST_FRAMES)?;
        let wanted = FIRST_FRAMES as f64 * ENOUGH.as_secs_f64() / seconds.max(1e-6);
        let frames = (wanted as usize).clamp(FIRST_FRAMES, MOST_FRAMES);
        let mut rates = Vec::new();
        let mut cycles = 0;
        for _ in 0..REPETITIONS {
            let (simulated, seconds) = run(frames)?;
            cycles = simulated;
            rates.push(simulated as f64 / seconds);
        }
        let range = [rates.iter().copied().fold(f64::INFINITY, f64::min), rates.iter().copied().fold(0.0, f64::max)];
        let cycles_per_second = median(rates);
        rows.push(Rate {
            design: path.clone(),
            hash: design.hash(),
            lanes: design.hardware.lanes,
            frames,
            cycles_per_second,
            range,
            frames_per_second: cycles_per_second * frames as f64 / cycles as f64,
        });
    }
    Ok(rows)
}
