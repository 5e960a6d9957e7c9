//! Co-simulation of a design: its RTL is built, frames go through it, words and cycles are judged. Whoever asks whether
//! hardware is right asks here.

use std::fmt;
use std::path::Path;

use golden::design::Design;
use hdl_gen::emit::{EmitError, emit};
use hdl_gen::model::Model;
use hdl_gen::plan::{Plan, PlanError};
use hdl_gen::timing::Timeline;
use serde::Serialize;
use thiserror::Error;

use crate::compare::Mismatch;
use crate::dut::{Dut, DutError};
use crate::simulate::{Cycles, Job, Simulation, SimulationError, simulate};
use crate::stream::{Outcome, Pacing, Traffic, exchange};
use crate::verilate::{BuildError, Built, RtlSources, Verilate};

/// Why a design cannot be co-simulated.
#[derive(Debug, Error)]
pub enum CoSimulationError {
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
}

impl From<DutError> for CoSimulationError {
    fn from(error: DutError) -> Self {
        Self::Simulation(error.into())
    }
}

/// The plan of a design.
///
/// # Errors
/// [`CoSimulationError::Plan`] if it has none.
pub fn planned(design: &Design) -> Result<Plan, CoSimulationError> {
    Ok(Plan::new(design)?)
}

/// The Verilog and ROM files of a plan.
///
/// # Errors
/// [`CoSimulationError::Emit`] if the emitter fails.
pub fn rtl_sources(plan: &Plan) -> Result<RtlSources, CoSimulationError> {
    Ok(RtlSources::new(&plan.design.name, &emit(plan)?))
}

/// The plan's RTL, compiled.
///
/// # Errors
/// [`CoSimulationError::Emit`] and [`CoSimulationError::Build`].
pub fn build(plan: &Plan) -> Result<Built, CoSimulationError> {
    Ok(Verilate::default().build(&rtl_sources(plan)?)?)
}

/// When packets follow each other so that none is lost: back to back, and to a core that drops frames as it can take
/// them.
pub fn pacing(plan: &Plan) -> Pacing {
    let Timeline { latency_cycles, interval_cycles, .. } = plan.timeline;
    if plan.streams().drops {
        Pacing::Spaced { cycles: interval_cycles, inside: latency_cycles.div_ceil(interval_cycles) as usize + 1 }
    } else {
        Pacing::BackToBack
    }
}

/// Sends packets through a core, both streams free-running; back to back means as [`pacing`] has it.
///
/// # Errors
/// [`CoSimulationError::Simulation`].
pub fn send(core: &mut Dut, plan: &Plan, packets: &[Vec<u32>], pacing: Pacing) -> Result<Outcome, CoSimulationError> {
    let pacing = if pacing == Pacing::BackToBack { self::pacing(plan) } else { pacing };
    let traffic = Traffic::new(packets, timeout(plan)).with_pacing(pacing);
    let sent = exchange(core, &traffic, |_| ());
    Ok(sent.map_err(|source| SimulationError::Stream { mode: "free-running", source })?)
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

impl Cycles {
    /// What the plan says.
    pub fn predicted(plan: &Plan) -> Self {
        Self { latency: plan.timeline.latency_cycles, interval: plan.timeline.interval_cycles }
    }
}

/// Simulated cycles beside the predicted ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Timing {
    /// The same.
    AsPredicted,
    /// Others.
    Wrong,
}

impl Timing {
    /// Judges the cycles of a frame.
    pub fn of(plan: &Plan, simulated: Cycles) -> Self {
        if simulated == Cycles::predicted(plan) { Self::AsPredicted } else { Self::Wrong }
    }
}

/// A plan and frames for it.
#[derive(Clone, Debug)]
pub struct CoSimulation<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// Input packets.
    pub packets: Vec<Vec<u32>>,
    /// The integer model's answers, from reset.
    pub expected: Vec<Vec<u32>>,
    /// Decides the pauses of the streams and the registers' random start.
    pub seed: u32,
}

impl<'a> CoSimulation<'a> {
    /// Of packets in this order.
    pub fn new(plan: &'a Plan, packets: Vec<Vec<u32>>, seed: u32) -> Self {
        Self { plan, expected: model_answers(plan, &packets), packets, seed }
    }

