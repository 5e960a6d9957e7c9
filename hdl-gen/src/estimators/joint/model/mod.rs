//! Op's friction in integers: grid search, correction, both components at once.

mod features;
mod network;
mod search;

use super::super::{Found, Seen};
use super::{CUBIC_FRACTION, FACTOR_FRACTION, JointPlan, LINEAR_FRACTION};
use crate::plan::format::{FRICTION_BITS, FRICTION_FRACTION, largest, round_shift};

/// Finds the friction of a frame.
pub fn friction(joint: &JointPlan, seen: &Seen) -> Found {
    let centroid = search::search(&joint.search, seen);
    let mut found = Found { unknown: centroid.unknown, at_bound: centroid.on_border, ..Found::default() };
    let mut correction = [0; 2];
    if let Some(network) = &joint.network {
        let features = features::take(network, seen, centroid.mu);
        found.saturated = features.saturated;
        correction = network::correction(network, &features.inputs);
    }
    found.saturated = (found.saturated || centroid.saturated) && !centroid.unknown;
    let exact = scaled(joint, centroid.mu);
    if centroid.unknown {
        return found;
    }
    for (axis, component) in found.friction.iter_mut().enumerate() {
        let sum = exact[axis] + correction[axis];
        *component = sum.clamp(-largest(FRICTION_BITS) - 1, largest(FRICTION_BITS));
        found.at_bound |= *component != sum;
    }
    found
}

/// `c1 mu + c3 mu |mu|^2`.
fn scaled(joint: &JointPlan, mu: [i64; 2]) -> [i64; 2] {
    let square = (mu[0] * mu[0] + mu[1] * mu[1]) >> (2 * FRICTION_FRACTION - LINEAR_FRACTION);
    let sum = (joint.linear << CUBIC_FRACTION) + joint.cubic * square;
    let factor = sum >> (LINEAR_FRACTION + CUBIC_FRACTION - FACTOR_FRACTION);
    mu.map(|component| round_shift(component * factor, FACTOR_FRACTION))
}
