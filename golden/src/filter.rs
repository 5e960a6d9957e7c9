//! Sparse filters: which entries of the 13 matrices are kept.

use std::sync::Arc;

use nalgebra::DMatrix;
use nalgebra_sparse::{CooMatrix, CsrMatrix};

use crate::design::{Filter, MatrixFilter};
use crate::matrices::Matrices;
use crate::names::MatrixName;
use crate::parity::{FoldedMatrix, sign};

/// Why a filter cannot be used, in words.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct FilterError(pub(crate) String);

impl FilterError {
    /// F3 before its search.
    pub fn unresolved() -> Self {
        Self(
            "the filter f3 has reference scenes but no choices yet; run `sptfra tune-filter DESIGN.toml --out RESOLVED.toml` \
             once and use RESOLVED.toml"
                .to_owned(),
        )
    }

    /// Nothing of a row is left, so a taxel would get no result.
    pub(crate) fn empty_row(matrix: &str, row: usize, filter: MatrixFilter) -> Self {
        Self(format!(
            "the filter {filter} empties row {row} of {matrix}; use a weaker filter (f1: smaller l, f2: larger p)"
        ))
    }
}

/// The 13 matrices after the filter, in compressed sparse row form.
#[derive(Clone, Debug)]
pub struct FilteredMatrices {
    thirteen: Vec<Arc<CsrMatrix<f64>>>,
}

impl FilteredMatrices {
    /// Filters all 13 matrices, whole ones made and dropped one at a time.
    ///
    /// # Errors
    ///
    /// [`FilterError::unresolved`] for F3 without choices, others when a matrix or a row of one loses every entry.
    pub fn new(matrices: &Matrices, filter: &Filter) -> Result<Self, FilterError> {
        let thirteen = MatrixName::ALL
            .into_iter()
            .map(|name| {
                let filter = filter.of(name).ok_or_else(FilterError::unresolved)?;
                filtered(matrices, name, filter).map(Arc::new)
            })
            .collect::<Result<_, FilterError>>()?;
        Ok(Self { thirteen })
    }

    /// These with another filter of one matrix.
    pub(crate) fn with(
        &self,
        matrices: &Matrices,
        name: MatrixName,
        filter: MatrixFilter,
    ) -> Result<Self, FilterError> {
        let mut thirteen = self.thirteen.clone();
        thirteen[name.index()] = Arc::new(filtered(matrices, name, filter)?);
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

/// Number of entries that a filter keeps of one of the 13 matrices, as [`FilteredMatrices::nnz`], without making the
/// matrix whole: for sensors of thousands of taxels, whose filtered matrices nobody needs.
pub fn nnz_of(matrices: &Matrices, name: MatrixName, filter: MatrixFilter) -> usize {
    let orbits = matrices.orbits();
    let m = orbits.taxels();
    match filter {
        MatrixFilter::None => m * m,
        // l diagonals on either side have 1 + 2 + ... + l entries each.
        MatrixFilter::F1 { l } => m * m - l * (l + 1),
        MatrixFilter::F2 { p } => {
            let folded = matrices.folded(name);
            (0..orbits.count()).map(|q| rows_over_threshold(&folded, q, p)).sum()
        }
    }
}

/// Entries that F2 keeps in all rows of orbit q. They are the same but for their order and, in some rows of a matrix
/// that changes parity, their sign, on which the threshold depends.
fn rows_over_threshold(folded: &FoldedMatrix, q: usize, p: f64) -> usize {
    let orbits = &folded.orbits;
    let row: Vec<f64> = (0..orbits.count())
        .flat_map(|column| {
            let values = folded.values(q, column);
            orbits.distinct(column).map(move |(s, _)| values[s])
        })
        .collect();
    let count = |sign: f64| {
        let threshold = row.iter().fold(f64::NEG_INFINITY, |max, value| max.max(sign * value)) / (1000.0 * p);
        row.iter().filter(|value| value.abs() >= threshold).count()
    };
    let counts = [count(1.0), count(-1.0)];
    orbits.distinct(q).map(|(s, _)| counts[usize::from(sign(folded.parity, s) < 0.0)]).sum()
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
fn rule(matrix: &DMatrix<f64>, filter: MatrixFilter) -> impl Fn(usize, usize) -> bool {
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

/// One of the 13 matrices after its filter, no row of it empty.
fn filtered(matrices: &Matrices, name: MatrixName, filter: MatrixFilter) -> Result<CsrMatrix<f64>, FilterError> {
    let matrix = apply(&matrices.dense(name), filter);
    match matrix.row_iter().position(|row| row.nnz() == 0) {
        Some(row) => Err(FilterError::empty_row(&format!("matrix {name}"), row, filter)),
        None => Ok(matrix),
    }
}
