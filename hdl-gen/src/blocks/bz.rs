//! Bz, the stream's frames to fixed point: `sptfra_bz`, or `sptfra_bz_wide` where all samples of a beat are taken at once.

use golden::design::Samples;
use golden::parity::CLASSES;

use crate::cores::{ACCUMULATOR_BITS, LONG_BITS};
use crate::plan::Plan;
use crate::plan::calibration::CalibrationPlan;
use crate::plan::counts::{CountsPlan, EXPONENT_BITS};
use crate::plan::curve::{self, CurvePlan, SEGMENT_BITS};
use crate::plan::dead::{DeadPlan, WEIGHT_BITS};
use crate::plan::gain::{GAIN_BITS, LARGEST_NUMBER};
use crate::plan::memory::memory;
use crate::plan::resources::BlockCost;
use crate::plan::streams::{Intake, Streams};

use super::{Parameters, calibration, latency};

/// The module.
pub fn module(plan: &Plan) -> &'static str {
    match plan.streams().intake {
        Intake::Whole => "sptfra_bz_wide",
        Intake::Single | Intake::Unpacked => "sptfra_bz",
    }
}

/// What the ROM files of taxels' constants are called behind the design's name: one for all, or one for each sample of a
/// beat.
pub fn taxel_files(streams: Streams) -> Vec<String> {
    match streams.intake {
        Intake::Whole => (0..streams.samples()).map(|sample| format!("_sample{sample}")).collect(),
        Intake::Single | Intake::Unpacked => vec![String::new()],
    }
}

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let (stress, streams) = (plan.formats.stress, plan.streams());
    let curve_in_ram = plan.calibration.as_ref().and_then(CalibrationPlan::curve);
    let curve = plan.counts.as_ref().and_then(|counts| counts.curve.as_ref());
    let shift = match (&plan.counts, curve) {
        (Some(counts), None) => counts.exponents[0],
        (Some(_), Some(curve)) => curve.exponent,
        (None, _) => curve_in_ram.map_or(-stress.lsb, |curve| curve.exponent),
    };
    let counts = plan.counts.is_some() || plan.calibration.is_some();
    let bound = if counts { curve.map_or(LARGEST_NUMBER, CurvePlan::reach) } else { stress.bound };
    let parameters =
        Parameters::new().count("COLUMNS", plan.design.sensor.columns).count("ROWS", plan.design.sensor.rows);
    let parameters = if streams.intake == Intake::Whole {
        parameters.count("STREAM_BITS", streams.bits)
    } else {
        // Where frames are scaled, that is done before they are folded.
        parameters.count("WAYS", if plan.scales_frames() { 1 } else { plan.ways() })
    };
    let written = if plan.scales_frames() { plan.factors().outside_bits() } else { plan.design.hardware.data_bits };
    let parameters = parameters.number("DATA_BITS", written.into());
    // As in sptfra_samples.
    let parameters = match streams.sample {
        Samples::Float32 => parameters,
        Samples::Int16 => parameters.number("SAMPLE", 1),
        Samples::Uint16 => parameters.number("SAMPLE", 2),
    };
    let parameters = parameters.number("NUMBER_SHIFT", shift.into()).wide("NUMBER_BOUND", LONG_BITS, bound);
    let parameters = match &plan.counts {
        Some(counts) => of_counts(parameters, counts),
        None => parameters,
    };
    let parameters = match curve {
        Some(curve) => of_curve(parameters, curve),
        None => parameters,
    };
    let parameters = match &plan.dead {
        Some(dead) => of_dead(parameters.count("REPLACEABLE", dead.taxels.len()), dead, dead.taxels.len()),
        None => parameters,
    };
    let parameters = match &plan.calibration {
        Some(of) => calibration::of_frames(parameters, of),
        None => parameters,
    };
    let parameters = if plan.counts.is_none() && plan.dead.is_none() && plan.calibration.is_none() {
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
    let in_ram = plan.calibration.as_ref().and_then(CalibrationPlan::curve).map(|curve| curve.levels());
    let in_rom = plan.counts.as_ref().and_then(|counts| counts.curve.as_ref()).map(CurvePlan::levels);
    let per_taxel = plan.calibration.is_some() || plan.counts.as_ref().is_some_and(CountsPlan::per_taxel);
    let counts = plan.calibration.is_some() || plan.counts.is_some();
    latency::beat_to_stress(counts, per_taxel, in_ram.or(in_rom).map(curve::stages))
}

/// When what a frame brings is there, in cycles after its first beat enters Bz, streams never waiting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// Its last beat has entered Bz.
    pub taken: u64,
    /// The frame is ready for the lanes.
    pub ready: u64,
    /// `CeAn` has its last stress.
    pub last_stress: u64,
    /// Nothing of it is in Bz any more.
    pub done: u64,
    /// What it does from here on waits while the lanes write results.
    pub waits_from: u64,
}

