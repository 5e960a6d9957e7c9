//! Frames that are negative prints of others, as a tare under load leaves them.

/// From so many taxels on no two contacts are opposite by chance.
const TAXELS: usize = 9;
/// Frames looked at.
const FRAMES: usize = 64;
/// Cosine of two frames of which one is the print of the other.
const OPPOSITE: f64 = -0.9;

/// A message where a loaded frame is the negative of another, in pascals.
pub(super) fn check(stress: &[Vec<f64>], is_loaded: &[bool]) -> Option<String> {
    let loaded: Vec<(usize, &Vec<f64>)> = stress.iter().enumerate().filter(|(frame, _)| is_loaded[*frame]).collect();
    let some: Vec<_> = loaded.iter().step_by(loaded.len().div_ceil(FRAMES).max(1)).collect();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let pairs = || some.iter().enumerate().flat_map(|(at, one)| some[at + 1..].iter().map(move |other| (*one, *other)));
    let is_print = |((_, one), (_, other)): &(&(usize, &Vec<f64>), &(usize, &Vec<f64>))| {
        one.len() >= TAXELS && product(one, other) < OPPOSITE * (product(one, one) * product(other, other)).sqrt()
    };
    let ((one, _), (other, _)) = pairs().find(is_print)?;
    Some(format!(
        "frame {} is the negative print of frame {}: was the sensor tared under a load, or does a baseline follow the readings? \
         Tare without load, and switch off what follows the baseline",
        other + 1,
        one + 1
    ))
}
