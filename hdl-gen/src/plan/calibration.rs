//! A calibration in RAM: the numbers of a taxel's gain and offset as a bank holds them, and the bounds of what it takes.

mod bank;
mod curve_map;
mod dead_map;

pub use bank::Bank;
pub use curve_map::CurveMap;
pub use dead_map::DeadMap;

use golden::design::{Calibration, CalibrationIn, Design};

use super::counts::OFFSET_FULL_SCALES;
use super::curve_format::CurveFormat;
use super::dead::DeadPlan;
pub use super::gain::Reading;
use super::gain::{GAIN_BITS, Gain, Scale};
use super::{PlanError, Thresholds};
use crate::format::{Format, largest, pow2};

/// How counts become stress where gains and offsets are written while frames run:
/// `number = round(count * 2^exponent)`, then `stress = round(number * mantissa / 2^shift) + offset`, clipped to the full
/// scale.
///
/// Mantissas have all of their bits in use and offsets are at most `offset_limit`, so that a number at its bound is beyond
/// the full scale by every content of a bank. Behind the clipping stand the formats that hold for every stress.
///
/// Along a curve the banks' own makes values of counts before, in steps of `2^lsb` Pa, and
/// `stress = round(value * mantissa * 2^(exponent + lsb) / 2^shift) + offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationPlan {
    /// Taxels of a frame.
    pub taxels: usize,
    /// Steps of the stress for one count at a gain of 1.
    pub count_steps: f64,
    /// Bits dropped, with rounding, after the product.
    pub shift: u32,
    /// Largest magnitude of an offset, in steps.
    pub offset_limit: i64,
    /// Stress from which on a value counts as full scale, in steps: what the rounding of any gain leaves of that.
    pub full_scale: i64,
    /// The format of the stress.
    pub stress: Format,
    /// What the banks hold at power-up.
    pub power_up: Bank,
}

impl CalibrationPlan {
    /// The conversion, if the design's calibration is in RAM.
    ///
    /// # Errors
    /// [`PlanError::Key`] for an offset or a contact threshold beyond what a bank takes; those of [`CurveMap::new`].
    pub fn new(design: &Design, stress: Format, thresholds: &Thresholds) -> Result<Option<Self>, PlanError> {
        // Behind a curve a count is a pascal.
        let per_count = design.input.pa_per_count.or(design.input.curve.as_ref().map(|_| 1.0));
        let Some(pa_per_count) = per_count.filter(|_| design.hardware.calibration == CalibrationIn::Ram) else {
            return Ok(None);
        };
        let curve = design.input.curve.as_ref();
        let curve = curve.map(|curve| CurveMap::new(CurveFormat::new(design, curve), curve)).transpose()?;
        let offset_limit = OFFSET_FULL_SCALES * stress.bound;
        let Scale { shift, full_scale } =
            Scale::new(stress, offset_limit, curve.as_ref().map(|curve| curve.format.lsb))
                .unwrap_or(Scale { shift: 0, full_scale: 1 });
        let mut plan = Self {
            taxels: design.sensor.taxels(),
            count_steps: pa_per_count * pow2(-stress.lsb),
            shift,
            offset_limit,
            full_scale,
            stress,
            power_up: Bank {
                gains: Vec::new(),
                offsets: Vec::new(),
                contact: 1,
                noise: thresholds.taxel as u32,
                dead: Self::dead_map(design),
                curve,
            },
        };
        plan.power_up.contact = u32::try_from(thresholds.contact).map_err(|_| {
            PlanError::Key(format!(
                "[hardware] calibration = \"ram\": with [algorithm] noise_floor_pa = {} the threshold of contact has more than \
                 32 bits; lower it to {:.0} or less, or write calibration = \"rom\"",
                design.algorithm.noise_floor_pa,
                f64::from(u32::MAX) * stress.step() / plan.taxels as f64
            ))
        })?;
        let mut calibration = match &design.input.calibration {
            Some(calibration) => calibration.clone(),
            None => Calibration { gain: vec![1.0; plan.taxels], offset: vec![0.0; plan.taxels] },
        };
        // What is replaced anyway must not keep a tare from finding rest.
        for &taxel in &design.input.dead {
            calibration.gain[taxel] = 0.0;
        }
        plan.power_up = plan.bank(&calibration, &plan.power_up).map_err(|taxel| {
            PlanError::Key(format!(
                "[sensor] calibration: the offset of taxel {taxel} is {} counts; with [hardware] calibration = \"ram\" at most \
                 {:.1} of either sign, two full scales, have room; correct the file, state a full_scale_pa that fits the \
                 sensor, or write calibration = \"rom\"",
                calibration.offset[taxel],
                offset_limit as f64 / plan.count_steps.abs()
            ))
        })?;
        Ok(Some(plan))
    }

