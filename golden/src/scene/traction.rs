//! How a contact loads the surface: points with a force each, in place of a closed form.
//!
//! Whatever a scene says of a contact beyond its shape (tilt, turn, edge, stick) ends here. The points are those of
//! quadrature rules that suit the pressure's edge, so that a few hundred of them are good to a hundred thousandth of the
//! peak below a depth of a pitch.

use std::f64::consts::{PI, TAU};

use super::green::gauss_legendre;
use super::shape::Shape;

/// How a contact loads the surface, beyond its shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traction {
    /// Angle in degrees by which the shape's axes are turned from x towards y.
    pub turn_deg: f64,
    /// Exponent n of the pressure `(1 - rho^2)^n` over the shape, where that is not the shape's own: 1/2 of Hertz,
    /// 0 of a disc and a rectangle, -1/2 of a punch. Below 0 the edge is hard, above 1/2 soft.
    pub edge: Option<f64>,
    /// Tilt of the pressure along and across the push: it is multiplied by `1 + along u / a + across v / b`, with u and
    /// v the coordinates in these directions and a, b the extent of the contact there. Their sum is at most 1.
    pub tilt: [f64; 2],
    /// What the tangential force does over the contact.
    pub shear: Shear,
}

/// How the tangential force is spread over a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shear {
    /// It slides: friction times the pressure everywhere, in the direction of the sliding. With `spin` the contact turns
    /// as well, at the edge that many times as fast as it slides, and the direction differs from place to place.
    Sliding {
        /// Speed of the turning at the largest half extent, over the speed of sliding.
        spin: f64,
    },
    /// Held, partial slip: Cattaneo's and Mindlin's traction for a Hertz contact, with this share of the largest
    /// tangential force, 0 to 1.
    Held {
        /// Tangential force over friction times normal force.
        share: f64,
    },
    /// The same everywhere, whatever the pressure: a glued contact.
    Even,
}

impl Default for Traction {
    fn default() -> Self {
        Self { turn_deg: 0.0, edge: None, tilt: [0.0; 2], shear: Shear::Sliding { spin: 0.0 } }
    }
}

/// A point of the surface with its share of the load.
#[derive(Clone, Copy, Debug)]
pub(super) struct Load {
    /// Place, in metres from the centre of the contact.
    pub(super) place: [f64; 2],
    /// Force on the surface: pressing, along x and along y.
    pub(super) force: [f64; 3],
}

/// Fineness of the rules: points along the radius or each side, around, and along each side of a taxel that averages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points {
    pub(super) radial: usize,
    pub(super) around: usize,
    pub(super) across: usize,
}

/// For scenes: errors below 1e-5 of the peak.
pub(super) const FINE: Points = Points { radial: 20, around: 48, across: 3 };
/// For frames by the thousand: errors below 4e-3 of the peak, in a tenth of the time.
pub(crate) const COARSE: Points = Points { radial: 8, around: 20, across: 2 };

/// The points of a contact that presses with `normal` newtons and is pushed in `direction` (radians) with the
/// coefficient `friction`; the forces' sum is the resultant.
pub(super) fn loads(
    shape: Shape,
    traction: &Traction,
    normal: f64,
    friction: f64,
    direction: f64,
    points: Points,
) -> Vec<Load> {
    let half = shape.half_extent_m();
    let edge = traction.edge.unwrap_or(shape.own_edge());
    let (sin, cos) = traction.turn_deg.to_radians().sin_cos();
    let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    let places: Vec<([f64; 2], f64)> = unit_points(shape, edge, points)
        .into_iter()
        .map(|([x, y], weight)| (turned([half[0] * x, half[1] * y]), weight))
        .collect();
    let push = [direction.cos(), direction.sin()];
    // Extent along and across the push, of the places themselves.
    let coordinates = |[x, y]: [f64; 2]| [x * push[0] + y * push[1], y * push[0] - x * push[1]];
    let extent = extents(shape, traction.turn_deg, direction);
    let pressure = |place: [f64; 2]| {
        let [u, v] = coordinates(place);
        1.0 + traction.tilt[0] * u / extent[0] + traction.tilt[1] * v / extent[1]
    };
    let mut loads: Vec<Load> = places
        .iter()
        .map(|&(place, weight)| Load { place, force: [normal * weight * pressure(place), 0.0, 0.0] })
        .collect();
    match traction.shear {
        Shear::Sliding { spin } => {
            let reach = half[0].max(half[1]);
            for load in &mut loads {
                let [x, y] = load.place;
                let slip = [push[0] - spin * y / reach, push[1] + spin * x / reach];
                let speed = slip[0].hypot(slip[1]).max(f64::MIN_POSITIVE);
                load.force[1] = friction * load.force[0] * slip[0] / speed;
                load.force[2] = friction * load.force[0] * slip[1] / speed;
            }
        }
        Shear::Even => {
            // Of the same weight everywhere: the rule without the pressure.
            let even = unit_points(shape, 0.0, points);
            loads.extend(even.into_iter().map(|([x, y], weight)| {
                let force = friction * normal * weight;
                Load { place: turned([half[0] * x, half[1] * y]), force: [0.0, force * push[0], force * push[1]] }
            }));
        }
        Shear::Held { share } => {
            // The traction of full sliding, less that over the part that sticks, c/a = (1 - share)^(1/3).
            let stuck = (1.0 - share).cbrt();
            let slipping = friction * normal;
            for (load, &(_, weight)) in loads.iter_mut().zip(&places) {
                load.force[1] = slipping * weight * push[0];
                load.force[2] = slipping * weight * push[1];
            }
            let inner = places.iter().map(|&([x, y], weight)| {
                let force = -slipping * stuck.powi(3) * weight;
                Load { place: [stuck * x, stuck * y], force: [0.0, force * push[0], force * push[1]] }
            });
            loads.extend(inner.collect::<Vec<_>>());
        }
    }
    loads
}

