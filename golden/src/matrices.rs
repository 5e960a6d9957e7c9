//! The 13 matrices of the method, unfiltered.

use std::fmt;
use std::str::FromStr;

use nalgebra::DMatrix;

use crate::design::{Kernel, Sensor};
use crate::kernel;

/// Names of the 13 matrices, in the order of Table 1 of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MatrixName {
    /// Inverse of C33.
    C33inv,
    /// First block row of the pseudo-inverse A+.
    A1,
    /// Second block row of A+.
    A2,
    /// Third block row of A+.
    A3,
    /// `-A1 C33`.
    D10,
    /// `-A1 C31`.
    D11,
    /// `-A1 C32` (Eq. 14 prints A2 here; it is A1).
    D12,
    /// `-A2 C33`.
    D20,
    /// `-A2 C31`.
    D21,
    /// `-A2 C32`.
    D22,
    /// `-A3 C33`.
    D30,
    /// `-A3 C31`.
    D31,
    /// `-A3 C32`.
    D32,
}

impl MatrixName {
    /// All names, in the order of Table 1.
    pub const ALL: [Self; 13] = [
        Self::C33inv,
        Self::A1,
        Self::A2,
        Self::A3,
        Self::D10,
        Self::D11,
        Self::D12,
        Self::D20,
        Self::D21,
        Self::D22,
        Self::D30,
        Self::D31,
        Self::D32,
    ];

    /// The name as written in files, reports and JSON.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::C33inv => "C33inv",
            Self::A1 => "A1",
            Self::A2 => "A2",
            Self::A3 => "A3",
            Self::D10 => "D10",
            Self::D11 => "D11",
            Self::D12 => "D12",
            Self::D20 => "D20",
            Self::D21 => "D21",
            Self::D22 => "D22",
            Self::D30 => "D30",
            Self::D31 => "D31",
            Self::D32 => "D32",
        }
    }

    /// Position in [`MatrixName::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }
}

impl fmt::Display for MatrixName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.as_str())
    }
}

/// A word that names none of the 13 matrices.
#[derive(Debug, thiserror::Error)]
#[error("\"{0}\" is no matrix; the names are C33inv A1 A2 A3 D10 D11 D12 D20 D21 D22 D30 D31 D32")]
pub struct UnknownMatrix(String);

impl FromStr for MatrixName {
    type Err = UnknownMatrix;

    fn from_str(word: &str) -> Result<Self, Self::Err> {
        Self::ALL.into_iter().find(|name| name.as_str() == word).ok_or_else(|| UnknownMatrix(word.to_owned()))
    }
}

/// Why the matrices of a sensor cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum MatrixError {
    /// A matrix to be inverted is singular to working precision.
    #[error(
        "{matrix} is singular to working precision (condition number {condition:.1e}): a depth of {depth_mm} mm \
         blurs a pitch of {} x {} mm beyond recovery; use a smaller depth or a larger pitch, depth/pitch below about 3",
        pitch_mm[0], pitch_mm[1]
    )]
    Singular {
        /// Name of the matrix.
        matrix: &'static str,
        /// Its condition number in the 2-norm, as far as it can be told in `f64`.
        condition: f64,
        /// Depth of the sensor.
        depth_mm: f64,
        /// Pitch of the sensor.
        pitch_mm: [f64; 2],
    },
}

/// C31, C32, C33 and the 13 matrices of a sensor, each `m` by `m`, dense.
///
/// `C` matrices are in Pa/N, `C33inv` and `A` in N/Pa, `D` without unit.
#[derive(Clone, Debug)]
pub struct Matrices {
    /// Stress for forces along x.
    pub c31: DMatrix<f64>,
    /// Stress for forces along y.
    pub c32: DMatrix<f64>,
    /// Stress for forces along z.
    pub c33: DMatrix<f64>,
    thirteen: Vec<DMatrix<f64>>,
    condition_c33: f64,
    condition_aat: f64,
}

/// Largest condition number that leaves a digit of the result, `1 / f64::EPSILON`.
const SINGULAR: f64 = 1.0 / f64::EPSILON;

impl Matrices {
    /// Computes all matrices of a sensor for a load kernel (Pinto-Salamanca et al., Sensors 2024, Eqs. 4, 7 and 14).
    ///
    /// # Errors
    ///
    /// [`MatrixError::Singular`] when C33 or `A A^T` is singular to working precision.
    pub fn new(sensor: &Sensor, kernel: Kernel) -> Result<Self, MatrixError> {
        let [c31, c32, c33] = kernel::matrices(sensor, kernel);
        let taxels = sensor.taxels();
        let singular = |matrix, condition| MatrixError::Singular {
            matrix,
            condition,
            depth_mm: sensor.depth_mm,
            pitch_mm: sensor.pitch_mm,
        };

        let mut transposed = DMatrix::zeros(3 * taxels, taxels);
        for (block, matrix) in [&c31, &c32, &c33].into_iter().enumerate() {
            transposed.rows_mut(block * taxels, taxels).copy_from(&matrix.transpose());
        }
        let (q, r) = transposed.qr().unpack();

        let condition_c33 = condition(&c33);
        let condition_a = condition(&r);
        let condition_aat = condition_a * condition_a;
        if is_singular(condition_c33) {
            return Err(singular("C33", condition_c33));
        }
        if is_singular(condition_aat) {
            return Err(singular("A A^T", condition_aat));
        }

        // A^T = Q R, so A+ = Q R^-T: unlike A^T (A A^T)^-1 this does not square the condition number.
        let a_plus =
            r.solve_upper_triangular(&q.transpose()).ok_or_else(|| singular("A A^T", f64::INFINITY))?.transpose();
        let c33inv = c33.clone().lu().try_inverse().ok_or_else(|| singular("C33", f64::INFINITY))?;

        let a = [0, 1, 2].map(|p| a_plus.rows(p * taxels, taxels).into_owned());
        let d = |p: usize, c: &DMatrix<f64>| -(&a[p] * c);
        let thirteen = vec![
            c33inv,
            a[0].clone(),
            a[1].clone(),
            a[2].clone(),
            d(0, &c33),
            d(0, &c31),
            d(0, &c32),
            d(1, &c33),
            d(1, &c31),
            d(1, &c32),
            d(2, &c33),
            d(2, &c31),
            d(2, &c32),
        ];
        Ok(Self { c31, c32, c33, thirteen, condition_c33, condition_aat })
    }

    /// One of the 13 matrices.
    pub fn get(&self, name: MatrixName) -> &DMatrix<f64> {
        &self.thirteen[name.index()]
    }

    /// Condition number of C33 in the 2-norm.
    pub fn condition_c33(&self) -> f64 {
        self.condition_c33
    }

    /// Condition number of `A A^T` in the 2-norm, the square of that of `A`.
    pub fn condition_aat(&self) -> f64 {
        self.condition_aat
    }
}

/// A NaN, from zero over zero, counts as singular.
fn is_singular(condition: f64) -> bool {
    condition.is_nan() || condition >= SINGULAR
}

/// Largest over smallest singular value.
fn condition(matrix: &DMatrix<f64>) -> f64 {
    let values = matrix.singular_values();
    values.max() / values.min()
}
