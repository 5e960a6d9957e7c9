//! The reference solver: one frame of normal stress in, forces and friction out.
//!
//! The stages are those of the paper's hardware, each a function of its own: [`cean`] (contact analysis), [`we`]
//! (weights), [`co`] (coefficients), [`op`] (optimum). [`Solver`] runs them and takes care of frames that have no
//! answer, which get a [`Status`] and zeros, never a NaN. With the reduced plan the stages We, Co and Op are the same
//! mathematics on folded vectors, see [`crate::reduced`]. A design may ask for another estimator of friction than the
//! paper's, with either plan.

mod batch;
pub mod cean;
pub mod co;
mod fours;
pub mod op;
mod paper;
pub(crate) mod reading;
mod reduced;
pub mod we;
mod workspace;

pub use crate::status::Status;
pub use workspace::Workspace;

use crate::design::{Design, Outputs, PlanKind};
use crate::estimators::Friction;
use crate::filter::{FilterError, FilteredMatrices};
use crate::matrices::{Matrices, MatrixError};
use crate::parity::Quads;
use crate::reduced::ReducedMatrices;
use paper::Paper;
use reading::Reader;
use reduced::Reduced;

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
    /// Forces `f_x, f_y, f_z` in newtons, one value for each taxel; empty if the design asks for resultants only.
    pub field: [Vec<f64>; 3],
}

impl Solution {
    /// The answer to a frame without one: the status and zeros, in a field of `taxels` values.
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

    /// As [`Solution::zeros`], in place.
    fn reset(&mut self, status: Status, taxels: usize) {
        let mut field = std::mem::take(&mut self.field);
        for component in &mut field {
            component.clear();
            component.resize(taxels, 0.0);
        }
        *self = Self { field, ..Self::zeros(status, 0) };
    }

    /// Multiplies all forces by a gain.
    fn scale(&mut self, gain: f64) {
        self.field.iter_mut().flatten().chain(&mut self.resultant).for_each(|force| *force *= gain);
    }

    /// Puts the friction components and the resultant in place, and what follows from that.
    fn put_friction(&mut self, [mu_x, mu_y]: [f64; 2], resultant: [f64; 3]) {
        let [x, y, _] = resultant;
        (self.mu_x, self.mu_y, self.resultant) = (mu_x, mu_y, resultant);
        (self.mu, self.phi) = (op::quotient(resultant), y.atan2(x));
    }
}

/// Everything that stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct Solver {
    reader: Reader,
    matrices: Matrices,
    products: Products,
    friction: Friction,
}

/// The estimator of a design.
fn friction(design: &Design) -> Friction {
    Friction::new(design.algorithm.constants(), &design.sensor)
}

/// The products of the design's plan.
#[derive(Clone, Debug)]
enum Products {
    Paper(Box<Paper>),
    Reduced(Box<Reduced>),
}

impl Solver {
    /// Computes and filters the matrices of a design, for the plan it names.
    ///
    /// # Errors
    ///
    /// [`SolverError::Matrices`] for a sensor whose matrices are singular or too ill-conditioned,
    /// [`SolverError::Filter`] for a filter that leaves nothing of a row.
    pub fn new(design: &Design) -> Result<Self, SolverError> {
        let name = || design.name.clone();
        let matrices = Matrices::of(design).map_err(|source| SolverError::Matrices { name: name(), source })?;
        let filter = &design.algorithm.filter;
        match design.algorithm.plan {
            PlanKind::Paper => {
                FilteredMatrices::new(&matrices, filter).map(|filtered| Self::from_parts(design, matrices, filtered))
            }
            PlanKind::Reduced => {
                let quads = Quads::new(design.sensor.columns, design.sensor.rows);
                ReducedMatrices::new(&matrices, &quads, filter).map(|reduced| {
                    let outputs = design.algorithm.outputs;
                    let products = Products::Reduced(Box::new(Reduced::new(&quads, reduced, outputs)));
                    Self { reader: Reader::new(design), matrices, products, friction: friction(design) }
                })
            }
        }
        .map_err(|source| SolverError::Filter { name: name(), source })
    }

    /// A solver by the paper's plan from matrices already computed for the same design, whatever plan that names.
    pub fn from_parts(design: &Design, matrices: Matrices, filtered: FilteredMatrices) -> Self {
        let products = Products::Paper(Box::new(Paper::new(&matrices, filtered)));
        Self { reader: Reader::new(design), matrices, products, friction: friction(design) }
    }

    /// The unfiltered matrices.
    pub fn matrices(&self) -> &Matrices {
        &self.matrices
    }

    /// The matrices the solver uses, with the paper's plan.
    pub fn filtered(&self) -> Option<&FilteredMatrices> {
        match &self.products {
            Products::Paper(paper) => Some(&paper.filtered),
            Products::Reduced(_) => None,
        }
    }

    /// The matrices the solver uses, with the reduced plan.
    pub fn reduced(&self) -> Option<&ReducedMatrices> {
        match &self.products {
            Products::Paper(_) => None,
            Products::Reduced(reduced) => Some(&reduced.matrices),
        }
    }

    /// Number of values in a frame.
    pub fn taxels(&self) -> usize {
        self.reader.taxels()
    }

    /// Solves one frame of values in taxel order, stresses in pascals or the counts that the design's input says.
    ///
    /// # Errors
    ///
    /// [`SolverError::FrameLength`] only; a frame with a NaN, without contact or without a direction gets a status.
    pub fn solve(&self, frame: &[f64]) -> Result<Solution, SolverError> {
        let mut solution = Solution::zeros(Status::default(), 0);
        self.solve_into(&mut self.workspace(), frame, &mut solution)?;
        Ok(solution)
    }

    fn field_length(&self) -> usize {
        match &self.products {
            Products::Reduced(reduced) if reduced.outputs == Outputs::Resultants => 0,
            _ => self.taxels(),
        }
    }
}
