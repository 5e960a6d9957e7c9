//! Contact analysis: is there a contact, and which way is it pushed.

use nalgebra::DVector;

pub use crate::estimators::Contact;
use crate::numbers::centre;

/// Analyses the stress `b` (pascals, length m) at `positions` (metres).
///
/// Tension trails the push, so the vector from the centroid of tension to that of compression points along it
/// (Pinto-Salamanca et al., Sensors 2024, Eq. 24, kept as a vector so that it has no poles). `noise_floor` in
/// pascals decides whether there is a contact and a direction at all; the centroids take in every taxel. The stress is that of a
/// single frame.
pub fn cean(b: &DVector<f64>, positions: &[[f64; 2]], noise_floor: f64) -> Contact {
    let stress_sum: f64 = b.iter().map(|stress| stress.abs()).sum();
    let compressed = b.iter().any(|&stress| stress < -noise_floor);
    let tensile = b.iter().any(|&stress| stress > noise_floor);
    let centroid = |sign: f64| centre(b.iter().zip(positions).map(|(stress, &at)| ((sign * stress).max(0.0), at)));
    let centroids = if compressed && tensile { centroid(-1.0).zip(centroid(1.0)) } else { None };
    let direction = centroids.map(|(c, t)| [c[0] - t[0], c[1] - t[1]]);
    Contact { stress_sum, touched: stress_sum >= b.len() as f64 * noise_floor, direction, noise_left: 1.0 }
}
