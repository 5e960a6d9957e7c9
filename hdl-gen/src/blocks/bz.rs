//! Bz, the stream's frames to fixed point: `sptfra_bz`.

use crate::cores::{ACCUMULATOR_BITS, LONG_BITS};
use crate::plan::Plan;
use crate::plan::counts::{CountsPlan, EXPONENT_BITS, LARGEST_NUMBER};
use crate::plan::curve::{CurvePlan, SEGMENT_BITS};
use crate::plan::dead::WEIGHT_BITS;
use crate::plan::gain::GAIN_BITS;
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;

use super::Parameters;
use super::latency;

/// Numbers of [`LONG_BITS`] on a line.
const KNOTS_PER_LINE: usize = 7;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let stress = plan.formats.stress;
    let (shift, bound) = match &plan.counts {
        Some(counts) => (counts.exponents[0], counts.curve.as_ref().map_or(LARGEST_NUMBER, |curve| curve.limit)),
        None => (-stress.lsb, stress.bound),
    };
    let parameters = Parameters::new()
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .count("WAYS", plan.ways())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .number("NUMBER_SHIFT", shift.into())
        .wide("NUMBER_BOUND", LONG_BITS, bound);
    let parameters = match &plan.counts {
        Some(counts) => of_counts(parameters, counts),
        None => parameters,
    };
    let parameters = match plan.counts.as_ref().and_then(|counts| counts.curve.as_ref()) {
        Some(curve) => of_curve(parameters, curve),
        None => parameters,
    };
    let parameters = match &plan.dead {
        Some(dead) => parameters.count("DEAD", dead.taxels.len()).number("WEIGHT_SHIFT", dead.shift.into()),
        None => parameters,
    };
    let parameters = if plan.counts.is_none() && plan.dead.is_none() {
        parameters
    } else {
        parameters
            .wide("STRESS_BOUND", LONG_BITS, stress.bound)
            .expression("ROM_DIR", "ROM_DIR")
            .expression("ROM_NAME", format!("\"{}\"", plan.design.name))
    };
    parameters.cycles("EXPECTED_STAGES", beat_to_stress(plan))
}

/// Cycles from a beat to its stress.
pub fn beat_to_stress(plan: &Plan) -> u64 {
    let curve = plan.counts.as_ref().and_then(|counts| counts.curve.as_ref());
    latency::beat_to_stress(plan.counts.is_some(), curve.map(CurvePlan::stages))
}

/// A multiplier each for a count's slope, a stress's gain and each dead taxel.
pub fn cost(plan: &Plan) -> BlockCost {
    let (taxels, dead) = (plan.taxels(), plan.dead.as_ref().map_or(0, |dead| dead.taxels.len()));
    let curve = plan.counts.as_ref().and_then(|counts| counts.curve.as_ref());
    let mut memories = Vec::new();
    if let Some(counts) = plan.counts.as_ref().filter(|counts| counts.per_taxel()) {
        if curve.is_none() {
            memories.push(memory("exponents", 1, taxels, EXPONENT_BITS, true));
        }
        memories.push(memory("gains", 1, taxels, GAIN_BITS, true));
        memories.push(memory("offsets", 1, taxels, counts.offset_bits(), true));
    }
    if let Some(curve) = curve {
        memories.push(memory("curve", 1, 1 << curve.levels(), SEGMENT_BITS, true));
    }
    if dead > 0 {
        // With a stress, whether it was clipped and whether it was a number.
        memories.push(memory("whole frame", 1, taxels, LONG_BITS + 2, false));
        memories.push(memory("neighbours", 1, taxels, WEIGHT_BITS * dead as u32, true));
        memories.push(memory("dead taxels", 1, taxels, 1, true));
    }
    if plan.ways() > 1 {
        memories.push(memory("half-folded b", 1, plan.elements(), 2 * plan.design.hardware.data_bits + 2, false));
    }
    let dsp = usize::from(plan.counts.is_some()) + usize::from(curve.is_some()) + dead;
    BlockCost::new("Bz", &["sptfra_bz"], dsp).with(memories)
}

fn of_counts(parameters: Parameters, counts: &CountsPlan) -> Parameters {
    parameters
        .flag("COUNTS", true)
        .flag("PER_TAXEL", counts.per_taxel())
        .flag("EXPONENTS", counts.per_taxel() && counts.curve.is_none())
        .wide("GAIN", GAIN_BITS, counts.gains[0].into())
        .number("OFFSET_BITS", counts.offset_bits().into())
        .number("COUNT_SHIFT", counts.shift.into())
        .wide("FULL_SCALE", ACCUMULATOR_BITS, counts.full_scale)
}

fn of_curve(parameters: Parameters, curve: &CurvePlan) -> Parameters {
    // Two's complement, the first in the lowest bits, as many on a line as it holds.
    let unsigned = |knot: &i64| knot & ((1 << LONG_BITS) - 1);
    let knots: Vec<String> =
        curve.knots().iter().rev().map(|knot| format!("{LONG_BITS}'d{}", unsigned(knot))).collect();
    let lines: Vec<String> = knots.chunks(KNOTS_PER_LINE).map(|knots| knots.join(", ")).collect();
    parameters
        .number("CURVE_LEVELS", curve.levels().into())
        .expression("CURVE_KNOTS", format!("{{\n            {}\n        }}", lines.join(",\n            ")))
        .wide("CURVE_FIRST", LONG_BITS, curve.segments[0].first)
        .wide("CURVE_LAST", LONG_BITS, curve.last)
}
