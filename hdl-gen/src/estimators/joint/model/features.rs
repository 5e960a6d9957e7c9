//! What the correction sees: the stress of the normal forces alone, in a window around the contact, folded.

use golden::parity::COMPONENTS;

use super::super::super::Inputs;
use super::super::{CENTRE_HALF, INPUT_FRACTION, NORMAL_DROP, NetworkPlan, RECIPROCAL_BITS, STRESS_BITS};
use crate::cores::{SHORT_BITS, ratio};
use crate::format::{FRICTION_FRACTION, SUM_BITS, largest, round_shift};

/// Fraction bits of the contact's centre.
const CENTRE_FRACTION: u32 = FRICTION_FRACTION;

/// The network's inputs.
pub struct Features {
    /// By word and component, [`INPUT_FRACTION`] fraction bits.
    pub inputs: Vec<[i64; COMPONENTS]>,
    /// A value of the frame was clipped.
    pub saturated: bool,
}

/// Computes the features at the friction `mu`.
pub fn take(network: &NetworkPlan, inputs: &Inputs, mu: [i64; 2]) -> Features {
    let (columns, rows) = (inputs.sensor.columns, inputs.sensor.rows);
    let (u, stress_sum) = (inputs.u, inputs.contact.stress_sum);
    let sum_bits = 64 - stress_sum.leading_zeros();
    let reciprocal = reciprocal(stress_sum, sum_bits);
    let mut saturated = false;
    let mut moments = [0; 3];
    let mut shares = Vec::with_capacity(columns * rows);
    for (taxel, ((u0, u1), u2)) in u[0].iter().zip(&u[1]).zip(&u[2]).enumerate() {
        let exact = (u0 << FRICTION_FRACTION) + mu[0] * u1 + mu[1] * u2;
        let normal = round_shift(exact, FRICTION_FRACTION + NORMAL_DROP);
        let weight = (-normal).max(0);
        let [x, y] = [taxel % columns, taxel / columns].map(|at| at as i64);
        moments = [moments[0] + weight, moments[1] + weight * x, moments[2] + weight * y];
        let wide = i128::from(normal * reciprocal) << network.stress_left;
        let share = (wide >> sum_bits) as i64;
        let clipped = share.clamp(-largest(STRESS_BITS), largest(STRESS_BITS));
        saturated |= clipped != share;
        shares.push(clipped);
    }
    let [sum, along_x, along_y] = moments;
    // Without compression any place does: there is nothing to see.
    let centroid = [along_x, along_y].map(|moment| match sum {
        0 => 0,
        _ => ratio::divide((moment as u64) << CENTRE_FRACTION, sum as u64) as i64,
    });
    let centre = centroid.map(|at| (at + CENTRE_HALF) >> CENTRE_FRACTION);
    let at = |[x, y]: [i64; 2]| {
        let inside = (0..columns as i64).contains(&x) && (0..rows as i64).contains(&y);
        if inside { shares[y as usize * columns + x as usize] } else { 0 }
    };
    let mut inputs = Vec::with_capacity(network.length);
    for y in 0..=network.half_window[1] as i64 {
        for x in 0..=network.half_window[0] as i64 {
            let [a, b, c, d] = std::array::from_fn(|image| {
                // On the middle row or column of the window images coincide: only the first of them counts.
                let [mirrored_x, mirrored_y] = [image & 1 == 1, image & 2 == 2];
                if (mirrored_x && x == 0) || (mirrored_y && y == 0) {
                    return 0;
                }
                let sign = |mirrored: bool, distance: i64| if mirrored { -distance } else { distance };
                at([centre[0] + sign(mirrored_x, x), centre[1] + sign(mirrored_y, y)])
            });
            inputs.push([a + b + c + d, a - b + c - d, a + b - c - d, a - b - c + d]);
        }
    }
    let finer = INPUT_FRACTION - FRICTION_FRACTION;
    let [mu_x, mu_y] = mu.map(|component| component << finer);
    let [left_x, left_y] = [0, 1].map(|axis| (centroid[axis] - (centre[axis] << CENTRE_FRACTION)) << finer);
    inputs.extend([[1 << INPUT_FRACTION, mu_x, mu_y, 0], [0, left_x, left_y, 0]]);
    inputs.resize(network.length, [0; COMPONENTS]);
    Features { inputs, saturated }
}

/// `1 / sum` as a factor of `2^-(RECIPROCAL_BITS + sum_bits)`; it has 17 significant bits.
fn reciprocal(sum: i64, sum_bits: u32) -> i64 {
    let normalised = (sum as u64) << (SUM_BITS - sum_bits);
    let quotient = ratio::divide(1 << (SUM_BITS + RECIPROCAL_BITS), normalised);
    quotient.min(largest(SHORT_BITS) as u64) as i64
}
