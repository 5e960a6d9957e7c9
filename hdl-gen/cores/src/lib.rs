//! The leaf cores in rust-hdl, and the printer that turns them into the Verilog in `hdl-gen/rtl`.
//!
//! Nothing that generates or simulates a design needs this package: the printed files lie in git, and a test prints
//! them anew and compares. What a core computes, and when, stands in [`hdl_gen::cores`].

use thiserror::Error;

mod emit;
mod flow;
mod printer;
mod process;
mod register;
mod section;
mod sint;

mod cordic;
mod fixed_to_float;
mod float_to_fixed;
mod row_sequencer;

/// One printed core.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoreFile {
    /// The file below `hdl-gen/rtl`, named after its module.
    pub path: &'static str,
    /// The whole file: Verilog-2005, one module.
    pub verilog: String,
}

/// A core that cannot be printed: a fault of its description, not of any design.
#[derive(Debug, Error)]
pub enum CoreError {
    /// rust-hdl's own checks failed.
    #[error("core {path}: rust-hdl found {problem}; connect or reorder the named signals in its kernel")]
    Check {
        /// The core's file.
        path: &'static str,
        /// rust-hdl's finding.
        problem: String,
    },
    /// The kernel has a construct that could mean another thing in Verilog than in Rust.
    #[error("core {path}: {problem}; rewrite its kernel with one operation per signal of exact width")]
    Kernel {
        /// The core's file.
        path: &'static str,
        /// The construct and what is wrong with it.
        problem: String,
    },
}

/// Prints every core, always in the same order.
///
/// # Errors
/// [`CoreError`] if a description does not translate; a test sees to it that none is released like that.
pub fn print_all() -> Result<Vec<CoreFile>, CoreError> {
    [row_sequencer::core, cordic::core, float_to_fixed::core, fixed_to_float::core]
        .into_iter()
        .map(|core| core())
        .collect()
}

#[cfg(test)]
mod tests;
