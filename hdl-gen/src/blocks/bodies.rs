//! The count of bodies beside We: `sptfra_bodies`, where the design asks for it.

use crate::plan::Plan;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;

use super::{Parameters, latency, row_width};

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
        .cycles("EXPECTED_LATENCY", latency::bodies(sensor))
}

/// The weights of two frames; adders and comparisons are no multipliers.
pub fn cost(plan: &Plan) -> Option<BlockCost> {
    plan.design.algorithm.count_bodies.then(|| {
        let width = plan.ways() as u32 * plan.design.hardware.data_bits;
        let frames = memory("bodies", 1, PLACES << row_width(plan), width, false);
        BlockCost::new("bodies", &["sptfra_bodies"], 0).with([frames])
    })
}
