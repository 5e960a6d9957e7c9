//! Co-simulation of a design: its RTL is built, frames go through it, words and cycles are judged. Whoever asks whether
//! hardware is right asks here.

use std::path::Path;

use golden::design::Design;
use hdl_gen::emit::{EmitError, emit};
use hdl_gen::model::Model;
use hdl_gen::plan::{Plan, PlanError};
use hdl_gen::timing::Timeline;
use thiserror::Error;

use crate::dut::DutError;
use crate::simulate::{Cycles, Job, Simulation, SimulationError, simulate};
use crate::stream::Pacing;
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
        Ok(Verdict { simulation, predicted: Cycles::predicted(self.plan) })
    }
}

/// What a co-simulation showed.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Answers, differences and cycles.
    pub simulation: Simulation,
    /// The predicted cycles.
    pub predicted: Cycles,
}

impl Verdict {
    /// Whether the cycles are the predicted ones.
    pub fn is_timely(&self) -> bool {
        self.simulation.cycles == self.predicted
    }

    /// All that is wrong, in words; nothing if every word is the model's and the cycles are right.
    pub fn faults(&self) -> Vec<String> {
        let Self { simulation, predicted } = self;
        let first = simulation.modes.iter().find_map(|mode| Some((mode.mode, mode.first_mismatches.first()?)));
        let words = first.map(|(mode, first)| {
            format!("{} words differ from the model, the first, {mode}: {first}", simulation.mismatches())
        });
        let cycles = (!self.is_timely())
            .then(|| format!("latency and interval are {} cycles, predicted {predicted}", simulation.cycles));
        words.into_iter().chain(cycles).collect()
    }

    /// The first of [`Verdict::faults`].
    ///
    /// # Errors
    /// That fault.
    pub fn right(self) -> Result<Simulation, String> {
        self.faults().into_iter().next().map_or(Ok(self.simulation), Err)
    }
}
