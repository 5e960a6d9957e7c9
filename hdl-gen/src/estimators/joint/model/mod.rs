//! Op's friction in integers, joint estimator: grid, level set, correction, both components at once.

mod look;
mod network;
mod points;

use super::super::{Found, Seen};
use super::{
    CUBIC_FRACTION, DEPTH_BITS, FACTOR_FRACTION, JointPlan, LINEAR_FRACTION, POINTS, SIDE, STEP_SHIFT, WEIGHT_DROP,
};
use crate::cores::divider;
use crate::plan::format::{FRICTION_BITS, FRICTION_FRACTION, largest, round_shift};

/// Steps of the grid from its middle to its border.
const REACH: i64 = SIDE as i64 / 2;

/// Finds the friction of a frame.
pub fn friction(joint: &JointPlan, seen: &Seen) -> Found {
    let centroid = match &joint.points {
        Some(points) => points::search(points, seen),
        None => level_set(joint, &values(joint, seen.u, seen.contact.largest), seen.contact.stress_sum),
    };
    let mut found = Found { unknown: centroid.unknown, at_bound: centroid.on_border, ..Found::default() };
    let mut correction = [0; 2];
    if let Some(network) = &joint.network {
        let look = look::take(network, seen, centroid.mu);
        found.saturated = look.saturated;
        (correction, found.error_log) = network::correction(network, &look.inputs);
    }
    found.saturated = (found.saturated || centroid.saturated) && !centroid.unknown;
    let exact = scaled(joint, centroid.mu);
    if centroid.unknown {
        // Without a direction the error is as much as presses.
        found.error_log = 0;
        return found;
    }
    for (axis, component) in found.friction.iter_mut().enumerate() {
        let sum = exact[axis] + correction[axis];
        *component = sum.clamp(-largest(FRICTION_BITS) - 1, largest(FRICTION_BITS));
        found.at_bound |= *component != sum;
    }
    found
}

/// The hinges' sums at every point, row by row, and back along every other row as the hardware walks.
fn values(joint: &JointPlan, u: &[Vec<i64>; 3], largest: i64) -> Vec<i64> {
    let [u0, u1, u2] = u;
    let dead_zone = joint.share(largest);
    let terms = u0.iter().zip(u1).zip(u2);
    let mut points: Vec<i64> =
        terms.map(|((u0, u1), u2)| (u0 << STEP_SHIFT) - dead_zone - REACH * u1 - REACH * u2).collect();
    let mut values = Vec::with_capacity(POINTS);
    for row in 0..SIDE {
        for column in 0..SIDE {
            values.push(points.iter().map(|&stress| stress.max(0)).sum());
            let step = |taxel: usize| match (column == SIDE - 1, row % 2) {
                (true, _) => u2[taxel],
                (false, 0) => u1[taxel],
                _ => -u1[taxel],
            };
            points.iter_mut().enumerate().for_each(|(taxel, stress)| *stress += step(taxel));
        }
    }
    values
}

/// The level set's centroid.
struct Centroid {
    mu: [i64; 2],
    unknown: bool,
    on_border: bool,
    /// A value was clipped.
    saturated: bool,
}

fn level_set(joint: &JointPlan, values: &[i64], stress_sum: i64) -> Centroid {
    // Column and row of the point in the order of the walk, from the middle.
    let place = |index: usize| {
        let (along, row) = (index % SIDE, index / SIDE);
        let column = if row % 2 == 0 { along } else { SIDE - 1 - along };
        [column, row].map(|at| at as i64 - REACH)
    };
    let is_border = |index: &usize| place(*index).iter().any(|at| at.abs() == REACH);
    let least = |border: bool| {
        let points = (0..POINTS).filter(|index| is_border(index) == border);
        points.map(|index| values[index]).min().unwrap_or(0)
    };
    let (inside, on_border) = (least(false), least(true));
    // One more, so that the least value is below the level in any case.
    let margin = joint.share(stress_sum) + 1;
    let level = inside.min(on_border) + margin;
    let left = joint.value_bits - (64 - margin.leading_zeros());
    let mut sums = [0; 3];
    let mut corners = 0;
    for (index, value) in values.iter().enumerate() {
        let depth = (level - value).max(0);
        let [x, y] = place(index);
        corners += u32::from(depth > 0 && x.abs() == REACH && y.abs() == REACH);
        let depth = (depth << left) >> (joint.value_bits - DEPTH_BITS);
        let weight = (depth * depth) >> WEIGHT_DROP;
        sums = [sums[0] + weight, sums[1] + weight * x, sums[2] + weight * y];
    }
    let [sum, ref moments @ ..] = sums;
    let quotient = |moment: i64| {
        let numerator = moment.unsigned_abs() << (FRICTION_FRACTION - STEP_SHIFT);
        let magnitude = divider::divide(numerator, sum as u64) as i64;
        if moment < 0 { -magnitude } else { magnitude }
    };
    Centroid { mu: moments.map(quotient), unknown: corners == 4, on_border: on_border < inside, saturated: false }
}

/// `c1 mu + c3 mu |mu|^2`.
fn scaled(joint: &JointPlan, mu: [i64; 2]) -> [i64; 2] {
    let square = (mu[0] * mu[0] + mu[1] * mu[1]) >> (2 * FRICTION_FRACTION - LINEAR_FRACTION);
    let sum = (joint.linear << CUBIC_FRACTION) + joint.cubic * square;
    let factor = sum >> (LINEAR_FRACTION + CUBIC_FRACTION - FACTOR_FRACTION);
    mu.map(|component| round_shift(component * factor, FACTOR_FRACTION))
}
