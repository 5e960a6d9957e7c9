//! Counts to pascals: what a raw sensor's values are multiplied by and what is added, in fixed point.

use golden::design::{Curve, Design, Input};
use serde::Serialize;

use super::PlanError;
use super::curve::CurvePlan;
use super::format::{Format, largest, pow2, round_shift};
use super::gain::{GAIN_BITS, Gain};
use crate::cores::LONG_BITS;
use crate::cores::float_to_fixed::{self, Converted};

/// Width of a number, the longer operand: a count in fixed point.
const COUNT_BITS: u32 = LONG_BITS;
/// Bits of the exponent at the float conversion.
pub const EXPONENT_BITS: u32 = 10;
/// Most bits dropped after the product, whose width is 45.
const MOST_SHIFT: i32 = 40;
/// Widest offset along a curve, in steps of the stress: with the product it fits the 48 bits of the sum.
const MOST_OFFSET_BITS: u32 = 44;
/// Most that gains may differ by along a curve: the smallest keeps eleven bits.
const MOST_SPREAD: i32 = 64;
/// Most noise floors that a step of the numbers may be worth, as of the stress.
const MOST_COARSE: f64 = 16.0;

/// The conversion of one design, taxel by taxel: `number = round(count * 2^exponent)`, then
/// `stress = round(number * gain / 2^shift) + offset`, clipped to the full scale.
///
/// A taxel's gain is a mantissa of [`GAIN_BITS`] and the exponent with which its counts come out of the float conversion.
/// So every gain is as exact as the largest, and no taxel's steps depend on another's gain.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CountsPlan {
    /// The curve between the two, if the sensor is not linear: then `stress = round(curve(number) * gain / 2^shift) +
    /// offset`, and all taxels have one exponent.
    pub curve: Option<CurvePlan>,
    /// Exponent of each taxel's counts, or one for all: a step of the number is `2^-exponent` counts.
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

/// Largest magnitude of a number; a count that reaches it exceeds the full scale.
pub const LARGEST_NUMBER: i64 = largest(COUNT_BITS);

impl CountsPlan {
    /// The conversion, if the design's frames are counts.
    ///
    /// # Errors
    /// [`PlanError::Offset`] when an offset is so far beyond the full scale that a step of the numbers that hold both
    /// exceeds the noise.
    pub fn new(design: &Design, stress: Format) -> Result<Option<Self>, PlanError> {
        if let Some(curve) = &design.input.curve {
            return Self::along(curve, design, stress).map(Some);
        }
        let Input { pa_per_count: Some(pa_per_count), ref calibration, .. } = design.input else {
            return Ok(None);
        };
        let (gains, offsets) = match calibration {
            Some(calibration) => (calibration.gain.clone(), calibration.offset.clone()),
            None => (vec![1.0], vec![0.0]),
        };
        let per_count = pa_per_count * pow2(-stress.lsb);
        let taxels: Vec<Gain> = gains.iter().map(|gain| Gain::new(gain * per_count)).collect();
        // Where a taxel reads its full scale, its gain has multiplied that and what the offset takes off again.
        let reach = |taxel: usize| (offsets[taxel] * per_count).abs() + (stress.bound + 1) as f64;
        let furthest =
            (0..gains.len()).map(|taxel| (reach(taxel), taxel)).fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
        let fits = |shift: i32| {
            // A dead taxel has no gain, and whatever it reads is 0.
            let holds = |taxel: usize| {
                let gain = f64::from(taxels[taxel].mantissa.abs());
                reach(taxel) * pow2(shift) <= gain * LARGEST_NUMBER as f64 || gain == 0.0
            };
            (0..gains.len()).all(holds)
        };
        let shift = (0..=MOST_SHIFT).rev().find(|&shift| fits(shift));
        // A number's step is at most this many steps of the stress.
        let coarsest = |shift: i32| pow2(GAIN_BITS as i32 - 1 - shift) * stress.step();
        let Some(shift) = shift.filter(|&shift| coarsest(shift) <= MOST_COARSE * design.algorithm.noise_floor_pa)
        else {
            let full_scale = design.hardware.full_scale_pa / pa_per_count.abs();
            return Err(PlanError::Offset { taxel: furthest.1, counts: offsets[furthest.1], full_scale });
        };
        // By the gain as it is stored, so that the count of no stress at all gives none.
        let offset = |(taxel, gain): (usize, &Gain)| {
            let at_gain = if gains[taxel] == 0.0 { 0.0 } else { offsets[taxel] / gains[taxel] };
            (at_gain * f64::from(gain.mantissa) * pow2(gain.exponent)).round() as i64
        };
        let mut plan = Self {
            curve: None,
            exponents: taxels.iter().map(|gain| gain.exponent + shift).collect(),
            gains: taxels.iter().map(|gain| gain.mantissa).collect(),
            offsets: taxels.iter().enumerate().map(offset).collect(),
            shift: shift as u32,
            full_scale: stress.bound,
        };
        plan.full_scale = plan.least_full_scale(design, stress);
        Ok(Some(plan))
    }

