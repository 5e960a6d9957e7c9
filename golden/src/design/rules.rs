//! Rules that bind several keys of a design file: what one key says must fit the others.

use super::checks::Check;
use super::hardware::{CalibrationIn, Hardware, MAX_LANES, Optimise, Samples};
use super::input::Input;
use super::{Algorithm, Design, DesignError, Estimator, Filter, MAX_SIDE_PAPER, Outputs, PlanKind, Sensor};
use crate::dead_taxels::MOST_DEAD;
use crate::estimators::joint::Grid;

/// Lanes of the reduced plan come in fours, one for each class of parity.
const LANES_MULTIPLE: usize = 4;
/// Range of the magnitude of pascals per count.
const PA_PER_COUNT: [f64; 2] = [1e-9, 1e9];

/// What a frame's values are: pascals, or counts of which one key says what they are worth.
pub(super) fn counts(
    check: &Check,
    pa_per_count: Option<f64>,
    curve: bool,
    calibration: bool,
) -> Result<(), DesignError> {
    let [low, high] = PA_PER_COUNT;
    if let Some(value) = pa_per_count
        && !(low..=high).contains(&value.abs())
    {
        return Err(check.value(
            "sensor.pa_per_count",
            format!("is {value}"),
            format!(
                "use a number from {low:e} to {high:e} or from -{high:e} to -{low:e}, negative if larger counts press"
            ),
        ));
    }
    if calibration && pa_per_count.is_none() && !curve {
        return Err(check.value(
            "sensor.calibration",
            "is given, but pa_per_count is not".to_owned(),
            "add pa_per_count, the pascals of one count, or a curve: gains and offsets are those of counts".to_owned(),
        ));
    }
    if pa_per_count.is_some() && curve {
        let remedy = "a curve says what counts are worth: remove pa_per_count".to_owned();
        return Err(check.value("sensor.curve", "is given, and so is pa_per_count".to_owned(), remedy));
    }
    Ok(())
}

/// Dead taxels are replaced by their neighbours, of which enough have to be alive.
pub(super) fn dead(check: &Check, dead: usize, taxels: usize) -> Result<(), DesignError> {
    let most = MOST_DEAD.min(taxels / 2);
    if dead <= most {
        return Ok(());
    }
    Err(check.value(
        "sensor.dead",
        format!("has {dead} taxels, with those of gain 0 in the calibration"),
        format!("at most {most} of this sensor's can be replaced: mend the sensor, or leave out the part of it"),
    ))
}

/// What the tables say of each other, but for those files that are not read yet.
pub(super) fn tables(
    check: &Check,
    sensor: &Sensor,
    algorithm: &Algorithm,
    hardware: &Hardware,
) -> Result<(), DesignError> {
    let full_scale_pa = hardware.full_scale_pa;
    if algorithm.noise_floor_pa > full_scale_pa {
        return Err(check.value(
            "algorithm.noise_floor_pa",
            format!("is {}", algorithm.noise_floor_pa),
            format!("use a number greater than 0 and at most {full_scale_pa} Pa, the full scale"),
        ));
    }
    match algorithm.plan {
        PlanKind::Paper => paper(check, sensor, algorithm, hardware),
        PlanKind::Reduced => reduced(check, algorithm, hardware),
    }
}

fn paper(check: &Check, sensor: &Sensor, algorithm: &Algorithm, hardware: &Hardware) -> Result<(), DesignError> {
    let needs = |key: &str, problem: String| {
        let remedy = "only the reduced plan has that: write plan = \"reduced\" under [algorithm], or remove the key";
        Err(check.value(key, problem, remedy.to_owned()))
    };
    if algorithm.outputs == Outputs::Resultants {
        return needs("algorithm.outputs", "is \"resultants\" with the paper's plan".to_owned());
    }
    if hardware.optimise != Optimise::Throughput {
        return needs("hardware.optimise", format!("is \"{}\" with the paper's plan", hardware.optimise));
    }
    for (key, side) in [("sensor.columns", sensor.columns), ("sensor.rows", sensor.rows)] {
        if side > MAX_SIDE_PAPER {
            return Err(check.value(
                key,
                format!("is {side} with the paper's plan, which has matrices for at most {MAX_SIDE_PAPER}"),
                "write plan = \"reduced\" under [algorithm] and a multiple of 4 for lanes".to_owned(),
            ));
        }
    }
    Ok(())
}

