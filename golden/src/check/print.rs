//! A frame that is the negative print of others, as a tare under load leaves it.

/// From so many taxels on no two contacts are opposite by chance.
const TAXELS: usize = 9;
/// Cosine of two frames of which one is the print of the other.
const OPPOSITE: f64 = -0.9;

/// A message where the loaded frame that pulls most is the negative of another, in pascals.
pub(super) fn check(stress: &[Vec<f64>], is_loaded: &[bool]) -> Option<String> {
    let loaded = || stress.iter().enumerate().filter(|(frame, _)| is_loaded[*frame]);
    let pull = |frame: &[f64]| frame.iter().sum::<f64>();
    let (print, pulled) = loaded().max_by(|(_, a), (_, b)| pull(a).total_cmp(&pull(b)))?;
    let (pressed, _) = loaded().find(|(_, frame)| is_print(pulled, frame))?;
    (pull(pulled) > 0.0).then(|| {
        format!(
            "frame {} is the negative print of frame {}: was the sensor tared under a load, or does a baseline follow the \
             readings? Tare without load, and switch off what follows the baseline",
            print + 1,
            pressed + 1
        )
    })
}

fn is_print(one: &[f64], other: &[f64]) -> bool {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    one.len() >= TAXELS && product(one, other) < OPPOSITE * (product(one, one) * product(other, other)).sqrt()
}
