//! Formats of the numbers along a curve from counts to pascals.

use golden::design::{Curve, Design, Samples};

use crate::cores::LONG_BITS;
use crate::format::{Format, largest};

/// Width of a count on the curve: the difference of two is the longer operand of a multiplier.
pub const COUNT_BITS: u32 = LONG_BITS - 1;
/// Room for so many segments, at least.
const LEAST_ROOM: usize = 16;
/// A curve's values have room for so many full scales.
const VALUE_SCALES: f64 = 8.0;
/// Where the design's curve ends, and counts are floats, another one may end so much later.
const COUNT_SCALES: f64 = 2.0;
/// Largest magnitude of a value: the end of a segment may be beyond the next one's by what the rounding of a slope leaves.
pub const MOST_VALUE: i64 = largest(LONG_BITS) - (1 << 12);
/// Words of a segment in a bank, and behind all of them.
pub const SEGMENT_WORDS: usize = 4;
const END_WORDS: usize = 3;

/// The numbers of a design's curves: what every curve in a bank has in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurveFormat {
    /// Segments for which a bank has room, a power of two.
    pub room: usize,
    /// `number = round(count * 2^exponent)`.
    pub exponent: i32,
    /// A step of the values is `2^lsb` Pa.
    pub lsb: i32,
}

impl CurveFormat {
    /// That of a design with this curve.
    pub fn new(design: &Design, curve: &Curve) -> Self {
        let counts = match design.hardware.samples {
            Samples::Float32 => COUNT_SCALES * curve.largest_count(),
            Samples::Int16 => curve.largest_count().max(-f64::from(i16::MIN)),
            Samples::Uint16 => curve.largest_count().max(f64::from(u16::MAX)),
        };
        let values = VALUE_SCALES * design.hardware.full_scale_pa * largest(LONG_BITS) as f64;
        Self {
            room: (curve.points.len() - 1).next_power_of_two().max(LEAST_ROOM),
            exponent: -Format::covering(counts, COUNT_BITS).lsb,
            lsb: Format::covering(values / MOST_VALUE as f64, LONG_BITS).lsb,
        }
    }

    /// Comparisons that find a segment, one after the other.
    pub fn levels(&self) -> u32 {
        self.room.trailing_zeros()
    }

    /// Words of a bank that a curve takes.
    pub fn length(&self) -> usize {
        SEGMENT_WORDS * self.room + END_WORDS
    }
}
