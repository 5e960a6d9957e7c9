//! The paper's stages as it writes them, block by block: weights, coefficients, optimum.

use golden::estimators::line::{LineScratch, friction};
use golden::filter::FilteredMatrices;
use golden::matrices::{Matrices, MatrixName as Name};
use golden::solver::cean::Contact;
use nalgebra::DVector;

/// The weights `w_z = min(C33inv b, 0)` in newtons of the stress `b` in pascals (Pinto-Salamanca et al., Sensors 2024,
/// Eq. 15).
pub fn we(b: &DVector<f64>, matrices: &FilteredMatrices) -> DVector<f64> {
    (matrices.get(Name::C33inv) * b).map(|force| force.min(0.0))
}

/// The coefficients of a frame: `f_p = g[p][0] + mu_x g[p][1] + mu_y g[p][2]` for p = x, y, z, and their sums `G_pq`.
pub struct Coefficients {
    pub g: [[DVector<f64>; 3]; 3],
    pub sums: [[f64; 3]; 3],
}

/// The twelve products of Eq. 16 and the sums of Eqs. 11 to 13, for stress and weights (Eq. 13 prints A2 where A3 belongs).
pub fn co(b: &DVector<f64>, w: &DVector<f64>, matrices: &FilteredMatrices) -> Coefficients {
    let magnitude = -w;
    let times = |name, vector: &DVector<f64>| matrices.get(name) * vector;
    let g = [
        [
            times(Name::A1, b) + times(Name::D10, w),
            &magnitude + times(Name::D11, &magnitude),
            times(Name::D12, &magnitude),
        ],
        [
            times(Name::A2, b) + times(Name::D20, w),
            times(Name::D21, &magnitude),
            &magnitude + times(Name::D22, &magnitude),
        ],
        [times(Name::A3, b) + w + times(Name::D30, w), times(Name::D31, &magnitude), times(Name::D32, &magnitude)],
    ];
    let sums = std::array::from_fn(|p| std::array::from_fn(|q| g[p][q].sum()));
    Coefficients { g, sums }
}

/// Friction components, forces, their sums, and the friction and direction of these.
pub struct Forces {
    pub friction: [f64; 2],
    pub field: [DVector<f64>; 3],
    pub resultant: [f64; 3],
    pub mu: f64,
    pub phi: f64,
}

/// The friction components on the line of the direction of push, and the forces; `level` is a share of the sum of |b|.
pub fn op(contact: &Contact, coefficients: &Coefficients, matrices: &Matrices, level: f64) -> Forces {
    let u = [0, 1, 2].map(|q| &matrices.c33 * &coefficients.g[2][q]);
    let stresses = u.each_ref().map(DVector::as_slice);
    let (_, [mu_x, mu_y]) = friction(contact, &coefficients.sums, stresses, level, &mut LineScratch::default());
    let field = coefficients.g.each_ref().map(|[g0, g1, g2]| g0 + g1 * mu_x + g2 * mu_y);
    let [x, y, z] = field.each_ref().map(DVector::sum);
    Forces { friction: [mu_x, mu_y], field, resultant: [x, y, z], mu: x.hypot(y) / z.abs(), phi: y.atan2(x) }
}
