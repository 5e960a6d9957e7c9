//! What a tare under load leaves, and a baseline that follows the load: the negative print of a contact.

use super::{LOADED, PULLS_TOGETHER, count, largest, together};
use crate::design::Design;

/// From so many taxels on no two contacts are opposite by chance.
const TAXELS: usize = 9;
/// Cosine of two frames of which one is the print of the other.
const OPPOSITE: f64 = -0.9;
/// A frame without load has this share of the largest pull,
const WHOLE: f64 = 0.9;
/// and what lessens it leaves at most this share.
const LESS: f64 = 0.5;
/// Where a baseline follows, all that pulls is as opposite to all that presses,
const FOLLOWS: f64 = -0.7;
/// and decays: at most one in so many of them pulls as much as the largest.
const DECAYS: usize = 2;

/// A message where the loaded frame that pulls most is the negative of another, in pascals. So is one that a recording begins
/// or ends with.
pub(super) fn check(design: &Design, stress: &[Vec<f64>]) -> Option<String> {
    let pull = |frame: &[f64]| frame.iter().sum::<f64>();
    let peak = stress.iter().map(|frame| largest(frame)).fold(0.0, f64::max);
    let loaded = || stress.iter().enumerate().filter(|(_, frame)| largest(frame) >= LOADED * peak);
    let (print, pulled) = loaded().max_by(|(_, a), (_, b)| pull(a).total_cmp(&pull(b)))?;
    let most = pull(pulled);
    if most <= 0.0 || pulled.len() < TAXELS {
        return None;
    }
    if let Some(message) = follows(design, stress, most).filter(|_| together(&design.sensor, pulled) >= PULLS_TOGETHER)
    {
        return Some(message);
    }
    if let Some((pressed, _)) = loaded().find(|(_, frame)| cosine(pulled, frame) < OPPOSITE) {
        return Some(format!(
            "frame {} is the negative print of frame {}: was the sensor tared under a load, or does a baseline follow the \
             readings? Tare without load, and switch off what follows the baseline",
            print + 1,
            pressed + 1
        ));
    }
    let (nearest, least) = stress.iter().enumerate().min_by(|(_, a), (_, b)| pull(a).total_cmp(&pull(b)))?;
    let is_print = |frame: &Vec<f64>| pull(frame) >= WHOLE * most && cosine(pulled, frame) > -OPPOSITE;
    let prints = stress.iter().filter(|frame| is_print(frame)).count();
    let near_zero = stress.iter().filter(|frame| pull(frame).abs() <= (1.0 - WHOLE) * most).count();
    let ends = usize::from(is_print(&stress[0])) + usize::from(is_print(&stress[stress.len() - 1]));
    // An even offset is no contact.
    let is_contact = together(&design.sensor, pulled) >= PULLS_TOGETHER && pull(least) <= LESS * most;
    (is_contact && (ends == 2 || ends == 1 && prints > near_zero)).then(|| {
        format!(
            "the unloaded frames are more loaded than others: {prints} frames{} have the pull of one contact, and frame {} has \
             the least. Was the sensor tared under a load? Tare it without. If a contact did lie on it then, the sign is wrong: compression must be negative",
            if ends == 2 { ", the first and the last," } else { "" },
            nearest + 1
        )
    })
}

/// A baseline that follows: frames that pull add up to the negative of those that press, by up to `most`, and decay.
fn follows(design: &Design, stress: &[Vec<f64>], most: f64) -> Option<String> {
    let (mut sums, mut pulling, mut whole, mut least) =
        ([vec![0.0; design.sensor.taxels()], vec![0.0; design.sensor.taxels()]], 0, 0, 0.0_f64);
    for frame in stress {
        let pull = frame.iter().sum::<f64>();
        least = least.min(pull);
        pulling += usize::from(pull >= LOADED * most);
        whole += usize::from(pull >= WHOLE * most);
        sums[usize::from(pull > 0.0)].iter_mut().zip(frame).for_each(|(sum, value)| *sum += value);
    }
    let is_one = cosine(&sums[0], &sums[1]) < FOLLOWS && least <= -LESS * most && pulling >= DECAYS * whole;
    is_one.then(|| {
        format!(
            "the baseline follows the load: {pulling} of {} pull where others press, by up to {:.0} % of the largest load, and \
             the pull decays. Forces are wrong as long as it does: switch off the sensor's or driver's drift compensation \
             (auto-zero, high-pass filter), and tare it once, without load",
            count(stress.len()),
            -100.0 * most / least
        )
    })
}

fn cosine(one: &[f64], other: &[f64]) -> f64 {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(one, other) / (product(one, one) * product(other, other)).sqrt()
}
