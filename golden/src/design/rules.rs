//! Rules that bind several keys of a design file: what one key says must fit the others.

use super::checks::Check;
use super::hardware::{CalibrationIn, Hardware, MAX_LANES, Optimise, Samples};
use super::keys::SensorKeys;
use super::{Algorithm, Design, DesignError, Estimator, Filter, MAX_NOISE, MAX_SIDE_PAPER, Outputs, PlanKind, Sensor};
use crate::creep::FRAMES;
use crate::dead_taxels::MOST_DEAD;

/// Lanes of the reduced plan come in fours, one for each parity.
const LANES_MULTIPLE: usize = 4;
/// Range of the magnitude of pascals per count.
const PA_PER_COUNT: [f64; 2] = [1e-9, 1e9];
/// What to do about a key that the paper's plan does not have.
const OF_REDUCED: &str =
    "only the reduced plan has that: write plan = \"reduced\" under [algorithm], or remove the key";

/// What a frame's values are: pascals, or counts of which one key says what they are worth.
pub(super) fn counts(check: &Check, keys: &SensorKeys) -> Result<(), DesignError> {
    let SensorKeys { pa_per_count, curve, calibration, .. } = keys;
    let ([low, high], value) = (PA_PER_COUNT, pa_per_count.unwrap_or(1.0));
    check.refuse_if(
        !(low..=high).contains(&value.abs()),
        "sensor.pa_per_count",
        format!("is {value}"),
        format!("use a number from {low:e} to {high:e} or from -{high:e} to -{low:e}, negative if larger counts press"),
    )?;
    check.refuse_if(
        calibration.is_some() && pa_per_count.is_none() && curve.is_none(),
        "sensor.calibration",
        "is given, but pa_per_count is not",
        "add pa_per_count, the pascals of one count, or a curve: gains and offsets are those of counts",
    )?;
    check.refuse_if(
        pa_per_count.is_some() && curve.is_some(),
        "sensor.curve",
        "is given, and so is pa_per_count",
        "a curve says what counts are worth: remove pa_per_count",
    )
}

/// What the tables say of each other, but for those files that are not read yet.
pub(super) fn tables(
    check: &Check,
    sensor: &Sensor,
    algorithm: &Algorithm,
    hardware: &Hardware,
) -> Result<(), DesignError> {
    let Hardware { full_scale_pa, lanes, optimise, .. } = hardware;
    let floor = algorithm.noise_floor_pa;
    let is_paper = algorithm.plan == PlanKind::Paper;
    check.refuse_if(
        floor > *full_scale_pa,
        "algorithm.noise_floor_pa",
        format!("is {floor}"),
        format!("use a number greater than 0 and at most {full_scale_pa} Pa, the full scale"),
    )?;
    check.refuse_if(
        is_paper && algorithm.outputs == Outputs::Resultants,
        "algorithm.outputs",
        "is \"resultants\" with the paper's plan",
        OF_REDUCED,
    )?;
    check.refuse_if(
        is_paper && *optimise != Optimise::Throughput,
        "hardware.optimise",
        format!("is \"{optimise}\" with the paper's plan"),
        OF_REDUCED,
    )?;
    for (key, side) in [("sensor.columns", sensor.columns), ("sensor.rows", sensor.rows)] {
        check.refuse_if(
            is_paper && side > MAX_SIDE_PAPER,
            key,
            format!("is {side} with the paper's plan, which has matrices for at most {MAX_SIDE_PAPER}"),
            "write plan = \"reduced\" under [algorithm] and a multiple of 4 for lanes",
        )?;
    }
    check.refuse_if(
        !is_paper && matches!(algorithm.filter, Filter::F3 { .. }),
        "algorithm.filter",
        "is of kind \"f3\", which chooses for each matrix of the paper; the reduced plan has other matrices",
        "write plan = \"paper\" or another filter",
    )?;
    check.refuse_if(
        !is_paper && !lanes.is_multiple_of(LANES_MULTIPLE),
        "hardware.lanes",
        format!("is {lanes} with the reduced plan"),
        format!("use a multiple of 4 from 4 to {MAX_LANES}, or write plan = \"paper\" under [algorithm]"),
    )?;
    check.refuse_if(
        *optimise == Optimise::Area && algorithm.estimator != Estimator::Joint,
        "hardware.optimise",
        "is \"area\", which needs estimator = \"joint\"",
        "set it, or remove the key",
    )
}