    /// Builds and simulates.
    ///
    /// # Errors
    /// [`CoSimulationError`]; what is wrong with the answers is part of the verdict.
    pub fn run(&self) -> Result<Verdict, CoSimulationError> {
        let built = build(self.plan)?;
        Ok(self.simulate(&built, None, &|| ())?)
    }

    /// Simulates what was built, all stream modes and the timing; the signals of the free-running mode go to `trace`.
    /// `progress` is called once a frame answered, in all [`crate::simulate::frames_to_simulate`] times.
    ///
    /// # Errors
    /// [`SimulationError`]; what is wrong with the answers is part of the verdict.
    pub fn simulate(
        &self,
        built: &Built,
        trace: Option<&Path>,
        progress: &(impl Fn() + Sync),
    ) -> Result<Verdict, SimulationError> {
        let mut timed = self.packets.clone();
        if self.plan.streams().drops {
            // At a given distance one of another length moves the ends of its neighbours.
            timed.retain(|packet| self.plan.streams().is_frame(packet.len()));
        }
        if timed.is_empty() {
            timed.push(vec![0; self.plan.streams().words_in()]);
        }
        let job = Job {
            built,
            packets: &self.packets,
            timed: &timed,
            expected: &self.expected,
            columns: self.plan.design.sensor.columns,
            pacing: pacing(self.plan),
            spacing: self.plan.streams().drops.then_some(self.plan.timeline.interval_cycles),
            timeout: timeout(self.plan),
            seed: self.seed,
            trace,
            half_period: (5e5 / self.plan.design.hardware.clock_mhz).round() as u64,
        };
        let simulation = simulate(&job, progress)?;
        let timing = Timing::of(self.plan, simulation.cycles);
        Ok(Verdict { simulation, timing, predicted: Cycles::predicted(self.plan) })
    }
}

/// What a co-simulation showed.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Answers, differences and cycles.
    pub simulation: Simulation,
    /// The cycles beside the predicted ones.
    pub timing: Timing,
    /// The predicted ones.
    pub predicted: Cycles,
}

impl Verdict {
    /// All that is wrong; nothing if every word is the model's and the cycles are right.
    pub fn faults(&self) -> Vec<Fault> {
        let simulation = &self.simulation;
        let first = simulation.modes.iter().find_map(|mode| Some((mode.mode.name, mode.comparison.first.first()?)));
        let words =
            first.map(|(mode, first)| Fault::Words { count: simulation.mismatches(), mode, first: first.clone() });
        let Self { timing, predicted, .. } = *self;
        let cycles = (timing == Timing::Wrong).then_some(Fault::Cycles { simulated: simulation.cycles, predicted });
        words.into_iter().chain(cycles).collect()
    }

    /// The first of [`Verdict::faults`].
    ///
    /// # Errors
    /// That fault.
    pub fn right(self) -> Result<Simulation, Fault> {
        self.faults().into_iter().next().map_or(Ok(self.simulation), Err)
    }
}

/// How RTL is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Words are not the model's.
    Words {
        /// How many, over all stream modes.
        count: u64,
        /// The first mode that has one.
        mode: &'static str,
        /// Its first one.
        first: Mismatch,
    },
    /// The cycles are not the predicted ones.
    Cycles {
        /// What was found.
        simulated: Cycles,
        /// What the plan says.
        predicted: Cycles,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Words { count, mode, first } => {
                write!(out, "{count} words differ from the model, the first, {mode}: {first}")
            }
            Self::Cycles { simulated, predicted } => {
                write!(out, "latency and interval are {simulated} cycles, predicted {predicted}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Timing::{AsPredicted, Wrong};
    use super::*;

    #[test]
    fn cycles_are_exact() {
        let text = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
            name = \"tiny\"\n[sensor]\ncolumns = 2\nrows = 2\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
             [algorithm]\nplan = \"reduced\"\n[hardware]\nlanes = 4\n";
        let plan = planned(&Design::from_toml(text, "tiny").expect("a design")).expect("a plan");
        let Cycles { latency, interval } = Cycles::predicted(&plan);
        let timings = [(0, 0), (-1, 0), (0, -1), (1, 0), (0, 1)].map(|(one, other): (i64, i64)| {
            let (latency, interval) = (latency.strict_add_signed(one), interval.strict_add_signed(other));
            Timing::of(&plan, Cycles { latency, interval })
        });
        assert_eq!(timings, [AsPredicted, Wrong, Wrong, Wrong, Wrong]);
    }
}