/// Cycles of Bz.
pub fn arrival(plan: &Plan) -> Arrival {
    let (sensor, streams) = (&plan.design.sensor, plan.streams());
    let stages = beat_to_stress(plan);
    if streams.intake != Intake::Whole {
        let dead = if plan.places_for_dead() > 0 { latency::replacing(plan.taxels()) } else { 0 };
        let taken = plan.taxels() as u64 - 1;
        let last_stress = taken + stages + dead;
        if plan.scales_frames() {
            let ready = last_stress + latency::range(plan.elements());
            return Arrival {
                taken,
                ready,
                last_stress,
                done: ready,
                waits_from: last_stress + latency::RANGE_TO_TURN + 1,
            };
        }
        let ready = last_stress + latency::stress_to_ready(plan.ways() > 1);
        return Arrival { taken, ready, last_stress, done: last_stress + 1, waits_from: 0 };
    }
    let beat_there = |taxel: usize| (taxel / streams.samples()) as u64 + stages + 1;
    // A quad a cycle, from the middle rows on, each when its last taxel is there.
    let (columns, rows) = (sensor.columns, sensor.rows);
    let last_taxels = (rows / 2..rows).flat_map(|y| (columns / 2..columns).map(move |x| y * columns + x));
    let last_quad = last_taxels.fold(0, |before, taxel| beat_there(taxel).max(before + 1));
    // A taxel a cycle.
    let last_taxel = (0..plan.taxels()).fold(0, |before, taxel| beat_there(taxel).max(before + 1));
    let last_stress = last_taxel + latency::TAXEL_TO_CEAN;
    let done = last_stress.max(last_quad + 1) + 1;
    let taken = streams.beats_in() as u64 - 1;
    Arrival { taken, ready: last_quad + latency::QUAD_TO_READY, last_stress, done, waits_from: 0 }
}

/// A multiplier each for a count's slope, a stress's gain and each place for a dead taxel.
pub fn cost(plan: &Plan) -> BlockCost {
    let (streams, data) = (plan.streams(), plan.factors().outside_bits());
    let (taxels, places) = (plan.taxels(), plan.places_for_dead());
    let conversions = streams.conversions();
    let curve = plan.counts.as_ref().and_then(|counts| counts.curve.as_ref());
    let mut memories = Vec::new();
    if let Some(counts) = plan.counts.as_ref().filter(|counts| counts.per_taxel()) {
        let depth = taxels.div_ceil(conversions);
        if curve.is_none() {
            memories.push(memory("exponents", conversions, depth, EXPONENT_BITS, true));
        }
        memories.push(memory("gains", conversions, depth, GAIN_BITS, true));
        memories.push(memory("offsets", conversions, depth, counts.offset_bits(), true));
    }
    if let Some(curve) = curve {
        memories.push(memory("curve", conversions, 1 << curve.levels(), SEGMENT_BITS, true));
    }
    if places > 0 {
        // With a stress, whether it was clipped and whether it was a number.
        memories.push(memory("whole frame", 1, taxels, LONG_BITS + 2, false));
    }
    if plan.dead.is_some() {
        memories.push(memory("neighbours", 1, taxels, WEIGHT_BITS * places as u32, true));
    }
    if streams.intake == Intake::Whole {
        // One for each taxel of a quad, and one for CeAn.
        let samples = streams.samples();
        memories.push(memory("frame by quads", CLASSES * samples, streams.beats_in(), data, false));
        memories.push(memory("frame by taxels", samples, streams.beats_in(), LONG_BITS, false));
    } else if plan.ways() > 1 && !plan.scales_frames() {
        memories.push(memory("half-folded b", 1, plan.elements(), 2 * data + 2, false));
    }
    let gain = plan.counts.is_some() || plan.calibration.is_some();
    let curve = plan.design.input.curve.is_some();
    let dsp = conversions * (usize::from(gain) + usize::from(curve)) + places;
    BlockCost::new("Bz", &["sptfra_bz", "sptfra_bz_wide"], dsp).with(memories)
}

fn of_counts(parameters: Parameters, counts: &CountsPlan) -> Parameters {
    parameters
        .flag("COUNTS", true)
        .flag("PER_TAXEL", counts.per_taxel())
        .wide("EXPONENT", EXPONENT_BITS, counts.exponents[0].into())
        .wide("GAIN", GAIN_BITS, counts.gains[0].into())
        .number("OFFSET_BITS", counts.offset_bits().into())
        .number("COUNT_SHIFT", i64::from(counts.shift) - counts.curve.as_ref().map_or(0, |curve| curve.lsb.into()))
        .wide("FULL_SCALE", ACCUMULATOR_BITS, counts.full_scale)
}

fn of_curve(parameters: Parameters, curve: &CurvePlan) -> Parameters {
    parameters.number("CURVE_LEVELS", curve.levels().into()).numbers("CURVE_KNOTS", LONG_BITS, &curve.knots()).wide(
        "CURVE_LAST",
        LONG_BITS,
        curve.last,
    )
}

/// Which taxels are replaced at power-up, in so many places.
pub(super) fn of_dead(parameters: Parameters, dead: &DeadPlan, places: usize) -> Parameters {
    let numbers = dead.taxels.iter().copied().chain(std::iter::repeat(0)).take(places);
    let numbers: Vec<String> = numbers.map(|number| format!("16'd{number}")).collect();
    let numbers: Vec<&str> = numbers.iter().rev().map(String::as_str).collect();
    parameters
        .expression("REPLACED_COUNT", format!("4'd{}", dead.taxels.len()))
        .expression("REPLACED_SHIFT", format!("5'd{}", dead.shift))
        .expression("REPLACED_TAXELS", format!("{{{}}}", numbers.join(", ")))
}
