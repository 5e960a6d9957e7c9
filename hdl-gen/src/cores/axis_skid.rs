//! The AXI-Stream skid buffer: cuts every combinational path of a stream, both ways, at full throughput.

/// Cycles from a word taken to the same word offered, when the way ahead is free.
pub const LATENCY: u32 = 1;
