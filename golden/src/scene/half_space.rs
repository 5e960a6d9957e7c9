//! Closed forms for a Hertz contact on a half-space.

use std::f64::consts::PI;

/// Normal stress at depth `z` under an elliptical Hertz contact that carries 1 N pressing, 1 N along x, 1 N along y,
/// in pascals per newton.
///
/// The traction is `p0 sqrt(1 - x^2/a^2 - y^2/b^2)` with the semi-axes `[a, b]`, and `offset` is the position of the
/// field point minus the centre of the contact. The forms follow from the ellipsoidal coordinate of the point; with
/// them the circular contact and the point force (a, b to 0) are special cases.
pub fn hertz(semi_axes: [f64; 2], offset: [f64; 2], z: f64) -> [f64; 3] {
    let [a2, b2] = semi_axes.map(|axis| axis * axis);
    let [x, y] = offset;
    let s = confocal(a2, b2, x * x, y * y, z * z);
    let (sa, sb) = (a2 + s, b2 + s);
    let curvature = (x / sa).powi(2) + (y / sb).powi(2) + (z / s).powi(2);
    // Peak traction of a unit force times a b is 3 / (2 pi).
    let common = -1.5 / PI * z * z / (s * curvature * (s * sa * sb).sqrt());
    [common * z / s, common * x / sa, common * y / sb]
}

/// The positive root s of `x^2/(a^2+s) + y^2/(b^2+s) + z^2/s = 1`.
fn confocal(a2: f64, b2: f64, x2: f64, y2: f64, z2: f64) -> f64 {
    // The left side falls and is convex, and the start lies below the root, so Newton's steps only go up.
    let mut s = z2.max(x2 + y2 + z2 - a2.max(b2));
    loop {
        let (sa, sb) = (a2 + s, b2 + s);
        let excess = x2 / sa + y2 / sb + z2 / s - 1.0;
        let slope = x2 / (sa * sa) + y2 / (sb * sb) + z2 / (s * s);
        let next = s + excess / slope;
        // Rounding ends the climb.
        if next.is_nan() || next <= s * (1.0 + f64::EPSILON) {
            return s;
        }
        s = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel;

    #[test]
    fn a_tiny_contact_is_a_point_force() {
        let offset = [2.0e-3, -1.5e-3];
        let found = hertz([1e-6, 2e-6], offset, 3e-3);
        // The kernel takes force minus taxel, and f_z presses when negative.
        let expected = kernel::point(offset.map(|v| -v), 3e-3);
        for (found, expected) in found.into_iter().zip([-expected[2], expected[0], expected[1]]) {
            assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        }
    }

    #[test]
    fn on_the_axis_the_circular_contact_is_the_textbook_one() {
        // Johnson, Contact Mechanics, Eq. 3.45b: sigma_zz = -p0 / (1 + z^2/a^2).
        let (a, z): (f64, f64) = (7e-3, 3e-3);
        let p0 = 1.5 / (PI * a * a);
        let [normal, x, y] = hertz([a, a], [0.0, 0.0], z);
        assert!((normal / (-p0 / (1.0 + (z / a).powi(2))) - 1.0).abs() < 1e-14);
        assert!(x == 0.0 && y == 0.0);
    }

    #[test]
    fn turning_the_ellipse_swaps_the_axes() {
        let one = hertz([5e-3, 2e-3], [1e-3, 4e-3], 3e-3);
        let other = hertz([2e-3, 5e-3], [4e-3, 1e-3], 3e-3);
        let swapped = [other[0], other[2], other[1]];
        assert_eq!(one.map(f64::to_bits), swapped.map(f64::to_bits));
    }
}
