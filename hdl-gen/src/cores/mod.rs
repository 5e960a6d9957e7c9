//! The leaf cores: hardware whose widths do not depend on the geometry, described in rust-hdl and emitted once.
//!
//! Every core has its bit-exact Rust reference beside it, free of rust-hdl types; the integer model computes with these
//! references, and a test compares each emitted text with its reference in Verilator.

use thiserror::Error;

mod emit;
mod printer;
mod register;
mod sint;

pub mod axis_skid;
pub mod cordic;
pub mod divider;
pub mod fixed_to_float;
pub mod float_to_fixed;
pub mod mac;
pub mod mac_split;
pub mod multiply;
pub mod row_sequencer;

/// One emitted core.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoreFile {
    /// The module's name, which is also the file's, without `.v`.
    pub module: &'static str,
    /// The whole file: Verilog-2005, one module.
    pub verilog: String,
}

/// A core that cannot be emitted: a fault of its description, not of any design.
#[derive(Debug, Error)]
pub enum CoreError {
    /// rust-hdl's own checks failed.
    #[error("core {module}: rust-hdl found {problem}; connect or reorder the named signals in its kernel")]
    Check {
        /// The core's module name.
        module: &'static str,
        /// rust-hdl's finding.
        problem: String,
    },
    /// The kernel has a construct that could mean another thing in Verilog than in Rust.
    #[error("core {module}: {problem}; rewrite its kernel with one operation per signal of exact width")]
    Kernel {
        /// The core's module name.
        module: &'static str,
        /// The construct and what is wrong with it.
        problem: String,
    },
}

/// How a fabric multiplies 18 by 27 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Multiplier {
    /// In one DSP block, as UltraScale+ does.
    Whole,
    /// In two blocks of 18 by 18 bits whose products are registered before they are added, as on ECP5.
    Split,
}

impl Multiplier {
    /// The form that suits `part`: whole, unless its name is that of a Lattice ECP5. Both take the same cycles.
    pub fn of_part(part: &str) -> Self {
        if part.starts_with("LFE5") { Self::Split } else { Self::Whole }
    }

    /// The module that multiplies and accumulates.
    pub fn mac(self) -> &'static str {
        match self {
            Self::Whole => "sptfra_mac",
            Self::Split => "sptfra_mac_split",
        }
    }

    /// The module that multiplies alone.
    pub fn multiply(self) -> &'static str {
        match self {
            Self::Whole => "sptfra_multiply",
            Self::Split => "sptfra_multiply_split",
        }
    }
}

/// Emits the cores of a design with multipliers of this form, always in the same order.
///
/// # Errors
/// As [`emit_all`].
pub fn emit_with(multiplier: Multiplier) -> Result<Vec<CoreFile>, CoreError> {
    let other = if multiplier == Multiplier::Whole { Multiplier::Split } else { Multiplier::Whole };
    let mut cores = emit_all()?;
    cores.retain(|core| core.module != other.mac() && core.module != other.multiply());
    Ok(cores)
}

/// Emits every core, always in the same order.
///
/// # Errors
/// [`CoreError`] if a description does not translate; a test sees to it that none is released like that.
pub fn emit_all() -> Result<Vec<CoreFile>, CoreError> {
    [
        mac::core,
        mac_split::core,
        multiply::whole,
        multiply::split,
        axis_skid::core,
        row_sequencer::core,
        divider::core,
        cordic::core,
        float_to_fixed::core,
        fixed_to_float::core,
    ]
    .into_iter()
    .map(|core| core())
    .collect()
}

#[cfg(test)]
mod tests;
