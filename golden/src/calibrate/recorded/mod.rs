//! Constants from recordings: what a count is worth, and what each taxel's is, from frames with measured forces.
//!
//! A recording is separated into contacts and holds ([`holds`]). The normal force of a hold is a weighted sum of its stress
//! ([`rows`]), so that the curve of counts ([`shape`]) and the taxels' gains ([`gains`]) are linear least squares each, in
//! turns. What is chosen, the curve's kind and how smooth the gains are, is chosen by cross-validation that leaves whole
//! places out, the simplest that is as good as the best. What it does not better is not fitted.

mod columns;
pub mod creep;
mod fit;
mod folds;
mod force;
mod friction;
mod gains;
mod holds;
mod lag;
mod loads;
mod readings;
mod report;
mod rows;
mod shape;
mod sideways;
mod table;
mod uniform;

use std::fmt::Display;

pub use force::fit_forces;
pub use report::{Errors, Hold, Recorded, TaxelGain};
pub use table::{Measured, read_forces, read_pressures};
pub(crate) use table::{forces, table};
pub use uniform::fit_uniform;

use crate::frames::FrameError;
use crate::solver::SolverError;

/// Why constants cannot be found from a recording.
#[derive(Debug, thiserror::Error)]
pub enum RecordedError {
    /// What is wrong with a file, or with frames and forces that tell nothing, and what to do.
    #[error("{0}")]
    Wrong(String),
    /// A file that cannot be read.
    #[error(transparent)]
    Read(#[from] FrameError),
    /// The sensor's matrices or the filter.
    #[error(transparent)]
    Solver(#[from] SolverError),
}

impl RecordedError {
    /// Of a file or a design.
    fn of(what: impl Display, (problem, remedy): loads::Wrong) -> Self {
        Self::Wrong(format!("{what}: {problem}; {remedy}"))
    }
}
