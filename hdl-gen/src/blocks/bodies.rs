//! The count of bodies beside We: `sptfra_bodies`, where the design asks for it.

use golden::sensor::Sensor;

use crate::plan::Plan;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;

use super::{Parameters, row_width};

/// Frames whose weights have a place.
const PLACES: usize = 2;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let sensor = &plan.design.sensor;
    Parameters::new()
        .count("WAYS", plan.ways())
        .count("COLUMNS", sensor.columns)
        .count("ROWS", sensor.rows)
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .cycles("EXPECTED_LATENCY", latency(sensor))
}

/// Cycles from the last weights of a frame to its count: a step for each taxel and for the end of each row, and the way
/// through sums and comparisons.
///
/// A search has a stage that is longer (the joint estimator's with 15 points a side takes `4 quads + 108`, the others far
/// longer; it takes `2 quads + 80` with many lanes, where that is longer than the count), and a frame is begun only when that stage of the one before the last is over. So a count is there before the
/// search, and neither latency nor interval knows of it.
pub fn latency(sensor: &Sensor) -> u64 {
    ((sensor.columns + 1) * sensor.rows) as u64 + 12
}

/// The weights of two frames; adders and comparisons are no multipliers.
pub fn cost(plan: &Plan) -> Option<BlockCost> {
    plan.design.algorithm.count_bodies.then(|| {
        let width = plan.ways() as u32 * plan.design.hardware.data_bits;
        let frames = memory("bodies", 1, PLACES << row_width(plan), width, false);
        BlockCost::new("bodies", &["sptfra_bodies"], 0).with([frames])
    })
}