/// What dead taxels and the hardware's input need of the sensor.
pub(super) fn input(check: &Check, design: &Design) -> Result<(), DesignError> {
    let Design { input, hardware, .. } = design;
    let (room, dead) = (input.room, input.dead.len());
    let most = MOST_DEAD.min(design.sensor.taxels() / 2);
    let in_ram = hardware.calibration == CalibrationIn::Ram;
    let [fewest, longest] = FRAMES;
    check.refuse_if(
        dead > most,
        "sensor.dead",
        format!("has {dead} taxels, with those of gain 0 in the calibration"),
        format!("at most {most} of this sensor's can be replaced: mend the sensor, or leave out the part of it"),
    )?;
    check.refuse_if(
        input.noise > MAX_NOISE,
        "sensor.noise",
        format!("is {:.1} % of the largest reading", 100.0 * input.noise),
        format!("shear needs at most {} %: press harder, or use a quieter sensor", 100.0 * MAX_NOISE),
    )?;
    check.refuse_if(
        input.measured_noise.is_some() && input.curve.is_some(),
        "sensor.noise",
        "is a deviation in counts, which a curve makes unlike at each stress",
        "write the share that `sptfra check --unloaded --loaded` prints, noise = 0.01",
    )?;
    check.refuse_if(
        input.typical_pa().is_some_and(|largest| largest > hardware.full_scale_pa),
        "sensor.noise.largest",
        format!("is {} Pa, beyond the full scale", input.typical_pa().unwrap_or(0.0)),
        format!("write at most full_scale_pa = {}, or raise that", hardware.full_scale_pa),
    )?;
    check.refuse_if(
        input.creep.is_some_and(|creep| !(fewest..=longest).contains(&creep.frames())),
        "sensor.creep",
        format!("has a time constant of {} frames", input.creep.map_or(0.0, |creep| creep.frames())),
        format!("seconds times frames_per_second is {fewest} to {longest}; send every nth frame, or remove the key"),
    )?;
    check.refuse_if(
        input.smoothing > 0 && input.noise <= 0.0,
        "sensor.smoothing",
        format!("is {}, and sensor.noise is 0, so that every frame would restart it", input.smoothing),
        "state the noise of the sensor, which `sptfra check --unloaded` measures, or remove the key",
    )?;
    check.refuse_if(
        hardware.samples != Samples::Float32 && !input.counts(),
        "hardware.samples",
        format!("is \"{}\", and frames are in pascals", hardware.samples),
        "integers are counts: add sensor.pa_per_count or sensor.curve",
    )?;
    check.refuse_if(
        room != 0 && !in_ram,
        "sensor.dead.room",
        format!("is {room}, and the map of dead taxels stands in ROM"),
        "add calibration = \"ram\" under [hardware], or write dead = [...]: the design's own need no room",
    )?;
    check.refuse_if(
        room != 0 && dead > room,
        "sensor.dead.room",
        format!("is {room}, and {dead} taxels are dead"),
        "give at least as many as there are dead taxels, with those of gain 0 in the calibration",
    )?;
    check.refuse_if(
        in_ram && !hardware.control,
        "hardware.calibration",
        "is \"ram\", and there are no registers through which it could be written",
        "add control = true, or write calibration = \"rom\"",
    )?;
    check.refuse_if(
        in_ram && !input.counts(),
        "hardware.calibration",
        "is \"ram\", and frames are in pascals, which have no gains and offsets",
        "add sensor.pa_per_count or sensor.curve, or write calibration = \"rom\"",
    )
}
