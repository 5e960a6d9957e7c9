//! Estimated LUTs and flip-flops: a linear fit to what Yosys counts module by module, in `results/luts.csv`.

use std::fmt;

use golden::design::Samples;
use serde::Serialize;

use super::Plan;
use super::streams::Intake;

/// Largest error in percent of LUTs and of flip-flops: of the five whole designs, each by a fit to the others. All have
/// 10 x 10 taxels; the error of other designs is not known.
pub const ERROR_PERCENT: [u32; 2] = [3, 8];

/// LUTs and flip-flops of one of each feature, or [`NOT_COUNTED`]: `make luts` fits and prints them.
pub const FITTED: [[f64; FEATURES]; 2] = [
    [
        250.9, 0.0, 4.9, -1.0, 308.0, 308.0, -1.0, 308.0, 790.8, 739.2, 256.3, 1148.5, 30.3, 485.5, 51.6, 51.6, 0.0,
        72.5, -1.0, 4070.0, 0.0, 119.4, 288.0, 2270.0, 0.0, 0.0, 386.1, 869.0, 952.5, 0.0, -1.0, 329.0, -1.0, 692.5,
        352.0, 0.0, 382.0, 495.0, 214.0, 119.4, 238.8, 2286.0, 6299.0, 181.0, 152.0, 180.0, 10.0, 163.0, 11.0, 115.0,
        65.0, 308.0, 0.0,
    ],
    [
        616.4, 0.0, 7.7, -1.0, 1181.2, 1181.2, -1.0, 1181.2, 1178.8, 418.2, 420.7, 1772.0, 26.0, 415.3, 760.6, 760.6,
        2536.0, 84.8, -1.0, 3289.0, 425.3, 188.0, 344.0, 1965.9, 0.0, 0.0, 581.4, 776.0, 430.2, 0.0, -1.0, 300.0, -1.0,
        867.2, 212.0, 16.2, 367.0, 348.0, 310.0, 125.0, 250.0, 199.0, 4035.0, 99.0, 23.0, 11.0, 93.0, 337.0, 5.0, 95.0,
        73.0, 1181.2, 0.0,
    ],
];

/// No design with this feature was counted, so that one that has it is not estimated.
pub const NOT_COUNTED: f64 = -1.0;

const FEATURES: usize = 53;

/// Estimated logic of a design on UltraScale+.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Logic {
    /// LUTs of six inputs, those used as memories and shift registers too.
    pub lut: u64,
    /// Flip-flops.
    pub ff: u64,
    /// Largest error of such an estimate of LUTs, in percent.
    pub lut_error_percent: u32,
    /// The same of flip-flops.
    pub ff_error_percent: u32,
}

impl fmt::Display for Logic {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { lut, ff, lut_error_percent, ff_error_percent } = self;
        write!(f, "{lut} LUT, {ff} FF by a fit to Yosys' counts; ")?;
        write!(f, "within {lut_error_percent} and {ff_error_percent} % for five designs")
    }
}

/// What counts grow with: the module, the feature, and how much of it a plan has. A module counts with what it
/// instantiates, but for modules that are features themselves.
pub fn features(plan: &Plan) -> [(&'static str, &'static str, f64); FEATURES] {
    let (input, hardware, streams) = (&plan.design.input, &plan.design.hardware, plan.streams());
    let flag = |is: bool| f64::from(u8::from(is));
    let multipliers = |name| {
        let block = plan.resources.blocks.iter().find(|block| block.name == name);
        block.map_or(0.0, |block| block.multipliers as f64)
    };
    let grid = plan.estimator.joint().map(|grid| (&grid.search, grid.network.is_some()));
    let points = grid.map_or(0.0, |(search, _)| (search.parallel * search.taxels) as f64);
    let [one, lanes, width] = [1.0, hardware.lanes as f64, f64::from(hardware.data_bits) / 27.0];
    let [line, network] = [grid.is_none(), grid.is_some_and(|(_, network)| network)].map(flag);
    let (reduced, places) = (flag(plan.channels() > 1), plan.places_for_dead() as f64);
    let [beat, words] = [streams.conversions() as f64, streams.words() as f64];
    let [ram, curve, counts] = [plan.calibration.is_some(), input.curve.is_some(), input.counts()].map(flag);
    let [control, float] = [hardware.control, hardware.samples == Samples::Float32].map(flag);
    [
        ("spmv_array", "one", one),
        ("spmv_array", "programs", plan.pes() as f64),
        ("spmv_array", "lanes x bits", lanes * f64::from(hardware.coefficient_bits + hardware.data_bits)),
        ("spmv_array", "wide", flag(plan.factors().multipliers() > 1)),
        ("we", "one", width),
        ("co", "one", width),
        ("co", "not folded", one - reduced),
        ("unfold", "folded", width * reduced),
        ("cean", "one", one),
        ("cean", "line", line),
        ("estimator_line", "line", line),
        ("line", "line", line),
        ("search", "line", line),
        ("search", "cells", multipliers("cells")),
        ("estimator_joint", "grid", one - line),
        ("estimator_joint", "network", network),
        ("grid_search", "grid", one - line),
        ("grid_search", "points", points),
        ("grid_search", "by rows", flag(grid.is_some_and(|(search, _)| search.is_serial()))),
        ("features", "network", network),
        ("network", "network", network),
        ("network", "multipliers", multipliers("network")),
        ("friction", "grid", one - line),
        ("summary", "one", one),
        ("output", "words", words),
        ("field", "one", flag(plan.has_field())),
        ("field", "multipliers", multipliers("field")),
        ("contact_counter", "one", flag(plan.design.algorithm.count_contacts)),
        ("samples", "samples", beat),
        ("float_to_fixed", "samples", beat * float),
        ("int_to_fixed", "samples", beat * (one - float)),
        ("counts", "samples", beat * counts),
        ("curve", "samples", beat * curve),
        ("fold", "samples", width * beat),
        ("frame_scale", "samples", beat * flag(plan.scales_frames())),
        ("taxel_stream", "samples", beat),
        ("smoothing", "one", flag(plan.smoothing.is_some())),
        ("crosstalk", "one", flag(plan.crosstalk.is_some())),
        ("creep", "one", flag(plan.creep.is_some())),
        ("replace", "one", flag(places > 0.0)),
        ("replace", "dead", places),
        ("banks", "ram", ram),
        ("curve_bank", "curve", ram * curve),
        ("dead_bank", "dead", ram * places),
        ("calibration_registers", "ram", ram),
        ("registers", "control", control),
        ("axi_lite", "control", control),
        ("frame_meter", "control", control),
        ("stream_gate", "control", control),
        ("ingress_fifo", "drop", flag(streams.drops)),
        ("unpack", "samples", flag(streams.intake == Intake::Unpacked)),
        ("rest", "one", one),
        ("rest", "words", words),
    ]
}

/// The estimate of a plan, in hundreds, if all was counted that it has.
pub fn logic(plan: &Plan) -> Option<Logic> {
    let sum = |kind: usize| {
        let features = features(plan).into_iter().zip(FITTED[kind]).filter(|((.., of), _)| *of > 0.0);
        let each = features.map(|((.., of), fitted)| (fitted >= 0.0).then_some(of * fitted));
        each.sum::<Option<f64>>().map(|sum| 100 * (sum / 100.0).round() as u64)
    };
    let [lut_error_percent, ff_error_percent] = ERROR_PERCENT;
    Some(Logic { lut: sum(0)?, ff: sum(1)?, lut_error_percent, ff_error_percent })
}
