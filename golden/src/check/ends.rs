//! Readings that pile up at one extreme value: the end of a converter.

use super::{PULL, count};
use crate::design::Design;
use crate::numbers::{magnitude, sorted};

/// Of smooth readings few share the largest value, and many are just below it.
const LEAST: usize = 5;
const BELOW: f64 = 0.97;
/// Of coarse readings just below is that many steps of them.
const STEPS: f64 = 3.0;
/// A converter that ends this many times below the full scale is none.
const WITHIN: f64 = 8.0;
/// So many readings of one frame are no peak: such frames, so many of them, are cut off wherever the end is.
const FLAT: usize = 4;
/// A taxel that reads the same in frames whose loads differ by this share reads no more than that.
const OTHER_LOAD: f64 = 0.1;

/// Where readings of several taxels, or of one under several loads, share the value that is the largest of their sign by
/// far: a line for each sign. `peak` is the largest magnitude of all, in pascals.
pub(super) fn check(design: &Design, frames: &[Vec<f64>], loaded: usize, peak: f64) -> Vec<String> {
    let full_scale = design.hardware.full_scale_in_frames();
    let of_sign = |sign: f64| {
        // By the values of the file, which a gain of each taxel has not touched yet.
        let own = frames.iter().flat_map(|frame| frame.iter().enumerate()).filter(|(_, value)| *value * sign > 0.0);
        let farthest = magnitude(own.map(|(taxel, &value)| design.input.to_pa(taxel, value)));
        let is_larger = farthest >= peak;
        let least = if is_larger { full_scale / WITHIN } else { PULL * peak };
        let magnitudes = frames.iter().map(|frame| frame.iter().map(|&value| value * sign));
        let (end, readings) = end_of_range(&magnitudes, 0.0)?;
        let flat = magnitudes.filter(|frame| frame.clone().filter(|&value| value >= end).count() >= FLAT).count();
        if farthest >= full_scale || farthest < least && (!is_larger || flat < FLAT) {
            return None;
        }
        let what = format!("{readings} readings of {} are exactly {}, the largest", count(loaded), end * sign);
        Some(if is_larger {
            format!(
                "{what}: the end of the converter? Write the stress there, {farthest:.0} Pa, as hardware.full_scale_pa, so \
                 that such frames get the status \"saturated\""
            )
        } else {
            format!(
                "{what} of their sign: the converter's end on that side? Readings beyond it get no status: let its \
                 range reach farther than {farthest:.0} Pa there"
            )
        })
    };
    [-1.0, 1.0].into_iter().filter_map(of_sign).collect()
}

/// The value at which readings of frames pile up above their rest, and how many do.
///
/// One contact that stays where it is has its peak at one taxel, the same in every frame: that alone is no end.
pub(crate) fn end_of_range<Frame: Iterator<Item = f64>>(
    frames: &(impl Iterator<Item = Frame> + Clone),
    rest: f64,
) -> Option<(f64, usize)> {
    let end = frames.clone().flatten().fold(f64::NEG_INFINITY, f64::max);
    let close = (BELOW * (end - rest)).min(end - rest - STEPS * step(frames.clone().flatten(), rest, end));
    let (mut at, mut below) = (0, 0);
    let mut places: Vec<usize> = Vec::new();
    let mut loads: Vec<f64> = Vec::new();
    for frame in frames.clone() {
        let (before, mut sum) = (at, 0.0);
        for (taxel, value) in frame.enumerate() {
            sum += value - rest;
            if value >= end {
                at += 1;
                places.push(taxel);
            } else if value - rest >= close {
                below += 1;
            }
        }
        if at > before {
            loads.push(sum);
        }
    }
    let several = places.iter().any(|&place| place != places[0]);
    let [least, most] = [f64::min, f64::max].map(|pick| loads.iter().copied().reduce(pick).unwrap_or(0.0));
    let other = most - least > OTHER_LOAD * magnitude([least, most]);
    (end > rest && at >= LEAST && at > 2 * below && (several || other)).then_some((end, at))
}

/// The least distance of two readings in the upper half of the range: a count, where they are counts.
fn step(readings: impl Iterator<Item = f64>, rest: f64, end: f64) -> f64 {
    let upper = sorted(readings.filter(|&value| value - rest >= 0.5 * (end - rest)));
    let distances = upper.windows(2).map(|pair| pair[1] - pair[0]).filter(|&distance| distance > 0.0);
    distances.reduce(f64::min).unwrap_or(0.0)
}
