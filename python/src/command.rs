//! The command, as the wheel installs it.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs a command line, whose first word is the program's name, and returns the exit code.
#[pyfunction]
pub fn command(python: Python<'_>, words: Vec<OsString>) -> u8 {
    python.detach(|| sptfra::run(words))
}