    /// The design's own dead taxels, where banks have room for them.
    fn dead_map(design: &Design) -> DeadMap {
        let room = design.input.room;
        let dead = if room == 0 { &[][..] } else { &design.input.dead };
        DeadMap { room, dead: DeadPlan::of(design, dead) }
    }

    /// The bank of a calibration, with the thresholds and the dead taxels of another one. A gain of 0, which only a taxel has that the design
    /// replaces, is stored as the smallest.
    ///
    /// # Errors
    /// The first taxel whose offset is beyond the limit.
    pub fn bank(&self, calibration: &Calibration, thresholds: &Bank) -> Result<Bank, usize> {
        let mut bank = Bank { gains: Vec::new(), offsets: Vec::new(), ..thresholds.clone() };
        for (taxel, (&gain, &offset)) in calibration.gain.iter().zip(&calibration.offset).enumerate() {
            if gain == 0.0 {
                bank.gains.push((1 << (GAIN_BITS - 2), -512));
                bank.offsets.push(0);
                continue;
            }
            let of = Gain::new(gain * self.count_steps);
            let steps = of.offset(gain, offset);
            if steps.abs() > self.offset_limit as f64 {
                return Err(taxel);
            }
            bank.gains.push((of.mantissa, of.exponent + self.shift as i32));
            bank.offsets.push(steps as i32);
        }
        Ok(bank)
    }

    /// The stress of a taxel's count, given as float32.
    pub fn stress_of(&self, bank: &Bank, taxel: usize, count: u32) -> Reading {
        let scale = Scale { shift: self.shift, full_scale: self.full_scale };
        let curve = bank.curve.as_ref().map(|map| &map.curve);
        scale.stress_of(count, curve, bank.gains[taxel], bank.offsets[taxel].into(), self.stress.bound)
    }

    /// Bits of the widest offset, sign included.
    pub fn offset_bits(&self) -> u32 {
        let widest = self.offset_limit.unsigned_abs();
        u64::BITS - widest.leading_zeros() + 1
    }

    /// The numbers of the curves, where the design has one.
    pub fn curve(&self) -> Option<CurveFormat> {
        self.power_up.curve.as_ref().map(|curve| curve.format)
    }

    /// Words of a bank.
    pub fn words(&self) -> usize {
        let curve = self.curve().map_or(0, |curve| curve.length());
        2 * self.taxels + 2 + DeadMap::length(self.power_up.dead.room, self.taxels) + curve
    }
}

// The bound of an offset has room in a word.
const _: () = assert!(OFFSET_FULL_SCALES * largest(crate::cores::LONG_BITS) < 1 << 31);

#[cfg(test)]
mod tests {
    use super::CalibrationPlan;
    use golden::design::{Calibration, CalibrationIn, Design};

    use crate::plan::Plan;

    fn design() -> Design {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../designs/small-control.toml");
        let mut design = Design::load(std::path::Path::new(file)).unwrap();
        design.input.pa_per_count = Some(-12.5);
        design.hardware.calibration = CalibrationIn::Ram;
        design
    }

    fn plan(data_bits: u32) -> CalibrationPlan {
        let mut design = design();
        design.hardware.data_bits = data_bits;
        Plan::new(&design).unwrap().calibration.unwrap()
    }

    #[test]
    fn offsets_beyond_the_bounds_are_refused() {
        let plan = plan(27);
        let counts = plan.stress.bound as f64 / plan.count_steps;
        let mut calibration = Calibration { gain: vec![1.0; 12], offset: vec![0.0; 12] };
        calibration.offset[7] = 2.1 * counts;
        assert_eq!(plan.bank(&calibration, &plan.power_up), Err(7));
        let mut design = design();
        design.input.calibration = Some(calibration);
        let message = Plan::new(&design).unwrap_err().to_string();
        assert!(
            ["taxel 7", "at most 16000.0", "calibration = \"rom\""].iter().all(|part| message.contains(part)),
            "{message}"
        );
        // A threshold beyond 32 bits.
        design.input.calibration = None;
        (design.sensor.columns, design.sensor.rows) = (10, 10);
        design.algorithm.noise_floor_pa = 9e4;
        let message = Plan::new(&design).unwrap_err().to_string();
        assert!(
            message.contains("noise_floor_pa = 90000") && message.contains("the threshold of contact"),
            "{message}"
        );
    }
}
