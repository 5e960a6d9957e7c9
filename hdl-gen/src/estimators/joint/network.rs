//! The network of the correction in integers: weights by parity, formats that its sums cannot leave.
//!
//! A mirrored window changes the signs of what is odd in x or y. So the window is folded into parity components, the
//! weights too, and one pass over the weights gives the four sums from which the hidden units of all four images follow.

use golden::estimators::joint::{Correction, EXTRA_INPUTS, STRESS_SCALE, WEIGHT_FRACTION, WEIGHT_LIMIT};
use golden::parity::{COMPONENTS, sign};
use serde::Serialize;

use crate::estimators::block::WEIGHT_BITS;
use crate::format::{FRICTION_FRACTION, largest, pow2, round_shift};

/// Fraction bits of an input.
pub const INPUT_FRACTION: u32 = 19;
/// Width of a value of the window: what is beyond is clipped, with a status bit.
pub const STRESS_BITS: u32 = 25;
/// Width of an input, a folded value of the window: four of them added.
pub const INPUT_BITS: u32 = STRESS_BITS + 2;
/// Width of a hidden unit's sum before the rectifier.
pub const UNIT_BITS: u32 = 26;
/// Fewest words of a pass beyond its units: while it lasts, those of the pass before are read out one by one.
const LENGTH_OVER_UNITS: usize = 4;
/// Sum of the coefficients' magnitudes below which products with 27 bits do not overflow 48.
const SUM_LIMIT: i64 = 1 << 21;
// A weight of a design file, as it is, fits the readout.
const _: () = assert!(WEIGHT_LIMIT <= 1 << (WEIGHT_BITS - 1));
/// Bits that the stress at the centroid is coarser than `u`: three of them are added with factors up to 1.25.
pub const NORMAL_DROP: u32 = 2;
/// Fraction bits of the reciprocal of the normalised `sum |b|`.
pub const RECIPROCAL_BITS: u32 = 16;

/// A hidden unit's weights of one word of inputs, by component.
type ByComponent = [i32; COMPONENTS];

/// The network of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NetworkPlan {
    /// Taxels on either side of the centre of the window.
    pub half_window: [usize; 2],
    /// Words of inputs, four components each: places of a quarter of the window, then the other inputs, then zeros.
    pub length: usize,
    /// Passes over the inputs.
    pub passes: usize,
    /// Hidden units of a pass, and so sums of each component.
    pub at_once: usize,
    /// One step of a weight is worth `2^weight_lsb`.
    pub weight_lsb: i32,
    /// One step of a weight in the output is worth `2^readout_lsb`.
    pub readout_lsb: i32,
    /// Left shift of a stress times the reciprocal, before the shift by the bits of `sum |b|`.
    pub stress_left: u32,
    /// Bits dropped from a component's sum.
    pub unit_shift: u32,
    /// Bits dropped from the sum of the output; negative: added.
    pub correction_shift: i32,
    /// Weights by pass and word, of each unit of the pass.
    #[serde(skip)]
    pub weights: Vec<Vec<ByComponent>>,
    /// Weights of each hidden unit in the x and the y component.
    #[serde(skip)]
    pub readout: Vec<[i32; 2]>,
}

