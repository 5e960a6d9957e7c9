//! `CeAn`: what a frame's stress says at first sight, and the direction of the push.

use golden::design::Tension;

use crate::cores::{LONG_BITS, SHORT_BITS};
use crate::plan::Plan;
use crate::plan::format::SUM_BITS;

use super::Parameters;

/// Parameters of `sptfra_cean`.
pub fn parameters(plan: &Plan) -> Parameters {
    let slot = plan.estimator.slot();
    let pitch = slot.pitch();
    let [pitch_x, pitch_y] = pitch.unwrap_or_default();
    let parameters = Parameters::new()
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .flag("DIRECTION", pitch.is_some())
        .flag("TENSION_READ", plan.design.input.tension == Tension::Read);
    let parameters = if plan.thresholds.error.is_some() { parameters.flag("WITH_ERROR", true) } else { parameters };
    parameters
        .wide("PITCH_X", SHORT_BITS, pitch_x)
        .wide("PITCH_Y", SHORT_BITS, pitch_y)
        .cycles("EXPECTED_LATENCY", slot.contact_latency())
}

/// The design's thresholds as constants, a taxel's noise and the least sum `|b|` of a contact, in steps of the stress: those
/// of every frame, unless a calibration in RAM brings them.
pub fn thresholds(plan: &Plan) -> [String; 2] {
    let thresholds = &plan.thresholds;
    [format!("{LONG_BITS}'d{}", thresholds.taxel), format!("{SUM_BITS}'d{}", thresholds.contact)]
}
