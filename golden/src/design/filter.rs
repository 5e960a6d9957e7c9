//! Filters of the matrices, as a design states them.

use std::fmt;
use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::names::MatrixName;
use crate::words::{self, print_as_words};

/// The kinds of filters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FilterKind {
    /// All entries are kept.
    #[default]
    None,
    /// A band around the diagonal: the l outermost diagonals on either side are removed.
    F1,
    /// Entries that are large within their row.
    F2,
    /// For each matrix its own filter, which `sptfra tune-filter` chooses on scenes; with the paper's plan only.
    F3,
}

print_as_words!(FilterKind);

/// Which entries of the 13 matrices are kept.
#[derive(Clone, Debug, PartialEq)]
pub enum Filter {
    /// All of them.
    None,
    /// A band around the diagonal.
    F1 {
        /// Number of diagonals **removed** on either side: kept is `|i - j| <= (m - 1) - l`.
        l: usize,
    },
    /// Entries that are large within their row.
    F2 {
        /// Kept is `|B_ij| >= max_j(B_ij) / (1000 p)`, with the signed maximum of the row.
        p: f64,
    },
    /// For each matrix its own filter, chosen by what it does to the friction in reference scenes (Pinto-Salamanca
    /// et al., Sensors 2024, Eq. 27).
    F3 {
        /// Scene files to choose by, relative to the design file; not read once the choices are there.
        scenes: Vec<String>,
        /// The choices, or `None` before the search of [`crate::tune_filter`].
        choices: Option<Box<Choices>>,
    },
}

impl Filter {
    /// Which of the filters it is.
    pub fn kind(&self) -> FilterKind {
        match self {
            Self::None => FilterKind::None,
            Self::F1 { .. } => FilterKind::F1,
            Self::F2 { .. } => FilterKind::F2,
            Self::F3 { .. } => FilterKind::F3,
        }
    }

    /// The filter of one matrix, or `None` for F3 without choices.
    pub fn of(&self, matrix: MatrixName) -> Option<MatrixFilter> {
        match self {
            Self::None => Some(MatrixFilter::None),
            Self::F1 { l } => Some(MatrixFilter::F1 { l: *l }),
            Self::F2 { p } => Some(MatrixFilter::F2 { p: *p }),
            Self::F3 { choices, .. } => choices.as_ref().map(|choices| choices[matrix.index()]),
        }
    }
}

impl fmt::Display for Filter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.of(MatrixName::C33inv) {
            Some(filter) if self.kind() != FilterKind::F3 => filter.fmt(formatter),
            _ => self.kind().fmt(formatter),
        }
    }
}

/// Which entries of one matrix are kept.
///
/// As text, in design files and reports: `none`, `f1 l=40` or `f2 p=30`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MatrixFilter {
    /// All of them.
    None,
    /// As [`Filter::F1`].
    F1 {
        /// Diagonals removed on either side.
        l: usize,
    },
    /// As [`Filter::F2`].
    F2 {
        /// Kept is `|B_ij| >= max_j(B_ij) / (1000 p)`.
        p: f64,
    },
}

impl fmt::Display for MatrixFilter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => FilterKind::None.fmt(formatter),
            Self::F1 { l } => formatter.pad(&format!("{} l={l}", FilterKind::F1)),
            Self::F2 { p } => formatter.pad(&format!("{} p={p}", FilterKind::F2)),
        }
    }
}

impl FromStr for MatrixFilter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut words = text.split_whitespace();
        let kind = words.next().and_then(|kind| words::read(kind).ok());
        let parsed = match (kind, words.next(), words.next()) {
            (Some(FilterKind::None), None, _) => Some(Self::None),
            (Some(FilterKind::F1), Some(l), None) => {
                l.strip_prefix("l=").and_then(|l| l.parse().ok()).map(|l| Self::F1 { l })
            }
            (Some(FilterKind::F2), Some(p), None) => {
                p.strip_prefix("p=").and_then(|p| p.parse().ok()).map(|p| Self::F2 { p })
            }
            _ => None,
        };
        parsed.ok_or_else(|| format!("\"{text}\" is no filter of a matrix; write \"none\", \"f1 l=40\" or \"f2 p=30\""))
    }
}

/// A filter for each of the 13 matrices, in the order of [`MatrixName::ALL`].
pub type Choices = [MatrixFilter; MatrixName::ALL.len()];
