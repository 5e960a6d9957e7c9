//! The standard error in integers, as `sptfra_standard_error` takes the steps.

use golden::design::{Algorithm, Design};
use golden::estimators::{BORDER, ERROR_FRACTION, error_log};
use serde::Serialize;

use crate::cores::LONG_BITS;
use crate::estimators::Contact;
use crate::format::{Format, largest, pow2};
use crate::parameters::Parameters;
use crate::plan::smoothing::VARIANCE_FRACTION;

/// Fraction bits of an error over `|F_z|`.
pub const SHARE_FRACTION: u32 = 16;
/// Fraction bits of the weights of noise and border.
pub const WEIGHT_FRACTION: u32 = 13;
/// Bits of such a weight.
const WEIGHT_BITS: u32 = 17;
/// Bits of an error, of which the lowest ones are never there alone: 2^-10 at least, just below 4 at most.
const SHARE_BITS: u32 = 18;
/// A typical contact's largest stress may be so many times the sum of a frame's: up to `2^(1 + 4)`.
const LARGEST_SHIFT: u32 = 4;
const LARGEST_BITS: u32 = LONG_BITS - LARGEST_SHIFT;
/// Most error by measured noise: that, and the two others, are below `2^23`.
const MOST_NOISE: i64 = (1 << 22) - 1;
const LEAST: i64 = 1 << (SHARE_FRACTION - 10);
/// Share of the stress that is allowed at the border, as a right shift.
const BORDER_SHIFT: u32 = 5;
const _: () = assert!(BORDER == 1.0 / (1 << BORDER_SHIFT) as f64);

/// Constants of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct StandardErrorPlan {
    /// The error of the model, [`SHARE_FRACTION`] fraction bits.
    pub model: i64,
    /// Weight of `max|b| / sum|b|` at the design's noise in a frame, [`WEIGHT_FRACTION`] fraction bits.
    pub noise: i64,
    /// Weight of the border's share, likewise.
    pub border: i64,
    /// The largest stress of a typical contact in sixteen steps of the stress, where the noise was measured.
    pub largest: Option<i64>,
    /// Whether frames are averaged.
    pub averaged: bool,
    /// A frame with a larger logarithm has low confidence, [`ERROR_FRACTION`] fraction bits.
    pub limit: i64,
}

impl StandardErrorPlan {
    /// Of a design whose standard error was fitted.
    pub(crate) fn of(design: &Design, stress: Format) -> Option<Self> {
        let Algorithm { standard_error, max_standard_error, .. } = &design.algorithm;
        let fixed = |value: f64, fraction: u32, bits: u32| {
            ((value * pow2(fraction as i32)).round() as i64).min((1 << bits) - 1)
        };
        standard_error.map(|of| Self {
            model: fixed(of.model, SHARE_FRACTION, SHARE_BITS),
            noise: fixed(of.noise * design.input.noise, WEIGHT_FRACTION, WEIGHT_BITS),
            border: fixed(of.border, WEIGHT_FRACTION, WEIGHT_BITS),
            largest: design
                .input
                .typical_pa()
                .map(|pascals| ((pascals * pow2(-stress.lsb) / pow2(LARGEST_SHIFT as i32)).round() as i64).max(1)),
            averaged: design.input.smoothing > 0,
            limit: (error_log(*max_standard_error) * pow2(ERROR_FRACTION as i32)).round() as i64,
        })
    }

    /// Parameters of an estimator that has it.
    pub fn parameters(&self, parameters: Parameters) -> Parameters {
        parameters
            .flag("WITH_ERROR", true)
            .flag("ERROR_AVERAGED", self.averaged)
            .unsigned("ERROR_MODEL", SHARE_BITS, self.model as u64)
            .unsigned("ERROR_NOISE", WEIGHT_BITS, self.noise as u64)
            .unsigned("ERROR_BORDER", WEIGHT_BITS, self.border as u64)
            .some(self.largest, |all, largest| all.unsigned("ERROR_LARGEST", LARGEST_BITS, largest as u64))
    }

    /// The logarithm of base 2 of the error over `|F_z|`, [`ERROR_FRACTION`] fraction bits, in a frame that is scaled by
    /// `2^exponent`, where this variance is left of its noise, [`VARIANCE_FRACTION`] fraction bits.
    pub fn log(&self, contact: &Contact, exponent: u32, variance: i64) -> i64 {
        let sum = contact.stress_sum;
        let excess = (contact.border - (sum >> BORDER_SHIFT)).max(0);
        let weight = (self.noise * variance.isqrt()) >> (VARIANCE_FRACTION / 2);
        let noise = match self.largest {
            None => weighed(contact.largest, sum, weight) >> WEIGHT_FRACTION,
            Some(largest) => {
                let sixteenths = weighed((largest << exponent).min(2 * sum - 1), sum, weight);
                (sixteenths >> (WEIGHT_FRACTION - LARGEST_SHIFT)).min(MOST_NOISE)
            }
        };
        let border = weighed(excess, sum, self.border) >> WEIGHT_FRACTION;
        let total = added(added(self.model, noise), border);
        let share = total.clamp(LEAST, largest(SHARE_BITS + 1));
        let whole = i64::from(share.ilog2()) - i64::from(SHARE_FRACTION);
        let fraction = (share << (63 - share.ilog2())) as u64 >> (63 - ERROR_FRACTION);
        (whole << ERROR_FRACTION) + (fraction & ((1 << ERROR_FRACTION) - 1)) as i64
    }
}

/// `weight part / sum`, with [`SHARE_FRACTION`] fraction bits more than the weight; the quotient, below 2, bit by bit.
fn weighed(part: i64, sum: i64, weight: i64) -> i64 {
    let (mut remainder, mut total) = (part, 0);
    for _ in 0..=SHARE_FRACTION {
        let fits = remainder >= sum;
        total = 2 * total + if fits { weight } else { 0 };
        remainder = 2 * (remainder - if fits { sum } else { 0 });
    }
    total
}

/// Two errors together, as [`golden::estimators`] adds them.
fn added(x: i64, y: i64) -> i64 {
    let (larger, smaller) = (x.max(y), x.min(y));
    larger.max(larger - (larger >> 3) + (smaller >> 1))
}

#[cfg(test)]
mod tests {
    use golden::design::Design;

    use crate::plan::Plan;
    use crate::timing::latency::STANDARD_ERROR;

    #[test]
    fn no_search_ends_before_the_standard_error() {
        for estimator in ["\"line\"", "\"joint\"\ngain = 1\nfriction_correction = [1, 0]"] {
            let text = format!(
                "format = 3\nname = \"least\"\n[sensor]\ncolumns = 2\nrows = 2\npitch_mm = [4, 4]\ndepth_mm = 3\n\
                 [algorithm]\nestimator = {estimator}\n[hardware]\nlanes = 128\n"
            );
            let plan = Plan::new(&Design::from_toml(&text, "least").unwrap()).unwrap();
            assert!(plan.timeline.search_cycles > STANDARD_ERROR, "{estimator}");
        }
    }
}
