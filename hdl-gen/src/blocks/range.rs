//! A range of its own for each frame, `sptfra_range` behind Bz, where the design asks for it.

use crate::cores::LONG_BITS;
use crate::plan::Plan;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;
use crate::plan::vector_formats::FOLD_BITS;

use super::{Parameters, latency};

/// Parameters of `sptfra_range`.
pub fn parameters(plan: &Plan) -> Parameters {
    let sensor = &plan.design.sensor;
    Parameters::new()
        .count("COLUMNS", sensor.columns)
        .count("ROWS", sensor.rows)
        .count("WAYS", plan.ways())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .wide("STRESS_BOUND", LONG_BITS, plan.formats.stress.bound)
        // A cycle more counts the frame.
        .cycles("EXPECTED_LATENCY", latency::range(plan.elements()) - 1)
}

/// The frame, folded without a rounding; nothing where all frames have the full scale's range.
pub fn cost(plan: &Plan) -> Option<BlockCost> {
    plan.scales_frames().then(|| {
        let (ways, stress, folded) = (plan.ways() as u32, plan.factors().outside_bits(), plan.ways() > 1);
        let exact = stress + if folded { FOLD_BITS } else { 0 };
        let mut memories = vec![memory("frame to be scaled", 1, plan.elements(), ways * exact, false)];
        if folded {
            memories.push(memory("half-folded b", 1, plan.elements(), 2 * stress + 2, false));
        }
        BlockCost::new("range", &["sptfra_range"], 0).with(memories)
    })
}