impl NetworkPlan {
    /// Splits and quantises the weights of a correction, for stresses `u` with steps `2^coarser` times those of `b`, and
    /// multipliers that are worth it beside so many `lanes`.
    pub(super) fn new(correction: &Correction, coarser: i32, lanes: usize) -> Self {
        let half_window = correction.half_window;
        let units: Vec<Vec<[f64; COMPONENTS]>> =
            correction.hidden.iter().map(|row| by_parity(row, half_window)).collect();
        let at_once = at_once(lanes);
        let length = units.first().map_or(0, Vec::len).max(at_once + LENGTH_OVER_UNITS);
        let passes = units.len().div_ceil(at_once);

        // Two bits finer than the weights as they were found: a parity's share of one is a quarter of four's sum.
        let mut weight_lsb = -(WEIGHT_FRACTION as i32) - 2;
        let fixed = |weight: f64, lsb: i32| (weight * pow2(-lsb)).round() as i64;
        let fits = |lsb: i32| {
            let sum = |unit: &Vec<ByRealComponent>, component: usize| -> i64 {
                unit.iter().map(|weights| fixed(weights[component], lsb).abs()).sum()
            };
            let narrow = |weight: &f64| fixed(*weight, lsb).abs() <= largest(WEIGHT_BITS);
            units.iter().flatten().flatten().all(narrow)
                && units.iter().all(|unit| (0..COMPONENTS).all(|component| sum(unit, component) < SUM_LIMIT))
        };
        while !fits(weight_lsb) {
            weight_lsb += 1;
        }
        let mut weights = vec![vec![[0; COMPONENTS]; at_once]; passes * length];
        for (index, unit) in units.iter().enumerate() {
            for (word, of_component) in unit.iter().enumerate() {
                weights[index / at_once * length + word][index % at_once] =
                    of_component.map(|weight| fixed(weight, weight_lsb) as i32);
            }
        }

        // A unit is a sum of weights times values of the window, each below 2^24; a component's sum is the mean of four
        // units but for signs. One bit less than the width, so that two units may be added.
        let row = |row: &Vec<i32>| row.iter().map(|weight| i64::from(weight.abs())).sum::<i64>();
        let most = correction.hidden.iter().map(row).max().unwrap_or(0);
        let slack = i128::from(length as u32) << (INPUT_BITS + 2); // what rounding the weights adds, at most
        let bound = scaled(i128::from(most) << (STRESS_BITS - 1), -(WEIGHT_FRACTION as i32) - weight_lsb) + slack;
        let mut unit_shift = 0;
        while (bound >> unit_shift) + COMPONENTS as i128 >= 1 << (UNIT_BITS - 1) {
            unit_shift += 1;
        }

        let mut drop = 0;
        let [along_x, along_y] = correction.output.each_ref().map(Vec::as_slice);
        let readout = |drop: u32| [along_x, along_y].map(|of| of.iter().map(|&v| dropped(v, drop)).collect());
        let sums = |readout: &[Vec<i32>; 2]| readout.iter().map(row).max().unwrap_or(0);
        let mut chosen: [Vec<i32>; 2] = readout(drop);
        while sums(&chosen) >= SUM_LIMIT {
            drop += 1;
            chosen = readout(drop);
        }
        let readout_lsb = drop as i32 - WEIGHT_FRACTION as i32;
        let [along_x, along_y] = chosen;
        let readout: Vec<[i32; 2]> = along_x.into_iter().zip(along_y).map(|(x, y)| [x, y]).collect();

        // Of the output: the mean over four images.
        let fraction = INPUT_FRACTION as i32 - weight_lsb - unit_shift as i32 - readout_lsb + 2;
        Self {
            half_window,
            length,
            passes,
            at_once,
            weight_lsb,
            readout_lsb,
            stress_left: stress_left(coarser),
            unit_shift,
            correction_shift: fraction - FRICTION_FRACTION as i32,
            weights,
            readout,
        }
    }

    /// Hidden units, those included that fill up the last pass.
    pub fn units(&self) -> usize {
        self.passes * self.at_once
    }
}

/// Hidden units at a time, each on four multipliers: as many multipliers as lanes, but not fewer than 16.
fn at_once(lanes: usize) -> usize {
    match lanes {
        0..=16 => 4,
        17..=32 => 8,
        _ => 16,
    }
}

/// The same in f64.
type ByRealComponent = [f64; COMPONENTS];

