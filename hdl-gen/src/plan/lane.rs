//! What a lane works through, and the results that it leaves.

use serde::Serialize;

use super::matrix::Entry;

/// Results that a lane holds until the collector comes.
pub const RESULT_PLACES: usize = 2;
/// A count in the MACs-per-row ROM has 14 bits.
pub const MAX_SEGMENT: u32 = (1 << 14) - 1;

/// What a lane does with the sum of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SegmentKind {
    /// A whole row: its sum is a result.
    Row = 0,
    /// The end of a row that the lane before began: its sum goes to the carry register.
    Tail = 1,
    /// The beginning of a row that the next lane ends: its sum plus that lane's carry is a result.
    Head = 2,
    /// No MAC at all: waiting.
    Idle = 3,
}

/// A run of consecutive MACs of one row in one lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Segment {
    /// What happens to the sum.
    pub kind: SegmentKind,
    /// MACs (or idle cycles), 1 to [`MAX_SEGMENT`].
    pub macs: u32,
}

/// The MCSR data of one lane, in the order in which it is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LaneProgram {
    /// `(column, coefficients)` pairs; a matrix that several products share stands here once.
    pub words: Vec<Entry>,
    /// MACs per row, product after product.
    pub segments: Vec<Segment>,
}

/// The collector takes a result from a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Visit {
    /// Cycle, counted from the first issue of the program.
    pub cycle: u64,
    /// The lane that holds the result.
    pub lane: u32,
    /// The product it belongs to.
    pub product: u32,
    /// The row of that product.
    pub row: u32,
}
