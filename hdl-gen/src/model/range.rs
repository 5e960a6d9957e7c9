//! A range of its own for each frame, in integers: what `sptfra_frame_scale` and the output do.

use crate::plan::{Plan, SUMMARY_WORDS, words};

/// Bits of the fraction of a float32.
const FRACTION_BITS: u32 = 23;
/// Its sign.
const SIGN: u32 = 1 << 31;

/// A frame's stress as the lanes see it.
pub struct Scaled {
    /// Of each taxel.
    pub stress: Vec<i64>,
    /// The power of two by which it is larger than what was read.
    pub exponent: u32,
    /// Variance of the noise in it over that of a frame, as [`crate::plan::smoothing::Average`] has it.
    pub variance: i64,
}

impl Scaled {
    /// Of what was read: as it is where all frames have the range of the full scale, else by the largest power of two that
    /// keeps it within that.
    pub fn new(plan: &Plan, stress: &[i64], variance: i64) -> Self {
        let (bound, largest) = (plan.formats.stress.bound, stress.iter().map(|stress| stress.abs()).max().unwrap_or(0));
        let exponent = if plan.scales_frames() && largest > 0 { (bound / largest).ilog2() } else { 0 };
        Self { stress: stress.iter().map(|stress| stress << exponent).collect(), exponent, variance }
    }

    /// Gives an answer's forces, torques and standard error the range of what was read.
    pub fn back(&self, answer: &mut [u32]) {
        let of_summary = (words::FORCE..words::MU).chain([words::STANDARD_ERROR]);
        for index in of_summary.chain(SUMMARY_WORDS..answer.len()) {
            answer[index] = lower(answer[index], self.exponent);
        }
    }
}

/// A float32 over `2^exponent`; what is below the smallest normal number becomes a zero of its sign.
fn lower(float: u32, exponent: u32) -> u32 {
    if (float & !SIGN) >> FRACTION_BITS <= exponent { float & SIGN } else { float - (exponent << FRACTION_BITS) }
}

#[cfg(test)]
mod tests {
    use super::lower;

    #[test]
    fn forces_are_scaled_back_exactly_or_vanish() {
        for (value, exponent, expected) in [
            (3.5_f32, 2, 0.875_f32),
            (-1.0, 26, -1.0 / 67_108_864.0),
            (0.0, 7, 0.0),
            (f32::MIN_POSITIVE, 0, f32::MIN_POSITIVE),
            (f32::MIN_POSITIVE, 1, 0.0),
            (-3.0 * f32::MIN_POSITIVE, 2, -0.0),
            (-3.0 * f32::MIN_POSITIVE, 1, -1.5 * f32::MIN_POSITIVE),
        ] {
            assert_eq!(lower(value.to_bits(), exponent), expected.to_bits(), "{value} {exponent}");
        }
    }
}
