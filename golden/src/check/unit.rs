//! Readings in another unit, and the keys of the design that say what a count is worth.

use super::{Kind, count};
use crate::design::{Curve, Design};

/// A peak this many times below the full scale is in another unit.
const TOO_SMALL: f64 = 1000.0;
/// So is one this many times above it: more than any converter is overdriven by.
pub(super) const TOO_LARGE: f64 = 10.0;

/// What says how many pascals a count is.
pub(super) struct Scale {
    /// The key.
    pub(super) key: &'static str,
    /// What is to be changed for another size,
    size: &'static str,
    /// and for the other sign.
    pub(super) sign: &'static str,
}

impl Scale {
    pub(super) fn of(design: &Design) -> Self {
        let [key, size, sign] = match &design.input.curve {
            Some(Curve { law: Some(_), .. }) => {
                ["sensor.curve", "sensor.curve.scale", "the sign of sensor.curve.scale"]
            }
            Some(_) => [
                "sensor.curve",
                "the pascals in the file of sensor.curve",
                "the sign of the pascals in the file of sensor.curve",
            ],
            None => ["sensor.pa_per_count", "sensor.pa_per_count", "the sign of sensor.pa_per_count"],
        };
        Self { key, size, sign }
    }
}

/// Frames whose stress is nowhere other than 0.
pub(super) fn nothing(design: &Design, frames: &[Vec<f64>]) -> (Kind, String) {
    let least = frames.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let most = frames.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
    match &design.input.curve {
        Some(curve) if least < 0.0 || most > 0.0 => (
            Kind::Range,
            format!(
                "all readings of {}, from {least} to {most}, are 0 Pa by sensor.curve, whose counts begin at {}: do counts \
                 fall where something presses, or are the frames in pascals already? Give a curve of these readings, or \
                 remove sensor.curve",
                count(frames.len()),
                curve.points[0][0]
            ),
        ),
        _ => (Kind::Empty, format!("all readings of {} are 0: is the sensor connected?", count(frames.len()))),
    }
}

/// Readings in another unit; `peak` is the largest stress in pascals.
pub(super) fn range(design: &Design, peak: f64) -> Option<String> {
    let (counts, full_scale) = (design.input.counts(), design.hardware.full_scale_pa);
    let Scale { key, size, .. } = Scale::of(design);
    let what = if counts { "stress" } else { "reading" };
    let unit = |what: &str| format!("{what}? Change the unit of the frames, or write sensor.pa_per_count,");
    let (times, side, digits, cause) = if peak * TOO_SMALL <= full_scale {
        let cause =
            if counts { format!("is a count worth more? Change {size}") } else { unit("kilopascals, or counts") };
        (full_scale / peak, "below", 3, cause)
    } else if peak >= TOO_LARGE * full_scale {
        let it = if size == key { "it" } else { size };
        let already = || format!("are the frames in pascals already? Remove {key}; if not, change {it}");
        (peak / full_scale, "above", 0, if counts { already() } else { unit("counts") })
    } else {
        return None;
    };
    Some(format!(
        "the largest {what} is {peak:.digits$} Pa, {times:.0} times {side} hardware.full_scale_pa: {cause} or \
         hardware.full_scale_pa"
    ))
}
