//! The shapes of contacts: how a load is spread, in space and over waves.

use super::bessel::j1;
use crate::half_space;

/// A contact's distribution of load; normal and tangential load have the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Elliptical Hertz contact, `sqrt(1 - x^2/a^2 - y^2/b^2)`: smooth bodies that touch.
    Hertz {
        /// Semi-axes along x and y in metres.
        semi_axes_m: [f64; 2],
    },
    /// Uniform load on a rectangle.
    Rectangle {
        /// Lengths of the sides along x and y in metres.
        sides_m: [f64; 2],
    },
    /// Uniform load on a disc.
    Disc {
        /// Radius in metres.
        radius_m: f64,
    },
    /// Flat circular punch, `1 / sqrt(1 - r^2/a^2)`: a rigid edge, where the load grows without bound.
    Punch {
        /// Radius in metres.
        radius_m: f64,
    },
}

impl Shape {
    /// Half the extent along x and y in metres.
    pub fn half_extent_m(self) -> [f64; 2] {
        match self {
            Self::Hertz { semi_axes_m } => semi_axes_m,
            Self::Rectangle { sides_m } => sides_m.map(|side| 0.5 * side),
            Self::Disc { radius_m } | Self::Punch { radius_m } => [radius_m; 2],
        }
    }

    /// Exponent n of the pressure `(1 - rho^2)^n`.
    pub(super) fn own_edge(self) -> f64 {
        match self {
            Self::Hertz { .. } => 0.5,
            Self::Rectangle { .. } | Self::Disc { .. } => 0.0,
            Self::Punch { .. } => -0.5,
        }
    }

    /// Stress on a half-space as the functions of [`half_space`] give it, or `None` where there is no closed form.
    pub(super) fn half_space(self, offset_m: [f64; 2], depth_m: f64) -> Option<[f64; 3]> {
        match self {
            Self::Hertz { semi_axes_m } => Some(half_space::hertz(semi_axes_m, offset_m, depth_m)),
            Self::Rectangle { .. } => Some(half_space::rectangle(self.half_extent_m(), offset_m, depth_m)),
            Self::Punch { radius_m } => Some(half_space::punch(radius_m, offset_m, depth_m)),
            Self::Disc { .. } => None,
        }
    }

    /// Fourier transform of the load of a unit force at a wave vector given in units of the inverse half extents.
    pub(super) fn spectrum(self, [x, y]: [f64; 2]) -> f64 {
        match self {
            Self::Hertz { .. } => {
                let k = length([x, y]);
                // Below 0.1 the closed form loses digits, and the series is exact to f64.
                if k < 0.1 {
                    let k2 = k * k;
                    1.0 - k2 / 10.0 * (1.0 - k2 / 28.0 * (1.0 - k2 / 54.0))
                } else {
                    let (sin, cos) = k.sin_cos();
                    3.0 * (sin - k * cos) / k.powi(3)
                }
            }
            Self::Rectangle { .. } => sinc(x) * sinc(y),
            Self::Disc { .. } => {
                let k = length([x, y]);
                if k < 1e-8 { 1.0 } else { 2.0 * j1(k) / k }
            }
            Self::Punch { .. } => sinc(length([x, y])),
        }
    }
}

/// Of a wave vector in units of a contact: `hypot` would spend more on sizes that there are not than all else does.
fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// `sin(x) / x`.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { x.sin() / x }
}
