//! What a design's blocks take, as far as it does not depend on the frames under way.

/// Durations in cycles, and how many frames have a buffer.
#[derive(Clone, Debug, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each is a question that the cycle model asks")]
pub struct Durations {
    /// Whether frames that find no room are dropped.
    pub drops: bool,
    /// Beats of an answer.
    pub beats: u64,
    /// From a frame's first beat out of the skid buffer to the first that enters Bz: where it waits for room, or is
    /// unpacked.
    pub unpacking: u64,
    /// What a frame brings, counted from there.
    pub arrival: Arrival,
    /// From the taking of a result to its taxels having left the unfolding.
    pub take_to_taxels: u64,
    /// From taking the last sum, or the last g, to the sums being complete.
    pub take_to_sums: u64,
    /// Whether the answer has a field.
    pub field: bool,
    /// Whether the lanes put the field together, once the friction is known; else it is there with the sums.
    pub composed: bool,
    /// Frames that have a buffer from their start until they have left, if any is needed.
    pub buffers: Option<u64>,
    /// Whether a frame may start while the residual of the one before waits.
    pub interval: bool,
    /// Frames whose residual has a buffer.
    pub residuals: usize,
    /// Of the stage before the search, if there is one: without it the search waits for all that it needs at once.
    pub line: Option<u64>,
    /// From the last stress to what `CeAn` knows of the frame.
    pub direction: u64,
    /// Of the search; behind the first one a frame's `u_q` has no buffer any more.
    pub stages: Vec<Stage>,
    /// Of the lanes.
    pub programs: Vec<Program>,
    /// Write-back slot of the last of the sums, in the first program.
    pub last_sum: u64,
}

/// When what a frame brings is there, in cycles after its first beat enters Bz, streams never waiting.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Arrival {
    /// Its last beat has entered Bz.
    pub taken: u64,
    /// Each element may be read, to be written to the lanes; while these write results it waits.
    pub elements: Vec<u64>,
    /// From the last element's reading to its write, in cycles in which the lanes write nothing.
    pub read_to_write: u64,
    /// `CeAn` has its last stress.
    pub last_stress: u64,
}

/// A stage of the search: it has a frame of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// From start to end, in cycles.
    pub cycles: u64,
    /// Cycles for which the next stage still needs it, from when it has taken the frame. One cycle later it may begin anew.
    pub shows: u64,
}

/// A program of the lanes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Cycles without issue between the last issue of whatever program runs before and its first, at least.
    pub gap: u64,
    /// Cycles from the first issue to the last, inclusive.
    pub length: u64,
    /// Cycle of its last write-back slot.
    pub last_slot: u64,
    /// When its results are written to the operand memories, and the stress that comes in stands still, counted from its
    /// first issue.
    pub writes: Vec<u64>,
}
