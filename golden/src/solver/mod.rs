//! The reference solver: one frame of normal stress in, forces and friction out.
//!
//! The stages are those of the paper's hardware, each a function of its own: [`cean`] (contact analysis), [`we`]
//! (weights), [`co`] (coefficients), [`op`] (optimum). [`Solver`] runs them and takes care of frames that have no
//! answer, which get a [`Status`] and zeros, never a NaN.

pub mod cean;
pub mod co;
mod line;
pub mod op;
pub(crate) mod reading;
pub mod status;
pub mod we;

pub use status::Status;

use crate::design::Design;
use crate::filter::{FilterError, FilteredMatrices};
use crate::matrices::{Matrices, MatrixError};
use reading::{Reader, Reading};

/// Why a solver cannot be made or a frame cannot be solved.
#[derive(Debug, thiserror::Error)]
pub enum SolverError {
    /// The sensor's matrices cannot be computed.
    #[error("{name}: {source}")]
    Matrices {
        /// Name of the design.
        name: String,
        /// Why.
        source: MatrixError,
    },
    /// The filter cannot be used.
    #[error("{name}: {source}")]
    Filter {
        /// Name of the design.
        name: String,
        /// Why.
        source: FilterError,
    },
    /// A frame of the wrong length.
    #[error("the frame has {found} values, the sensor {expected} taxels; give one value for each taxel")]
    FrameLength {
        /// Values in the frame.
        found: usize,
        /// Taxels of the sensor.
        expected: usize,
    },
}

/// What one frame yields.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// What is to be known about the result.
    pub status: Status,
    /// Sum of the forces `[F_x, F_y, F_z]` in newtons.
    pub resultant: [f64; 3],
    /// `sqrt(F_x^2 + F_y^2) / |F_z|`, 0 where `F_z` is 0 (Eq. 29).
    pub mu: f64,
    /// Direction of the tangential resultant, `atan2(F_y, F_x)`, in radians.
    pub phi: f64,
    /// Friction component along x.
    pub mu_x: f64,
    /// Friction component along y.
    pub mu_y: f64,
    /// Forces `f_x, f_y, f_z` in newtons, one value for each taxel.
    pub field: [Vec<f64>; 3],
}

impl Solution {
    /// The answer to a frame without one: the status and zeros.
    pub fn zeros(status: Status, taxels: usize) -> Self {
        Self {
            status,
            resultant: [0.0; 3],
            mu: 0.0,
            phi: 0.0,
            mu_x: 0.0,
            mu_y: 0.0,
            field: std::array::from_fn(|_| vec![0.0; taxels]),
        }
    }
}

/// Everything that stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct Solver {
    reader: Reader,
    matrices: Matrices,
    filtered: FilteredMatrices,
}

impl Solver {
    /// Computes and filters the matrices of a design.
    ///
    /// # Errors
    ///
    /// [`SolverError::Matrices`] for a sensor whose matrices are singular, [`SolverError::Filter`] for a filter that
    /// leaves nothing of a row.
    pub fn new(design: &Design) -> Result<Self, SolverError> {
        let name = || design.name.clone();
        let matrices = Matrices::new(&design.sensor, design.algorithm.kernel)
            .map_err(|source| SolverError::Matrices { name: name(), source })?;
        let filtered = FilteredMatrices::new(&matrices, &design.algorithm.filter)
            .map_err(|source| SolverError::Filter { name: name(), source })?;
        Ok(Self::from_parts(design, matrices, filtered))
    }

    /// A solver from matrices already computed for the same design.
    pub fn from_parts(design: &Design, matrices: Matrices, filtered: FilteredMatrices) -> Self {
        Self { reader: Reader::new(design), matrices, filtered }
    }

    /// The unfiltered matrices.
    pub fn matrices(&self) -> &Matrices {
        &self.matrices
    }

    /// The matrices the solver uses.
    pub fn filtered(&self) -> &FilteredMatrices {
        &self.filtered
    }

    /// Number of values in a frame.
    pub fn taxels(&self) -> usize {
        self.reader.taxels()
    }

    /// Solves one frame, stress in pascals in taxel order.
    ///
    /// # Errors
    ///
    /// [`SolverError::FrameLength`] only; a frame with a NaN, without contact or without a direction gets a status.
    pub fn solve(&self, frame: &[f64]) -> Result<Solution, SolverError> {
        let (b, contact, mut status) = match self.reader.read(frame)? {
            Reading::Contact { b, contact, status } => (b, contact, status),
            Reading::Nothing(status) => return Ok(Solution::zeros(status, self.taxels())),
        };
        let weights = we::we(&b, &self.filtered);
        let coefficients = co::co(&b, &weights, &self.filtered);
        let forces = op::op(&contact, &coefficients, &self.matrices, op::LEVEL);
        status.insert(forces.status);
        Ok(Solution {
            status,
            resultant: forces.resultant,
            mu: forces.mu,
            phi: forces.phi,
            mu_x: forces.mu_x,
            mu_y: forces.mu_y,
            field: forces.field.map(|component| component.as_slice().to_vec()),
        })
    }
}
