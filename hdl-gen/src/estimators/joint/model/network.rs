//! The network of rectifiers in integers.

use golden::parity::COMPONENTS;

use super::super::{CORRECTION_LIMIT, NetworkPlan};
use crate::format::round_shift;

/// The correction of both friction components for the features by word and component.
pub fn correction(network: &NetworkPlan, inputs: &[[i64; COMPONENTS]]) -> [i64; 2] {
    let mut sums = [0; 2];
    for (pass, weights) in network.weights.chunks(network.length).enumerate() {
        for (unit, readout) in network.readout.iter().skip(pass * network.at_once).take(network.at_once).enumerate() {
            let component = |component: usize| -> i64 {
                let terms = weights.iter().zip(inputs);
                let sum = terms.map(|(weights, inputs)| i64::from(weights[unit][component]) * inputs[component]).sum();
                round_shift(sum, network.unit_shift)
            };
            let [a, b, c, d] = std::array::from_fn(component);
            // Of the four mirror images, then their rectifiers, mirrored back.
            let images = [a + b + c + d, a - b + c - d, a + b - c - d, a - b - c + d];
            let [a, b, c, d] = images.map(|sum| sum.max(0));
            sums[0] += i64::from(readout[0]) * (a - b + c - d);
            sums[1] += i64::from(readout[1]) * (a + b - c - d);
        }
    }
    let shifted = |sum: i64, shift: i32| if shift >= 0 { round_shift(sum, shift as u32) } else { sum << -shift };
    sums.map(|sum| shifted(sum, network.correction_shift).clamp(-CORRECTION_LIMIT, CORRECTION_LIMIT))
}
