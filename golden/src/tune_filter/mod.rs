//! The search behind filter F3: for each matrix the filter that costs friction least for the entries it keeps.
//!
//! With only that matrix filtered, every candidate is judged by `e_mu * Nnz`, where `e_mu` is the error of the
//! friction coefficient averaged over reference frames (Pinto-Salamanca et al., Sensors 2024, Eqs. 27 to 29), by the
//! design's own estimator.

mod scenes;

pub use scenes::{rebase, reference_frames};

use rayon::prelude::*;
use serde::{Serialize, Serializer};

use crate::design::{Choices, Design, Filter, Input, MatrixFilter};
use crate::filter::{FilterError, FilteredMatrices};
use crate::matrices::{Matrices, MatrixError, MatrixName};
use crate::scene::SceneFrame;
use crate::solver::{Solver, SolverError};

/// Why no choice can be made.
#[derive(Debug, thiserror::Error)]
pub enum TuneFilterError {
    /// The sensor's matrices cannot be computed.
    #[error(transparent)]
    Matrices(#[from] MatrixError),
    /// The choices leave nothing of a row.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// The frames are not those of the sensor.
    #[error(transparent)]
    Frames(#[from] SolverError),
}

/// One filter of one matrix, judged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Candidate {
    /// The matrix.
    pub matrix: MatrixName,
    /// Its filter.
    #[serde(serialize_with = "as_text")]
    pub filter: MatrixFilter,
    /// Entries it keeps.
    pub nnz: usize,
    /// Error of the friction coefficient in percent, mean over the frames, with only this matrix filtered.
    pub e_mu: f64,
    /// `e_mu * nnz`, of which the least is chosen.
    pub cost: f64,
    /// Whether it is.
    pub chosen: bool,
}

fn as_text<S: Serializer>(value: &impl ToString, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&value.to_string())
}

/// What the search found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// All candidates, matrix by matrix, F1 before F2, the parameter rising: Figure 11 of the paper.
    pub candidates: Vec<Candidate>,
    /// Frames they were judged by.
    pub frames: usize,
    /// Mean error of the friction coefficient in percent without a filter.
    pub e_mu_unfiltered: f64,
    /// The same with all choices together.
    pub e_mu_chosen: f64,
    /// Entries kept in all 13 matrices.
    pub nnz_chosen: usize,
}

impl Choice {
    /// The filter of each matrix.
    pub fn choices(&self) -> Choices {
        let mut filters = [MatrixFilter::None; MatrixName::ALL.len()];
        for candidate in self.candidates.iter().filter(|candidate| candidate.chosen) {
            filters[candidate.matrix.index()] = candidate.filter;
        }
        filters
    }
}

/// Number of candidates of a search on a sensor of `taxels`, for progress.
pub fn candidate_count(taxels: usize) -> usize {
    MatrixName::ALL.len() * candidate_filters(taxels).len()
}

/// The filters tried on each matrix: `L` and `p` from 10 to 90 in steps of 10, as in the paper; on a small sensor
/// only the bands that leave a neighbour of the diagonal.
fn candidate_filters(taxels: usize) -> Vec<MatrixFilter> {
    let steps = || (1..=9).map(|step| 10 * step);
    let bands = steps().filter(|&l| l + 2 <= taxels).map(|l| MatrixFilter::F1 { l });
    bands.chain(steps().map(|p| MatrixFilter::F2 { p: p as f64 })).collect()
}

/// Searches the filter of each matrix of a design by reference frames; `tick` is called after every candidate, from
/// several threads.
///
/// Of candidates that cost the same the first is chosen: F1 before F2, as in Eq. 27, then the smaller parameter.
///
/// # Errors
///
/// A sensor whose matrices are singular, frames of another sensor, a candidate that leaves a row without entries.
pub fn tune_filter(
    design: &Design,
    frames: &[SceneFrame],
    tick: &(dyn Fn() + Sync),
) -> Result<Choice, TuneFilterError> {
    // Scenes are in pascals, whatever the sensor counts.
    let design = &Design { input: Input::default(), ..design.clone() };
    let matrices = Matrices::of(design)?;
    let whole = FilteredMatrices::new(&matrices, &Filter::None)?;
    let error = |filtered| mean_error(&Solver::from_parts(design, matrices.clone(), filtered), frames);
    let filters = candidate_filters(design.sensor.taxels());
    let pairs: Vec<_> =
        MatrixName::ALL.into_iter().flat_map(|matrix| filters.iter().map(move |&filter| (matrix, filter))).collect();
    let mut candidates = pairs
        .into_par_iter()
        .map(|(matrix, filter)| {
            let filtered = whole.with(&matrices, matrix, filter)?;
            let nnz = filtered.nnz(matrix);
            let e_mu = error(filtered)?;
            tick();
            Ok(Candidate { matrix, filter, nnz, e_mu, cost: e_mu * nnz as f64, chosen: false })
        })
        .collect::<Result<Vec<_>, TuneFilterError>>()?;
    for of_matrix in candidates.chunks_mut(filters.len()) {
        // `min_by` keeps the first of equal ones.
        if let Some(best) = of_matrix.iter_mut().min_by(|a, b| a.cost.total_cmp(&b.cost)) {
            best.chosen = true;
        }
    }
    let mut choice =
        Choice { candidates, frames: frames.len(), e_mu_unfiltered: error(whole)?, e_mu_chosen: 0.0, nnz_chosen: 0 };
    let together = Filter::F3 { scenes: Vec::new(), choices: Some(Box::new(choice.choices())) };
    let filtered = FilteredMatrices::new(&matrices, &together)?;
    choice.nnz_chosen = MatrixName::ALL.into_iter().map(|name| filtered.nnz(name)).sum();
    choice.e_mu_chosen = error(filtered)?;
    Ok(choice)
}

/// Mean error of a solver's friction coefficient over frames, in percent (Eq. 28).
///
/// # Errors
///
/// Frames of another sensor.
pub fn mean_error(solver: &Solver, frames: &[SceneFrame]) -> Result<f64, SolverError> {
    let mut sum = 0.0;
    for frame in frames {
        sum += 100.0 * (frame.friction - solver.solve(&frame.stress)?.mu).abs();
    }
    Ok(sum / frames.len() as f64)
}
