//! The field memory: `sptfra_field` of a folded grid, `sptfra_field_wide` for several words a beat,
//! `sptfra_coefficient_field` where taxels are not folded.

use crate::plan::Plan;
use crate::plan::formats::field_shifts;

use super::Parameters;

/// The module.
pub fn module(plan: &Plan) -> &'static str {
    match (plan.ways() > 1, plan.streams().words() > 1) {
        (true, false) => "sptfra_field",
        (true, true) => "sptfra_field_wide",
        (false, _) => "sptfra_coefficient_field",
    }
}

/// Cycles from a step to the forces.
pub fn stages(plan: &Plan) -> u64 {
    if module(plan) == "sptfra_field_wide" { 6 } else { 5 }
}

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let (data, words) = (plan.design.hardware.data_bits.into(), plan.streams().words());
    let Some(folded) = plan.formats.folded else {
        let parameters = Parameters::new().count("TAXELS", plan.taxels()).number("DATA_BITS", data);
        return if words > 1 { parameters.count("WORDS", words) } else { parameters };
    };
    let (force, share, _) = field_shifts(&plan.formats, &folded);
    let parameters = if words > 1 { Parameters::new().count("WORDS", words) } else { Parameters::new() };
    parameters
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .number("DATA_BITS", data)
        .number("FORCE_SHIFT", force.into())
        .number("SHARE_SHIFT", share.into())
}
