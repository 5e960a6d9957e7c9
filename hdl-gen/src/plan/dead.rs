//! Dead taxels: the weights of the others, in fixed point.

use golden::dead_taxels::DeadTaxels;
use golden::design::Design;

use crate::cores::SHORT_BITS;
use crate::format::{Format, largest, pow2, round_shift};

/// Width of a weight: the shorter operand of a multiplier.
pub const WEIGHT_BITS: u32 = SHORT_BITS;
/// Most that the magnitudes of a sum's weights add up to: with it the accumulator holds any frame.
pub const MOST_WEIGHT: i64 = (1 << 21) - 1;
/// One in this many of a frame's stress is the most that may be replaced: [`golden::dead_taxels::GUESSED`].
pub const GUESSED_SHARE: i64 = (1.0 / golden::dead_taxels::GUESSED) as i64;

/// What takes the place of dead taxels' readings: `round(sum of weight * stress / 2^shift)`, clipped to the full scale.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeadPlan {
    /// The dead taxels, in ascending order.
    pub taxels: Vec<usize>,
    /// For each of them the weights of all taxels; those of dead ones are 0.
    pub weights: Vec<Vec<i32>>,
    /// Fraction bits of the weights.
    pub shift: u32,
}

impl DeadPlan {
    /// The weights, if the design has dead taxels and they stand in ROM.
    pub fn new(design: &Design) -> Option<Self> {
        let given = !design.input.dead.is_empty() && design.input.room == 0;
        given.then(|| Self::of(design, &design.input.dead))
    }

    /// The weights for dead taxels of a design's sensor, in ascending order.
    pub fn of(design: &Design, dead: &[usize]) -> Self {
        let dead = DeadTaxels::new(&design.sensor, design.algorithm.kernel, dead);
        let rounded = |weight: f64, shift: u32| (weight * pow2(shift as i32)).round() as i64;
        let fits = |shift: &u32| {
            dead.weights().iter().all(|weights| {
                let steps = || weights.iter().map(|&weight| rounded(weight, *shift).abs());
                steps().all(|weight| weight <= largest(WEIGHT_BITS)) && steps().sum::<i64>() <= MOST_WEIGHT
            })
        };
        let shift = (0..WEIGHT_BITS).rev().find(fits).unwrap_or(0);
        let of = |weights: &Vec<f64>| weights.iter().map(|&weight| rounded(weight, shift) as i32).collect();
        Self { taxels: dead.taxels().to_vec(), weights: dead.weights().iter().map(of).collect(), shift }
    }

    /// Replaces the readings of a frame; whether a sum was clipped.
    pub fn replace(&self, stress: &mut [i64], format: Format) -> bool {
        let mut saturated = false;
        // A dead taxel's own weight is 0, so that the order does not matter.
        for (&taxel, weights) in self.taxels.iter().zip(&self.weights) {
            let sum: i64 = weights.iter().zip(&*stress).map(|(&weight, stress)| i64::from(weight) * stress).sum();
            let rounded = round_shift(sum, self.shift);
            stress[taxel] = rounded.clamp(-format.bound, format.bound);
            saturated |= stress[taxel] != rounded;
        }
        saturated
    }

    /// Each taxel's weights in all sums, taxel by taxel.
    pub fn words(&self) -> Vec<Vec<i32>> {
        let taxels = self.weights.first().map_or(0, Vec::len);
        (0..taxels).map(|taxel| self.weights.iter().map(|weights| weights[taxel]).collect()).collect()
    }
}
