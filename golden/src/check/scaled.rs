//! Frames that are each divided by their own largest reading, or sum.

use super::largest;

/// From so many frames on.
const FRAMES: usize = 5;
/// Whole readings below this share a largest one by chance.
const COARSE: f64 = 100.0;
/// Largest values that programs scale to.
const USUAL: [f64; 6] = [1.0, 100.0, 255.0, 1000.0, 4095.0, 65535.0];
/// The end of a converter is read by more taxels of a frame than this.
const AT_MOST: usize = 2;
/// Values are the same but for this share of them, and sums of printed ones but for that.
const SAME: f64 = 1e-9;
const PRINTED: f64 = 1e-4;

/// A message where all frames, values as they are in the file, have the same largest reading or a sum of 1, and differ
/// otherwise.
pub(super) fn check(frames: &[Vec<f64>]) -> Option<String> {
    let some: Vec<&Vec<f64>> = frames.iter().filter(|frame| largest(frame) > 0.0).collect();
    let [peak, total] = [largest(some.first()?), sum(some[0])];
    let whole = some.iter().all(|frame| frame.iter().all(|value| value.fract() == 0.0));
    if some.len() < FRAMES || whole && peak < COARSE || some.iter().all(|frame| frame == &some[0]) {
        return None;
    }
    let alike = |a: f64, b: f64, within: f64| (a - b).abs() <= within * a.abs();
    let same = |of: fn(&[f64]) -> f64, within: f64| some.iter().all(|frame| alike(of(some[0]), of(frame), within));
    let few = |of: fn(&[f64]) -> f64| {
        let at = |frame: &[f64]| frame.iter().filter(|value| alike(of(frame), value.abs(), SAME)).count();
        2 * some.iter().filter(|frame| at(frame) <= AT_MOST).count() > some.len()
    };
    // The peak of one contact that stays may be the same by symmetry.
    let at = |frame: &[f64]| frame.iter().position(|value| alike(peak, value.abs(), SAME));
    let moves = some.iter().any(|frame| at(frame) != at(some[0]));
    // From 0 to 1, what does not press may be the 1.
    let is_usual = USUAL.contains(&peak);
    let is_one =
        (moves || is_usual) && few(largest) || is_usual && least(some[0]) == 0.0 && same(least, SAME) && few(least);
    let (what, value) = if same(largest, SAME) && is_one {
        ("largest reading", peak)
    } else if same(sum, PRINTED) && [1.0, 100.0].iter().any(|&usual| alike(usual, total, PRINTED)) {
        ("sum", total)
    } else {
        return None;
    };
    Some(format!(
        "all {} frames have the same {what}, {value}: is each frame divided by its own? Its force is lost then; record the \
         readings as the sensor gives them, or scale all frames alike",
        some.len()
    ))
}

fn least(frame: &[f64]) -> f64 {
    frame.iter().copied().fold(f64::INFINITY, f64::min)
}

fn sum(frame: &[f64]) -> f64 {
    frame.iter().sum::<f64>().abs()
}
