//! The 13 matrices of the method, unfiltered.

use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt;
use std::str::FromStr;

use nalgebra::{DMatrix, DVector};

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
        let singular = |matrix, condition| MatrixError::Singular {
            matrix,
            condition,
            depth_mm: sensor.depth_mm,
            pitch_mm: sensor.pitch_mm,
        };

        let classes = parity_classes(sensor);
        let blocks = [[0, 0], [0, 1], [1, 0], [1, 1]].map(|parity| Block::new(parity, &classes, [&c31, &c32, &c33]));
        let condition_c33 = condition(blocks.each_ref().map(|block| &block.c33));
        let condition_a = condition(blocks.each_ref().map(|block| &block.r));
        let condition_aat = condition_a * condition_a;
        if is_singular(condition_c33) {
            return Err(singular("C33", condition_c33));
        }
        if is_singular(condition_aat) {
            return Err(singular("A A^T", condition_aat));
        }

        let taxels = sensor.taxels();
        let mut c33inv = DMatrix::zeros(taxels, taxels);
        let mut a = [c33inv.clone(), c33inv.clone(), c33inv.clone()];
        for block in blocks {
            block.add_inverses(&classes, &mut c33inv, &mut a).ok_or_else(|| singular("A A^T", f64::INFINITY))?;
        }
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

/// Orthonormal bases of the vectors of m numbers that are even (0) or odd (1) in x and in y, at `[x][y]`.
type Classes = [[DMatrix<f64>; 2]; 2];

fn parity_classes(sensor: &Sensor) -> Classes {
    let along = |count: usize, odd: usize| {
        DMatrix::from_fn(count, (count + 1 - odd) / 2, |at, index| {
            let mirror = count - 1 - index;
            match (at == index, at == mirror) {
                (true, true) => 1.0,
                (false, true) if odd == 1 => -FRAC_1_SQRT_2,
                (true, false) | (false, true) => FRAC_1_SQRT_2,
                (false, false) => 0.0,
            }
        })
    };
    [0, 1].map(|x| [0, 1].map(|y| along(sensor.rows, y).kronecker(&along(sensor.columns, x))))
}

/// C33 and A as far as they concern stresses of one class.
///
/// C33 commutes with both mirrors of the grid, C31 is odd in x, C32 odd in y: in the bases of [`Classes`] each falls
/// apart into four blocks of a quarter the size, and a factorisation of a block costs a 64th.
struct Block {
    /// Class of the stress, and of the forces along x, y and z that cause it.
    stress: [usize; 2],
    forces: [[usize; 2]; 3],
    c33: DMatrix<f64>,
    /// `A^T = Q R`.
    q: DMatrix<f64>,
    r: DMatrix<f64>,
}

impl Block {
    fn new([x, y]: [usize; 2], classes: &Classes, c: [&DMatrix<f64>; 3]) -> Self {
        let forces = [[1 - x, y], [x, 1 - y], [x, y]];
        let fold = classes[x][y].transpose();
        let folded: Vec<DMatrix<f64>> =
            c.iter().zip(forces).map(|(matrix, [x, y])| ((&fold * *matrix) * &classes[x][y]).transpose()).collect();
        let mut transposed = DMatrix::zeros(folded.iter().map(DMatrix::nrows).sum(), fold.nrows());
        let mut first = 0;
        for part in &folded {
            transposed.rows_mut(first, part.nrows()).copy_from(part);
            first += part.nrows();
        }
        let (q, r) = transposed.qr().unpack();
        Self { stress: [x, y], forces, c33: folded[2].transpose(), q, r }
    }

    /// Adds the block's share to C33^-1 and to the three parts of A+; `None` where there is no inverse.
    fn add_inverses(self, classes: &Classes, c33inv: &mut DMatrix<f64>, a: &mut [DMatrix<f64>; 3]) -> Option<()> {
        let [x, y] = self.stress;
        let fold = classes[x][y].transpose();
        *c33inv += (&classes[x][y] * self.c33.lu().try_inverse()?) * &fold;
        // A+ = Q R^-T: unlike A^T (A A^T)^-1 this does not square the condition number.
        let a_plus = self.r.solve_upper_triangular(&self.q.transpose())?.transpose();
        let mut first = 0;
        for (part, [x, y]) in a.iter_mut().zip(self.forces) {
            let forces = &classes[x][y];
            *part += (forces * a_plus.rows(first, forces.ncols())) * &fold;
            first += forces.ncols();
        }
        Some(())
    }
}

/// A NaN, from zero over zero, counts as singular.
fn is_singular(condition: f64) -> bool {
    condition.is_nan() || condition >= SINGULAR
}

/// Largest over smallest singular value of a matrix with these blocks.
fn condition(blocks: [&DMatrix<f64>; 4]) -> f64 {
    let values = blocks.map(DMatrix::singular_values);
    let largest = values.iter().map(DVector::max).fold(0.0, f64::max);
    let smallest = values.iter().map(DVector::min).fold(f64::INFINITY, f64::min);
    largest / smallest
}
