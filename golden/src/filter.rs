//! Sparse filters: which entries of the 13 matrices are kept.

use nalgebra::DMatrix;
use nalgebra_sparse::{CooMatrix, CsrMatrix};

use crate::design::{Filter, MatrixFilter};
use crate::matrices::{Matrices, MatrixName};

/// Why a filter cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FilterError {
    /// F3 before its search.
    #[error(
        "the filter f3 has reference scenes but no choices yet; run `golden choose DESIGN.toml --out RESOLVED.toml` \
         once and use RESOLVED.toml"
    )]
    Unresolved,
    /// Nothing of a matrix is left.
    #[error("the filter {filter} empties matrix {matrix}; use a weaker filter (f1: smaller l, f2: larger p)")]
    EmptyMatrix {
        /// The matrix.
        matrix: MatrixName,
        /// Its filter.
        filter: MatrixFilter,
    },
    /// Nothing of a row is left, so a taxel would get no result.
    #[error(
        "the filter {filter} empties row {row} of matrix {matrix}; use a weaker filter (f1: smaller l, f2: larger p)"
    )]
    EmptyRow {
        /// The matrix.
        matrix: MatrixName,
        /// The first empty row, from 0.
        row: usize,
        /// Its filter.
        filter: MatrixFilter,
    },
}

/// The 13 matrices after the filter, in compressed sparse row form.
#[derive(Clone, Debug)]
pub struct FilteredMatrices {
    thirteen: Vec<CsrMatrix<f64>>,
}

impl FilteredMatrices {
    /// Filters all 13 matrices.
    ///
    /// # Errors
    ///
    /// [`FilterError::Unresolved`] for F3 without choices, others when a matrix or a row of one loses every entry.
    pub fn new(matrices: &Matrices, filter: &Filter) -> Result<Self, FilterError> {
        let thirteen = MatrixName::ALL
            .into_iter()
            .map(|name| {
                let filter = filter.of(name).ok_or(FilterError::Unresolved)?;
                let sparse = apply(matrices.get(name), filter);
                check(name, &sparse, filter)?;
                Ok(sparse)
            })
            .collect::<Result<_, FilterError>>()?;
        Ok(Self { thirteen })
    }

    /// One of the 13 matrices.
    pub fn get(&self, name: MatrixName) -> &CsrMatrix<f64> {
        &self.thirteen[name.index()]
    }

    /// Number of entries kept; an entry that is kept counts even if its value is zero.
    pub fn nnz(&self, name: MatrixName) -> usize {
        self.get(name).nnz()
    }
}

/// Applies a filter to one matrix (Pinto-Salamanca et al., Sensors 2024, section 2.6, as Table 1 counts it).
///
/// The counts of Table 1 fix two points on which the text of the paper misleads: `l` of F1 counts the diagonals
/// removed, and the row maximum of F2 is a signed one, so that a row without a positive entry is kept whole.
pub fn apply(matrix: &DMatrix<f64>, filter: MatrixFilter) -> CsrMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let keeps = rule(matrix, filter);
    let mut kept = CooMatrix::new(rows, columns);
    for row in 0..rows {
        for column in (0..columns).filter(|&column| keeps(row, column)) {
            kept.push(row, column, matrix[(row, column)]);
        }
    }
    CsrMatrix::from(&kept)
}

/// Whether the filter keeps the entry at `(row, column)` of the matrix.
pub(crate) fn rule(matrix: &DMatrix<f64>, filter: MatrixFilter) -> impl Fn(usize, usize) -> bool {
    let thresholds: Vec<f64> = match filter {
        MatrixFilter::F2 { p } => matrix.row_iter().map(|row| row.max() / (1000.0 * p)).collect(),
        MatrixFilter::None | MatrixFilter::F1 { .. } => Vec::new(),
    };
    move |row, column| match filter {
        MatrixFilter::None => true,
        MatrixFilter::F1 { l } => row.abs_diff(column) + l < matrix.nrows(),
        MatrixFilter::F2 { .. } => matrix[(row, column)].abs() >= thresholds[row],
    }
}

fn check(name: MatrixName, matrix: &CsrMatrix<f64>, filter: MatrixFilter) -> Result<(), FilterError> {
    if matrix.nnz() == 0 {
        return Err(FilterError::EmptyMatrix { matrix: name, filter });
    }
    match matrix.row_iter().position(|row| row.nnz() == 0) {
        Some(row) => Err(FilterError::EmptyRow { matrix: name, row, filter }),
        None => Ok(()),
    }
}
