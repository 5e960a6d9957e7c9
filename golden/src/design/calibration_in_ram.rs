//! What a design needs if its calibration is in RAM.

use super::DesignError;
use super::checks::Check;
use super::hardware::{CalibrationIn, Hardware, REPLACEABLE};
use super::input::Input;

/// How many dead taxels a bank has room for.
pub(super) fn replaceable(check: &Check, given: Option<i64>) -> Result<usize, DesignError> {
    let Some(given) = given else { return Ok(0) };
    REPLACEABLE.into_iter().find(|&room| room as i64 == given).ok_or_else(|| {
        let remedy = "use 1, 2, 4 or 8, or 0 for the design's own dead taxels, for good".to_owned();
        check.value("hardware.replaceable", format!("is {given}"), remedy)
    })
}

/// A calibration in RAM needs registers through which it is written, and counts whose gains and offsets it holds.
pub(super) fn calibration_in_ram(check: &Check, hardware: &Hardware, input: &Input) -> Result<(), DesignError> {
    let refuse = |problem: &str, remedy: &str| {
        Err(check.value("hardware.calibration", format!("is \"ram\", {problem}"), remedy.to_owned()))
    };
    let most = hardware.replaceable;
    let of_map = |problem: String, remedy: &str| Err(check.value("hardware.replaceable", problem, remedy.to_owned()));
    if hardware.calibration == CalibrationIn::Rom {
        if most != 0 {
            return of_map(
                format!("is {most}, and the map of dead taxels stands in ROM"),
                "add calibration = \"ram\", or remove replaceable: sensor.dead needs no room in a bank",
            );
        }
        return Ok(());
    }
    if most != 0 && input.dead.len() > most {
        return of_map(
            format!("is {most}, and {} taxels are dead", input.dead.len()),
            "give at least as many as sensor.dead has, with those of gain 0 in the calibration",
        );
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