/// One hidden unit's weights by word and component. A place on the middle row or column has fewer images than four, and
/// components without a weight: what is odd vanishes there.
fn by_parity(row: &[i32], half_window: [usize; 2]) -> Vec<ByRealComponent> {
    let [half_x, half_y] = half_window;
    let width = 2 * half_x + 1;
    let window = width * (2 * half_y + 1);
    let real = |index: usize| pow2(-(WEIGHT_FRACTION as i32)) * f64::from(row[index]);
    let mut words = Vec::new();
    for y in 0..=half_y {
        for x in 0..=half_x {
            let vanishes = |bits: usize| (x == 0 && bits & 1 == 1) || (y == 0 && bits & 2 == 2);
            let images: Vec<usize> = (0..COMPONENTS).filter(|&image| !vanishes(image)).collect();
            let at = |image: usize| {
                let column = if image & 1 == 1 { half_x - x } else { half_x + x };
                let line = if image & 2 == 2 { half_y - y } else { half_y + y };
                real(line * width + column)
            };
            let component = |component: usize| {
                if vanishes(component) {
                    return 0.0;
                }
                let sum: f64 = images.iter().map(|&image| sign(component, image) * at(image)).sum();
                sum / images.len() as f64
            };
            words.push(std::array::from_fn(component));
        }
    }
    let extra: [f64; EXTRA_INPUTS] = std::array::from_fn(|index| real(window + index));
    let [mu_x, mu_y, fraction_x, fraction_y, one] = extra;
    words.push([one, mu_x, mu_y, 0.0]);
    words.push([0.0, fraction_x, fraction_y, 0.0]);
    words
}

fn dropped(value: i32, drop: u32) -> i32 {
    round_shift(i64::from(value), drop).clamp(-largest(WEIGHT_BITS), largest(WEIGHT_BITS)) as i32
}

fn scaled(value: i128, left: i32) -> i128 {
    if left >= 0 { value << left } else { (value >> -left) + 1 }
}

/// `STRESS_SCALE n / sum |b|` from `n r` with n coarser than u by [`NORMAL_DROP`] bits and `1 / sum |b|` as
/// `r 2^-(RECIPROCAL_BITS + bits of the sum)`: left shift, before a right shift by the bits of the sum.
fn stress_left(coarser: i32) -> u32 {
    let scale = STRESS_SCALE.log2().round() as i32;
    let left = scale + NORMAL_DROP as i32 + coarser + INPUT_FRACTION as i32 - RECIPROCAL_BITS as i32;
    // The steps of u, which holds the stress, are never so much finer than those of the stress.
    left.max(0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hidden unit of a mirrored window, from the window itself and the weights by parity.
    #[test]
    fn the_parities_give_the_units_of_every_mirror_image() {
        let row: Vec<i32> = (0..20).map(|index| 37 * index * index - 501 * index + 100).collect();
        let features: Vec<f64> = (0..20).map(|index| f64::from(index * 7 % 11) - 4.5).collect();
        let words = by_parity(&row, [1, 2]);
        for signs in 0..COMPONENTS {
            let mut direct = 0.0;
            let mut folded = 0.0;
            for y in 0..5 {
                for x in 0..3 {
                    let from_x = if signs & 1 == 1 { 2 - x } else { x };
                    let from_y = if signs & 2 == 2 { 4 - y } else { y };
                    direct += f64::from(row[y * 3 + x]) * features[from_y * 3 + from_x];
                }
            }
            let sign_x = if signs & 1 == 1 { -1.0 } else { 1.0 };
            let sign_y = if signs & 2 == 2 { -1.0 } else { 1.0 };
            for (index, sign) in [sign_x, sign_y, sign_x, sign_y, 1.0].into_iter().enumerate() {
                direct += f64::from(row[15 + index]) * sign * features[15 + index];
            }
            for component in 0..COMPONENTS {
                let of_component = sign(component, signs);
                for y in 0..3 {
                    for x in 0..2 {
                        let mut input = 0.0;
                        for image in 0..COMPONENTS {
                            if (x == 0 && image & 1 == 1) || (y == 0 && image & 2 == 2) {
                                continue;
                            }
                            let column = if image & 1 == 1 { 1 - x } else { 1 + x };
                            let line = if image & 2 == 2 { 2 - y } else { 2 + y };
                            input += sign(component, image) * features[line * 3 + column];
                        }
                        folded += of_component * words[y * 2 + x][component] * input;
                    }
                }
                let extras = [[features[19], features[15], features[16], 0.0], [0.0, features[17], features[18], 0.0]];
                folded += of_component
                    * (words[6][component] * extras[0][component] + words[7][component] * extras[1][component]);
            }
            assert!((direct / 4096.0 - folded).abs() < 1e-9, "{signs}: {direct} {folded}");
        }
    }
}
