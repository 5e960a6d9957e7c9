//! The field memory: `sptfra_field` of a folded grid, `sptfra_coefficient_field` where taxels are not folded.

use golden::parity::CLASSES;

use crate::plan::Plan;
use crate::plan::memory::memory;
use crate::plan::places::WEIGHT_PLACES;
use crate::plan::resources::BlockCost;
use crate::plan::vector_formats::field_shifts;

use super::Parameters;

/// The module.
pub fn module(plan: &Plan) -> &'static str {
    if plan.ways() > 1 { "sptfra_field" } else { "sptfra_coefficient_field" }
}

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let data = plan.design.hardware.data_bits.into();
    let Some(folded) = plan.formats.folded else {
        return Parameters::new().count("TAXELS", plan.taxels()).number("DATA_BITS", data);
    };
    let (force, share, _) = field_shifts(&plan.formats, &folded);
    Parameters::new()
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .number("DATA_BITS", data)
        .number("FORCE_SHIFT", force.into())
        .number("SHARE_SHIFT", share.into())
}

/// What a frame's taxels leave until they go out, and the multipliers that put a force together.
pub fn cost(plan: &Plan) -> BlockCost {
    let (data, elements) = (plan.design.hardware.data_bits, plan.elements());
    let block = |dsp| BlockCost::new("field", &["sptfra_field", "sptfra_coefficient_field"], dsp);
    if plan.ways() == 1 {
        // The memory is there without a field, too: the sums over the frame pass it.
        let dsp = if plan.field_words() > 0 { 2 } else { 0 };
        return block(dsp).with([memory("field", 3, 6 * plan.taxels(), data, false)]);
    }
    if plan.field_words() == 0 {
        return block(0);
    }
    let weights = WEIGHT_PLACES * elements.next_power_of_two();
    block(1)
        .with([memory("weights", CLASSES, weights, data, false), memory("field", CLASSES, 6 * elements, data, false)])
}
