//! Op's friction in integers: grid search, correction, both components at once.

mod features;
mod network;
mod search;

use super::super::{Estimate, Inputs};
use super::{CUBIC_FRACTION, FACTOR_FRACTION, JointPlan, LINEAR_FRACTION};
use crate::format::{FRICTION_BITS, FRICTION_FRACTION, largest, round_shift};

/// Finds the friction of a frame.
pub fn friction(joint: &JointPlan, inputs: &Inputs) -> Estimate {
    let centroid = search::search(&joint.search, inputs);
    let mut estimate = Estimate { unknown: centroid.unknown, at_bound: centroid.on_border, ..Estimate::default() };
    let mut correction = [0; 2];
    if let Some(network) = &joint.network {
        let features = features::take(network, inputs, centroid.mu);
        estimate.saturated = features.saturated;
        correction = network::correction(network, &features.inputs);
    }
    estimate.saturated = (estimate.saturated || centroid.saturated) && !centroid.unknown;
    let exact = scaled(joint, centroid.mu);
    if centroid.unknown {
        return estimate;
    }
    for (axis, component) in estimate.friction.iter_mut().enumerate() {
        let sum = exact[axis] + correction[axis];
        *component = sum.clamp(-largest(FRICTION_BITS) - 1, largest(FRICTION_BITS));
        estimate.at_bound |= *component != sum;
    }
    estimate
}

/// `c1 mu + c3 mu |mu|^2`.
fn scaled(joint: &JointPlan, mu: [i64; 2]) -> [i64; 2] {
    let square = (mu[0] * mu[0] + mu[1] * mu[1]) >> (2 * FRICTION_FRACTION - LINEAR_FRACTION);
    let sum = (joint.linear << CUBIC_FRACTION) + joint.cubic * square;
    let factor = sum >> (LINEAR_FRACTION + CUBIC_FRACTION - FACTOR_FRACTION);
    mu.map(|component| round_shift(component * factor, FACTOR_FRACTION))
}
