//! The Bessel function J1, which the standard library lacks.

use std::f64::consts::PI;

/// From here on the asymptotic series is exact to `f64`; its least term is about `exp(-2 x)`.
const ASYMPTOTIC: f64 = 25.0;
/// Steps of the trapezoid rule on half a period. The rule errs by `J_63(25) < 1e-16`.
const STEPS: u32 = 32;

/// The Bessel function of the first kind and order 1, to about 1e-15, for `x >= 0`.
pub fn j1(x: f64) -> f64 {
    if x < ASYMPTOTIC {
        // (1/pi) times the integral of cos(t - x sin t) from 0 to pi. The integrand is even and periodic, so the
        // trapezoid rule converges faster than any power of the step; both ends together count as one point.
        let inner: f64 = (1..STEPS)
            .map(|step| {
                let t = PI * f64::from(step) / f64::from(STEPS);
                (t - x * t.sin()).cos()
            })
            .sum();
        // At the ends the integrand is cos(0) = 1 and cos(pi) = -1, which cancel.
        return inner / f64::from(STEPS);
    }
    // Hankel's expansion: sqrt(2 / (pi x)) (P cos(chi) - Q sin(chi)), terms of alternating sign in pairs.
    let chi = x - 0.75 * PI;
    let (mut even, mut odd) = (0.0, 0.0);
    let mut term = 1.0;
    for order in 0_u32..40 {
        let sign = if order % 4 < 2 { 1.0 } else { -1.0 };
        if order % 2 == 0 {
            even += sign * term;
        } else {
            odd += sign * term;
        }
        let factor = f64::from(2 * order + 1);
        term *= (4.0 - factor * factor) / (8.0 * x * f64::from(order + 1));
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
    }

    #[test]
    fn both_methods_meet() {
        let (below, above) = (j1(ASYMPTOTIC - 1e-12), j1(ASYMPTOTIC));
        assert!((below - above).abs() < 2e-13, "{below} {above}");
    }
}
