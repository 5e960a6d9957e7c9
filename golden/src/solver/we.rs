//! Weights: the contact force that the stress alone would mean.

use nalgebra::DVector;

use crate::filter::FilteredMatrices;
use crate::matrices::MatrixName;

/// The weights of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// `w_z = min(C33inv b, 0)` in newtons, length m; never positive, since a contact can only press.
    pub w: DVector<f64>,
}

/// Computes the weights of the stress `b` (pascals, length m), Eq. 15 of Pinto-Salamanca et al., Sensors 2024.
pub fn we(b: &DVector<f64>, matrices: &FilteredMatrices) -> Weights {
    let w = (matrices.get(MatrixName::C33inv) * b).map(|force| force.min(0.0));
    Weights { w }
}
