//! Counts in Bz as the templates see them.

use serde::Serialize;

use crate::plan::counts::{CountsPlan, GAIN_BITS};

use super::expressions::{half, signed_literal};

/// Conversion of counts in Bz.
#[derive(Serialize)]
pub struct CountsView {
    per_taxel: bool,
    /// Literal of the gain that all taxels share.
    gain: String,
    offset_bits: u32,
    shift: u32,
    half: u64,
    full_scale: i64,
}

impl CountsView {
    /// The constants of the conversion.
    pub fn new(counts: &CountsPlan) -> Self {
        Self {
            per_taxel: counts.per_taxel(),
            gain: signed_literal(GAIN_BITS, counts.gains[0]),
            offset_bits: counts.offset_bits(),
            shift: counts.shift,
            half: if counts.shift == 0 { 0 } else { half(counts.shift) },
            full_scale: counts.full_scale,
        }
    }
}
