//! The leaf cores: hardware whose widths do not depend on the geometry, the same in every design.
//!
//! Each file states what a core computes, bit for bit, and when; the integer model computes with these references, and
//! a test compares each core's Verilog with its reference. The Verilog lies in `hdl-gen/rtl`; the package `hdl-cores`
//! prints it from descriptions in rust-hdl.

pub mod axis_skid;
pub mod cordic;
pub mod divider;
pub mod fixed_to_float;
pub mod float_to_fixed;
pub mod mac;
pub mod multiply;
pub mod row_sequencer;

/// One leaf core's Verilog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoreFile {
    /// The module's name, which is also the file's, without `.v`.
    pub module: &'static str,
    /// The whole file: Verilog-2005, one module.
    pub verilog: &'static str,
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
}

/// The core whose file, below `hdl-gen/rtl`, is named.
macro_rules! core_file {
    ($module: literal, $file: literal) => {
        CoreFile { module: $module, verilog: include_str!(concat!("../../rtl/", $file)) }
    };
}

/// The cores that multiply, in one piece.
const WHOLE: [CoreFile; 2] =
    [core_file!("sptfra_mac", "sptfra_mac.v"), core_file!("sptfra_multiply", "sptfra_multiply.v")];

/// The same in two pieces: other implementations of the same modules.
const SPLIT: [CoreFile; 2] =
    [core_file!("sptfra_mac", "ecp5/sptfra_mac.v"), core_file!("sptfra_multiply", "ecp5/sptfra_multiply.v")];

/// The cores that are the same on every fabric.
const COMMON: [CoreFile; 6] = [
    core_file!("sptfra_axis_skid", "sptfra_axis_skid.v"),
    core_file!("sptfra_row_sequencer", "sptfra_row_sequencer.v"),
    core_file!("sptfra_divider", "sptfra_divider.v"),
    core_file!("sptfra_cordic", "sptfra_cordic.v"),
    core_file!("sptfra_float_to_fixed", "sptfra_float_to_fixed.v"),
    core_file!("sptfra_fixed_to_float", "sptfra_fixed_to_float.v"),
];

/// The cores of a design with multipliers of this form, always in the same order.
pub fn files(multiplier: Multiplier) -> impl Iterator<Item = CoreFile> {
    let multipliers = match multiplier {
        Multiplier::Whole => WHOLE,
        Multiplier::Split => SPLIT,
    };
    multipliers.into_iter().chain(COMMON)
}
