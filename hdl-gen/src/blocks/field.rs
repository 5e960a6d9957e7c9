//! The field memory: `sptfra_field` of a folded grid, `sptfra_coefficient_field` where taxels are not folded.

use golden::parity::COMPONENTS;

use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::vector_formats::field_shifts;
use crate::resources::BlockCost;
use crate::resources::memory::memory;
use crate::timing::buffers::WEIGHT_BUFFERS;

/// The module.
pub fn module(plan: &Plan) -> &'static str {
    if plan.channels() > 1 { "sptfra_field" } else { "sptfra_coefficient_field" }
}

/// Cycles from a step to the forces.
pub fn stages(plan: &Plan) -> u64 {
    // Several words of a folded grid are chosen among two taxels first.
    if plan.channels() > 1 && plan.streams().words() > 1 { 7 } else { 6 }
}

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let (data, words) = (plan.design.hardware.data_bits.into(), plan.streams().words());
    let in_words = |parameters: Parameters| parameters.when(words > 1, |all| all.count("WORDS", words));
    let Some(folded) = plan.formats.folded else {
        return in_words(Parameters::new().count("TAXELS", plan.taxels()).number("DATA_BITS", data));
    };
    let (force, share, _) = field_shifts(&plan.formats, &folded);
    in_words(Parameters::new())
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .number("DATA_BITS", data)
        .number("FORCE_SHIFT", force.into())
        .number("SHARE_SHIFT", share.into())
}

/// What a frame's taxels leave until they go out, and the multipliers that put a force together.
pub fn cost(plan: &Plan) -> BlockCost {
    let (data, elements) = (plan.design.hardware.data_bits, plan.elements());
    let words = plan.streams().words();
    let modules = &["sptfra_field", "sptfra_coefficient_field"];
    let narrow = plan.factors().element_is_narrow();
    let block =
        |multipliers| BlockCost::new("field", modules, multipliers).narrow(if narrow { multipliers } else { 0 });
    if plan.channels() == 1 {
        // The memory is there without a field, too: the sums over the frame pass it.
        let multipliers = if plan.has_field() { 2 * words } else { 0 };
        let depth = 2 * (3 * plan.taxels()).div_ceil(words);
        return block(multipliers).with([memory("field", 3 * words, depth, data, false)]);
    }
    if !plan.has_field() {
        return block(0);
    }
    let multipliers = if plan.factors().has_wide_data() { 2 } else { 1 };
    let weights = WEIGHT_BUFFERS * elements.next_power_of_two();
    if words > 1 {
        // A copy for a taxel, and one for the next.
        return block(words * multipliers).with([
            memory("weights", 2 * COMPONENTS, weights, data, false),
            memory("field", 2 * 3 * COMPONENTS, 2 * elements, data, false),
        ]);
    }
    block(multipliers).with([
        memory("weights", COMPONENTS, weights, data, false),
        memory("field", COMPONENTS, 6 * elements, data, false),
    ])
}
