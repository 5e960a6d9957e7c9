//! The stress under one point force, as functions of the distance alone: what any distribution of load adds up from.
//!
//! At depth h and distance r from the force, `sigma = P G_P(r) + (Q . r / |r|) G_Q(r)`, with P pressing and r from the
//! force to the taxel. On a half-space these are Boussinesq's and Cerruti's closed forms. On a layer they are Hankel
//! transforms of its transfer functions, `G_P = -1/(2 pi) int H_P(k h) J0(k r) k dk` and
//! `G_Q = -1/(2 pi) int H_Q(k h) J1(k r) k dk`, tabulated once: lengths in depths, forces per square depth.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

use super::bessel::{j0, j1};
use super::transfer::Medium;

/// Largest wave number times the depth; the transfer functions have fallen below 1e-11 there.
const LARGEST_KH: f64 = 32.0;
/// Panels of that range with [`NODES`] points each: nine points for each wave of the largest distance.
const PANELS: usize = 96;
/// Points of a panel.
const NODES: usize = 8;
/// Largest distance of the table, in depths. The stress of a nearly incompressible layer falls by a half with each depth,
/// to 1e-6 of the peak there.
const REACH: f64 = 16.0;
/// Steps of the table to a depth; cubic interpolation errs by less than 1e-6 of the peak.
const STEPS: usize = 60;

/// The stress of a point force on a medium, lengths in depths.
pub(super) enum PointLoad {
    HalfSpace,
    /// `[G_P, G_Q / r]` at distances of whole steps, two more than the reach. The quotient is even in r and smooth at 0.
    Layer {
        /// Steps to a depth.
        steps: usize,
        table: Vec<[f64; 2]>,
    },
}

/// Tables made so far, by Poisson's ratio: few in a scene, and a few in what makes thousands of frames.
static TABLES: Mutex<BTreeMap<u64, Arc<PointLoad>>> = Mutex::new(BTreeMap::new());

impl PointLoad {
    /// The table of a medium, made at first use.
    pub(super) fn of(medium: Medium) -> Arc<Self> {
        let Medium::BondedLayer { poisson } = medium else { return Arc::new(Self::HalfSpace) };
        let mut tables = TABLES.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(tables.entry(poisson.to_bits()).or_insert_with(|| Arc::new(Self::new(medium))))
    }

    /// Tabulates a layer; some tenths of a second.
    fn new(medium: Medium) -> Self {
        Self::tabulated(medium, STEPS)
    }

    fn tabulated(medium: Medium, steps: usize) -> Self {
        if medium == Medium::HalfSpace {
            return Self::HalfSpace;
        }
        let (points, weights) = gauss_legendre(NODES);
        let width = LARGEST_KH / PANELS as f64;
        let waves: Vec<[f64; 3]> = (0..PANELS)
            .flat_map(|panel| {
                points.iter().zip(&weights).map(move |(x, w)| {
                    let k = (panel as f64 + 0.5 * (1.0 + x)) * width;
                    let [h_p, h_q] = medium.transfer(k);
                    let weight = -0.5 * width * w * k / (2.0 * PI);
                    [k, weight * h_p, weight * h_q]
                })
            })
            .collect();
        let count = (REACH * steps as f64) as usize + 3;
        let table = (0..count).map(|index| {
            let r = index as f64 / steps as f64;
            waves.iter().fold([0.0, 0.0], |[normal, shear], &[k, p, q]| {
                // J1(x) / x tends to a half.
                let slope = if index == 0 { 0.5 * k } else { j1(k * r) / r };
                [normal + p * j0(k * r), shear + q * slope]
            })
        });
        Self::Layer { steps, table: table.collect() }
    }

