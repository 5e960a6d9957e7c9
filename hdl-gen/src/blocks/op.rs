//! Op behind the estimator: summary, status and output of a frame.

use crate::format::{FRICTION_BITS, FRICTION_FRACTION};
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::vector_formats::field_shifts;
use crate::resources::BlockCost;

use super::field;
use crate::timing::latency::{OUTPUT_LATENCY, SUMMARY_LATENCY};

/// Parameters of `sptfra_op`.
pub fn parameters(plan: &Plan) -> Parameters {
    let words = plan.streams().words();
    Parameters::new()
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .flag("FIELD", plan.has_field())
        .flag("DEPENDENT", plan.estimator.block().pitch().is_some())
        .number("SUM_LSB", plan.formats.g.lsb.into())
        .number("TORQUE_LSB", plan.formats.torque_lsb.into())
        .number("FIELD_LSB", field_lsb(plan).into())
        .some(plan.thresholds.error, |all, error| all.flag("WITH_ERROR", true).signed("ERROR_LIMIT", 18, error.limit))
        .when(plan.thresholds.thin, |all| all.flag("THIN", true))
        .when(words > 1, |all| all.count("WORDS", words).cycles("FIELD_STAGES", field::stages(plan)))
        .some(plan.thresholds.slip, |all, [limit, _]| all.unsigned("SLIP_LIMIT", FRICTION_BITS, limit as u64))
        .some(plan.thresholds.slip, |all, [_, release]| all.unsigned("SLIP_RELEASE", FRICTION_BITS, release as u64))
        .cycles("EXPECTED_SUMMARY_LATENCY", SUMMARY_LATENCY)
        .cycles("EXPECTED_OUTPUT_LATENCY", OUTPUT_LATENCY)
}

/// One multiplier in turns, for all quotients and products of the summary.
pub fn cost() -> BlockCost {
    BlockCost::new("summary", &["sptfra_summary"], 1)
}

/// Exponent of a step of a taxel's force as the field memory puts it together, in N.
pub fn field_lsb(plan: &Plan) -> i32 {
    match &plan.formats.folded {
        Some(folded) => field_shifts(&plan.formats, folded).2,
        None => plan.formats.g.lsb - FRICTION_FRACTION as i32,
    }
}
