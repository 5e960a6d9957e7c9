//! Frames that are each divided by a norm of their own: the largest reading, the sum, the root of the squares.

use super::{LOADED, largest};
use crate::numbers::rounded;

/// From so many frames on.
const FRAMES: usize = 5;
/// Whole readings below this share a largest one by chance.
const COARSE: f64 = 100.0;
/// Values that programs scale to, other than those of one digit.
const USUAL: [f64; 5] = [255.0, 1023.0, 1024.0, 4095.0, 65535.0];
/// The end of a converter is read by more taxels of a frame than this.
const AT_MOST: usize = 2;
/// Values are the same but for this share of them, and sums of printed ones but for that.
const SAME: f64 = 1e-9;
const PRINTED: f64 = 1e-4;
/// Norms of values that are rounded to few decimals are the same but for this share, if shapes differ.
const ROUNDED: f64 = 0.02;
/// Most decimals of values that are called rounded.
const DECIMALS: i32 = 6;
/// Largest readings of one load differ by less than this factor, whatever the direction that it pushes in.
const OTHER_SHAPE: f64 = 1.5;

/// A norm by its name, of one frame.
type Norm = (&'static str, fn(&[f64]) -> f64);

/// Norms other than the largest reading. Of contacts simulated without noise they may be the same.
const NORMS: [Norm; 4] =
    [("sum", sum), ("sum of magnitudes", magnitudes), ("root of the sum of squares", root), ("root mean square", rms)];

/// A message where all frames, or all loaded ones, values as they are in the file, have the same norm and differ otherwise.
pub(super) fn check(frames: &[Vec<f64>]) -> Option<String> {
    let peak = frames.iter().map(|frame| largest(frame)).fold(0.0, f64::max);
    let some = |share: f64| frames.iter().filter(|frame| largest(frame) > share * peak).collect::<Vec<_>>();
    [0.0, LOADED].into_iter().find_map(|share| of_all(&some(share)))
}

fn of_all(some: &[&Vec<f64>]) -> Option<String> {
    let first = *some.first()?;
    let peak = largest(first);
    let whole = some.iter().all(|frame| frame.iter().all(|value| value.fract() == 0.0));
    if some.len() < FRAMES || whole && peak < COARSE || some.iter().all(|frame| *frame == first) {
        return None;
    }
    let same = |of: fn(&[f64]) -> f64, within: f64| some.iter().all(|frame| alike(of(first), of(frame), within));
    let few = |of: fn(&[f64]) -> f64| {
        let at = |frame: &[f64]| frame.iter().filter(|value| alike(of(frame), value.abs(), SAME)).count();
        2 * some.iter().filter(|frame| at(frame) <= AT_MOST).count() > some.len()
    };
    // The peak of one contact that stays may be the same by symmetry.
    let at = |frame: &[f64]| frame.iter().position(|value| alike(peak, value.abs(), SAME));
    let moves = some.iter().any(|frame| at(frame) != at(first));
    // One load elsewhere, without noise, has the same sum too.
    let moves = moves && !same(sum, PRINTED);
    // From 0 to 1, what does not press may be the 1.
    let is_one = (moves || is_usual(peak)) && few(largest)
        || is_usual(peak) && least(first) == 0.0 && same(least, SAME) && few(least);
    let (what, value) = if same(largest, SAME) && is_one {
        ("largest reading", peak)
    } else {
        // Or the shapes differ as those of one load do not.
        let [most, least] = [f64::max, f64::min].map(|of| some.iter().map(|frame| largest(frame)).reduce(of));
        let differ = most.zip(least).is_some_and(|(most, least)| most > OTHER_SHAPE * least);
        // Many small values are rounded to the same side.
        let rounding = step(some).map_or(0.0, |step| 0.5 * step * first.len() as f64);
        let same = |(_, of): &&Norm| {
            let share = (rounding / of(first)).min(ROUNDED);
            same(*of, PRINTED) && (differ || is_usual(of(first))) || differ && same(*of, share)
        };
        let (what, of) = NORMS.iter().filter(same).min_by_key(|(_, of)| !alike(1.0, of(first), PRINTED))?;
        (*what, of(first))
    };
    let value = rounded(value, 6);
    Some(format!(
        "all {} frames have the same {what}, {value}: is each frame divided by its own? Its force is lost then; record the \
         readings as the sensor gives them, or scale all frames alike",
        some.len()
    ))
}

/// The power of ten of which all values are multiples; nothing if they have many decimals.
fn step(some: &[&Vec<f64>]) -> Option<f64> {
    let is_multiple = |value: &f64, per_one: f64| ((value * per_one).round() - value * per_one).abs() < SAME * per_one;
    let holds = |per_one: &f64| some.iter().all(|frame| frame.iter().all(|value| is_multiple(value, *per_one)));
    (0..=DECIMALS).map(|decimals| 10_f64.powi(decimals)).find(holds).map(f64::recip)
}

/// Whether programs scale to this value: one of a single digit, or the end of whole numbers of some bits.
fn is_usual(value: f64) -> bool {
    let power = 10.0_f64.powf(value.log10().floor());
    let digit = (value / power).round() * power;
    USUAL.iter().chain(&[digit]).any(|&usual| alike(usual, value, PRINTED))
}

fn alike(a: f64, b: f64, within: f64) -> bool {
    (a - b).abs() <= within * a.abs()
}

fn least(frame: &[f64]) -> f64 {
    frame.iter().copied().fold(f64::INFINITY, f64::min)
}

fn sum(frame: &[f64]) -> f64 {
    frame.iter().sum::<f64>().abs()
}

fn magnitudes(frame: &[f64]) -> f64 {
    frame.iter().map(|value| value.abs()).sum()
}

fn root(frame: &[f64]) -> f64 {
    frame.iter().map(|value| value * value).sum::<f64>().sqrt()
}

fn rms(frame: &[f64]) -> f64 {
    root(frame) / (frame.len() as f64).sqrt()
}
