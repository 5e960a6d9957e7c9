//! How much of a recording lies outside what the sensor was calibrated for.

use std::fmt;

use serde::Serialize;

use crate::design::Design;

/// Readings at the full scale or beyond it, or beyond the ends of the sensor's curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Beyond {
    /// How many readings, of taxels that are not dead.
    pub readings: usize,
    /// Their share of all readings, from 0 to 1.
    pub share: f64,
    /// Frames with any of them.
    pub frames: usize,
}

impl fmt::Display for Beyond {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { readings, share, frames } = self;
        let what = "lie beyond what the design is calibrated for, its curve's ends or full_scale_pa";
        if *readings == 0 {
            return write!(f, "No readings {what}");
        }
        write!(f, "{:.2} % of the readings, in {frames} frames, {what}", 100.0 * share)
    }
}

/// Counts the readings of frames, values as they are in the file, that the design has no stress for.
pub fn beyond(design: &Design, frames: &[Vec<f64>]) -> Beyond {
    let (input, full_scale) = (&design.input, design.hardware.full_scale_in_frames());
    let live: Vec<usize> = (0..design.sensor.taxels()).filter(|taxel| !input.dead.contains(taxel)).collect();
    // At its lower end, of no count, a curve is still good.
    let off_curve = |count: f64| {
        input.curve.as_ref().is_some_and(|curve| {
            input.is_beyond(count) || count < curve.points[0][0] || count > curve.points[curve.points.len() - 1][0]
        })
    };
    let is_beyond = |taxel: usize, value: f64| off_curve(value) || input.to_pa(taxel, value).abs() >= full_scale;
    let of_frame = |frame: &Vec<f64>| live.iter().filter(|&&taxel| is_beyond(taxel, frame[taxel])).count();
    let counts: Vec<usize> = frames.iter().map(of_frame).collect();
    let readings = counts.iter().sum();
    let of = (live.len() * frames.len()).max(1);
    Beyond { readings, share: readings as f64 / of as f64, frames: counts.iter().filter(|&&count| count > 0).count() }
}
