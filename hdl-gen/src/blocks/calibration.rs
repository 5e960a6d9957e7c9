//! A calibration in RAM: the banks' control and its registers beside the core's.

use crate::cores::LONG_BITS;
use crate::format::address_bits;
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::calibration::CalibrationPlan;
use crate::plan::counts::EXPONENT_BITS;
use crate::plan::dead::WEIGHT_BITS;
use crate::plan::gain::GAIN_BITS;
use crate::resources::BlockCost;
use crate::resources::memory::memory;

/// Bits of a taxel's sum and extremes while it is tared.
const TARE_BITS: u32 = 37 + 2 * LONG_BITS;

/// Bits of `bank_command` and of `bank_words`, which go between the banks and their control: more where words stand behind
/// the thresholds.
pub fn bank_bits(of: &CalibrationPlan) -> [u32; 2] {
    let [command, words] = if of.power_up.dead.room > 0 || of.power_up.curve.is_some() { [56, 34] } else { [0, 0] };
    [address_bits(of.taxels) + of.offset_bits() + 31 + command, of.offset_bits() + 28 + words]
}

/// Bits of `tare_command`.
pub fn tare_bits(taxels: usize) -> u32 {
    address_bits(taxels) + 5
}

/// Parameters of `sptfra_calibration`.
pub fn control(of: &CalibrationPlan) -> Parameters {
    Parameters::new()
        .count("TAXELS", of.taxels)
        .number("OFFSET_BITS", of.offset_bits().into())
        .signed("OFFSET_LIMIT", 32, of.offset_limit)
        .unsigned("CONTACT", 32, of.power_up.contact.into())
        .unsigned("NOISE", LONG_BITS, of.power_up.noise.into())
        .pattern("CRC", 32, of.power_up.crc().into())
        .count("REPLACEABLE", of.power_up.dead.room)
        .some(of.curve(), |all, curve| all.count("CURVE_WORDS", curve.length()))
}

/// What `CALIBRATION_CURVE` says: room for segments, the exponents of numbers and of a step of the values.
pub fn curve_register(of: &CalibrationPlan) -> Option<[u8; 3]> {
    let byte = |exponent: i32| (exponent as i8).cast_unsigned();
    of.curve().map(|curve| [curve.room as u8, byte(curve.exponent), byte(curve.lsb)])
}

/// Parameters of `sptfra_calibration_registers`.
pub fn registers(of: &CalibrationPlan) -> Parameters {
    let steps = of.count_steps.to_bits();
    let words = [
        (u64::from(lsb(of)) << 24 | u64::from(of.shift) << 16 | of.words() as u64, "LSB, shift, words"),
        (of.offset_limit as u64, "limit of offsets"),
        (steps & u64::from(u32::MAX), "steps of a count, low"),
        (steps >> 32, "steps of a count, high"),
    ];
    Parameters::new()
        .words("CONSTANTS", &words.map(|(word, of)| (word, of.to_owned())))
        .some(curve_register(of), |all, [room, exponent, lsb]| {
            all.list("CURVE", 8, [room, exponent, lsb, 0].map(u64::from))
        })
}

/// The exponent of the stress' step as eight bits of two's complement.
pub fn lsb(of: &CalibrationPlan) -> u8 {
    (of.stress.lsb as i8).cast_unsigned()
}

/// A multiplier, both banks, a copy of them for each of two readers, and what a tare adds up; for dead taxels a frame, and
/// for each place of the map a multiplier and weights; for a curve one, and its lines; nothing without a calibration in
/// RAM.
pub fn cost(plan: &Plan) -> Option<BlockCost> {
    let of = plan.calibration.as_ref()?;
    let words = 1 << address_bits(of.taxels);
    let mut memories = vec![
        memory("exponents", 2, 2 * words, EXPONENT_BITS, false),
        memory("gains", 2, 2 * words, GAIN_BITS, false),
        memory("offsets", 2, 2 * words, of.offset_bits(), false),
        memory("tare", 1, words, TARE_BITS, false),
    ];
    let room = of.power_up.dead.room;
    if room > 0 {
        memories.push(memory("neighbours", 2 * room, 2 * words, WEIGHT_BITS, false));
    }
    let curve = of.curve();
    if let Some(curve) = curve {
        for (name, bits) in [("curve", LONG_BITS), ("curve values", LONG_BITS), ("slopes", GAIN_BITS), ("shifts", 6)] {
            memories.push(memory(name, 2, 2 * curve.room, bits, false));
        }
    }
    Some(BlockCost::new("Calibration", &["sptfra_banks"], 0).with(memories))
}
