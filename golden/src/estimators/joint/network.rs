//! A small network that corrects what the grid search systematically gets wrong.
//!
//! The taxels sample the stress; where a contact's edge lies between two of them moves the estimate by several
//! percent, in a way that repeats with the pitch. The network sees the stress that the normal forces alone would
//! cause, in a window that moves with the contact, and adds a bounded amount to the estimate.

use super::constants::{Correction, WEIGHT_FRACTION};
use super::features::Features;
use crate::parity::{COMPONENTS, Orbits, butterfly};
use crate::reduced::FoldedRows;

/// The correction of a component is at most this, so that an unforeseen contact is never made much worse.
pub const LARGEST: f64 = 1.0 / 4.0;
/// Parity components of the inputs behind the window: odd in x, odd in y, the same again, even.
pub(crate) const EXTRA_COMPONENTS: [usize; 5] = [1, 2, 1, 2, 0];

/// The network: one layer of rectifiers, then two sums.
///
/// Mirrored features only differ in the signs of what is odd in x or y. So window and weights stand in the basis of the
/// parity components, and one product gives the hidden units of all four mirror images.
#[derive(Clone, Debug)]
pub(crate) struct Network {
    pub(crate) half_window: [usize; 2],
    /// Images of each orbit of the window, each once: index in the features, and the sign's bits.
    window: Vec<Vec<(usize, usize)>>,
    /// Weights of each hidden unit (rows) by component: a word for each orbit, then one for each other input.
    hidden: FoldedRows,
    output: [Vec<f64>; 2],
}

/// Memory of the network, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct NetworkScratch {
    /// Words of inputs, by component.
    inputs: Vec<[f64; COMPONENTS]>,
    /// The hidden units' sums, by component.
    sums: Vec<[f64; COMPONENTS]>,
}

impl Network {
    pub(crate) fn new(correction: &Correction) -> Self {
        let step = (-f64::from(WEIGHT_FRACTION)).exp2();
        let Correction { half_window, hidden, output } = correction;
        let [half_x, half_y] = *half_window;
        let orbits = Orbits::new(2 * half_x + 1, 2 * half_y + 1);
        let weight = |unit: &Vec<i32>, input: usize| step * f64::from(unit[input]);
        let window: Vec<Vec<(usize, usize)>> = (0..orbits.count())
            .map(|orbit| orbits.distinct(orbit).map(|(image, place)| (place, image)).collect())
            .collect();
        let row = |unit: &Vec<i32>| {
            let of_window = window.iter().enumerate().map(|(orbit, images)| {
                // The components' shares: a weight of an image is their sum with its signs.
                let sums = butterfly(placed(images.iter().map(|&(place, image)| (image, weight(unit, place)))));
                let share = |component: usize| if orbits.exists(component, orbit) { sums[component] } else { 0.0 };
                [0, 1, 2, 3].map(|component| share(component) / images.len() as f64)
            });
            let of_extra = EXTRA_COMPONENTS.into_iter().zip(orbits.taxels()..);
            let words = of_window.chain(of_extra.map(|(component, input)| placed([(component, weight(unit, input))])));
            words.enumerate().map(|(word, weights)| (word as u32, weights)).collect()
        };
        let hidden = FoldedRows { parity: 0, rows: hidden.iter().map(row).collect() };
        let output = output.each_ref().map(|weights| weights.iter().map(|of| step * f64::from(*of)).collect());
        Self { half_window: *half_window, window, hidden, output }
    }

    /// The correction, each component within [`LARGEST`].
    ///
    /// It is the mean over the mirror images of the contact, mirrored back: a mirrored contact gets the mirrored
    /// correction, exactly.
    pub(crate) fn correct(&self, features: &Features, scratch: &mut NetworkScratch) -> [f64; 2] {
        let NetworkScratch { inputs, sums: of_units } = scratch;
        inputs.clear();
        inputs.extend(
            self.window
                .iter()
                .map(|images| butterfly(placed(images.iter().map(|&(place, image)| (image, features.values[place]))))),
        );
        let behind = &features.values[features.values.len() - EXTRA_COMPONENTS.len()..];
        inputs.extend(EXTRA_COMPONENTS.into_iter().zip(behind).map(|(component, &value)| placed([(component, value)])));
        of_units.resize(self.hidden.rows.len(), [0.0; COMPONENTS]);
        self.hidden.times(inputs, of_units);
        let mut sums = [0.0; 2];
        for (unit, &by_component) in of_units.iter().enumerate() {
            let images = butterfly(by_component).map(|sum| sum.max(0.0));
            let [_, odd_x, odd_y, _] = butterfly(images);
            sums[0] += self.output[0][unit] * odd_x;
            sums[1] += self.output[1][unit] * odd_y;
        }
        sums.map(|sum| (0.25 * sum).clamp(-LARGEST, LARGEST))
    }
}

/// Four values, those that are given in their places.
fn placed(values: impl IntoIterator<Item = (usize, f64)>) -> [f64; COMPONENTS] {
    let mut all = [0.0; COMPONENTS];
    values.into_iter().for_each(|(place, value)| all[place] = value);
    all
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
    fn the_components_give_the_mean_over_the_mirror_images() {
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
