//! Bz, the stream's frames to fixed point: `sptfra_bz`.

use crate::plan::Plan;
use crate::plan::counts::{CountsPlan, LARGEST_NUMBER};
use crate::plan::curve::CurvePlan;

use super::Parameters;

/// Numbers of 27 bits on a line.
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
        .wide("NUMBER_BOUND", 27, bound);
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
    if plan.counts.is_none() && plan.dead.is_none() {
        return parameters;
    }
    parameters
        .wide("STRESS_BOUND", 27, stress.bound)
        .expression("ROM_DIR", "ROM_DIR")
        .expression("ROM_NAME", format!("\"{}\"", plan.design.name))
}

fn of_counts(parameters: Parameters, counts: &CountsPlan) -> Parameters {
    parameters
        .flag("COUNTS", true)
        .flag("PER_TAXEL", counts.per_taxel())
        .flag("EXPONENTS", counts.per_taxel() && counts.curve.is_none())
        .wide("GAIN", 18, counts.gains[0].into())
        .number("OFFSET_BITS", counts.offset_bits().into())
        .number("COUNT_SHIFT", counts.shift.into())
        .wide("FULL_SCALE", 48, counts.full_scale)
}

fn of_curve(parameters: Parameters, curve: &CurvePlan) -> Parameters {
    // Two's complement, the first in the lowest bits, as many on a line as it holds.
    let knots: Vec<String> = curve.knots().iter().rev().map(|knot| format!("27'd{}", knot & 0x7ff_ffff)).collect();
    let lines: Vec<String> = knots.chunks(KNOTS_PER_LINE).map(|knots| knots.join(", ")).collect();
    parameters
        .number("CURVE_LEVELS", curve.levels().into())
        .expression("CURVE_KNOTS", format!("{{\n            {}\n        }}", lines.join(",\n            ")))
        .wide("CURVE_FIRST", 27, curve.segments[0].first)
        .wide("CURVE_LAST", 27, curve.last)
}
