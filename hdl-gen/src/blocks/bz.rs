//! Bz, the stream's frames to fixed point: `sptfra_bz`, or `sptfra_bz_wide` where all samples of a beat are taken at once.

use golden::sensor::Sensor;

use crate::plan::Plan;
use crate::plan::counts::{CountsPlan, LARGEST_NUMBER};
use crate::plan::curve::CurvePlan;
use crate::plan::streams::{Intake, Streams};

use super::Parameters;
use super::latency;

/// Numbers of 27 bits on a line.
const KNOTS_PER_LINE: usize = 7;

/// The module.
pub fn module(streams: Streams) -> &'static str {
    if streams.intake == Intake::Whole { "sptfra_bz_wide" } else { "sptfra_bz" }
}

/// What the ROM files of taxels' constants are called behind the design's name: one for all, or one for each sample of a
/// beat.
pub fn taxel_files(streams: Streams) -> Vec<String> {
    match streams.intake {
        Intake::Whole => (0..streams.samples()).map(|sample| format!("_sample{sample}")).collect(),
        Intake::Single | Intake::Unpacked => vec![String::new()],
    }
}

/// When what a frame brings is there, in cycles after its first beat enters Bz, streams never waiting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// The frame is ready for the lanes.
    pub ready: u64,
    /// `CeAn` has its last stress.
    pub last_stress: u64,
    /// Nothing of it is in Bz any more.
    pub done: u64,
}

/// Cycles of Bz. `stages` are those of a sample's conversion, `dead` what replacing dead taxels takes.
pub fn arrival(sensor: &Sensor, streams: Streams, folded: bool, stages: u64, dead: u64) -> Arrival {
    let taxels = sensor.taxels() as u64;
    if streams.intake != Intake::Whole {
        let last_stress = taxels - 1 + stages + dead;
        return Arrival { ready: last_stress + latency::stress_to_ready(folded), last_stress, done: last_stress + 1 };
    }
    let beat_there = |taxel: usize| (taxel / streams.samples()) as u64 + stages + 1;
    // A quad a cycle, from the middle rows on, each when its last taxel is there.
    let (columns, rows) = (sensor.columns, sensor.rows);
    let last_taxels = (rows / 2..rows).flat_map(|y| (columns / 2..columns).map(move |x| y * columns + x));
    let last_quad = last_taxels.fold(0, |before, taxel| beat_there(taxel).max(before + 1));
    // A taxel a cycle.
    let last_taxel = (0..sensor.taxels()).fold(0, |before, taxel| beat_there(taxel).max(before + 1));
    let last_stress = last_taxel + WIDE_TO_CEAN;
    Arrival { ready: last_quad + WIDE_TO_WRITE + 1, last_stress, done: last_stress.max(last_quad + 1) + 1 }
}

/// From a taxel's turn in `sptfra_bz_wide` to its stress in `CeAn`, from a quad's to its write, in cycles.
const WIDE_TO_CEAN: u64 = 2;
const WIDE_TO_WRITE: u64 = 4;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let (stress, streams) = (plan.formats.stress, plan.streams());
    let (shift, bound) = match &plan.counts {
        Some(counts) => (counts.exponents[0], counts.curve.as_ref().map_or(LARGEST_NUMBER, |curve| curve.limit)),
        None => (-stress.lsb, stress.bound),
    };
    let parameters = if streams.intake == Intake::Whole {
        Parameters::new().count("STREAM_BITS", streams.bits).count("SAMPLE_BITS", streams.sample_bits)
    } else {
        Parameters::new().count("WAYS", plan.ways())
    };
    let parameters = parameters
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
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
