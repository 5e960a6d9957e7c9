//! The AXI-Stream skid buffer: cuts every combinational path of a stream, both ways, at full throughput.

/// Cycles from a word taken to the same word offered, when the way ahead is free.
pub const LATENCY: u32 = 1;

/// Words it holds at most. It takes a word only while it holds less than this, and offers the words in their order.
pub const CAPACITY: usize = 2;
