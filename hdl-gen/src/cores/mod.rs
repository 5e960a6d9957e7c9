//! The leaf cores: hardware whose widths do not depend on the geometry, the same in every design.
//!
//! Each file states what a core computes, bit for bit, and when; the integer model computes with these references, and
//! a test compares each core's Verilog with its reference. Of multipliers, the skid buffer and the row sequencer the test
//! itself has the reference. The Verilog lies in `hdl-gen/rtl`; the package `sptfra-hdl-cores` prints that of cores without parameters
//! from descriptions in rust-hdl.

pub mod axis_skid;
pub mod cordic;
pub mod fixed_to_float;
pub mod float_to_fixed;
pub mod ratio;

/// Width of the shorter operand of a multiplier, as in one DSP48E2.
pub const SHORT_BITS: u32 = 18;
/// Width of the longer one.
pub const LONG_BITS: u32 = 27;
/// Width of the longer one in the DSP48E1 of 7-series parts (UG479); a longer operand takes two of them.
pub const OLDER_LONG_BITS: u32 = 25;
/// Width of the sum of products behind them.
pub const ACCUMULATOR_BITS: u32 = 48;

/// Bits of a product that two multipliers drop, together, before they add it: as many as the operand's lower part has.
pub const DROPPED_BITS: u32 = 17;
/// Widths of the operands of two multipliers together: a coefficient, and a value in two parts.
pub const WIDE_COEFFICIENT_BITS: u32 = LONG_BITS;
/// See [`WIDE_COEFFICIENT_BITS`].
pub const WIDE_DATA_BITS: u32 = SHORT_BITS + DROPPED_BITS;

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

/// The multipliers that a part has, as Vivado's reports call them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum DspBlock {
    /// 27 by 18 bits, of UltraScale and later; other fabrics are counted in these, too.
    #[default]
    Dsp48E2,
    /// 25 by 18 bits, of the 7-series.
    Dsp48E1,
}

impl DspBlock {
    /// Those of `part`, by the beginning of its name.
    pub fn of_part(part: &str) -> Self {
        if part.starts_with("xc7") { Self::Dsp48E1 } else { Self::Dsp48E2 }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dsp48E2 => "DSP48E2",
            Self::Dsp48E1 => "DSP48E1",
        }
    }

    /// How many of them so many multipliers take, of which `narrow` have no operand beyond [`OLDER_LONG_BITS`].
    pub fn count(self, multipliers: usize, narrow: usize) -> usize {
        match self {
            Self::Dsp48E2 => multipliers,
            Self::Dsp48E1 => 2 * multipliers - narrow,
        }
    }
}
