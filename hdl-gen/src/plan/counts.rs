//! Counts to pascals: what a raw sensor's values are multiplied by and what is added, in fixed point.

use golden::design::{Design, Input};

use super::PlanError;
use super::curve::CurvePlan;
use super::gain::{GAIN_BITS, Gain, Reading, Scale};
use crate::format::{Format, pow2};

/// Bits of the exponent at the float conversion.
pub const EXPONENT_BITS: u32 = 10;
/// Offsets are within so many full scales of either sign, unless the design's own are beyond.
pub const OFFSET_FULL_SCALES: i64 = 2;
/// Most noise floors that a step of the numbers may be worth, as of the stress.
const MOST_COARSE: f64 = 16.0;

/// The conversion of one design, taxel by taxel: `number = round(count * 2^exponent)`, then
/// `stress = round(number * gain / 2^shift) + offset`, clipped to the full scale.
///
/// A taxel's gain is a mantissa of [`GAIN_BITS`] and an exponent. So every gain is as exact as the largest, and no
/// taxel's steps depend on another's gain. The numbers are those of a calibration in RAM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CountsPlan {
    /// The curve between the two, if the sensor is not linear: then
    /// `stress = round(curve(count) * gain * 2^(exponent + lsb) / 2^shift) + offset`.
    pub curve: Option<CurvePlan>,
    /// Exponent of each taxel's gain, or one for all: without a curve a step of the number is `2^-exponent` counts.
    pub exponents: Vec<i32>,
    /// Mantissa of each taxel's gain, of full width; as many as exponents.
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
    /// [`PlanError::Offset`] when an offset is so far beyond the full scale that a step of the numbers that hold both
    /// exceeds the noise; [`PlanError::Key`] for a curve too steep.
    pub fn new(design: &Design, stress: Format) -> Result<Option<Self>, PlanError> {
        let Input { pa_per_count, ref curve, ref calibration, .. } = design.input;
        let curve = curve.as_ref().map(|curve| CurvePlan::new(design, curve)).transpose()?;
        // Behind a curve a count is a pascal.
        let Some(pa_per_count) = pa_per_count.or(curve.as_ref().map(|_| 1.0)) else { return Ok(None) };
        let (gains, offsets) = match calibration {
            Some(calibration) => (calibration.gain.clone(), calibration.offset.clone()),
            None => (vec![1.0], vec![0.0]),
        };
        let per_count = pa_per_count * pow2(-stress.lsb);
        let taxels: Vec<Gain> = gains.iter().map(|gain| Gain::new(gain * per_count)).collect();
        let steps = |taxel: usize| taxels[taxel].offset(gains[taxel], offsets[taxel]);
        let furthest =
            (0..gains.len()).fold(0, |most, taxel| if steps(taxel).abs() > steps(most).abs() { taxel } else { most });
        let most_offset = (steps(furthest).abs() as i64).max(OFFSET_FULL_SCALES * stress.bound);
        // A number's step is at most this many steps of the stress.
        let coarsest = |scale: &Scale| pow2(GAIN_BITS as i32 - 1 - scale.shift as i32) * stress.step();
        let fine = |scale: &Scale| curve.is_some() || coarsest(scale) <= MOST_COARSE * design.algorithm.noise_floor_pa;
        let scale = Scale::new(stress, most_offset, curve.as_ref().map(|curve| curve.lsb)).filter(fine);
        let Some(scale) = scale else {
            let full_scale = design.hardware.full_scale_pa / pa_per_count.abs();
            return Err(PlanError::Offset { taxel: furthest, counts: offsets[furthest], full_scale });
        };
        Ok(Some(Self {
            curve,
            exponents: taxels.iter().map(|gain| gain.exponent + scale.shift as i32).collect(),
            gains: taxels.iter().map(|gain| gain.mantissa).collect(),
            offsets: (0..gains.len()).map(|taxel| steps(taxel) as i64).collect(),
            shift: scale.shift,
            full_scale: scale.full_scale,
        }))
    }

    /// The stress of a taxel's count, given as float32.
    pub fn stress_of(&self, taxel: usize, count: u32, stress: Format) -> Reading {
        let index = self.index(taxel);
        let gain = (self.gains[index], self.exponents[index]);
        let scale = Scale { shift: self.shift, full_scale: self.full_scale };
        scale.stress_of(count, self.curve.as_ref(), gain, self.offsets[index], stress.bound)
    }

    /// The place of a taxel's constants.
    fn index(&self, taxel: usize) -> usize {
        if self.per_taxel() { taxel } else { 0 }
    }

    /// Whether each taxel has a gain and an offset of its own.
    pub fn per_taxel(&self) -> bool {
        self.gains.len() > 1
    }

    /// Bits of the widest offset, sign included.
    pub fn offset_bits(&self) -> u32 {
        let widest = self.offsets.iter().map(|offset| offset.unsigned_abs()).max().unwrap_or(0);
        u64::BITS - widest.leading_zeros() + 1
    }
}
