//! Frames that are each divided by their own largest reading.

use super::largest;

/// From so many frames on.
const FRAMES: usize = 5;
/// Whole readings below this share a largest one by chance.
const COARSE: f64 = 100.0;
/// Largest values that programs scale to.
const USUAL: [f64; 6] = [1.0, 100.0, 255.0, 1000.0, 4095.0, 65535.0];
/// The end of a converter is read by more taxels of a frame than this.
const AT_MOST: usize = 2;

/// A message where all frames, values as they are in the file, have the same largest reading and differ otherwise.
pub(super) fn check(frames: &[Vec<f64>]) -> Option<String> {
    let some: Vec<&Vec<f64>> = frames.iter().filter(|frame| largest(frame) > 0.0).collect();
    let peak = largest(some.first()?);
    let is_peak = |value: f64| (value.abs() - peak).abs() <= 1e-9 * peak;
    let whole = some.iter().all(|frame| frame.iter().all(|value| value.fract() == 0.0));
    let few = |frame: &&&Vec<f64>| frame.iter().filter(|&&value| is_peak(value)).count() <= AT_MOST;
    let differ = some.iter().any(|frame| frame != &some[0]);
    if some.len() < FRAMES || whole && peak < COARSE || !differ || !some.iter().all(|frame| is_peak(largest(frame))) {
        return None;
    }
    // The peak of one contact that stays may be the same by symmetry.
    let at = |frame: &Vec<f64>| frame.iter().position(|&value| is_peak(value));
    let moves = some.iter().any(|frame| at(frame) != at(some[0]));
    if !moves && !USUAL.contains(&peak) {
        return None;
    }
    (2 * some.iter().filter(few).count() > some.len()).then(|| {
        format!(
            "all {} frames have the same largest reading, {peak}: is each frame divided by its own largest one? Its force is \
             lost then; record the readings as the sensor gives them, or scale all frames alike",
            some.len()
        )
    })
}
