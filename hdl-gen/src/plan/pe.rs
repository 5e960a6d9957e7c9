//! What a PE works through, and the results that it leaves.

use super::matrix::Entry;

/// Results that a PE holds until the collector comes.
pub const RESULT_BUFFERS: usize = 2;
/// A count in the MACs-per-row ROM has 14 bits.
pub const MAX_SEGMENT: u32 = (1 << MACS_BITS) - 1;
/// Bits of that number in a row word; its kind stands above them.
pub const MACS_BITS: u32 = 14;

/// What a PE does with the sum of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentKind {
    /// A whole row: its sum is a result.
    Row = 0,
    /// The end of a row that the PE before began: its sum goes to the carry register.
    Tail = 1,
    /// The beginning of a row that the next PE ends: its sum plus that PE's carry is a result.
    Head = 2,
    /// No MAC at all: waiting.
    Idle = 3,
}

/// A run of consecutive MACs of one row in one PE.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// What happens to the sum.
    pub kind: SegmentKind,
    /// MACs (or idle cycles), 1 to [`MAX_SEGMENT`].
    pub macs: u32,
}

/// The MCSR data of one PE, in the order in which it is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PeProgram {
    /// `(column, coefficients)` pairs; a matrix that several products share stands here once.
    pub words: Vec<Entry>,
    /// MACs per row, product after product.
    pub segments: Vec<Segment>,
}

/// The collector takes a result from a PE.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WriteBackSlot {
    /// Cycle, counted from the first issue of the program.
    pub cycle: u64,
    /// The PE that holds the result.
    pub pe: u32,
    /// The product it belongs to.
    pub product: u32,
    /// The row of that product.
    pub row: u32,
}
