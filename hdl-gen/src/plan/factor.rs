//! Factors in fixed point, for one multiplier.

use crate::cores::SHORT_BITS;
use crate::format::{largest, pow2};

/// Width of a factor, which is not negative: the shorter operand of a multiplier.
const FACTOR_BITS: u32 = SHORT_BITS - 1;
/// Bits of [`Factor::bits`].
pub const WITH_FRACTION: u32 = 6 + FACTOR_BITS;

/// A factor with its fraction bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Factor {
    /// In steps of `2^-fraction`.
    pub factor: i64,
    /// Fraction bits.
    pub fraction: u32,
}

impl Factor {
    /// The most exact one of a number below 2^16 that is not negative.
    pub fn new(exact: f64) -> Self {
        let at = |fraction: u32| (exact * pow2(fraction as i32)).round() as i64;
        let fraction = (1..=40).rev().find(|&fraction| at(fraction) <= largest(SHORT_BITS)).unwrap_or(1);
        Self { factor: at(fraction), fraction }
    }

    /// The product, cut to whole steps of the value.
    pub fn times(self, value: i64) -> i64 {
        (self.factor * value) >> self.fraction
    }

    /// As the hardware has it: the fraction bits above the factor.
    pub fn bits(self) -> u64 {
        (u64::from(self.fraction) << FACTOR_BITS) | self.factor.unsigned_abs()
    }
}
