//! Cycles from block to block in the hardware, each a count of pipeline registers.
//!
//! The schedule, the predicted times and the checks in simulation read them here. They are needed before there is a
//! plan, and so stand apart from what the blocks make of one. `folded` says whether vectors are folded by parity. Cycles
//! of an estimator stand with it, those of a leaf core in [`crate::cores`].

use golden::sensor::Sensor;

use crate::cores::{axis_skid, cordic, float_to_fixed, ratio};

// ---- Intake
/// What the ingress FIFO takes more than the skid buffer in its place: a memory is written, then read.
pub const OVERRUN: u64 = 2 - axis_skid::LATENCY as u64;

// ---- Bz
/// From a beat entering the conversion to its stress.
///
/// Where each taxel has an exponent, its memory and a register stand in front of the conversion. A curve and the counts'
/// gains, if there are any, stand behind it.
pub fn beat_to_stress(counts: bool, per_taxel: bool, curve: Option<u64>) -> u64 {
    let exponent = if per_taxel { 2 } else { 0 };
    // Gain, product, sum, limits; behind a curve the product is shifted in three more.
    let gain = if counts { curve.map_or(4, |_| 7) } else { 0 };
    u64::from(float_to_fixed::LATENCY) + curve.unwrap_or(exponent) + gain
}

/// What replacing dead taxels adds to that: the frame is read once more.
pub fn replacing(taxels: usize) -> u64 {
    taxels as u64 + 6
}

/// What removing crosstalk adds: a term for each row, each column and the frame, then the frame is read once more.
pub fn crosstalk(sensor: &Sensor) -> u64 {
    (sensor.taxels() + sensor.columns + sensor.rows) as u64 + 8
}

/// What removing creep adds.
pub const CREEP: u64 = 2;

/// From a stress to the average with it.
pub const SMOOTHING: u64 = 4;
/// From a frame's last average to the first element's reading, where no scale takes longer. A tree finds the largest step
/// of a beat.
pub fn smoothing_decided(samples: usize) -> u64 {
    1 + u64::from(samples.ilog2())
}

/// From an element's reading to its write to the operand memories: two cycles more where stresses are shifted.
pub fn read_to_write(scaled: bool) -> u64 {
    if scaled { 6 } else { 4 }
}

/// From a frame's last stress to the first element's reading, where each frame has a scale of its own. A tree finds the
/// largest stress of a beat.
pub fn frame_scale(samples: usize) -> u64 {
    5 + u64::from(samples.ilog2())
}

/// From a taxel's reading to its stress in `CeAn`, where a frame that is kept is read.
pub const TAXEL_TO_CEAN: u64 = 2;

// ---- The array of lanes
/// From the array's control to its PEs and its collector: a register.
pub const CONTROL_TO_LANES: u64 = 1;
/// From a program's start pulse to its first issue, in the lanes, where `gap` cycles pass without issue from one program
/// to the next.
pub fn start_to_issue(gap: u64) -> u64 {
    2 + CONTROL_TO_LANES + gap - PROGRAM_GAP
}

/// Without issue when the lanes pass from one program to the next, at least.
pub const PROGRAM_GAP: u64 = 2;
/// From the issue of a row's last MAC to its sum standing in the PE's result buffer.
pub const ISSUE_TO_RESULT: u64 = 7;
/// From taking a program's last result to taking the next program's first: the order is read from a ROM, whose address is
/// there `ahead` or goes there then.
pub fn collector_jump(ahead: bool) -> u64 {
    if ahead { 2 } else { 4 }
}
/// From the collector taking a result to its standing on the result bus.
pub const TAKE_TO_BUS: u64 = 3;
/// From a write at the array's port to the first issue that may read the word: the write passes a register and enters the
/// memory; the operand is read two cycles after its issue.
pub const WRITE_TO_ISSUE: u64 = 0;

// ---- Unfold, We, Co
/// From the result bus to taxels.
pub fn bus_to_taxels(folded: bool) -> u64 {
    if folded { 5 } else { 1 }
}

/// From taxels to the write port of the operand memories: of a folded grid to the second of two words, y+.
pub fn taxels_to_write(folded: bool) -> u64 {
    if folded { 5 } else { 1 }
}

/// From the result bus to the write port of the operand memories: of what is stored as it comes, or of g.
pub fn bus_to_write(folded: bool) -> u64 {
    if folded { 1 } else { 3 }
}

/// From the last sum, or the last g, on the result bus to the sums being complete.
pub fn bus_to_sums(folded: bool) -> u64 {
    if folded { 2 } else { 7 }
}

/// From taking the last result of the residual to the field's program being allowed.
pub const TAKE_TO_RESIDUAL: u64 = TAKE_TO_BUS + 1;

// ---- The count of contacts
/// From the last weights of a frame to its count: a step for each taxel and for the end of each row, and the way through
/// sums and comparisons.
///
/// A search has a longer stage: that of the grid takes `4 orbits` and more, or `2 orbits + 82` with many lanes. A frame
/// begins when that stage of the one before the last is over. So a count is there before the search, and adds nothing to
/// latency or interval.
pub fn count_contacts(sensor: &Sensor) -> u64 {
    ((sensor.columns + 1) * sensor.rows) as u64 + 12
}

// ---- The estimator and Op
/// From the last taxels having left the unfolding to the line's search knowing that they are in its cells. The joint
/// estimator's knows with them, and a register starts it: it reads none before the last is there.
pub const TAXELS_TO_CELLS: u64 = 2;
/// From the last taxels of the field having left the unfolding to the field being there for the output.
pub const TAXELS_TO_FIELD: u64 = 2;
/// From the end of the search to the friction being known to the lanes.
pub const SEARCH_TO_FRICTION: u64 = 9;
/// From the answer's taking to the end of the summary.
pub const SUMMARY_LATENCY: u64 = 37 + cordic::LATENCY as u64 + ratio::latency(33);
/// From the start of the output to the first beat leaving Op.
pub const OUTPUT_LATENCY: u64 = 13;
/// From a beat leaving Op to its leaving the core.
pub const OUTPUT_SKID: u64 = axis_skid::LATENCY as u64;
/// From the last beat of a frame being read to its buffers being free.
pub const OUTPUT_TO_RELEASE: u64 = 3;
/// From the last beat of a frame being read to the start of the next frame's output.
pub const OUTPUT_TO_IDLE: u64 = 4;

// ---- The estimator
/// From a start to the result of `sptfra_standard_error`, which begins with the search.
pub const STANDARD_ERROR: u64 = 56;
