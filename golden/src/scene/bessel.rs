//! The Bessel functions J0 and J1, which the standard library lacks.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// From here on the asymptotic series is exact to `f64`; its least term is about `exp(-2 x)`.
const ASYMPTOTIC: f64 = 25.0;
/// Steps of the trapezoid rule on half a period. The rule errs by `J_63(25) < 1e-16`.
const STEPS: usize = 32;

/// `sin t` at the steps up to a fourth of a period: behind it the sines come back.
static SINES: LazyLock<[f64; STEPS / 2]> =
    LazyLock::new(|| std::array::from_fn(|index| (PI * (index + 1) as f64 / STEPS as f64).sin()));

/// The Bessel function of the first kind and order 0, to about 1e-15, for `x >= 0`.
pub fn j0(x: f64) -> f64 {
    // (1/pi) times the integral of cos(x sin t) from 0 to pi, where both ends are 1.
    if x < ASYMPTOTIC { trapezoid(1.0, |sine| (x * sine).cos()) } else { asymptotic(x, 0.0) }
}

/// The Bessel function of the first kind and order 1, to about 1e-15, for `x >= 0`.
pub fn j1(x: f64) -> f64 {
    // (1/pi) times the integral of cos(t - x sin t) from 0 to pi, of which what is odd about the middle cancels.
    if x < ASYMPTOTIC { trapezoid(0.0, |sine| sine * (x * sine).sin()) } else { asymptotic(x, 1.0) }
}

/// The mean from 0 to pi of a function of `sin t`, with its value at the ends. It is even and periodic, so the trapezoid
/// rule converges faster than any power of the step.
fn trapezoid(ends: f64, integrand: impl Fn(f64) -> f64) -> f64 {
    let [twice @ .., middle] = &*SINES;
    let inner: f64 = twice.iter().map(|&sine| integrand(sine)).sum();
    (ends + 2.0 * inner + integrand(*middle)) / STEPS as f64
}

/// Hankel's expansion: `sqrt(2 / (pi x)) (P cos(chi) - Q sin(chi))`, terms of alternating sign in pairs.
fn asymptotic(x: f64, order: f64) -> f64 {
    let chi = x - (0.5 * order + 0.25) * PI;
    let (mut even, mut odd) = (0.0, 0.0);
    let mut term = 1.0;
    for index in 0_u32..40 {
        let sign = if index % 4 < 2 { 1.0 } else { -1.0 };
        if index % 2 == 0 {
            even += sign * term;
        } else {
            odd += sign * term;
        }
        let factor = f64::from(2 * index + 1);
        term *= (4.0 * order * order - factor * factor) / (8.0 * x * f64::from(index + 1));
        if term.abs() < f64::EPSILON * 1e-2 {
            break;
        }
    }
    (2.0 / (PI * x)).sqrt() * (even * chi.cos() - odd * chi.sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        // Abramowitz and Stegun, Table 9.1, and the first zero, Table 9.5.
        let table = [
            (0.0, 0.0),
            (1.0, 0.440_050_585_744_933_5),
            (2.0, 0.576_724_807_756_873_4),
            (5.0, -0.327_579_137_591_465_2),
            (10.0, 0.043_472_746_168_861_44),
            (3.831_705_970_207_512, 0.0),
        ];
        for (x, value) in table {
            assert!((j1(x) - value).abs() < 2e-15, "J1({x}) = {}", j1(x));
        }
        let table = [
            (0.0, 1.0),
            (1.0, 0.765_197_686_557_966_6),
            (5.0, -0.177_596_771_314_338_3),
            (10.0, -0.245_935_764_451_348_3),
            (2.404_825_557_695_773, 0.0),
        ];
        for (x, value) in table {
            assert!((j0(x) - value).abs() < 2e-15, "J0({x}) = {}", j0(x));
        }
    }

    #[test]
    fn both_methods_meet() {
        for function in [j0, j1] {
            let (below, above) = (function(ASYMPTOTIC - 1e-12), function(ASYMPTOTIC));
            assert!((below - above).abs() < 2e-13, "{below} {above}");
        }
    }
}
