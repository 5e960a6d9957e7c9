//! A small network that corrects what the grid search systematically gets wrong.
//!
//! The taxels sample the stress; where a contact's edge lies between two of them moves the estimate by several
//! percent, in a way that repeats with the pitch. The network sees the stress that the normal forces alone would
//! cause, in a window that moves with the contact, and adds a bounded amount to the estimate.

use super::constants::{Correction, WEIGHT_FRACTION};
use super::features::Features;
use crate::parity::{CLASSES, Quads, butterfly};

/// The correction of a component is at most this, so that an unforeseen contact is never made much worse.
pub const LARGEST: f64 = 1.0 / 4.0;
/// Words that are added to the sums in one pass over these, one after the other.
const TOGETHER: usize = 4;
/// Classes of the inputs behind the window: odd in x, odd in y, the same again, even.
pub(crate) const EXTRA_CLASSES: [usize; 5] = [1, 2, 1, 2, 0];

/// The network: one layer of hinges, then two sums.
///
/// Mirrored features only differ in the signs of what is odd in x or y. So window and weights stand in the basis of the parity
/// classes, and one product gives the hidden units of all four mirror images.
#[derive(Clone, Debug)]
pub(crate) struct Network {
    pub(crate) half_window: [usize; 2],
    /// Members of each quad of the window, each once: index in the features, and the sign's bits.
    window: Vec<Vec<(usize, usize)>>,
    /// Weights of all hidden units for each word of inputs and class, a word for each quad and one for each other input,
    /// the units next to each other.
    hidden: Vec<[Vec<f64>; CLASSES]>,
    output: [Vec<f64>; 2],
}

/// Memory of the network, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct NetworkScratch {
    /// Words of inputs, by class.
    inputs: Vec<[f64; CLASSES]>,
    /// The hidden units' sums by class.
    sums: [Vec<f64>; CLASSES],
}

impl Network {
    pub(crate) fn new(correction: &Correction) -> Self {
        let step = (-f64::from(WEIGHT_FRACTION)).exp2();
        let Correction { half_window, hidden, output } = correction;
        let [half_x, half_y] = *half_window;
        let quads = Quads::new(2 * half_x + 1, 2 * half_y + 1);
        let weight = |unit: &Vec<i32>, input: usize| step * f64::from(unit[input]);
        let mut words: Vec<[Vec<f64>; CLASSES]> = Vec::new();
        let mut window = Vec::new();
        for quad in 0..quads.count() {
            let members: Vec<(usize, usize)> = quads.distinct(quad).collect();
            // The classes' shares: a weight of a member is their sum with its signs.
            let classes = hidden.iter().map(|unit| {
                let mut values = [0.0; CLASSES];
                for &(member, place) in &members {
                    values[member] = weight(unit, place);
                }
                let sums = butterfly(values);
                let share = |class: usize| if quads.exists(class, quad) { sums[class] } else { 0.0 };
                [0, 1, 2, 3].map(|class| share(class) / members.len() as f64)
            });
            words.push(by_class(classes));
            window.push(members.into_iter().map(|(member, place)| (place, member)).collect());
        }
        for (offset, of) in EXTRA_CLASSES.into_iter().enumerate() {
            words.push(by_class(hidden.iter().map(|unit| {
                let mut values = [0.0; CLASSES];
                values[of] = weight(unit, quads.taxels() + offset);
                values
            })));
        }
        let output = output.each_ref().map(|weights| weights.iter().map(|of| step * f64::from(*of)).collect());
        Self { half_window: *half_window, window, hidden: words, output }
    }

    /// The correction, each component within [`LARGEST`].
    ///
    /// It is the mean over the mirror images of the contact, mirrored back: a mirrored contact gets the mirrored
    /// correction, exactly.
    pub(crate) fn correct(&self, features: &Features, scratch: &mut NetworkScratch) -> [f64; 2] {
        let units = self.output[0].len();
        for sums in &mut scratch.sums {
            sums.clear();
            sums.resize(units, 0.0);
        }
        scratch.inputs.clear();
        scratch.inputs.extend(self.window.iter().map(|members| {
            let mut values = [0.0; CLASSES];
            for &(place, member) in members {
                values[member] = features.values[place];
            }
            butterfly(values)
        }));
        let behind = features.values.len() - EXTRA_CLASSES.len();
        scratch.inputs.extend(EXTRA_CLASSES.into_iter().enumerate().map(|(offset, of)| {
            let mut values = [0.0; CLASSES];
            values[of] = features.values[behind + offset];
            values
        }));
        for (weights, inputs) in self.hidden.chunks(TOGETHER).zip(scratch.inputs.chunks(TOGETHER)) {
            for (class, sums) in scratch.sums.iter_mut().enumerate() {
                add(sums, weights, inputs, class);
            }
        }
        let [a, b, c, d] = &scratch.sums;
        let mut sums = [0.0; 2];
        for unit in 0..units {
            let images = butterfly([a[unit], b[unit], c[unit], d[unit]]).map(|sum| sum.max(0.0));
            let [_, odd_x, odd_y, _] = butterfly(images);
            sums[0] += self.output[0][unit] * odd_x;
            sums[1] += self.output[1][unit] * odd_y;
        }
        sums.map(|sum| (0.25 * sum).clamp(-LARGEST, LARGEST))
    }
}