    /// The conversion along a curve.
    fn along(curve: &Curve, design: &Design, stress: Format) -> Result<Self, PlanError> {
        let (gains, offsets) = match &design.input.calibration {
            Some(calibration) => (calibration.gain.clone(), calibration.offset.clone()),
            None => (vec![1.0], vec![0.0]),
        };
        let curve = CurvePlan::new(curve)?;
        let steps = pow2(curve.lsb - stress.lsb);
        let largest_gain = gains.iter().copied().fold(0.0, f64::max);
        // Of the largest gain all bits are in use.
        let shift = -Gain::new(largest_gain * steps).exponent;
        let scaled = |gain: f64| (gain * steps * pow2(shift)).round() as i32;
        let few = |gain: f64| gain != 0.0 && scaled(gain) < largest(GAIN_BITS) as i32 / (2 * MOST_SPREAD);
        if let Some(taxel) = gains.iter().position(|&gain| few(gain)) {
            return Err(PlanError::GainSpread {
                taxel,
                gain: gains[taxel],
                largest: largest_gain,
                spread: MOST_SPREAD,
            });
        }
        let in_steps = |offset: f64| (offset * pow2(-stress.lsb)).round();
        let far = offsets.iter().position(|&offset| in_steps(offset).abs() > largest(MOST_OFFSET_BITS) as f64);
        if !(0..=MOST_SHIFT).contains(&shift) || far.is_some() {
            let taxel = far.unwrap_or(0);
            let full_scale = design.hardware.full_scale_pa;
            return Err(PlanError::Offset { taxel, counts: offsets[taxel], full_scale });
        }
        let mut plan = Self {
            exponents: vec![curve.exponent; gains.len()],
            gains: gains.iter().map(|&gain| scaled(gain)).collect(),
            offsets: offsets.iter().map(|&offset| in_steps(offset) as i64).collect(),
            shift: shift as u32,
            full_scale: stress.bound,
            curve: Some(curve),
        };
        plan.full_scale = plan.least_full_scale(design, stress);
        Ok(plan)
    }

    /// The least stress that a taxel's reading of just the full scale, of either sign, becomes.
    fn least_full_scale(&self, design: &Design, stress: Format) -> i64 {
        let full_scale = design.hardware.full_scale_pa;
        (0..self.gains.len())
            .filter(|taxel| !design.input.dead.contains(taxel))
            .flat_map(|taxel| [full_scale, -full_scale].map(|stress| (taxel, design.input.from_pa(taxel, stress))))
            // Where a curve ends before it, no count reads the full scale.
            .filter(|&(taxel, count)| {
                let read = design.input.to_pa(taxel, count).abs();
                self.curve.is_none() || read >= (1.0 - 1e-9) * full_scale
            })
            .map(|(taxel, count)| {
                let converted = self.number(taxel, (count as f32).to_bits());
                self.to_stress(taxel, i64::from(converted.fixed)).abs()
            })
            .fold(stress.bound, i64::min)
    }

    /// A taxel's count, given as float32, in fixed point.
    pub fn number(&self, taxel: usize, count: u32) -> Converted {
        let limit = self.curve.as_ref().map_or(LARGEST_NUMBER, |curve| curve.limit);
        float_to_fixed::convert(count, self.exponents[self.index(taxel)], limit as u32)
    }

    /// The place of a taxel's constants.
    fn index(&self, taxel: usize) -> usize {
        if self.per_taxel() { taxel } else { 0 }
    }

    /// Whether each taxel has a gain and an offset of its own.
    pub fn per_taxel(&self) -> bool {
        self.gains.len() > 1
    }

    /// The stress of a number before it is clipped, in steps.
    pub fn to_stress(&self, taxel: usize, number: i64) -> i64 {
        let index = self.index(taxel);
        let number = self.curve.as_ref().map_or(number, |curve| curve.value(number));
        round_shift(number * i64::from(self.gains[index]), self.shift) + self.offsets[index]
    }

    /// Bits of the widest offset, sign included.
    pub fn offset_bits(&self) -> u32 {
        let widest = self.offsets.iter().map(|offset| offset.unsigned_abs()).max().unwrap_or(0);
        u64::BITS - widest.leading_zeros() + 1
    }
}