/// Half extents of a shape along and across a direction.
fn extents(shape: Shape, turn_deg: f64, direction: f64) -> [f64; 2] {
    let [a, b] = shape.half_extent_m();
    let extent = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        match shape {
            Shape::Rectangle { .. } => (a * cos).abs() + (b * sin).abs(),
            _ => (a * cos).hypot(b * sin),
        }
    };
    let angle = direction - turn_deg.to_radians();
    [extent(angle), extent(angle + 0.5 * PI)]
}

/// Points of the unit disc or the square from -1 to 1 with weights that add up to 1 and hold the pressure
/// `(1 - rho^2)^edge`, of a rectangle `((1 - x^2) (1 - y^2))^edge`.
fn unit_points(shape: Shape, edge: f64, Points { radial, around, .. }: Points) -> Vec<([f64; 2], f64)> {
    let (nodes, weights) = gauss_legendre(radial);
    let mut found: Vec<([f64; 2], f64)> = match shape {
        Shape::Rectangle { .. } => {
            // x = sin t: the pressure's edge is a power of cos t, smooth for the usual exponents.
            let axis: Vec<(f64, f64)> = nodes
                .iter()
                .zip(&weights)
                .map(|(t, w)| ((0.5 * PI * t).sin(), w * (0.5 * PI * t).cos().powf(2.0 * edge + 1.0)))
                .collect();
            axis.iter().flat_map(|&(y, wy)| axis.iter().map(move |&(x, wx)| ([x, y], wx * wy))).collect()
        }
        _ => nodes
            .iter()
            .zip(&weights)
            .flat_map(|(t, w)| {
                // 1 - rho^2 = v^2: the pressure and the area make it v^(2 edge + 1).
                let v = 0.5 * (1.0 + t);
                let (rho, weight) = ((1.0 - v * v).sqrt(), w * v.powf(2.0 * edge + 1.0));
                (0..around).map(move |index| {
                    let (sin, cos) = (TAU * (index as f64 + 0.5) / around as f64).sin_cos();
                    ([rho * cos, rho * sin], weight)
                })
            })
            .collect(),
    };
    let sum: f64 = found.iter().map(|(_, weight)| weight).sum();
    for (_, weight) in &mut found {
        *weight /= sum;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERTZ: Shape = Shape::Hertz { semi_axes_m: [6e-3, 4e-3] };

    fn resultant(loads: &[Load]) -> [f64; 3] {
        loads.iter().fold([0.0; 3], |sum, load| [0, 1, 2].map(|axis| sum[axis] + load.force[axis]))
    }

    #[test]
    fn the_points_carry_the_forces_of_the_contact() {
        for shear in [Shear::Sliding { spin: 0.0 }, Shear::Even, Shear::Held { share: 1.0 }] {
            for tilt in [[0.0, 0.0], [0.6, -0.3]] {
                let traction = Traction { turn_deg: 25.0, tilt, shear, ..Traction::default() };
                let [normal, x, y] = resultant(&loads(HERTZ, &traction, 5.0, 0.4, 1.0, FINE));
                assert!((normal - 5.0).abs() < 1e-12, "{shear:?}: {normal}");
                assert!((x - 2.0 * 1.0_f64.cos()).abs() < 1e-12 && (y - 2.0 * 1.0_f64.sin()).abs() < 1e-12);
            }
        }
        let held = Traction { shear: Shear::Held { share: 0.5 }, ..Traction::default() };
        let [_, x, _] = resultant(&loads(HERTZ, &held, 5.0, 0.4, 0.0, FINE));
        assert!((x - 1.0).abs() < 1e-12, "half of the largest tangential force: {x}");
    }

    #[test]
    fn moments_of_the_pressure_are_those_of_its_formula() {
        // Of p = (1 - rho^2)^n over an ellipse the mean of x^2 is a^2 / (2 n + 4).
        for (edge, shape) in [(0.5, HERTZ), (0.0, Shape::Disc { radius_m: 5e-3 }), (2.0, HERTZ), (-0.5, HERTZ)] {
            let traction = Traction { edge: Some(edge), ..Traction::default() };
            let loads = loads(shape, &traction, 1.0, 0.0, 0.0, FINE);
            let square: f64 = loads.iter().map(|load| load.force[0] * load.place[0].powi(2)).sum();
            let exact = shape.half_extent_m()[0].powi(2) / (2.0 * edge + 4.0);
            assert!((square / exact - 1.0).abs() < 1e-12, "{edge}: {square} {exact}");
        }
        // Tilted: the first moment along the push is tilt / extent times the second.
        let traction = Traction { tilt: [0.6, 0.0], ..Traction::default() };
        let loads = loads(HERTZ, &traction, 1.0, 0.0, 0.0, FINE);
        let first: f64 = loads.iter().map(|load| load.force[0] * load.place[0]).sum();
        assert!((first - 0.6 * 6e-3 / 5.0).abs() < 1e-15, "{first}");
        assert!(loads.iter().all(|load| load.force[0] > 0.0), "nothing pulls");
    }

    #[test]
    fn a_held_contact_has_mindlins_traction() {
        // Sum the points into rings: mu p0 [sqrt(1 - r^2/a^2) - (c/a) sqrt(1 - r^2/c^2)].
        let (a, share, friction) = (6e-3_f64, 0.488, 0.5);
        let shape = Shape::Hertz { semi_axes_m: [a, a] };
        let traction = Traction { shear: Shear::Held { share }, ..Traction::default() };
        let loads = loads(shape, &traction, 1.0, friction, 0.0, Points { radial: 400, around: 8, ..FINE });
        let c = a * (1.0 - share).cbrt();
        assert!((c / a - 0.8).abs() < 1e-3);
        let p0 = 1.5 / (PI * a * a);
        for (inner, outer) in [(0.0, 2e-3), (2e-3, 4e-3), (4e-3, 5.2e-3), (5.2e-3, 6e-3)] {
            let within = |load: &&Load| (inner..outer).contains(&load.place[0].hypot(load.place[1]));
            let found: f64 = loads.iter().filter(within).map(|load| load.force[1]).sum();
            // The integral of sqrt(1 - r^2/R^2) 2 pi r dr is -(2/3) pi R^2 (1 - r^2/R^2)^(3/2).
            let rest = |r: f64, radius: f64| (1.0 - (r / radius).powi(2)).max(0.0).powf(1.5) * radius * radius;
            let part = |radius: f64| 2.0 / 3.0 * PI * (rest(inner, radius) - rest(outer, radius));
            let exact = friction * p0 * (part(a) - c / a * part(c));
            assert!((found - exact).abs() < 0.02 * friction, "{inner} to {outer}: {found} {exact}");
        }
    }

    #[test]
    fn nowhere_is_the_traction_beyond_friction() {
        let traction = Traction { shear: Shear::Sliding { spin: 2.0 }, tilt: [0.5, 0.5], ..Traction::default() };
        let loads = loads(HERTZ, &traction, 3.0, 0.4, 0.3, FINE);
        for load in &loads {
            let [p, x, y] = load.force;
            assert!((x.hypot(y) - 0.4 * p).abs() < 1e-12 && p > 0.0);
        }
        let [normal, x, y] = resultant(&loads);
        assert!(x.hypot(y) < 0.9 * 0.4 * normal, "what turns does not push");
    }
}
