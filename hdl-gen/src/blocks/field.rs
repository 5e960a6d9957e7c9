//! The field memory: `sptfra_field` of a folded grid, `sptfra_coefficient_field` where taxels are not folded.

use crate::plan::Plan;
use crate::plan::formats::field_shifts;

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
