//! Optimum: the friction components, and with them the forces.

use nalgebra::DVector;

use super::cean::Contact;
use super::co::Coefficients;
use super::line::{self, LineScratch};
use super::status::Status;
use crate::matrices::Matrices;

/// Coefficients of the line at or above this magnitude make it degenerate: it is then all but parallel to the axis
/// of the dependent component, and the direction tells nothing.
pub const MAX_LINE_RATIO: f64 = 4.0;
/// Default level: the level set holds every point whose value exceeds the minimum by no more than this times the
/// sum of |b|. A power of two, so that it is a shift in hardware.
pub const LEVEL: f64 = 1.0 / 512.0;
/// Range of the dependent component.
pub const DEPENDENT_RANGE: f64 = 2.0;

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

/// The line `mu_dependent = offset + slope * mu_independent` that the direction of push fixes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The independent component: 0 is x, 1 is y.
    pub independent: usize,
    /// Dependent component where the independent one is 0.
    pub offset: f64,
    /// Change of the dependent component with the independent one.
    pub slope: f64,
}

/// The line for the direction of push `d` (any length) and the sums `G_pq`, or `None` if it is degenerate.
///
/// Eqs. 22 and 23 of Pinto-Salamanca et al., Sensors 2024, times cos(phi), are one line `a mu_x + e mu_y = k` without
/// poles. The independent component is that of the larger component of `d`, so that the division is well scaled.
pub fn line(direction: [f64; 2], sums: &[[f64; 3]; 3]) -> Option<Line> {
    let [dx, dy] = direction;
    let a = sums[0][1] * dy - sums[1][1] * dx;
    let e = sums[0][2] * dy - sums[1][2] * dx;
    let k = sums[1][0] * dx - sums[0][0] * dy;
    let (independent, numerator, denominator) = if dx.abs() >= dy.abs() { (0, a, e) } else { (1, e, a) };
    let line = Line { independent, offset: k / denominator, slope: -numerator / denominator };
    // A denominator of zero makes an infinity or a NaN, and neither is below the limit.
    (line.offset.abs() < MAX_LINE_RATIO && line.slope.abs() < MAX_LINE_RATIO).then_some(line)
}

/// Finds the friction components `[mu_x, mu_y]` on the line of the direction of push.
///
/// `sums` are the `G_pq` and `u` the stresses `C33 g_3q` in pascals. Without a direction, or with a degenerate line,
/// the components are 0, and the status says why.
pub(crate) fn friction(
    contact: &Contact,
    sums: &[[f64; 3]; 3],
    u: [&[f64]; 3],
    level: f64,
    scratch: &mut LineScratch,
) -> (Status, [f64; 2]) {
    let mut status = Status::default();
    let mut mu = [0.0; 2];
    let Some(line) = contact.direction.and_then(|direction| line(direction, sums)) else {
        status.insert(Status::DIRECTION_UNKNOWN);
        return (status, mu);
    };
    let (independent, dependent) = (line.independent, 1 - line.independent);
    let along = |from: &[f64], times: f64, to: &mut Vec<f64>| {
        to.clear();
        to.extend(from.iter().zip(u[1 + dependent]).map(|(from, dependent)| from + dependent * times));
    };
    along(u[0], line.offset, &mut scratch.alpha);
    along(u[1 + independent], line.slope, &mut scratch.beta);
    let found = line::level_set(scratch, level * contact.stress_sum);
    mu[independent] = found.interval[0].midpoint(found.interval[1]);
    let wanted = line.offset + line.slope * mu[independent];
    mu[dependent] = wanted.clamp(-DEPENDENT_RANGE, DEPENDENT_RANGE);
    if found.at_bound || !(-DEPENDENT_RANGE..DEPENDENT_RANGE).contains(&wanted) {
        status.insert(Status::AT_BOUND);
    }
    (status, mu)
}

/// Finds the friction components on the line of the direction of push and evaluates the forces.
///
/// `level` is [`LEVEL`] or another share of the sum of |b|. Without a direction, or with a degenerate line, the
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
