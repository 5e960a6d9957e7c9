//! Contact counter beside We: `sptfra_contact_counter`, where the design counts contacts.

use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::resources::BlockCost;
use crate::resources::memory::memory;
use crate::timing::latency;

use super::row_width;

/// Frames whose weights have a place.
const PLACES: usize = 2;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let sensor = &plan.design.sensor;
    Parameters::new()
        .count("CHANNELS", plan.channels())
        .count("COLUMNS", sensor.columns)
        .count("ROWS", sensor.rows)
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .cycles("EXPECTED_LATENCY", latency::count_contacts(sensor))
}

/// The weights of two frames; adders and comparisons are no multipliers.
pub fn cost(plan: &Plan) -> Option<BlockCost> {
    plan.design.algorithm.count_contacts.then(|| {
        let width = plan.channels() as u32 * plan.design.hardware.data_bits;
        let frames = memory("contacts", 1, PLACES << row_width(plan), width, false);
        BlockCost::new("contacts", &["sptfra_contact_counter"], 0).with([frames])
    })
}
