//! The line search, the paper's: friction along the direction of push, which the centroids of compression and tension
//! tell, found where the tension under the normal forces is least.

mod level_set;

use super::{Contact, RANGE};
use crate::status::Status;
pub use level_set::LineScratch;

/// Coefficients of the line at or above this magnitude make it degenerate: it is then all but parallel to the axis
/// of the dependent component, and the direction tells nothing.
pub const MAX_LINE_RATIO: f64 = 4.0;
/// Default level: the level set holds every point whose value exceeds the minimum by no more than this times the
/// sum of |b|. A power of two, so that it is a shift in hardware.
pub const LEVEL: f64 = 1.0 / 512.0;

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
pub fn line(direction: [f64; 2], sums: &[[f64; 3]]) -> Option<Line> {
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
pub fn friction(
    contact: &Contact,
    sums: &[[f64; 3]],
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
    let found = level_set::level_set(scratch, level * contact.stress_sum);
    mu[independent] = found.interval[0].midpoint(found.interval[1]);
    let wanted = line.offset + line.slope * mu[independent];
    mu[dependent] = wanted.clamp(-RANGE, RANGE);
    if found.at_bound || !(-RANGE..RANGE).contains(&wanted) {
        status.insert(Status::AT_BOUND);
    }
    (status, mu)
}
