//! A small network that corrects what the joint estimator systematically gets wrong.
//!
//! The taxels sample the stress; where a contact's edge lies between two of them moves the estimate by several
//! percent, in a way that repeats with the pitch. The network sees the stress that the normal forces alone would
//! cause, in a window that moves with the contact, and adds a bounded amount to the estimate.

use nalgebra::{DMatrix, DVectorView, DVectorViewMut};

use super::constants::{Correction, WEIGHT_FRACTION};
use super::look::Look;

/// The correction of a component is at most this, so that an unforeseen contact is never made much worse.
pub const LARGEST: f64 = 1.0 / 4.0;
/// The mirror images of a look.
pub(crate) const MIRRORS: [[f64; 2]; 4] = [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];

/// The network: one layer of hinges, then two sums.
#[derive(Clone, Debug)]
pub(crate) struct Network {
    pub(crate) half_window: [usize; 2],
    /// One row for each hidden unit.
    hidden: DMatrix<f64>,
    output: [Vec<f64>; 2],
}

/// Memory of the network, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct NetworkScratch {
    inputs: Vec<f64>,
    units: Vec<f64>,
}

impl Network {
    pub(crate) fn new(correction: &Correction) -> Self {
        let step = (-f64::from(WEIGHT_FRACTION)).exp2();
        let weight = |whole: &i32| step * f64::from(*whole);
        let Correction { half_window, hidden, output } = correction;
        let rows = hidden.iter().flatten().map(weight);
        Self {
            half_window: *half_window,
            hidden: DMatrix::from_row_iterator(hidden.len(), Correction::inputs(*half_window), rows),
            output: output.each_ref().map(|weights| weights.iter().map(weight).collect()),
        }
    }

    /// The correction, each component within [`LARGEST`].
    ///
    /// It is the mean over the mirror images of the contact, mirrored back: a mirrored contact gets the mirrored
    /// correction, exactly.
    pub(crate) fn correct(&self, look: &Look, scratch: &mut NetworkScratch) -> [f64; 2] {
        let NetworkScratch { inputs, units } = scratch;
        inputs.resize(look.values.len(), 0.0);
        units.resize(self.hidden.nrows(), 0.0);
        let mut sums = [0.0; 2];
        for signs in MIRRORS {
            look.mirrored(signs, inputs);
            let seen = DVectorView::from_slice(inputs, inputs.len());
            DVectorViewMut::from_slice(units, self.hidden.nrows()).gemv(1.0, &self.hidden, &seen, 0.0);
            for ((sum, sign), weights) in sums.iter_mut().zip(signs).zip(&self.output) {
                let output: f64 = weights.iter().zip(&*units).map(|(weight, unit)| weight * unit.max(0.0)).sum();
                *sum += sign * output;
            }
        }
        sums.map(|sum| (0.25 * sum).clamp(-LARGEST, LARGEST))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirrored_look_has_the_mirrored_correction_and_both_are_bounded() {
        let correction = Correction {
            half_window: [1, 0],
            hidden: vec![vec![4096, -2048, 512, 300, 20, -7, 900, 100], vec![-900, 4096, 77, -100, 5, 80, 1, 50]],
            output: [vec![300, -200], vec![150, 60]],
        };
        let network = Network::new(&correction);
        let correct = |look: &Look| network.correct(look, &mut NetworkScratch::default());
        let seen = Look { half_window: [1, 0], values: vec![-0.3, 0.9, 0.2, 0.4, -0.1, 0.25, 0.4, 1.0] };
        let mut mirror = seen.clone();
        seen.mirrored([-1.0, 1.0], &mut mirror.values);
        assert_ne!(seen, mirror);
        let ([x, y], [mirrored_x, mirrored_y]) = (correct(&seen), correct(&mirror));
        assert!(x.abs() > 1e-4 && (x + mirrored_x).abs() < 1e-15 && (y - mirrored_y).abs() < 1e-15);
        let loud = Look { values: seen.values.iter().map(|value| 1000.0 * value).collect(), ..seen };
        assert_eq!(correct(&loud)[0].abs().to_bits(), LARGEST.to_bits());
    }
}
