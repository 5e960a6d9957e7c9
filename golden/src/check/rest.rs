//! What taxels read that nothing touches.

use super::unit::Scale;
use super::{FAINT, count, holds, largest};
use crate::design::Design;
use crate::numbers::mean;

/// This part of the taxels touches nothing: the least loaded ones, or those farthest from where a frame has its peak.
const PART: usize = 4;
/// Without an offset they read as often above as below 0: at most this share of them to one side.
const ONE_SIDE: f64 = 0.9;
/// A pull of the whole rest is one only if it is larger than that of the layer around a contact, as a share of the peak.
const LIFTED: f64 = 0.02;

/// A load, or a pull, that even the taxels have that touch nothing; `is_tared`: frames without contact read nothing.
pub(super) fn check(design: &Design, loaded: &[Vec<f64>], is_tared: bool) -> Option<String> {
    let sensor = &design.sensor;
    if let Some(message) = pressed(design, loaded, is_tared) {
        return Some(message);
    }
    // The mean of the rest, where nearly all of it is on one side of 0.
    let rest = |frame: &Vec<f64>| -> f64 {
        let peak = (0..frame.len()).max_by(|&a, &b| frame[a].abs().total_cmp(&frame[b].abs())).unwrap_or(0);
        let distance = |taxel: usize| {
            let ([x, y], [far_x, far_y]) = (sensor.position_m(peak), sensor.position_m(taxel));
            (x - far_x).hypot(y - far_y)
        };
        let mut taxels: Vec<usize> = (0..frame.len()).collect();
        taxels.sort_by(|&a, &b| distance(b).total_cmp(&distance(a)));
        let rest: Vec<f64> = taxels.iter().take(frame.len().div_ceil(PART)).map(|&taxel| frame[taxel]).collect();
        let above = rest.iter().filter(|&&stress| stress > 0.0).count() as f64 / rest.len() as f64;
        let mean = mean(&rest);
        if above >= ONE_SIDE && mean > LIFTED * largest(frame) { mean } else { 0.0 }
    };
    let rests: Vec<f64> = loaded.iter().map(rest).filter(|&mean| mean > 0.0).collect();
    holds(rests.len(), loaded.len()).then(|| {
        let mean = mean(&rests);
        format!(
            "even the taxels that touch nothing pull in {} of {}, by {mean:.0} Pa: was something on the sensor when it was \
             tared, or has it drifted? Tare it anew, or write its offsets into the file of sensor.calibration",
            rests.len(),
            count(loaded.len())
        )
    })
}

/// The least loaded quarter of the taxels is pressed.
fn pressed(design: &Design, loaded: &[Vec<f64>], is_tared: bool) -> Option<String> {
    let rest = |frame: &Vec<f64>| {
        let mut sorted = frame.clone();
        sorted.sort_by(|a, b| b.total_cmp(a));
        let quarter = &sorted[..sorted.len().div_ceil(PART)];
        mean(quarter)
    };
    let rests: Vec<f64> = loaded.iter().map(rest).collect();
    let pressed = rests.iter().zip(loaded).filter(|(rest, frame)| **rest < -FAINT * largest(frame)).count();
    let mean = mean(&rests);
    holds(pressed, loaded.len()).then(|| {
        let cause = if -2.0 * mean > design.hardware.full_scale_pa {
            format!(
                "do the readings fall where something presses? Change {}, and give each taxel's unloaded reading as its offset \
                 in the file of sensor.calibration",
                Scale::of(design).sign
            )
        } else if is_tared {
            "as frames without contact read nothing, the contact covers the grid, and part of it is not seen. Press with \
             something smaller"
                .to_owned()
        } else {
            "is the tare missing? Subtract a frame without contact, or write its offsets into the file of \
             sensor.calibration"
                .to_owned()
        };
        format!(
            "every taxel is loaded in {pressed} of {}, the least loaded quarter by {:.0} Pa: {cause}",
            count(loaded.len()),
            -mean
        )
    })
}
