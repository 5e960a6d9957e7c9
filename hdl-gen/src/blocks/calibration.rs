//! A calibration in RAM: `sptfra_calibrate` in the core, the banks' control and its registers beside the core's.

use crate::cores::{ACCUMULATOR_BITS, LONG_BITS};
use crate::plan::Plan;
use crate::plan::calibration::{CalibrationPlan, CurveMap};
use crate::plan::counts::EXPONENT_BITS;
use crate::plan::dead::WEIGHT_BITS;
use crate::plan::format::address_bits;
use crate::plan::gain::GAIN_BITS;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;

use super::{Parameters, bz};

/// Bits of a taxel's sum and extremes while it is tared.
const TARE_BITS: u32 = 37 + 2 * LONG_BITS;

/// Parameters of `sptfra_bz` for a calibration in RAM.
pub fn of_frames(parameters: Parameters, of: &CalibrationPlan) -> Parameters {
    let parameters = parameters
        .flag("COUNTS", true)
        .flag("CALIBRATED", true)
        .flag("PER_TAXEL", true)
        .number("OFFSET_BITS", of.offset_bits().into())
        .number("COUNT_SHIFT", i64::from(of.shift) - of.curve().map_or(0, |curve| curve.lsb.into()))
        .wide("FULL_SCALE", ACCUMULATOR_BITS, of.full_scale);
    let parameters = match &of.power_up.curve {
        Some(curve) => of_curve(parameters, curve),
        None => parameters,
    };
    let map = &of.power_up.dead;
    if map.room == 0 {
        return parameters;
    }
    bz::of_dead(parameters.count("REPLACEABLE", map.room).flag("MAPPED", true), &map.dead, map.room)
}

fn of_curve(parameters: Parameters, map: &CurveMap) -> Parameters {
    let knots = (0..map.format.room).map(|place| i64::from(map.segment(place)[0].cast_signed()));
    parameters
        .number("CURVE_LEVELS", map.format.levels().into())
        .numbers("CURVE_KNOTS", LONG_BITS, &knots.collect::<Vec<_>>())
        .wide("CURVE_LAST", LONG_BITS, map.curve.last)
        .expression("CURVE_COUNT", format!("7'd{}", map.curve.segments.len()))
        .wide("CURVE_LAST_VALUE", LONG_BITS, map.end)
}

/// Whether banks have words behind the thresholds.
pub fn has_more(of: &CalibrationPlan) -> bool {
    of.power_up.dead.room > 0 || of.power_up.curve.is_some()
}

/// Bits that go between the banks' control and what they say of dead taxels and of the curve, there and back.
pub fn dead_bits(of: &CalibrationPlan) -> [u32; 2] {
    if has_more(of) { [56, 34] } else { [0, 0] }
}

/// Parameters of `sptfra_calibration`.
pub fn control(of: &CalibrationPlan) -> Parameters {
    let parameters = Parameters::new()
        .count("TAXELS", of.taxels)
        .number("OFFSET_BITS", of.offset_bits().into())
        .wide("OFFSET_LIMIT", 32, of.offset_limit)
        .expression("CONTACT", format!("32'd{}", of.power_up.contact))
        .expression("NOISE", format!("{LONG_BITS}'d{}", of.power_up.noise))
        .expression("CRC", format!("32'h{:08x}", of.power_up.crc()))
        .count("REPLACEABLE", of.power_up.dead.room);
    match of.curve() {
        Some(curve) => parameters.count("CURVE_WORDS", curve.length()),
        None => parameters,
    }
}

/// What `CALIBRATION_CURVE` says: room for segments, the exponents of numbers and of a step of the values.
pub fn curve_register(of: &CalibrationPlan) -> Option<[u8; 3]> {
    let byte = |exponent: i32| (exponent as i8).cast_unsigned();
    of.curve().map(|curve| [curve.room as u8, byte(curve.exponent), byte(curve.lsb)])
}

/// Parameters of `sptfra_calibration_registers`.
pub fn registers(of: &CalibrationPlan) -> Parameters {
    let parameters = Parameters::new()
        .expression("WORDS", format!("16'd{}", of.words()))
        .expression("SHIFT", format!("6'd{}", of.shift))
        .expression("LSB", format!("8'd{}", lsb(of)))
        .expression("OFFSET_LIMIT", format!("32'd{}", of.offset_limit))
        .expression("COUNT_STEPS", format!("64'h{:016x}", of.count_steps.to_bits()))
        .expression("REPLACEABLE", format!("4'd{}", of.power_up.dead.room));
    match curve_register(of) {
        Some([room, exponent, lsb]) => {
            parameters.expression("CURVE", format!("{{8'd0, 8'd{lsb}, 8'd{exponent}, 8'd{room}}}"))
        }
        None => parameters,
    }
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
