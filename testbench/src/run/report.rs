//! Everything a run found out, for machines (JSON) and as the source of the table for people.

use std::collections::BTreeMap;
use std::path::PathBuf;

use golden::design::Filter;
use golden::metrics::ErrorSummary;
use hdl_gen::plan::Plan;
use serde::Serialize;

use crate::accuracy::{SolverError, StatusCounts};
use crate::co_simulation::Verdict;
use crate::registers::RegisterReport;
use crate::simulate::ModeResult;

/// The published hardware of the method with a filter, for one frame of a 10 × 10 sensor (Pinto-Salamanca et al., Sensors
/// 2024): the average time of its sparse designs, the resources of the smallest.
pub const PUBLISHED: Published = Published {
    what: "the paper's sparse designs on average",
    latency_cycles: 7_335_000,
    milliseconds: 58.68,
    dsp: Some(568),
    bram36: Some(849),
};
/// Its hardware without a filter, for sensor 1, HW 1 of Table 3.
pub const UNFILTERED: Published = Published {
    what: "the paper's HW 1, which has no filter either",
    latency_cycles: 3_595_000,
    milliseconds: 28.76,
    dsp: None,
    bram36: None,
};

/// Figures of published hardware.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Published {
    /// What it is, for people.
    pub what: &'static str,
    /// Cycles from a frame to its forces.
    pub latency_cycles: u64,
    /// The same in time, at 125 MHz.
    pub milliseconds: f64,
    /// Multipliers.
    pub dsp: Option<u32>,
    /// Block memories.
    pub bram36: Option<u32>,
}

/// What the plan says without simulation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Predicted {
    /// First beat in to last beat out, both counted.
    pub latency_cycles: u64,
    /// Between the last beats of consecutive frames.
    pub interval_cycles: u64,
    /// DSP blocks of the part.
    pub dsp: usize,
    /// RAMB36; a RAMB18 counts one half.
    pub bram36: f64,
}

/// Times at the design's clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Microseconds {
    /// Of `latency_cycles`.
    pub latency: f64,
    /// Of `interval_cycles`.
    pub interval: f64,
}

/// The result of `sptfra run`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The design's name.
    pub design: String,
    /// Sensor, filter, lanes, clock and part in a line for people.
    #[serde(skip)]
    pub description: String,
    /// Where the frames come from.
    pub frames_from: String,
    /// Number of frames in the set.
    pub frames: usize,
    /// Whether the RTL gave the model's word everywhere, in all stream modes.
    pub bit_exact: bool,
    /// Words that differ, over all stream modes.
    pub mismatches: u64,
    /// Measured: first beat in to last beat out of a frame alone, both counted.
    pub latency_cycles: u64,
    /// Measured: between the last beats of consecutive frames, sent back to back.
    pub interval_cycles: u64,
    /// Predicted by the plan.
    pub predicted: Predicted,
    /// The measured cycles at the design's clock.
    pub microseconds: Microseconds,
    /// Against the f64 solver.
    pub error: SolverError,
    /// Against the true forces, in percent; absent if they are not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub true_force_errors: Option<ErrorSummary>,
    /// The same of the paper's method in f64, the line search without a filter, beside a design with another estimator.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub paper_errors: Option<ErrorSummary>,
    /// Frames by status bit.
    pub status_counts: StatusCounts,
    /// The cycles beside the predicted ones: `as_predicted` or `wrong`.
    pub timing: &'static str,
    /// All that is wrong, in words; nothing if the hardware is right.
    pub faults: Vec<String>,
    /// By stream mode.
    pub modes: Vec<ModeResult>,
    /// The register bank; absent in a core without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub registers: Option<RegisterReport>,
    /// The trace and its views, where one was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub traces: Vec<PathBuf>,
    /// DSP blocks of the part, as the plan counts them.
    pub dsp: usize,
    /// What those are called.
    #[serde(skip)]
    pub dsp_block: &'static str,
    /// RAMB36, as the plan counts them.
    pub bram36: f64,
    /// Bits in ROM files.
    pub rom_bits: u64,
    /// Multiply-accumulates of a frame in the lanes.
    pub macs: u64,
    /// Entries of the paper's 13 matrices after the filter, whichever the plan makes of them.
    pub nnz: BTreeMap<String, usize>,
    /// `SpMV` lanes.
    pub lanes: usize,
    /// Fraction of lane cycles that multiply, while an `SpMV` phase runs.
    pub lanes_busy: f64,
    /// Clock.
    pub clock_mhz: f64,
    /// The published design, for a sensor of its size.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub published: Option<Published>,
    /// The simulator.
    pub simulator: String,
}

impl Report {
    /// What the plan and the simulation say; nothing of frames and accuracy yet.
    pub fn new(plan: &Plan, verdict: &Verdict, registers: Option<RegisterReport>, simulator: String) -> Self {
        let Verdict { simulation, predicted } = verdict;
        let microseconds = |cycles: u64| cycles as f64 / plan.design.hardware.clock_mhz;
        let wrong_registers = registers.iter().flat_map(|registers| &registers.wrong);
        let faults = verdict
            .faults()
            .into_iter()
            .chain(wrong_registers.map(|wrong| format!("register bank: {wrong}")))
            .collect();
        Self {
            design: plan.design.name.clone(),
            description: describe(plan),
            frames_from: String::new(),
            frames: simulation.answers.len(),
            bit_exact: simulation.is_exact(),
            mismatches: simulation.mismatches(),
            latency_cycles: simulation.cycles.latency,
            interval_cycles: simulation.cycles.interval,
            predicted: Predicted {
                latency_cycles: predicted.latency,
                interval_cycles: predicted.interval,
                dsp: plan.resources.dsp,
                bram36: plan.resources.bram36,
            },
            microseconds: Microseconds {
                latency: microseconds(simulation.cycles.latency),
                interval: microseconds(simulation.cycles.interval),
            },
            timing: if verdict.is_timely() { "as_predicted" } else { "wrong" },
            faults,
            error: SolverError::default(),
            true_force_errors: None,
            paper_errors: None,
            status_counts: StatusCounts::default(),
            modes: simulation.modes.clone(),
            registers,
            traces: Vec::new(),
            dsp: plan.resources.dsp,
            dsp_block: plan.resources.dsp_block.name(),
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
}

/// One line on what the design is.
fn describe(plan: &Plan) -> String {
    use golden::design::Filter;
    let (sensor, hardware) = (&plan.design.sensor, &plan.design.hardware);
    let filter = match &plan.design.algorithm.filter {
        Filter::None => "no filter".to_owned(),
        Filter::F1 { l } => format!("filter F1 L = {l}"),
        Filter::F2 { p } => format!("filter F2 p = {p}"),
        Filter::F3 { .. } => "filter F3".to_owned(),
    };
    format!(
        "{} × {} taxels of {} × {} mm, {} mm deep · {filter} · {} lanes · {} × {} bits · {} MHz",
        sensor.columns,
        sensor.rows,
        sensor.pitch_mm[0],
        sensor.pitch_mm[1],
        sensor.depth_mm,
        hardware.lanes,
        hardware.coefficient_bits,
        hardware.data_bits,
        hardware.clock_mhz
    )
}

/// The published figures of hardware with a filter or without as the plan's, if the sensor has the size they are of.
fn published_for(plan: &Plan) -> Option<Published> {
    let sensor = &plan.design.sensor;
    let suited = if plan.design.algorithm.filter == Filter::None { UNFILTERED } else { PUBLISHED };
    ((sensor.columns, sensor.rows) == (10, 10)).then_some(suited)
}
