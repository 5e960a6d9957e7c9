//! Sends packets into a core, collects what comes out, and notes when.

mod check;
mod driver;
mod pattern;

use std::ops::Range;

use golden::design::MAX_SIDE;
use hdl_gen::plan::words::SUMMARY_WORDS;
use hdl_gen::timing;
use thiserror::Error;

pub use check::{Checker, Violation};
pub use driver::exchange;
pub use pattern::{Gate, Mode, Pattern};

use crate::dut::DutError;

/// Words of the longest answer that any design has: the summary, then three forces for each of 64 x 64 taxels.
const LONGEST_ANSWER: usize = SUMMARY_WORDS + 3 * MAX_SIDE * MAX_SIDE;

/// Reset before the first packet, in cycles.
pub const INITIAL_RESET: u64 = 8;

/// When the next packet is offered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pacing {
    /// As soon as the core takes it: packets overlap, the distance of their ends is the interval.
    #[default]
    BackToBack,
    /// When the output of the one before is complete: each packet's latency is its own.
    OneAtATime,
    /// So many cycles after the one before began, at the earliest, and while fewer than so many are inside: what a core
    /// that drops frames has room for.
    Spaced {
        /// Cycles from one packet's first offer to the next one's.
        cycles: u64,
        /// Packets sent and not answered.
        inside: usize,
    },
}

/// A reset in the middle of the traffic. The packet being sent is given up and not sent again; those inside the core
/// are lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reset {
    /// First cycle with `aresetn` low, counted from the end of the initial reset.
    pub cycle: u64,
    /// Number of cycles it stays low.
    pub length: u64,
}

/// What to do to a core.
#[derive(Clone, Debug)]
#[must_use]
pub struct Traffic<'a> {
    /// Packets in, TLAST on the last word of each; empty ones are skipped.
    pub packets: &'a [Vec<u32>],
    /// Pauses of the source.
    pub source: Pattern,
    /// Pauses of the sink.
    pub sink: Pattern,
    /// When packets follow each other.
    pub pacing: Pacing,
    /// In order of their cycles.
    pub resets: &'a [Reset],
    /// Whether packets may be dropped: which of them an answer belongs to is told by its timestamp, and the traffic is
    /// over when the timeout is.
    pub drops: bool,
    /// Give up after so many cycles without a handshake on either stream.
    pub timeout: u64,
    /// Most 32-bit words of an answer: a core whose answer has no end must not run for ever.
    pub longest_answer: usize,
}

impl<'a> Traffic<'a> {
    /// Both ends free-running, packets back to back, no reset.
    pub fn new(packets: &'a [Vec<u32>], timeout: u64) -> Self {
        Self {
            packets,
            source: Pattern::Free,
            sink: Pattern::Free,
            pacing: Pacing::BackToBack,
            resets: &[],
            drops: false,
            timeout,
            longest_answer: LONGEST_ANSWER,
        }
    }

    /// With the pauses of a mode.
    pub fn with_mode(self, mode: &Mode) -> Self {
        Self { source: mode.source, sink: mode.sink, ..self }
    }

    /// With another pacing.
    pub fn with_pacing(self, pacing: Pacing) -> Self {
        Self { pacing, ..self }
    }

    /// To a core that drops what it has no room for.
    pub fn with_drops(self) -> Self {
        Self { drops: true, ..self }
    }

    /// With resets.
    pub fn with_resets(self, resets: &'a [Reset]) -> Self {
        Self { resets, ..self }
    }
}

/// One packet in and the one it became.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exchange {
    /// Position in [`Traffic::packets`].
    pub packet: usize,
    /// Cycle in which the first input beat was taken.
    pub first_in: u64,
    /// Cycle in which the last output beat was taken.
    pub last_out: u64,
    /// The output packet. Of its timestamp only the difference to the cycle in which the first input beat was taken is
    /// left, counted from the reset: 0, as the integer model has it, if the timestamp is right.
    pub words: Vec<u32>,
}

impl Exchange {
    /// Cycles from the first input beat to the last output beat, both counted.
    pub fn latency(&self) -> u64 {
        self.last_out - self.first_in + 1
    }
}

/// What came of the traffic.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Completed exchanges, in order. Packets lost to a reset have none.
    pub exchanges: Vec<Exchange>,
    /// Packets that were dropped, and the cycles in which their first beats were taken. Of a core that drops frames only.
    pub dropped: Vec<(usize, u64)>,
    /// By reset that took place: the first packet that was sent after it.
    pub resumed: Vec<usize>,
    /// Cycles simulated.
    pub cycles: u64,
}

impl Outcome {
    /// What was sent of so many packets before the first reset, between two, and after the last one, and its exchanges.
    pub fn between_resets(&self, packets: usize) -> impl Iterator<Item = (Range<usize>, &[Exchange])> {
        let mut exchanges = self.exchanges.as_slice();
        let mut begin = 0;
        self.resumed.iter().copied().chain([packets]).map(move |end| {
            let count = exchanges.iter().position(|exchange| exchange.packet >= end).unwrap_or(exchanges.len());
            let (own, later) = exchanges.split_at(count);
            exchanges = later;
            (std::mem::replace(&mut begin, end)..end, own)
        })
    }

    /// Longest latency of the completed exchanges; the latency of the core if they were sent one at a time.
    pub fn latency(&self) -> Option<u64> {
        self.exchanges.iter().map(Exchange::latency).max()
    }

    /// Mean distance between the ends of the packets while the core is full, rounded up: its interval, if there were enough
    /// packets and they were sent back to back ([`timing::mean_interval`]).
    pub fn interval(&self) -> Option<u64> {
        let ends: Vec<u64> = self.exchanges.iter().map(|exchange| exchange.last_out).collect();
        (ends.len() > 1).then(|| timing::mean_interval(&ends))
    }
}

/// Why the traffic stopped.
#[derive(Debug, Error)]
pub enum StreamError {
    /// The core broke a rule of AXI4-Stream.
    #[error("AXI4-Stream rule broken in {0}")]
    Violation(#[from] Violation),
    /// Nothing moved for too long.
    #[error("no handshake for {waited} cycles (now cycle {cycle}): {received} of {expected} frames came out, {inside}")]
    Timeout {
        /// How long nothing moved.
        waited: u64,
        /// When the driver gave up.
        cycle: u64,
        /// Complete output packets so far.
        received: usize,
        /// Packets to send in all.
        expected: usize,
        /// Where things stand: what the source and the sink wait for.
        inside: String,
    },
    /// The simulation stopped.
    #[error(transparent)]
    Dut(#[from] DutError),
}
