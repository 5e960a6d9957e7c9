//! Fixed-point formats: how many bits a number has and what its last bit is worth.

use golden::design::Design;
use serde::Serialize;

use crate::cores::{ACCUMULATOR_BITS, DROPPED_BITS, LONG_BITS, OLDER_LONG_BITS, SHORT_BITS, WIDE_COEFFICIENT_BITS};

/// Fraction bits of the friction components; one integer bit and a sign go with them.
pub const FRICTION_FRACTION: u32 = 16;

/// Width of a friction component.
pub const FRICTION_BITS: u32 = FRICTION_FRACTION + 2;

/// Width of the frame sums `G_pq` and `sum |b|`.
pub const SUM_BITS: u32 = 40;

/// Most cells of an estimator's search that are worth their adders.
pub const MOST_CELLS: usize = 32;

/// With more lanes than these a frame's way past the lanes, and from one of their programs to the next, is worth more
/// cells and multipliers.
pub const MANY_LANES: usize = 64;

/// Elements of a vector, and rows of sums, for which the modules have room at least.
pub const FEWEST_ELEMENTS: usize = 8;

/// Most bits that a product drops between accumulator and result. A matrix whose results are so small beside the
/// others' that it would drop more is stored with fewer bits instead: they would be lost in the rounding.
pub const MOST_SHIFT: u32 = 40;

/// Largest magnitude of a row's sum in the accumulator. Above it is room for the half step that rounding adds.
pub const ACCUMULATOR_LIMIT: i64 = largest(ACCUMULATOR_BITS) - (1 << (MOST_SHIFT - 1));

/// A signed fixed-point format: `value = integer * 2^lsb`, with `|integer| <= bound`.
///
/// The bound is a proven one: no input within the design's full scale can exceed it, so numbers in this
/// format need no saturation logic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Format {
    /// Two's complement width in bits.
    pub bits: u32,
    /// Exponent of the least significant bit: one step is worth `2^lsb` of the unit.
    pub lsb: i32,
    /// Largest magnitude that can occur, in steps.
    pub bound: i64,
}

impl Format {
    /// The finest format of `bits` bits that holds `±limit` (in the unit of the quantity).
    pub fn covering(limit: f64, bits: u32) -> Self {
        let top = largest(bits) as f64;
        let mut lsb = (limit / top).log2().floor() as i32 - 1;
        while (limit * pow2(-lsb)).round() > top {
            lsb += 1;
        }
        Self { bits, lsb, bound: (limit * pow2(-lsb)).round() as i64 }
    }

    /// The upper bits of its numbers, as many as one multiplier takes: what estimators see of `u_q`.
    #[must_use]
    pub fn narrowed(self) -> Self {
        let below = self.bits.saturating_sub(LONG_BITS);
        Self {
            bits: self.bits - below,
            lsb: self.lsb + below as i32,
            bound: (self.bound >> below) + i64::from(below > 0),
        }
    }

    /// The worth of one step in the unit of the quantity.
    pub fn step(self) -> f64 {
        pow2(self.lsb)
    }
}

/// Largest positive integer of a two's complement word of `bits` bits.
pub const fn largest(bits: u32) -> i64 {
    (1 << (bits - 1)) - 1
}

/// What a lane multiplies with, and what of a product it adds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Factors {
    /// Bits of a coefficient.
    pub coefficient_bits: u32,
    /// Bits of an operand.
    pub data_bits: u32,
}

impl Factors {
    /// Of a design.
    pub fn of(design: &Design) -> Self {
        let hardware = &design.hardware;
        Self { coefficient_bits: hardware.coefficient_bits, data_bits: hardware.data_bits }
    }

    /// Whether a lane has two multipliers, because its operands do not fit one.
    pub fn is_wide(self) -> bool {
        self.coefficient_bits > SHORT_BITS || self.data_bits > LONG_BITS
    }

    /// Whether what does not fit is the operand.
    pub fn has_wide_data(self) -> bool {
        self.data_bits > LONG_BITS
    }

