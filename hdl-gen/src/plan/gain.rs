//! Gains in fixed point: a multiplier's shorter operand, an exponent, and what both make of a count.

use super::curve::CurvePlan;
use crate::cores::{LONG_BITS, SHORT_BITS, float_to_fixed};
use crate::format::{Format, largest, pow2, round_shift};

/// Width of a gain's mantissa: the shorter operand of a multiplier.
pub const GAIN_BITS: u32 = SHORT_BITS;
/// Largest magnitude of a number: a count in fixed point, the longer operand.
pub const LARGEST_NUMBER: i64 = largest(LONG_BITS);
/// Bits dropped after the product, at most.
const MOST_SHIFT: u32 = 40;
/// Bits dropped behind a curve, at most: nothing is left of a product.
const MOST_DROP: i32 = 47;
/// Largest gain of a taxel.
const LARGEST_GAIN: f64 = 16.0;

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

    /// The steps of an offset in counts behind a gain. By the gain as it is stored, so that the count of no stress at
    /// all gives none.
    pub(super) fn offset(&self, gain: f64, offset: f64) -> f64 {
        if gain == 0.0 { 0.0 } else { (offset / gain * f64::from(self.mantissa) * pow2(self.exponent)).round() }
    }
}

/// What gains have in common: `stress = round(number * mantissa / 2^shift) + offset`, clipped to the full scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Bits dropped, with rounding, after the product. The number has the gain's exponent and as many bits more.
    pub(super) shift: u32,
    /// Stress from which on a value counts as full scale, in steps: what the rounding of any gain leaves of that.
    pub(super) full_scale: i64,
}

/// What a count becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Stress, clipped to the full scale.
    pub steps: i64,
    /// It was clipped.
    pub saturated: bool,
    /// The count was NaN or an infinity.
    pub not_finite: bool,
}

impl Scale {
    /// That of gains with offsets of so many steps at most, behind a curve in steps of `2^curve` Pa if there is one: a
    /// number at its bound is beyond the full scale by each of them. None where no shift holds both.
    pub(super) fn new(stress: Format, most_offset: i64, curve: Option<i32>) -> Option<Self> {
        // The least mantissa times the largest number is beyond full scale and offset.
        let reach = (most_offset + stress.bound + 1) as f64;
        let least = pow2(GAIN_BITS as i32 - 2) * LARGEST_NUMBER as f64;
        let shift = (0..=MOST_SHIFT).rev().find(|&shift| reach * pow2(shift as i32) <= least)?;
        // A gain's rounding, that of half a number's step, and those of product and offset.
        let rounding = (stress.bound >> (GAIN_BITS - 1)) + (1 << (GAIN_BITS - 2)) / (1 << shift.min(16)) + 3;
        // That of a slope, and the value's at the largest gain.
        let of_curve =
            |lsb: i32| (stress.bound >> (GAIN_BITS - 2)) + (LARGEST_GAIN * pow2(lsb - stress.lsb)).ceil() as i64;
        let rounding = rounding + curve.map_or(0, of_curve);
        Some(Self { shift, full_scale: (stress.bound - rounding).max(1) })
    }

    /// The stress of a count, given as float32, by a gain's mantissa and exponent and an offset. Behind a curve the exponent
    /// is a shift.
    pub(super) fn stress_of(
        self,
        count: u32,
        curve: Option<&CurvePlan>,
        (mantissa, exponent): (i32, i32),
        offset: i64,
        bound: i64,
    ) -> Reading {
        let shift = self.shift as i32;
        let (number, drop) = match curve {
            Some(curve) => (curve.value_of(count), (shift - curve.lsb - exponent).clamp(0, MOST_DROP)),
            None => (float_to_fixed::convert(count, exponent, LARGEST_NUMBER as u32), shift),
        };
        let steps = round_shift(i64::from(number.fixed) * i64::from(mantissa), drop as u32) + offset;
        let clipped = steps.abs() >= self.full_scale;
        let steps = if clipped { steps.signum() * bound } else { steps };
        Reading { steps, saturated: clipped || number.saturated, not_finite: number.not_finite }
    }
}
