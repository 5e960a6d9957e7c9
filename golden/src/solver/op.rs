//! Optimum: the friction components, and with them the forces.

use nalgebra::DVector;

use super::cean::Contact;
use super::co::Coefficients;
use crate::estimators::line::{LineScratch, friction};
use crate::matrices::Matrices;
use crate::status::Status;

/// The result of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Forces {
    /// Bits raised by this stage.
    pub status: Status,
    /// Friction component along x.
    pub mu_x: f64,
    /// Friction component along y.
    pub mu_y: f64,
    /// Condition 1 (Eq. 20) at its minimum: tension in pascals, summed, that the normal forces alone would cause.
    pub condition_1: f64,
    /// Condition 2 (Eq. 21) at the optimum, in pascals; reported, not searched.
    pub condition_2: f64,
    /// Forces `f_x, f_y, f_z` in newtons, each of length m.
    pub field: [DVector<f64>; 3],
    /// Their sums.
    pub resultant: [f64; 3],
    /// Friction `sqrt(F_x^2 + F_y^2) / |F_z|`, 0 where `F_z` is 0.
    pub mu: f64,
    /// Direction `atan2(F_y, F_x)` in radians.
    pub phi: f64,
}

/// Finds the friction components on the line of the direction of push and evaluates the forces.
///
/// `level` is [`crate::estimators::line::LEVEL`] or another share of the sum of |b|. Without a direction, or with a degenerate line, the
/// components are 0.
pub fn op(contact: &Contact, coefficients: &Coefficients, matrices: &Matrices, level: f64) -> Forces {
    let u = [0, 1, 2].map(|q| &matrices.c33 * &coefficients.g[2][q]);
    let stresses = u.each_ref().map(DVector::as_slice);
    let (status, mu) = friction(contact, &coefficients.sums, stresses, level, &mut LineScratch::default());
    let [mu_x, mu_y] = mu;
    let field = coefficients.g.each_ref().map(|[g0, g1, g2]| g0 + g1 * mu_x + g2 * mu_y);
    let resultant = field.each_ref().map(DVector::sum);
    let [x, y, _] = resultant;
    let normal = &u[0] + &u[1] * mu_x + &u[2] * mu_y;
    let tangential = &matrices.c31 * &field[0] + &matrices.c32 * &field[1];
    let [condition_1, condition_2] = conditions(&normal, &tangential);
    Forces { status, mu_x, mu_y, condition_1, condition_2, field, resultant, mu: quotient(resultant), phi: y.atan2(x) }
}

/// Friction of a resultant: tangential over normal force, 0 where there is no normal force (Eq. 29).
pub(crate) fn quotient([x, y, z]: [f64; 3]) -> f64 {
    if z == 0.0 { 0.0 } else { x.hypot(y) / z.abs() }
}

/// Both conditions of the paper (Eqs. 20 and 21) in pascals for the stress of the normal and the tangential forces.
///
/// The first sums the tension under the normal forces; the second compares both stresses where both are tension.
fn conditions(normal: &DVector<f64>, tangential: &DVector<f64>) -> [f64; 2] {
    let mut sums = [0.0, 0.0];
    for (&z, &xy) in normal.iter().zip(tangential) {
        sums[0] += z.max(0.0);
        if z > 0.0 && xy > 0.0 {
            sums[1] += xy - z;
        }
    }
    [sums[0], sums[1].abs()]
}
