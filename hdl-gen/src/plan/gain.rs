//! Gains as a multiplier's shorter operand and an exponent.

use super::format::{largest, pow2};
use crate::cores::SHORT_BITS;

/// Width of a gain's mantissa: the shorter operand of a multiplier.
pub const GAIN_BITS: u32 = SHORT_BITS;

/// A gain in steps of the stress for one count: `mantissa * 2^exponent`.
pub(super) struct Gain {
    pub(super) mantissa: i32,
    pub(super) exponent: i32,
}

impl Gain {
    /// With all of its bits in use; 0 for a gain of 0.
    pub(super) fn new(per_count: f64) -> Self {
        if per_count == 0.0 {
            return Self { mantissa: 0, exponent: 0 };
        }
        let mut exponent = per_count.abs().log2().floor() as i32 + 2 - GAIN_BITS as i32;
        while (per_count.abs() * pow2(-exponent)).round() > largest(GAIN_BITS) as f64 {
            exponent += 1;
        }
        Self { mantissa: (per_count * pow2(-exponent)).round() as i32, exponent }
    }
}
