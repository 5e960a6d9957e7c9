//! Cycles from block to block in the hardware: the schedule, the predicted times and the checks in
//! simulation read them here. `folded` says whether vectors are folded by parity. Those of an estimator stand with it, those
//! of a leaf core in [`crate::cores`].

use crate::cores::{cordic, divider};

// ---- Bz
/// From a frame's last stress to the frame being ready for the lanes, in cycles: the fold, and the count of frames.
pub fn stress_to_ready(folded: bool) -> u64 {
    if folded { 4 } else { 1 }
}

// ---- The array of lanes
/// From the sequencer's control to the lanes' and the collector's, in cycles: the register on the way.
pub const SEQUENCER_TO_LANES: u64 = 1;
/// From a program's start pulse to its first issue, in the lanes.
pub const START_TO_ISSUE: u64 = 2 + SEQUENCER_TO_LANES;
/// From the collector taking a result to its standing on the result bus.
pub const VISIT_TO_BUS: u64 = 3;
/// From a write at the array's port to the first issue that may read the word: the write passes a register and enters the
/// memory; the operand is read two cycles after its issue.
pub const WRITE_TO_ISSUE: u64 = 0;

// ---- Unfold, We, Co
/// Result bus to taxels, in cycles.
pub fn bus_to_taxels(folded: bool) -> u64 {
    if folded { 5 } else { 1 }
}

/// Taxels to the write port of the operand memories, in cycles: of a folded grid to the second of two words, y+.
pub fn taxels_to_write(folded: bool) -> u64 {
    if folded { 5 } else { 1 }
}

/// Result bus to the write port of the operand memories, in cycles: of what is stored as it comes, or of g.
pub fn bus_to_write(folded: bool) -> u64 {
    if folded { 1 } else { 3 }
}

/// From the last sum, or the last g, on the result bus to the sums being complete.
pub fn bus_to_sums(folded: bool) -> u64 {
    if folded { 2 } else { 7 }
}

// ---- Op
/// From the answer's taking to the end of the summary.
pub const SUMMARY_LATENCY: u64 = 43 + cordic::LATENCY as u64 + divider::LATENCY as u64;
/// From the start of the output to the first beat leaving Op.
pub const OUTPUT_LATENCY: u64 = 13;
