//! The words of an output frame before those of the taxels: what stands where. The output (`sptfra_output`), the model,
//! `metadata.json` and the drivers have this list.

use golden::status::Status;
use serde::Serialize;

/// How the bits of a word are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// IEEE 754, single precision.
    Float32,
    /// A number from 0 on.
    Unsigned,
    /// One bit for each thing that can be said.
    Flags,
}

/// One value of an output frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Word {
    /// What it is.
    pub name: &'static str,
    /// Position of its word in the frame.
    pub index: usize,
    /// Its highest and its lowest bit in that word.
    pub bits: [u32; 2],
    /// How it is read.
    #[serde(rename = "type")]
    pub kind: Kind,
    /// Unit; empty for a bare number.
    pub unit: &'static str,
}

impl Word {
    const fn float(name: &'static str, index: usize, unit: &'static str) -> Self {
        Self { name, index, bits: [31, 0], kind: Kind::Float32, unit }
    }

    const fn number(name: &'static str, index: usize, bits: [u32; 2], unit: &'static str) -> Self {
        Self { name, index, bits, kind: Kind::Unsigned, unit }
    }
}

/// Words before those of the taxels.
pub const SUMMARY_WORDS: usize = 16;
/// Status and frame counter.
pub const STATUS: usize = 0;
/// Cycle of the first beat in.
pub const TIMESTAMP: usize = 1;
/// `F_x`, and two more.
pub const FORCE: usize = 2;
/// `T_x`, and two more.
pub const TORQUE: usize = 5;
/// Friction coefficient, and its direction.
pub const MU: usize = 8;
/// `mu_x`, and `mu_y`.
pub const MU_XY: usize = 10;
/// Standard error.
pub const STANDARD_ERROR: usize = 12;
/// Contacts, version of the calibration, replaced taxels.
pub const COUNTERS: usize = 13;

/// All values, in order; words that no value names are 0.
pub const SUMMARY: [Word; 17] = [
    Word { name: "status", index: STATUS, bits: [15, 0], kind: Kind::Flags, unit: "" },
    Word::number("frame", STATUS, [31, 16], ""),
    Word::number("timestamp", TIMESTAMP, [31, 0], "cycles"),
    Word::float("F_x", FORCE, "N"),
    Word::float("F_y", FORCE + 1, "N"),
    Word::float("F_z", FORCE + 2, "N"),
    Word::float("T_x", TORQUE, "N m"),
    Word::float("T_y", TORQUE + 1, "N m"),
    Word::float("T_z", TORQUE + 2, "N m"),
    Word::float("mu", MU, ""),
    Word::float("phi", MU + 1, "rad"),
    Word::float("mu_x", MU_XY, ""),
    Word::float("mu_y", MU_XY + 1, ""),
    Word::float("standard_error", STANDARD_ERROR, "N"),
    Word::number("contacts", COUNTERS, [7, 0], ""),
    Word::number("version", COUNTERS, [15, 8], ""),
    Word::number("replaced_taxels", COUNTERS, [23, 16], "taxels"),
];

/// The status bits that there are, as `(bit, name)`.
pub fn status_bits() -> impl Iterator<Item = (u32, &'static str)> {
    Status::NAMED.into_iter().map(|(bit, name)| (bit.0.trailing_zeros(), name))
}