    /// Whether a multiplier of 25 by 18 bits takes a lane's operands: of two multipliers together each takes a coefficient
    /// of 27.
    pub fn lane_is_narrow(self) -> bool {
        !self.is_wide() && self.data_bits <= OLDER_LONG_BITS
    }

    /// Whether it takes a vector's element, or each of the parts of one that is multiplied in two.
    pub fn element_is_narrow(self) -> bool {
        self.has_wide_data() || self.data_bits <= OLDER_LONG_BITS
    }

    /// Multipliers of a product.
    pub fn multipliers(self) -> usize {
        if self.is_wide() { 2 } else { 1 }
    }

    /// Bits of each product that are dropped, with rounding, before it is added: fewer of a coefficient that does not fill
    /// two multipliers, since it stands in their upper bits.
    pub fn dropped(self) -> u32 {
        if self.is_wide() { DROPPED_BITS.saturating_sub(WIDE_COEFFICIENT_BITS - self.coefficient_bits) } else { 0 }
    }

    /// The same where friction components take the coefficients' place.
    pub fn dropped_of_friction(self) -> u32 {
        if self.is_wide() { DROPPED_BITS } else { 0 }
    }

    /// Left shift of a friction component that takes a coefficient's place: so that nothing of it is dropped.
    pub fn friction_shift(self) -> u32 {
        if self.is_wide() { WIDE_COEFFICIENT_BITS - FRICTION_BITS } else { 0 }
    }

    /// Bits of a stress before the lanes, and of `u_q` behind them: the estimators multiply in one multiplier.
    pub fn outside_bits(self) -> u32 {
        self.data_bits.min(LONG_BITS)
    }
}

/// `2^exponent` as f64, exact over the whole range of the formats.
pub fn pow2(exponent: i32) -> f64 {
    f64::from(exponent).exp2()
}

/// Bits needed to count from 0 to `count - 1`; at least one.
pub const fn address_bits(count: usize) -> u32 {
    if count <= 2 { 1 } else { usize::BITS - (count - 1).leading_zeros() }
}

/// Rounds `value / 2^shift` to the nearest integer, ties towards plus infinity: what the hardware's
/// add-half-and-shift does.
pub const fn round_shift(value: i64, shift: u32) -> i64 {
    if shift == 0 { value } else { (value + (1 << (shift - 1))) >> shift }
}

/// Four significant digits, or all before the point.
pub fn short(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude != 0.0 && !(1e-3..1e7).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let digits_before = if magnitude < 1.0 { 1.0 } else { magnitude.log10().floor() + 1.0 };
    format!("{value:.*}", (4.0 - digits_before).max(0.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn covering_is_the_finest_format_that_fits() {
        for (limit, bits) in [(100_000.0, 27), (1.0, 18), (0.37, 16), (3e-9, 27)] {
            let format = Format::covering(limit, bits);
            assert!(format.bound <= largest(bits));
            let finer = (limit * pow2(1 - format.lsb)).round() as i64;
            assert!(finer > largest(bits), "{limit} at {bits} bits could use a finer step");
        }
    }

    #[test]
    fn rounding_goes_to_the_nearest_step() {
        assert_eq!(round_shift(5, 1), 3);
        assert_eq!(round_shift(-5, 1), -2);
        assert_eq!(round_shift(-7, 2), -2);
        assert_eq!(round_shift(9, 0), 9);
    }

    #[test]
    fn numbers_are_short() {
        let cases = [(0.0, "0.000"), (0.5, "0.500"), (7.1989, "7.199"), (52.303, "52.30"), (100_000.0, "100000")];
        for (value, text) in cases.into_iter().chain([(3.845e10, "3.845e10"), (0.0005, "5.000e-4")]) {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn address_widths() {
        assert_eq!([1, 2, 3, 4, 5, 512, 513].map(address_bits), [1, 1, 2, 2, 3, 9, 10]);
    }
}
