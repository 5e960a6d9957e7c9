//! `CeAn`: what a frame's stress says at first sight, and the direction of the push.

use golden::design::Tension;

use crate::plan::Plan;

use super::Parameters;

/// Bits of a stress, of `sum |b|`, and of a pitch with its 16 fraction bits.
const STRESS_BITS: u32 = 27;
const SUM_BITS: u32 = 40;
const PITCH_BITS: u32 = 18;

/// Parameters of `sptfra_cean`.
pub fn parameters(plan: &Plan) -> Parameters {
    let slot = plan.estimator.slot();
    let pitch = slot.pitch();
    let [pitch_x, pitch_y] = pitch.unwrap_or_default();
    Parameters::new()
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .flag("DIRECTION", pitch.is_some())
        .flag("TENSION_READ", plan.design.input.tension == Tension::Read)
        .wide("TAXEL_FLOOR", STRESS_BITS, plan.thresholds.taxel)
        .wide("CONTACT_FLOOR", SUM_BITS, plan.thresholds.contact)
        .wide("PITCH_X", PITCH_BITS, pitch_x)
        .wide("PITCH_Y", PITCH_BITS, pitch_y)
        .cycles("EXPECTED_LATENCY", slot.contact_latency())
}
