//! A calibration in RAM: `sptfra_calibrate` in the core, the banks' control and its registers beside the core's.

use crate::cores::{ACCUMULATOR_BITS, LONG_BITS};
use crate::plan::Plan;
use crate::plan::calibration::CalibrationPlan;
use crate::plan::counts::EXPONENT_BITS;
use crate::plan::format::address_bits;
use crate::plan::gain::GAIN_BITS;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;

use super::{Parameters, latency};

/// Bits of a taxel's sum and extremes while it is tared.
const TARE_BITS: u32 = 37 + 2 * LONG_BITS;

/// Parameters of `sptfra_bz_calibrated` that Bz alone has not.
pub fn of_frames(parameters: Parameters, of: &CalibrationPlan, words: usize) -> Parameters {
    parameters
        .number("OFFSET_BITS", of.offset_bits().into())
        .number("COUNT_SHIFT", of.shift.into())
        .wide("FULL_SCALE", ACCUMULATOR_BITS, of.full_scale)
        .cycles("EXPECTED_CALIBRATION", latency::CALIBRATION)
        .count("WORDS", words)
}

/// Parameters of `sptfra_calibration`.
pub fn control(of: &CalibrationPlan) -> Parameters {
    Parameters::new()
        .count("TAXELS", of.taxels)
        .number("OFFSET_BITS", of.offset_bits().into())
        .wide("OFFSET_LIMIT", 32, of.offset_limit)
        .expression("CONTACT", format!("32'd{}", of.power_up.contact))
        .expression("NOISE", format!("{LONG_BITS}'d{}", of.power_up.noise))
        .expression("CRC", format!("32'h{:08x}", of.power_up.crc()))
}

/// Parameters of `sptfra_calibration_registers`.
pub fn registers(of: &CalibrationPlan) -> Parameters {
    Parameters::new()
        .expression("WORDS", format!("16'd{}", of.words()))
        .expression("SHIFT", format!("6'd{}", of.shift))
        .expression("LSB", format!("8'd{}", lsb(of)))
        .expression("OFFSET_LIMIT", format!("32'd{}", of.offset_limit))
        .expression("COUNT_STEPS", format!("64'h{:016x}", of.count_steps.to_bits()))
}

/// The exponent of the stress' step as eight bits of two's complement.
pub fn lsb(of: &CalibrationPlan) -> u8 {
    (of.stress.lsb as i8).cast_unsigned()
}

/// A multiplier, both banks, a copy of them for each of two readers, and what a tare adds up; nothing without one.
pub fn cost(plan: &Plan) -> Option<BlockCost> {
    let of = plan.calibration.as_ref()?;
    let words = 1 << address_bits(of.taxels);
    Some(BlockCost::new("Calibration", &["sptfra_calibrate", "sptfra_tare"], 1).with(vec![
        memory("gains", 2, 2 * words, GAIN_BITS + EXPONENT_BITS, false),
        memory("offsets", 2, 2 * words, of.offset_bits(), false),
        memory("tare", 1, words, TARE_BITS, false),
    ]))
}
