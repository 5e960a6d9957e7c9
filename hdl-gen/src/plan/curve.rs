//! The curve from counts to pascals, in fixed point: the segment of a count, then a straight line.

use golden::design::{Curve, Design};

use super::PlanError;
use super::curve_format::CurveFormat;
use super::gain::{GAIN_BITS, Gain};
use crate::cores::LONG_BITS;
use crate::cores::float_to_fixed::{self, Converted};
use crate::format::{Format, largest, pow2, round_shift};

/// Width of the curve's value, the next multiplier's longer operand.
const VALUE_BITS: u32 = LONG_BITS;
/// Most bits dropped after the product.
pub const MOST_SHIFT: i32 = 40;
/// Beyond every count.
const NEVER: i64 = largest(LONG_BITS);
/// Bits of a segment in the ROM: first count, value there, slope, bits dropped.
pub const SEGMENT_BITS: u32 = LONG_BITS + VALUE_BITS + GAIN_BITS + SHIFT_BITS;
/// Of the bits dropped.
pub const SHIFT_BITS: u32 = 6;

/// One straight piece: `value + round(slope * (number - first) / 2^shift)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// The number with which it begins.
    pub first: i64,
    /// The curve's value there, in steps.
    pub value: i64,
    /// Mantissa of the slope, in steps of the value for one of the number.
    pub slope: i32,
    /// Bits dropped after the product, 1 at least.
    pub shift: u32,
}

/// The curve of one design.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurvePlan {
    /// Exponent of the numbers: `number = round(count * 2^exponent)`.
    pub exponent: i32,
    /// Last number of the curve.
    pub last: i64,
    /// Exponent of a step of the values, in Pa.
    pub lsb: i32,
    /// The segments in ascending order.
    pub segments: Vec<Segment>,
}

impl CurvePlan {
    /// The curve of a design in the numbers of one in RAM, with coarser values where they reach further than those.
    ///
    /// # Errors
    /// [`PlanError::Key`] where it rises too steeply for that.
    pub fn new(design: &Design, curve: &Curve) -> Result<Self, PlanError> {
        let format = CurveFormat::new(design, curve);
        let largest = curve.points.iter().fold(0.0_f64, |most, point| most.max(point[1].abs()));
        let value = Format::covering(largest, VALUE_BITS);
        Self::in_steps(curve, -format.exponent, format.lsb.max(value.lsb))
    }

    /// The curve in numbers whose steps are `2^count_lsb` counts and `2^value_lsb` Pa.
    ///
    /// # Errors
    /// [`PlanError::Key`] where it rises too steeply for that.
    pub fn in_steps(curve: &Curve, count_lsb: i32, value_lsb: i32) -> Result<Self, PlanError> {
        let points: Vec<[i64; 2]> = curve
            .points
            .iter()
            .map(|[at, pascals]| [at * pow2(-count_lsb), pascals * pow2(-value_lsb)].map(|x| x.round() as i64))
            .collect();
        let segment = |(pair, real): (&[[i64; 2]], &[[f64; 2]])| {
            let [[a, p], [b, q]] = [pair[0], pair[1]];
            let steep = || {
                PlanError::Key(format!(
                    "[sensor] curve: between the counts {} and {} it rises so steeply that the hardware's numbers have no \
                     step for it; move the points apart, or leave one out",
                    real[0][0], real[1][0]
                ))
            };
            if a == b {
                return Err(steep());
            }
            let Gain { mantissa, exponent } = Gain::new((q - p) as f64 / (b - a) as f64);
            // A slope of next to nothing has fewer bits.
            let dropped = (-exponent - MOST_SHIFT).max(0);
            if exponent >= 0 {
                return Err(steep());
            }
            let slope = round_shift(i64::from(mantissa), dropped.min(60) as u32) as i32;
            Ok(Segment { first: a, value: p, slope, shift: (-exponent - dropped) as u32 })
        };
        let segments = points.windows(2).zip(curve.points.windows(2)).map(segment).collect::<Result<_, _>>()?;
        let last = points.last().map_or(0, |point| point[0]);
        Ok(Self { exponent: -count_lsb, last, lsb: value_lsb, segments })
    }

    /// The value of a number.
    pub fn value(&self, number: i64) -> i64 {
        let number = number.clamp(self.segments[0].first, self.last);
        let index = self.segments[1..].partition_point(|segment| segment.first <= number);
        let Segment { first, value, slope, shift } = self.segments[index];
        value + round_shift(i64::from(slope) * (number - first), shift)
    }

    /// The numbers' largest magnitude: counts are clipped there, and say so.
    pub fn reach(&self) -> i64 {
        self.segments[0].first.abs().max(self.last.abs())
    }

    /// The value at a count, given as float32, in steps. It is saturated at an end of the curve.
    pub fn value_of(&self, count: u32) -> Converted {
        let number = float_to_fixed::convert(count, self.exponent, self.reach() as u32);
        Converted { fixed: self.value(i64::from(number.fixed)) as i32, ..number }
    }

    /// Comparisons that find a segment, one after the other.
    pub fn levels(&self) -> u32 {
        self.segments.len().next_power_of_two().trailing_zeros().max(1)
    }

    /// The first number of each segment, as many as the comparisons can tell apart.
    pub fn knots(&self) -> Vec<i64> {
        let firsts = self.segments.iter().map(|segment| segment.first);
        firsts.chain(std::iter::repeat(NEVER)).take(1 << self.levels()).collect()
    }

    /// The segments as words of the ROM, as many as the comparisons can tell apart.
    pub fn words(&self) -> Vec<u128> {
        let field = |value: i64, bits: u32| u128::from(value as u64 & ((1 << bits) - 1));
        let word = |segment: &Segment| {
            let line = field(segment.first, 27) << VALUE_BITS | field(segment.value, VALUE_BITS);
            // What the hardware's last bit rounds is not dropped before.
            (line << GAIN_BITS | field(segment.slope.into(), GAIN_BITS)) << SHIFT_BITS | u128::from(segment.shift - 1)
        };
        let mut words: Vec<u128> = self.segments.iter().map(word).collect();
        words.resize(1 << self.levels(), 0);
        words
    }
}

/// Pipeline registers from a number to its value, found by so many comparisons.
pub fn stages(levels: u32) -> u64 {
    u64::from(levels) + 7
}
