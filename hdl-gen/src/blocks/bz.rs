//! Bz, the stream's frames to fixed point: `sptfra_bz`.

use golden::design::Samples;

use super::registers::samples;
use crate::cores::{ACCUMULATOR_BITS, LONG_BITS};
use crate::format::address_bits;
use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::calibration::{CalibrationPlan, CurveMap};
use crate::plan::counts::{CountsPlan, EXPONENT_BITS};
use crate::plan::creep;
use crate::plan::crosstalk;
use crate::plan::curve::{self, CurvePlan, SEGMENT_BITS};
use crate::plan::dead::{DeadPlan, WEIGHT_BITS};
use crate::plan::gain::{GAIN_BITS, LARGEST_NUMBER};
use crate::plan::smoothing;
use crate::plan::streams::Streams;
use crate::resources::BlockCost;
use crate::resources::memory::memory;
use crate::timing::durations::Arrival;
use crate::timing::latency;

/// What the ROM files of taxels' constants are called behind the design's name: one for each sample that is converted at a
/// time.
pub fn taxel_files(streams: Streams) -> Vec<String> {
    (0..streams.conversions()).map(|sample| format!("_sample{sample}")).collect()
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
    let in_rom = plan.counts.is_some() || plan.dead.is_some() || plan.calibration.is_some();
    Parameters::new()
        .count("COLUMNS", plan.design.sensor.columns)
        .count("ROWS", plan.design.sensor.rows)
        .count("SAMPLES", streams.conversions())
        .count("CHANNELS", plan.channels())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .flag("SCALED", plan.scales_frames())
        .when(streams.sample != Samples::Float32, |all| all.number("SAMPLE", samples(plan).into()))
        .number("NUMBER_SHIFT", shift.into())
        .signed("NUMBER_BOUND", LONG_BITS, bound)
        .some(plan.counts.as_ref(), of_counts)
        .some(curve, of_curve)
        .some(plan.dead.as_ref(), |all, dead| {
            of_dead(all.count("REPLACEABLE", dead.taxels.len()), dead, dead.taxels.len())
        })
        .some(plan.crosstalk.as_ref(), |all, of| all.unsigned("CROSSTALK", crosstalk::PARAMETER_BITS, of.bits()))
        .some(plan.creep.as_ref(), |all, of| all.unsigned("CREEP", creep::PARAMETER_BITS, of.bits()))
        .some(plan.smoothing.as_ref(), |all, of| all.unsigned("SMOOTHING", smoothing::PARAMETER_BITS, of.bits()))
        .some(plan.calibration.as_ref(), of_calibration)
        .signed("STRESS_BOUND", LONG_BITS, stress.bound)
        .when(in_rom, |all| all.outer("ROM_DIR").text("ROM_NAME", &plan.design.name))
        .cycles("EXPECTED_STAGES", beat_to_stress(plan))
}

/// Cycles from a beat to its stress.
pub fn beat_to_stress(plan: &Plan) -> u64 {
    let in_ram = plan.calibration.as_ref().and_then(CalibrationPlan::curve).map(|curve| curve.levels());
    let in_rom = plan.counts.as_ref().and_then(|counts| counts.curve.as_ref()).map(CurvePlan::levels);
    let per_taxel = plan.calibration.is_some() || plan.counts.as_ref().is_some_and(CountsPlan::per_taxel);
    let counts = plan.calibration.is_some() || plan.counts.is_some();
    latency::beat_to_stress(counts, per_taxel, in_ram.or(in_rom).map(curve::stages))
}

/// Cycles of Bz.
pub fn arrival(plan: &Plan) -> Arrival {
    let (sensor, streams) = (&plan.design.sensor, plan.streams());
    let samples = streams.conversions();
    let dead = if plan.places_for_dead() > 0 { latency::replacing(plan.taxels()) } else { 0 };
    let crosstalk = if plan.crosstalk.is_some() { latency::crosstalk(sensor) } else { 0 };
    let creep = if plan.creep.is_some() { latency::CREEP } else { 0 };
    let there = |taxel: usize| (taxel / samples) as u64 + beat_to_stress(plan) + dead + crosstalk + creep;
    let last = there(plan.taxels() - 1);
    // It is decided whether the average restarts.
    let decided = last + latency::SMOOTHING + latency::smoothing_decided(samples);
    // A taxel a cycle.
    let last_stress = if plan.smoothing.is_some() {
        decided + latency::TAXEL_TO_CEAN + plan.taxels() as u64 - 1
    } else if samples == 1 {
        last
    } else {
        (0..plan.taxels()).fold(0, |before, taxel| (there(taxel) + 1).max(before + 1)) + latency::TAXEL_TO_CEAN
    };
    // Each element when its last taxel is there, orbits from the middle rows on. Where frames are scaled, when the scale is;
    // where they are averaged, when it is decided whether the average restarts.
    let (columns, rows) = if plan.channels() > 1 { (sensor.columns / 2, sensor.rows / 2) } else { (0, 0) };
    let last_taxels = (rows..sensor.rows).flat_map(|y| (columns..sensor.columns).map(move |x| y * sensor.columns + x));
    let element = |taxel| match (plan.scales_frames(), &plan.smoothing) {
        (true, Some(_)) => last + latency::SMOOTHING + latency::frame_scale(samples),
        (true, None) => last + latency::frame_scale(samples),
        (false, Some(_)) => decided,
        (false, None) => there(taxel) + 1,
    };
    Arrival {
        taken: plan.taxels().div_ceil(samples) as u64 - 1,
        elements: last_taxels.map(element).collect(),
        read_to_write: latency::read_to_write(plan.scales_frames()),
        last_stress,
    }
}