/// Adds a class of a few words to the units' sums, word after word.
fn add(sums: &mut [f64], weights: &[[Vec<f64>; CLASSES]], inputs: &[[f64; CLASSES]], class: usize) {
    if let ([a, b, c, d], [of_a, of_b, of_c, of_d]) = (weights, inputs) {
        let weights = a[class].iter().zip(&b[class]).zip(c[class].iter().zip(&d[class]));
        let [of_a, of_b, of_c, of_d] = [of_a, of_b, of_c, of_d].map(|of| of[class]);
        for (sum, ((a, b), (c, d))) in sums.iter_mut().zip(weights) {
            *sum = *sum + a * of_a + b * of_b + c * of_c + d * of_d;
        }
    } else {
        for (weights, input) in weights.iter().zip(inputs) {
            sums.iter_mut().zip(&weights[class]).for_each(|(sum, weight)| *sum += weight * input[class]);
        }
    }
}

/// What the units have by class, the units next to each other.
fn by_class(units: impl Iterator<Item = [f64; CLASSES]>) -> [Vec<f64>; CLASSES] {
    let mut classes: [Vec<f64>; CLASSES] = Default::default();
    for unit in units {
        classes.iter_mut().zip(unit).for_each(|(class, value)| class.push(value));
    }
    classes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One mirror image after the other, as the correction is defined.
    fn directly(correction: &Correction, features: &Features) -> [f64; 2] {
        let weight = |whole: i32| f64::from(whole) * (-f64::from(WEIGHT_FRACTION)).exp2();
        let mut sums = [0.0; 2];
        for signs in [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]] {
            let mut inputs = features.values.clone();
            features.mirrored(signs, &mut inputs);
            for (unit, weights) in correction.hidden.iter().enumerate() {
                let sum: f64 = weights.iter().zip(&inputs).map(|(&of, input)| weight(of) * input).sum();
                for axis in 0..2 {
                    sums[axis] += signs[axis] * weight(correction.output[axis][unit]) * sum.max(0.0);
                }
            }
        }
        sums.map(|sum| 0.25 * sum)
    }

    #[test]
    fn the_classes_give_the_mean_over_the_mirror_images() {
        let numbers = |length: usize, seed: i32| -> Vec<i32> {
            (0..length as i32).map(|at| (at * at * 37 + at * seed) % 701 - 350).collect()
        };
        for half_window in [[1, 2], [0, 1], [2, 0]] {
            let length = Correction::inputs(half_window);
            let hidden = (1..6).map(|unit| numbers(length, 91 * unit)).collect();
            let correction = Correction { half_window, hidden, output: [numbers(5, 3), numbers(5, 8)] };
            let values = numbers(length, 55).into_iter().map(|value| f64::from(value) / 700.0).collect();
            let seen = Features { half_window, values };
            let found = Network::new(&correction).correct(&seen, &mut NetworkScratch::default());
            let wanted = directly(&correction, &seen);
            assert!(wanted.iter().all(|sum| sum.abs() > 1e-6), "{wanted:?}");
            for (found, wanted) in found.into_iter().zip(wanted) {
                assert!((found - wanted.clamp(-LARGEST, LARGEST)).abs() < 1e-12, "{half_window:?}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn mirrored_features_have_the_mirrored_correction_and_both_are_bounded() {
        let correction = Correction {
            half_window: [1, 0],
            hidden: vec![vec![4096, -2048, 512, 300, 20, -7, 900, 100], vec![-900, 4096, 77, -100, 5, 80, 1, 50]],
            output: [vec![300, -200], vec![150, 60]],
        };
        let network = Network::new(&correction);
        let correct = |features: &Features| network.correct(features, &mut NetworkScratch::default());
        let seen = Features { half_window: [1, 0], values: vec![-0.3, 0.9, 0.2, 0.4, -0.1, 0.25, 0.4, 1.0] };
        let mut mirror = seen.clone();
        seen.mirrored([-1.0, 1.0], &mut mirror.values);
        assert_ne!(seen, mirror);
        let ([x, y], [mirrored_x, mirrored_y]) = (correct(&seen), correct(&mirror));
        assert!(x.abs() > 1e-4 && (x + mirrored_x).abs() < 1e-15 && (y - mirrored_y).abs() < 1e-15);
        let loud = Features { values: seen.values.iter().map(|value| 1000.0 * value).collect(), ..seen };
        assert_eq!(correct(&loud)[0].abs().to_bits(), LARGEST.to_bits());
    }
}
