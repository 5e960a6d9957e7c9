//! Closed forms for loads on an elastic half-space: the normal stress on a plane at some depth below the surface.
//!
//! That stress does not depend on the elastic constants. Every function gives it, in pascals per newton, for a load
//! of 1 N pressing, 1 N along x, 1 N along y; `offset` is the position of the field point minus the centre of the
//! load, and `z > 0` the depth, all in metres.

use std::f64::consts::PI;

use nalgebra::Complex;

/// Uniform load on a rectangle with sides along x and y; `half_sides` is half their lengths.
///
/// Love's integral of the point force over the rectangle, in closed form; the tangential loads by the same
/// integration. Mirroring `offset` mirrors the result to the bit.
pub fn rectangle(half_sides: [f64; 2], offset: [f64; 2], z: f64) -> [f64; 3] {
    let [a, b] = half_sides;
    let [x, y] = offset.map(f64::abs);
    // Sum over the corners with the sign of the product of their sides. Grouped like this it is even in x and y and
    // the same when the axes are swapped, to the bit.
    let corners = |term: &dyn Fn(f64, f64) -> f64| {
        (term(x + a, y + b) + term(x - a, y - b)) - (term(x + a, y - b) + term(x - a, y + b))
    };
    let normal = |u: f64, v: f64| {
        let (u2, v2, z2) = (u * u, v * v, z * z);
        let r = (u2 + v2 + z2).sqrt();
        // Not atan2, which would jump by a turn where a corner lies to the other side.
        (u * v / (z * r)).atan() + u * v * z / r * (1.0 / (u2 + z2) + 1.0 / (v2 + z2))
    };
    let along = |along: f64, across: f64| {
        let square = along * along + z * z;
        across / (square * (across * across + square).sqrt())
    };
    // Traction of a unit force over 2 pi.
    let common = 1.0 / (8.0 * PI * a * b);
    [
        -common * corners(&normal),
        common * z * z * corners(&along) * offset[0].signum(),
        common * z * z * corners(&|u, v| along(v, u)) * offset[1].signum(),
    ]
}

/// Flat circular punch of the given radius, pressed and pushed without turning: traction `1 / sqrt(1 - r^2/a^2)`.
///
/// It is the field of a point force at the complex depth `z - i a`.
pub fn punch(radius: f64, offset: [f64; 2], z: f64) -> [f64; 3] {
    let [x, y] = offset;
    let w = Complex::new(z, -radius);
    // The root stays clear of its cut: the imaginary part of its argument, -2 a z, is never 0.
    let distance = (Complex::from(x * x + y * y) + w * w).sqrt();
    let inverse = distance.inv();
    let cube = inverse * inverse * inverse;
    // Peak traction of a unit force times the radius is 1 / (2 pi a).
    let common = -1.0 / (2.0 * PI * radius);
    [common * (inverse + w * cube * z).im, common * x * z * cube.im, common * y * z * cube.im]
}

/// Elliptical Hertz contact with the semi-axes `[a, b]`: traction `p0 sqrt(1 - x^2/a^2 - y^2/b^2)`.
///
/// The forms follow from the ellipsoidal coordinate of the point; the circular contact and the point force (a, b to
/// 0) are special cases.
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