fn reduced(check: &Check, algorithm: &Algorithm, hardware: &Hardware) -> Result<(), DesignError> {
    if matches!(algorithm.filter, Filter::F3 { .. }) {
        return Err(check.value(
            "algorithm.filter",
            "is of kind \"f3\", which chooses for each matrix of the paper; the reduced plan has other matrices"
                .to_owned(),
            "write plan = \"paper\" or another filter".to_owned(),
        ));
    }
    if !hardware.lanes.is_multiple_of(LANES_MULTIPLE) {
        return Err(check.value(
            "hardware.lanes",
            format!("is {} with the reduced plan", hardware.lanes),
            format!("use a multiple of 4 from 4 to {MAX_LANES}, or write plan = \"paper\" under [algorithm]"),
        ));
    }
    if hardware.optimise == Optimise::Area
        && (algorithm.estimator != Estimator::Joint || algorithm.joint.grid != Grid::FINE)
    {
        return Err(check.value(
            "hardware.optimise",
            "is \"area\", which makes the joint estimator's search of its fine grid smaller, and there is no such search"
                .to_owned(),
            "write estimator = \"joint\" and grid = 21, or remove the key".to_owned(),
        ));
    }
    Ok(())
}

/// What the hardware's input needs of the sensor.
pub(super) fn input(check: &Check, design: &Design) -> Result<(), DesignError> {
    let Design { input, hardware, .. } = design;
    if hardware.samples != Samples::Float32 && !input.counts() {
        return Err(check.value(
            "hardware.samples",
            format!("is \"{}\", and frames are in pascals", hardware.samples),
            "integers are counts: add sensor.pa_per_count or sensor.curve".to_owned(),
        ));
    }
    match hardware.calibration {
        CalibrationIn::Rom => in_rom(check, input.room),
        CalibrationIn::Ram => in_ram(check, hardware, input),
    }
}

/// A calibration in ROM has the design's dead taxels, for good.
fn in_rom(check: &Check, room: usize) -> Result<(), DesignError> {
    if room == 0 {
        return Ok(());
    }
    Err(check.value(
        "sensor.dead.room",
        format!("is {room}, and the map of dead taxels stands in ROM"),
        "add calibration = \"ram\" under [hardware], or write dead = [...]: the design's own dead taxels need no room"
            .to_owned(),
    ))
}

/// A calibration in RAM needs registers through which it is written, and counts whose gains and offsets it holds.
fn in_ram(check: &Check, hardware: &Hardware, input: &Input) -> Result<(), DesignError> {
    let refuse = |problem: &str, remedy: &str| {
        Err(check.value("hardware.calibration", format!("is \"ram\", {problem}"), remedy.to_owned()))
    };
    let Input { room, dead, .. } = input;
    if *room != 0 && dead.len() > *room {
        return Err(check.value(
            "sensor.dead.room",
            format!("is {room}, and {} taxels are dead", dead.len()),
            "give at least as many as there are dead taxels, with those of gain 0 in the calibration".to_owned(),
        ));
    }
    if !hardware.control {
        return refuse(
            "and there are no registers through which it could be written",
            "add control = true, or write calibration = \"rom\"",
        );
    }
    if !input.counts() {
        return refuse(
            "and frames are in pascals, which have no gains and offsets",
            "add sensor.pa_per_count or sensor.curve, or write calibration = \"rom\"",
        );
    }
    Ok(())
}