/// A multiplier each for a count's slope, a stress's gain, each place for a dead taxel, crosstalk and smoothing; two for creep.
pub fn cost(plan: &Plan) -> BlockCost {
    let (streams, stress) = (plan.streams(), plan.factors().outside_bits());
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
    if plan.crosstalk.is_some() {
        // With a stress, three flags.
        memories.push(memory("frame with crosstalk", 1, taxels, LONG_BITS + 3, false));
    }
    if plan.creep.is_some() {
        memories.push(memory("creep", 1, 2 << address_bits(taxels), creep::WORD_BITS, false));
    }
    if plan.dead.is_some() {
        memories.push(memory("neighbours", 1, taxels, WEIGHT_BITS * places as u32, true));
    }
    // A copy for each taxel of an element, of the half of the frame that it is in; and one for CeAn.
    let beats = |taxels: usize| taxels.div_ceil(conversions);
    let half = if plan.channels() > 1 { plan.design.sensor.rows.div_ceil(2) } else { plan.design.sensor.rows };
    let kept = beats(half * plan.design.sensor.columns);
    let candidates = if plan.smoothing.is_some() { 2 } else { 1 };
    memories.push(memory("frame by elements", plan.channels() * conversions, kept, candidates * stress, false));
    if plan.smoothing.is_some() {
        let width = conversions as u32 * smoothing::WORD_BITS;
        memories.push(memory("averages", 1, 2 << address_bits(beats(taxels)), width, false));
    }
    if conversions > 1 || plan.smoothing.is_some() {
        let width = candidates * LONG_BITS + u32::from(places > 0);
        memories.push(memory("frame by taxels", conversions, beats(taxels), width, false));
    }
    let gain = plan.counts.is_some() || plan.calibration.is_some();
    let curve = plan.design.input.curve.is_some();
    let dsp = conversions * (usize::from(gain) + usize::from(curve)) + places;
    let dsp = dsp
        + usize::from(plan.crosstalk.is_some())
        + 2 * usize::from(plan.creep.is_some())
        + usize::from(plan.smoothing.is_some());
    BlockCost::new("Bz", &["sptfra_bz"], dsp).with(memories)
}

fn of_counts(parameters: Parameters, counts: &CountsPlan) -> Parameters {
    parameters
        .flag("COUNTS", true)
        .flag("PER_TAXEL", counts.per_taxel())
        .signed("EXPONENT", EXPONENT_BITS, counts.exponents[0].into())
        .signed("GAIN", GAIN_BITS, counts.gains[0].into())
        .number("OFFSET_BITS", counts.offset_bits().into())
        .number("COUNT_SHIFT", i64::from(counts.shift) - counts.curve.as_ref().map_or(0, |curve| curve.lsb.into()))
        .signed("FULL_SCALE", ACCUMULATOR_BITS, counts.full_scale)
}

fn of_curve(parameters: Parameters, curve: &CurvePlan) -> Parameters {
    parameters.number("CURVE_LEVELS", curve.levels().into()).numbers("CURVE_KNOTS", LONG_BITS, curve.knots()).signed(
        "CURVE_LAST",
        LONG_BITS,
        curve.last,
    )
}

/// Of a calibration in RAM.
fn of_calibration(parameters: Parameters, of: &CalibrationPlan) -> Parameters {
    let map = &of.power_up.dead;
    parameters
        .flag("COUNTS", true)
        .flag("CALIBRATED", true)
        .flag("PER_TAXEL", true)
        .number("OFFSET_BITS", of.offset_bits().into())
        .number("COUNT_SHIFT", i64::from(of.shift) - of.curve().map_or(0, |curve| curve.lsb.into()))
        .signed("FULL_SCALE", ACCUMULATOR_BITS, of.full_scale)
        .some(of.power_up.curve.as_ref(), of_bank_curve)
        .when(map.room > 0, |all| of_dead(all.count("REPLACEABLE", map.room).flag("MAPPED", true), &map.dead, map.room))
}

fn of_bank_curve(parameters: Parameters, map: &CurveMap) -> Parameters {
    let knots = (0..map.format.room).map(|place| i64::from(map.segment(place)[0].cast_signed()));
    parameters
        .number("CURVE_LEVELS", map.format.levels().into())
        .numbers("CURVE_KNOTS", LONG_BITS, knots.collect())
        .signed("CURVE_LAST", LONG_BITS, map.curve.last)
        .unsigned("CURVE_COUNT", 7, map.curve.segments.len() as u64)
        .signed("CURVE_LAST_VALUE", LONG_BITS, map.end)
}

/// Which taxels are replaced at power-up, in so many places.
fn of_dead(parameters: Parameters, dead: &DeadPlan, places: usize) -> Parameters {
    let numbers = dead.taxels.iter().map(|&number| number as u64).chain(std::iter::repeat(0)).take(places);
    let head = u64::from(dead.shift) << 4 | dead.taxels.len() as u64;
    parameters.list("REPLACED", 16, std::iter::once(head).chain(numbers))
}
