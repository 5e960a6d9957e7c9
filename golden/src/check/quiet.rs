//! Frames of a sensor on which nothing presses, tared or not, whether it reads what pulls or not.

use super::{ABOVE_NOISE, FAR_ABOVE, LOADED, LOUD, PRESSES, count, holds, largest};
use crate::design::Design;
use crate::numbers::mean;
use crate::sensor::Sensor;

/// From so many frames on, what stays is separated from what varies.
const FRAMES: usize = 8;
/// Neighbours vary on their own where nothing presses; under a contact this share of it is in common.
pub(super) const TOGETHER: f64 = 0.3;
/// Offsets are up to this share of the full scale.
const OFFSET: f64 = 0.05;
/// An offset is one, and no noise, from so many deviations on.
const CLEAR: f64 = 3.0;

/// A message where frames, in pascals, are those of an unloaded sensor.
pub(super) fn check(design: &Design, stress: &[Vec<f64>]) -> Option<String> {
    let full_scale = design.hardware.full_scale_pa;
    // Noise that the design states may be louder.
    let loud = (LOUD * full_scale).max(FAR_ABOVE * design.algorithm.noise_floor_pa);
    let peak = stress.iter().map(|frame| largest(frame)).fold(0.0, f64::max);
    let remedy = "`sptfra check DESIGN --frames FRAMES --unloaded` gives each taxel's offset, noise and drift";
    let floor = |mean: f64| (10.0 * ABOVE_NOISE * mean).ceil() / 10.0;
    if peak < loud
        && let Some((noise, of, mean)) = noise(&design.sensor, stress, peak)
    {
        return Some(format!(
            "nothing presses in {noise} of {}: readings of either sign, {mean:.3} Pa in the mean, add up to nothing. If the \
             sensor was unloaded, write algorithm.noise_floor_pa = {:.1}, and such frames have the status \"no contact\"; \
             {remedy}",
            count(of),
            floor(mean)
        ));
    }
    let (offset, mean) = still(&design.sensor, stress, loud, OFFSET * full_scale)?;
    let of = count(stress.len());
    let begin = if offset > 0.0 {
        format!("nothing presses in {of}, or it never moves: taxels stay at offsets of up to {offset:.0} Pa")
    } else {
        format!("nothing presses in {of}: taxels stay as they are")
    };
    Some(format!(
        "{begin}, within {mean:.3} Pa in the mean, each on its own. If the sensor was unloaded, {remedy}, and writes them \
         into a calibration; the noise floor is algorithm.noise_floor_pa = {:.1}",
        floor(mean)
    ))
}

/// In how many of how many loaded frames readings of both signs add up to nothing, and their mean magnitude.
fn noise(sensor: &Sensor, stress: &[Vec<f64>], peak: f64) -> Option<(usize, usize, f64)> {
    let loaded: Vec<&Vec<f64>> = stress.iter().filter(|frame| largest(frame) >= LOADED * peak).collect();
    let all = |frame: &[f64]| frame.iter().map(|stress| stress.abs()).sum::<f64>();
    // The sum of m Gaussian readings has 1.25 / √m of their magnitudes as its deviation.
    let chance = PRESSES.max((4.0 / (sensor.taxels() as f64).sqrt()).min(0.5));
    let is_noise = |frame: &&&Vec<f64>| {
        let share = frame.iter().sum::<f64>().abs() / all(frame);
        // A contact that is dragged hard adds up to little as well; its neighbours read alike.
        share < PRESSES || share < chance && together(sensor, frame) < TOGETHER
    };
    let noise = loaded.iter().filter(is_noise).count();
    let mean = loaded.iter().map(|frame| all(frame) / frame.len() as f64).fold(0.0, f64::max);
    holds(noise, loaded.len()).then_some((noise, loaded.len(), mean))
}

/// Frames in which no taxel moves but for noise below `loud`, with offsets below `far`. Returns the largest offset (0: none)
/// and the mean magnitude of the noise, in pascals.
fn still(sensor: &Sensor, stress: &[Vec<f64>], loud: f64, far: f64) -> Option<(f64, f64)> {
    if stress.len() < FRAMES {
        return None;
    }
    let (frames, taxels) = (stress.len() as f64, sensor.taxels());
    let means: Vec<f64> = (0..taxels).map(|taxel| mean(stress.iter().map(|frame| frame[taxel]))).collect();
    let rest: Vec<Vec<f64>> =
        stress.iter().map(|frame| frame.iter().zip(&means).map(|(stress, mean)| stress - mean).collect()).collect();
    let squares: f64 = rest.iter().flatten().map(|stress| stress * stress).sum();
    let deviation = (squares / (frames * taxels as f64)).sqrt();
    let moves = rest.iter().map(|frame| largest(frame)).fold(0.0, f64::max) >= loud;
    // Each frame by its own squares, so that a contact in few frames is not lost among many.
    let common = mean(rest.iter().map(|frame| together(sensor, frame)));
    if moves || squares <= 0.0 || common >= TOGETHER || largest(&means) >= far {
        return None;
    }
    // A peak that noise does not have is something that passes.
    if rest.iter().any(|frame| largest(frame) > 8.0 * deviation && together(sensor, frame) >= TOGETHER) {
        return None;
    }
    let has_offset = largest(&means) > CLEAR * deviation;
    let pairs = (2 * taxels) as f64;
    if has_offset && together(sensor, &means) >= (0.2 + 2.0 / pairs.sqrt()).min(0.5) {
        return None;
    }
    let mean = mean(rest.iter().flatten().map(|stress| stress.abs()));
    Some((if has_offset { largest(&means) } else { 0.0 }, mean))
}

/// Correlation of taxels with those beside them, about the mean of all, from -1 to 1; 0 of values that are all the same.
pub(crate) fn together(sensor: &Sensor, values: &[f64]) -> f64 {
    let (columns, rows) = (sensor.columns, sensor.rows);
    let mean = mean(values);
    let at = |x: usize, y: usize| values[y * columns + x] - mean;
    let (mut products, mut squares) = (0.0, 0.0);
    let mut pair = |a: f64, b: f64| {
        products += a * b;
        squares += f64::midpoint(a * a, b * b);
    };
    for y in 0..rows {
        for x in 0..columns {
            if x + 1 < columns {
                pair(at(x, y), at(x + 1, y));
            }
            if y + 1 < rows {
                pair(at(x, y), at(x, y + 1));
            }
        }
    }
    if squares > 0.0 { products / squares } else { 0.0 }
}
