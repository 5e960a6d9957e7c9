//! Estimated LUTs and flip-flops: a linear fit to what Yosys counts, whose table is `results/luts.csv`.

use golden::design::{CalibrationIn, Outputs, PlanKind, Scaling};
use serde::Serialize;

use super::Plan;

/// What a count depends on, in the order of [`features`].
pub const FEATURES: [&str; 17] = [
    "one",
    "lanes",
    "wide_lanes",
    "reduced_plan",
    "line_cells",
    "grid_search",
    "parallel_points",
    "network",
    "hidden_at_once",
    "field",
    "per_frame",
    "more_samples",
    "counts",
    "ram",
    "dead",
    "control",
    "contacts",
];

/// LUTs and flip-flops of each feature: `cargo xtask luts` fits and prints them.
const FITTED: [[f64; 2]; FEATURES.len()] = [[0.0, 0.0]; FEATURES.len()];

/// The estimate's error in percent, which 95 of 100 designs keep to that the fit has not seen.
pub const LOGIC_ERROR_PERCENT: u64 = 0;

/// Estimated logic of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Logic {
    /// LUTs of six inputs, those used as memories and shift registers too.
    pub lut: u64,
    /// Flip-flops.
    pub ff: u64,
}

/// The features of a plan; flags are 0 or 1.
pub fn features(plan: &Plan) -> [f64; FEATURES.len()] {
    let (algorithm, hardware, input) = (&plan.design.algorithm, &plan.design.hardware, &plan.design.input);
    let flag = |is: bool| f64::from(u8::from(is));
    let grid = plan.estimator.joint();
    let network = grid.and_then(|grid| grid.network.as_ref());
    let cells = plan.estimator.slot().cells(&plan.design.sensor).cells as f64;
    let lanes = hardware.lanes as f64;
    let samples = f64::from(hardware.stream_bits / hardware.samples.bits());
    [
        1.0,
        lanes,
        lanes * flag(hardware.data_bits > 27),
        flag(algorithm.plan == PlanKind::Reduced),
        if grid.is_some() { 0.0 } else { cells },
        flag(grid.is_some()),
        grid.map_or(0.0, |grid| (grid.search.parallel * grid.search.taxels) as f64),
        flag(network.is_some()),
        network.map_or(0.0, |network| network.at_once as f64),
        flag(algorithm.outputs == Outputs::Field),
        flag(hardware.scaling == Scaling::PerFrame),
        samples - 1.0,
        flag(input.counts()),
        flag(hardware.calibration == CalibrationIn::Ram),
        input.room.max(input.dead.len()) as f64,
        flag(hardware.control),
        flag(algorithm.count_contacts),
    ]
}

/// The estimate of a plan.
pub fn logic(plan: &Plan) -> Logic {
    let features = features(plan);
    let [lut, ff] =
        [0, 1].map(|kind| features.iter().zip(&FITTED).map(|(value, fitted)| value * fitted[kind]).sum::<f64>());
    Logic { lut: lut.max(0.0).round() as u64, ff: ff.max(0.0).round() as u64 }
}
