//! Counts to pascals: what a raw sensor's values are multiplied by and what is added, in fixed point.

use golden::design::{Design, Input};
use serde::Serialize;

use super::PlanError;
use super::format::{Format, largest, pow2, round_shift};
use crate::cores::float_to_fixed;

/// Width of a gain: the shorter operand of a multiplier.
pub const GAIN_BITS: u32 = 18;
/// Width of a count: the longer operand.
const COUNT_BITS: u32 = 27;
/// Widest offset, in steps of the stress: with the product it fits the 48 bits of the sum.
const MOST_OFFSET_BITS: u32 = 44;

/// The conversion of one design: `stress = round(count * gain / 2^shift) + offset`, clipped to the full scale.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CountsPlan {
    /// Counts as they come from the float conversion; a larger one exceeds the full scale on every taxel.
    pub count: Format,
    /// Exponent of a gain's last bit, in Pa.
    pub gain_lsb: i32,
    /// Gain of each taxel, or one for all.
    pub gains: Vec<i32>,
    /// Offset of each taxel in steps of the stress, as many as gains.
    pub offsets: Vec<i64>,
    /// Bits dropped, with rounding, after the product.
    pub shift: u32,
    /// Stress from which on a value counts as full scale, in steps: what the rounding of gains leaves of that.
    pub full_scale: i64,
}

impl CountsPlan {
    /// The conversion, if the design's frames are counts.
    ///
    /// # Errors
    /// [`PlanError::Offset`] when an offset is so far beyond the full scale that it does not fit the sum.
    pub fn new(design: &Design, stress: Format) -> Result<Option<Self>, PlanError> {
        let Input { pa_per_count: Some(pa_per_count), ref calibration, .. } = design.input else { return Ok(None) };
        let (gains, offsets) = match calibration {
            Some(calibration) => (calibration.gain.clone(), calibration.offset.clone()),
            None => (vec![1.0], vec![0.0]),
        };
        let full_scale = design.hardware.full_scale_pa / pa_per_count.abs();
        let pairs = || gains.iter().zip(&offsets);
        let largest_count = pairs().map(|(gain, offset)| (full_scale + offset.abs()) / gain).fold(0.0, f64::max);
        let count = Format::covering(largest_count, COUNT_BITS);
        let largest_gain = gains.iter().fold(0.0_f64, |top, &gain| top.max(gain)) * pa_per_count.abs();
        // As fine as the width allows, but no finer than that the product has a bit below the stress's.
        let mut gain_lsb = Format::covering(largest_gain, GAIN_BITS).lsb.min(stress.lsb - count.lsb);
        while (largest_gain * pow2(-gain_lsb)).round() > largest(GAIN_BITS) as f64 {
            gain_lsb += 1;
        }
        let in_steps = |offset: f64| offset * pa_per_count * pow2(-stress.lsb);
        if let Some(taxel) =
            offsets.iter().position(|&offset| in_steps(offset).abs() > largest(MOST_OFFSET_BITS) as f64)
        {
            return Err(PlanError::Offset { taxel, counts: offsets[taxel], full_scale });
        }
        let mut plan = Self {
            count,
            gain_lsb,
            gains: gains.iter().map(|gain| (gain * pa_per_count * pow2(-gain_lsb)).round() as i32).collect(),
            offsets: offsets.iter().map(|&offset| in_steps(offset).round() as i64).collect(),
            shift: (stress.lsb - count.lsb - gain_lsb).max(0) as u32,
            full_scale: stress.bound,
        };
        plan.full_scale = plan.least_full_scale(design, stress);
        Ok(Some(plan))
    }

    /// The least stress that a taxel's reading of just the full scale, of either sign, becomes.
    fn least_full_scale(&self, design: &Design, stress: Format) -> i64 {
        let full_scale = design.hardware.full_scale_pa;
        (0..self.gains.len())
            .flat_map(|taxel| [full_scale, -full_scale].map(|stress| (taxel, design.input.from_pa(taxel, stress))))
            .map(|(taxel, count)| {
                let bits = (count as f32).to_bits();
                let converted = float_to_fixed::convert(bits, -self.count.lsb, self.count.bound as u32);
                self.to_stress(taxel, i64::from(converted.fixed)).abs()
            })
            .fold(stress.bound, i64::min)
    }

    /// Whether each taxel has a gain and an offset of its own.
    pub fn per_taxel(&self) -> bool {
        self.gains.len() > 1
    }

    /// The stress of a count before it is clipped, in steps.
    pub fn to_stress(&self, taxel: usize, count: i64) -> i64 {
        let index = if self.per_taxel() { taxel } else { 0 };
        round_shift(count * i64::from(self.gains[index]), self.shift) + self.offsets[index]
    }

    /// Bits of the widest offset, sign included.
    pub fn offset_bits(&self) -> u32 {
        let widest = self.offsets.iter().map(|offset| offset.unsigned_abs()).max().unwrap_or(0);
        u64::BITS - widest.leading_zeros() + 1
    }
}

/// Pipeline registers from the stream to the stress in Bz: of the float conversion, and of the counts' if there is one.
pub const fn input_stages(counts: bool) -> u64 {
    float_to_fixed::LATENCY as u64 + if counts { COUNT_STAGES } else { 0 }
}

/// Pipeline registers from a count to its stress: gain, product, sum, limits.
const COUNT_STAGES: u64 = 4;
