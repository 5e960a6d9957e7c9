//! From a design to its plan: on its own lanes, or on the fewest that meet a target latency, or what else would.

use golden::design::{Design, Estimator, MAX_LANES, Optimise, Outputs, PlanKind, STREAM_BITS};
use golden::parity::COMPONENTS;

use super::check_widths;
use crate::estimators;
use crate::plan::{Plan, PlanError};

impl Plan {
    /// Plans the hardware of `design`.
    ///
    /// # Errors
    /// [`PlanError`] if the plan has no hardware for the estimator, the geometry is singular, the filter empties a matrix, or
    /// the widths are too small.
    pub fn new(design: &Design) -> Result<Self, PlanError> {
        checked(design)
    }

    /// As [`Plan::new`], on the fewest lanes whose latency is `target_us` microseconds at most, in place of the design's. The
    /// plan's design states them.
    ///
    /// # Errors
    /// As [`Plan::new`], or if no number of lanes meets the target, or the plan is the paper's.
    pub fn meeting(design: &Design, target_us: f64) -> Result<Self, PlanError> {
        if design.algorithm.plan == PlanKind::Paper {
            return Err(PlanError::Key(format!(
                "a target of {target_us} us: lanes are found for the reduced plan only; write plan = \"reduced\" under \
                 [algorithm], or state [hardware] lanes and leave the target out"
            )));
        }
        meet(&checked(design)?, design, target_us)
    }
}

/// The plan of a design, if its estimator and widths have hardware.
fn checked(design: &Design) -> Result<Plan, PlanError> {
    if !estimators::has_hardware(design) {
        let problem = "[algorithm] plan = \"paper\": the paper's plan has the line search only; write plan = \"reduced\", or \
                       estimator = \"line\" and remove gain, friction_correction and correction";
        return Err(PlanError::Key(problem.to_owned()));
    }
    check_widths(design)?;
    Plan::of(design)
}

fn meet(plan: &Plan, design: &Design, target_us: f64) -> Result<Plan, PlanError> {
    let mut fastest: Option<Plan> = None;
    for lanes in lanes() {
        let plan = plan.on_lanes(lanes);
        if is_met(&plan, target_us) {
            return Ok(plan);
        }
        if fastest.as_ref().is_none_or(|fastest| plan.timeline.latency_cycles < fastest.timeline.latency_cycles) {
            fastest = Some(plan);
        }
    }
    let (lanes, cycles) = fastest
        .map_or((MAX_LANES, f64::INFINITY), |plan| (plan.design.hardware.lanes, plan.timeline.latency_cycles as f64));
    let clock_mhz = design.hardware.clock_mhz;
    Err(PlanError::Target {
        target_us,
        lanes,
        latency_us: cycles / clock_mhz,
        clock_mhz,
        needed_mhz: (cycles / target_us).ceil(),
        remedies: remedies(design, target_us),
    })
}

/// A multiplier for each component on every lane.
fn lanes() -> impl DoubleEndedIterator<Item = usize> {
    (1..=MAX_LANES / COMPONENTS).map(|each| COMPONENTS * each)
}

fn is_met(plan: &Plan, target_us: f64) -> bool {
    plan.timeline.latency_cycles as f64 <= target_us * plan.design.hardware.clock_mhz
}

/// What would meet the target, as keys of the design file, each behind a comma: the smallest change, and if that is one of
/// the streams, the smallest that leaves them as they are. Each was planned, on so many lanes, the most first.
fn remedies(design: &Design, target_us: f64) -> String {
    let meets = |change: &Change| {
        let plan = Plan::of(&change.apply(design));
        plan.is_ok_and(|plan| lanes().rev().any(|lanes| is_met(&plan.on_lanes(lanes), target_us)))
    };
    let mut changes = changes(design).into_iter();
    let first = changes.find(meets);
    let same_streams = first
        .filter(|first| first.stream_bits.is_some())
        .and_then(|_| changes.find(|change| change.stream_bits.is_none() && meets(change)));
    let named = |change: Change| change.keys() + ", ";
    [first, same_streams].into_iter().flatten().map(named).collect()
}

/// Keys that a design would have otherwise.
#[derive(Clone, Copy)]
struct Change {
    outputs: Option<Outputs>,
    /// An estimator that needs fewer cycles, and the key that names it.
    quicker: Option<(Estimator, &'static str)>,
    stream_bits: Option<u32>,
}

/// What can be changed of a design, the smallest change first: wider streams cost pins, the line exactness, resultants alone the forces of the taxels.
fn changes(design: &Design) -> Vec<Change> {
    let algorithm = &design.algorithm;
    // An area that is kept small belongs to the estimator.
    let quicker = estimators::quicker(algorithm.estimator).filter(|_| design.hardware.optimise != Optimise::Area);
    let outputs = (algorithm.outputs == Outputs::Field).then_some(Outputs::Resultants);
    let outputs = [Some(None), outputs.map(Some)].into_iter().flatten();
    let choices = [Some(None), quicker.map(Some)];
    let wider = STREAM_BITS.into_iter().filter(|&bits| bits > design.hardware.stream_bits).map(Some);
    let streams: Vec<Option<u32>> = [None].into_iter().chain(wider).collect();
    let mut all = Vec::new();
    for outputs in outputs {
        for quicker in choices.into_iter().flatten() {
            all.extend(streams.iter().map(|&stream_bits| Change { outputs, quicker, stream_bits }));
        }
    }
    // The first is the design as it is.
    all.split_off(1)
}

impl Change {
    /// The design with it.
    fn apply(&self, design: &Design) -> Design {
        let mut changed = design.clone();
        if let Some(outputs) = self.outputs {
            changed.algorithm.outputs = outputs;
        }
        if let Some((estimator, _)) = self.quicker {
            changed.algorithm.estimator = estimator;
        }
        if let Some(bits) = self.stream_bits {
            changed.hardware.stream_bits = bits;
        }
        changed
    }

    /// As the design file states it: `key = value with key = value and key = value`.
    fn keys(&self) -> String {
        let quicker = self.quicker.map(|(_, key)| key.to_owned());
        let outputs = self.outputs.map(|outputs| format!("outputs = \"{outputs}\""));
        let streams = self.stream_bits.map(|bits| format!("stream_bits = {bits}"));
        let keys: Vec<String> = [quicker, outputs, streams].into_iter().flatten().collect();
        match keys.as_slice() {
            [first, others @ ..] if !others.is_empty() => format!("{first} with {}", others.join(" and ")),
            _ => keys.concat(),
        }
    }
}
