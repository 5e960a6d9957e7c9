//! What can be wrong with a design or scene file.

use std::fmt::Display;
use std::path::Path;

use crate::missing_file::{DESIGNS, remedy};

/// What is wrong with a design or scene file, or with a table beside it, in words: the file, the place and what to do.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct DesignError(pub(super) String);

impl DesignError {
    /// The file could not be read.
    pub(super) fn read(path: &Path, source: &std::io::Error) -> Self {
        Self(format!("{}: cannot read the file: {source}; {}", path.display(), remedy(path, source, DESIGNS)))
    }

    /// A line of a table beside the design does not fit it: gains and offsets, or weights.
    pub(super) fn line(path: &Path, line: usize, problem: impl Display, remedy: impl Display) -> Self {
        Self(format!("{}, line {line}: {problem}; {remedy}", path.display()))
    }
}
