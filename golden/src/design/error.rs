//! What can be wrong with a design or scene file.

use std::path::PathBuf;

/// What is wrong with a design or scene file.
#[derive(Debug, thiserror::Error)]
pub enum DesignError {
    /// The file could not be read.
    #[error("{}: cannot read the file: {source}; {}", path.display(), crate::missing_file::remedy(path, source, crate::missing_file::DESIGNS))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The text is no TOML, a key is unknown or missing, or a value has the wrong type.
    #[error("{origin}, line {line}, column {column}{}: {message}", near(context))]
    Syntax {
        /// File name.
        origin: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The line's text.
        context: String,
        /// What is wrong.
        message: String,
    },
    /// A value has the right type but is out of range or contradicts another.
    #[error("{origin}: {key} {problem}; {remedy}")]
    Value {
        /// File name.
        origin: String,
        /// Dotted key, e.g. `sensor.columns`.
        key: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A table beside the design that does not fit it: gains and offsets, or weights.
    #[error("{}, line {line}: {problem}; {remedy}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
}

fn near(context: &str) -> String {
    if context.is_empty() { String::new() } else { format!(", in `{context}`") }
}
