//! What a design needs if its calibration is in RAM.

use super::DesignError;
use super::checks::Check;
use super::hardware::{CalibrationIn, Hardware};
use super::input::Input;

/// A calibration in RAM needs registers through which it is written, and counts whose gains and offsets it holds.
pub(super) fn calibration_in_ram(check: &Check, hardware: &Hardware, input: &Input) -> Result<(), DesignError> {
    let refuse = |problem: &str, remedy: &str| {
        Err(check.value("hardware.calibration", format!("is \"ram\", {problem}"), remedy.to_owned()))
    };
    if hardware.calibration == CalibrationIn::Rom {
        return Ok(());
    }
    if !hardware.control {
        return refuse(
            "and there are no registers through which it could be written",
            "add control = true, or write calibration = \"rom\"",
        );
    }
    if input.curve.is_some() {
        return refuse(
            "and a curve stands in ROM only",
            "write sensor.pa_per_count in place of sensor.curve, or calibration = \"rom\"",
        );
    }
    if input.pa_per_count.is_none() {
        return refuse(
            "and frames are in pascals, which have no gains and offsets",
            "add sensor.pa_per_count, or write calibration = \"rom\"",
        );
    }
    Ok(())
}
