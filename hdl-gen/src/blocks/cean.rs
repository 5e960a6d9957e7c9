//! `CeAn`: what a frame's stress says at first sight, and the direction of the push.

use golden::design::Tension;

use crate::cores::SHORT_BITS;
use crate::parameters::Parameters;
use crate::plan::Plan;

/// Parameters of `sptfra_cean`.
pub fn parameters(plan: &Plan) -> Parameters {
    let estimator_block = plan.estimator.block();
    let pitch = estimator_block.pitch();
    let [pitch_x, pitch_y] = pitch.unwrap_or_default();
    Parameters::new()
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .flag("DIRECTION", pitch.is_some())
        .flag("TENSION_READ", plan.design.input.tension == Tension::Read)
        .when(plan.thresholds.error.is_some(), |all| all.flag("WITH_ERROR", true))
        .signed("PITCH_X", SHORT_BITS, pitch_x)
        .signed("PITCH_Y", SHORT_BITS, pitch_y)
        .cycles("EXPECTED_LATENCY", estimator_block.contact_latency())
}
