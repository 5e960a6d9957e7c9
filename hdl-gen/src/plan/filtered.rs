//! The filter pass: which coefficients a plan has, of the matrices that its list names.

use golden::design::{Design, Filter, PlanKind};
use golden::filter::{FilterError, FilteredMatrices, nnz_of};
use golden::matrices::Matrices;
use golden::names::{MatrixName, ReducedName};
use golden::parity::COMPONENTS;
use golden::products::{Form, Source};
use golden::reduced::ReducedMatrices;

use super::PlanError;
use super::matrix::{RealRows, one_channel};

/// The matrices of a plan after the filter.
pub enum Filtered<'a> {
    /// The paper's thirteen, and C33, which no filter touches.
    Thirteen(FilteredMatrices, &'a Matrices),
    /// The ten of the reduced plan, folded.
    Ten(Box<ReducedMatrices>, &'a Matrices),
}

impl<'a> Filtered<'a> {
    /// Filters the matrices of a design.
    ///
    /// # Errors
    /// [`PlanError`] when the filter leaves nothing of a row.
    pub fn new(design: &Design, matrices: &'a Matrices) -> Result<Self, PlanError> {
        let filter = &design.algorithm.filter;
        Ok(match design.algorithm.plan {
            PlanKind::Paper => Self::Thirteen(FilteredMatrices::new(matrices, filter)?, matrices),
            PlanKind::Reduced => {
                Self::Ten(Box::new(ReducedMatrices::new(matrices, matrices.orbits(), filter)?), matrices)
            }
        })
    }

    /// The ten, if it is those.
    pub fn ten(&self) -> Option<&ReducedMatrices> {
        if let Self::Ten(ten, _) = self { Some(ten) } else { None }
    }

    /// Entries of the paper's thirteen after the filter, whatever the plan has of them.
    ///
    /// # Errors
    /// [`PlanError`] for a filter without choices.
    pub fn nnz(&self, filter: &Filter) -> Result<Vec<(MatrixName, usize)>, PlanError> {
        let count = |name| match self {
            Self::Thirteen(filtered, _) => Ok((name, filtered.nnz(name))),
            // One of the thirteen at a time: of a large sensor they do not fit into memory together.
            Self::Ten(_, matrices) => {
                let filter = filter.of(name).ok_or_else(FilterError::unresolved)?;
                Ok((name, nnz_of(matrices, name, filter)))
            }
        };
        MatrixName::ALL.into_iter().map(count).collect()
    }

    /// The coefficients of a matrix as a list has it, times `scale`.
    pub fn rows(&self, form: &Form, scale: f64) -> RealRows {
        let factor = form.sign * scale;
        let mut rows = match (self, form.source) {
            (Self::Thirteen(filtered, _), Source::Thirteen(name)) => one_channel(filtered.get(name), factor),
            (Self::Thirteen(_, matrices), Source::Ten(ReducedName::C33)) => {
                one_channel(&(&matrices.c33.dense()).into(), factor)
            }
            (Self::Ten(ten, _), Source::Ten(name)) => {
                let scaled = |row: &Vec<(u32, [f64; COMPONENTS])>| {
                    row.iter().map(|&(column, channels)| (column, channels.map(|value| factor * value))).collect()
                };
                ten.get(name).rows.iter().map(scaled).collect()
            }
            // No list of the plan has such a matrix.
            _ => RealRows::new(),
        };
        if form.with_identity {
            for (index, row) in rows.iter_mut().enumerate() {
                let index = index as u32;
                match row.binary_search_by_key(&index, |&(column, _)| column) {
                    Ok(at) => row[at].1[0] += factor,
                    Err(at) => row.insert(at, (index, [factor, 0.0, 0.0, 0.0])),
                }
            }
        }
        rows
    }
}
