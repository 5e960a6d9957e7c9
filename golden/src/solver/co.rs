//! Coefficients: forces as a linear function of the two friction components.

use nalgebra::DVector;

use super::we::Weights;
use crate::filter::FilteredMatrices;
use crate::matrices::MatrixName;

/// The coefficients of a frame: `f_p = g[p][0] + mu_x g[p][1] + mu_y g[p][2]` for p = x, y, z.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    /// The vectors `g_pq` in newtons, each of length m, at `[p - 1][q]`.
    pub g: [[DVector<f64>; 3]; 3],
    /// Their sums `G_pq` over all taxels.
    pub sums: [[f64; 3]; 3],
}

/// Computes the coefficients from the stress `b` (pascals, length m) and the weights: the twelve products of Eq. 16
/// and the sums of Eqs. 11 to 13 of Pinto-Salamanca et al., Sensors 2024 (Eq. 13 prints A2 where A3 belongs).
pub fn co(b: &DVector<f64>, weights: &Weights, matrices: &FilteredMatrices) -> Coefficients {
    use MatrixName as Name;
    let w = &weights.w;
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