    /// `[G_P, G_Q / r]` at a distance whose square is given, in depths.
    #[inline]
    pub(super) fn at(&self, square: f64) -> [f64; 2] {
        match self {
            Self::HalfSpace => {
                let common = -3.0 / (2.0 * PI) * (1.0 + square).powi(-2) / (1.0 + square).sqrt();
                [common, common]
            }
            Self::Layer { steps, table } => {
                let place = square.sqrt() * *steps as f64;
                let index = place as usize;
                if index + 2 >= table.len() {
                    return [0.0, 0.0];
                }
                let t = place - index as f64;
                // Even in r: what is before the first is the second.
                let before = if index == 0 { table[1] } else { table[index - 1] };
                let (a, b, c) = (table[index], table[index + 1], table[index + 2]);
                // Lagrange's cubic through four neighbours.
                let weights = [
                    -t * (t - 1.0) * (t - 2.0) / 6.0,
                    (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
                    -(t + 1.0) * t * (t - 2.0) / 2.0,
                    (t + 1.0) * t * (t - 1.0) / 6.0,
                ];
                [0, 1].map(|kind| {
                    weights[0] * before[kind] + weights[1] * a[kind] + weights[2] * b[kind] + weights[3] * c[kind]
                })
            }
        }
    }
}

/// Points in (-1, 1) and weights of Gauss and Legendre's rule, by Newton's method on the polynomial.
pub(super) fn gauss_legendre(count: usize) -> (Vec<f64>, Vec<f64>) {
    let polynomial = |x: f64| {
        let (mut before, mut value) = (1.0, x);
        for n in 2..=count {
            let n = n as f64;
            (before, value) = (value, ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n);
        }
        [value, count as f64 * (x * value - before) / (x * x - 1.0)]
    };
    let points: Vec<f64> = (0..count)
        .map(|index| {
            let mut x = -(PI * (index as f64 + 0.75) / (count as f64 + 0.5)).cos();
            for _ in 0..8 {
                let [value, slope] = polynomial(x);
                x -= value / slope;
            }
            x
        })
        .collect();
    let weights = points.iter().map(|&x| 2.0 / ((1.0 - x * x) * polynomial(x)[1].powi(2))).collect();
    (points, weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_of_gauss_and_legendre_is_exact_for_polynomials() {
        for count in [2, 8, 15] {
            let (points, weights) = gauss_legendre(count);
            for power in 0..2 * count as i32 {
                let sum: f64 = points.iter().zip(&weights).map(|(x, w)| w * x.powi(power)).sum();
                let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-13, "{count} points, power {power}: {sum}");
            }
        }
    }

    #[test]
    fn below_the_force_the_half_space_has_the_textbook_stress() {
        // Boussinesq: sigma_zz = -3 P / (2 pi z^2). A rigid ground gathers the stress.
        let closed = PointLoad::HalfSpace;
        let layer = PointLoad::new(Medium::BondedLayer { poisson: 0.49 });
        assert!((closed.at(0.0)[0] + 1.5 / PI).abs() < 1e-15);
        assert!(layer.at(0.0)[0] < closed.at(0.0)[0], "{}", layer.at(0.0)[0]);
    }

    #[test]
    fn a_layer_carries_the_whole_force_and_no_moment_but_that_of_its_depth() {
        // Balance: the base presses back with the force, and a force along x at the surface has the arm of a depth.
        let layer = PointLoad::new(Medium::BondedLayer { poisson: 0.49 });
        let (step, count) = (0.005, 3200);
        let (mut force, mut moment) = (0.0, 0.0);
        for index in 0..count {
            let r = (f64::from(index) + 0.5) * step;
            let [normal, shear] = layer.at(r * r);
            force += 2.0 * PI * r * normal * step;
            moment += PI * r.powi(3) * shear * step;
        }
        assert!((force + 1.0).abs() < 1e-4, "{force}");
        // The base's shear does not act on moments about the base, so all of it is in the normal stress.
        assert!((moment + 1.0).abs() < 1e-3, "{moment}");
    }

    #[test]
    fn between_the_steps_the_table_is_as_good_as_at_them() {
        let medium = Medium::BondedLayer { poisson: 0.45 };
        let [table, finer] = [STEPS, 2 * STEPS].map(|steps| PointLoad::tabulated(medium, steps));
        let peak = table.at(0.0)[0].abs();
        for index in 0..600 {
            let r = 0.0137 * f64::from(index) + 0.005;
            let (one, other) = (table.at(r * r), finer.at(r * r));
            for kind in [0, 1] {
                assert!((one[kind] - other[kind]).abs() < 1e-6 * peak, "{r}: {one:?} {other:?}");
            }
        }
    }
}
