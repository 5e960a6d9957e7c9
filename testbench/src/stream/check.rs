//! The rules of AXI4-Stream that the core's output must keep, watched cycle by cycle.

use thiserror::Error;

use crate::dut::{Beat, Outputs};

/// A rule that the core broke.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum Violation {
    /// TVALID was withdrawn.
    #[error("cycle {cycle}: m_axis_tvalid fell before the beat {data:#010x} was taken")]
    ValidDropped {
        /// When.
        cycle: u64,
        /// The beat that was lost.
        data: u128,
    },
    /// Bytes are left out where they must not.
    #[error(
        "cycle {cycle}: m_axis_tkeep is {:#x} in {}: whole words from the lowest on, all of them but in a frame's last \
         beat, and zeros behind", .beat.keep, show(*.beat)
    )]
    Keep {
        /// When.
        cycle: u64,
        /// The beat.
        beat: Beat,
    },
    /// The payload of a waiting beat changed.
    #[error(
        "cycle {cycle}: the waiting output beat changed from {} to {}",
        show(*.before),
        show(*.after)
    )]
    PayloadChanged {
        /// When.
        cycle: u64,
        /// The beat on offer in the cycle before.
        before: Beat,
        /// The beat on offer now.
        after: Beat,
    },
    /// TVALID during reset.
    #[error("cycle {cycle}: m_axis_tvalid is high in reset")]
    ValidInReset {
        /// When.
        cycle: u64,
    },
    /// A core that drops frames held its source.
    #[error("cycle {cycle}: s_axis_tready is low, though the source cannot be held")]
    Held {
        /// When.
        cycle: u64,
    },
    /// An answer went on beyond its length.
    #[error(
        "cycle {cycle}: the answer to frame {frame} has {excess} words too many: no m_axis_tlast after {longest} words"
    )]
    NoEnd {
        /// When the word too many was taken.
        cycle: u64,
        /// Position of its packet in the traffic.
        frame: usize,
        /// Words beyond the longest answer so far.
        excess: usize,
        /// Words of the longest answer.
        longest: usize,
    },
    /// A frame came out that no frame in accounts for.
    #[error("cycle {cycle}: the core sends a frame that nothing was sent in for")]
    UnexpectedFrame {
        /// When its first beat was offered.
        cycle: u64,
    },
}

fn show(beat: Beat) -> String {
    format!("{:#010x}{}", beat.data, if beat.last { " (last)" } else { "" })
}

/// Rising edges in reset after which TVALID must be low: the streams are reset by `aresetn` itself.
const RESET_EDGES: u64 = 1;

/// Remembers the beat on offer.
#[derive(Clone, Debug, Default)]
pub struct Checker {
    waiting: Option<Beat>,
    cycles_in_reset: u64,
}

impl Checker {
    /// Looks at one cycle.
    ///
    /// A synchronous reset shows at the output after a rising edge; the cycle before is not judged.
    ///
    /// # Errors
    /// The [`Violation`] of this cycle.
    pub fn watch(&mut self, cycle: u64, run: bool, ready: bool, outputs: &Outputs) -> Result<(), Violation> {
        let beat = outputs.sink;
        if !run {
            self.waiting = None;
            self.cycles_in_reset += 1;
            let settled = self.cycles_in_reset > RESET_EDGES;
            return if settled && beat.valid { Err(Violation::ValidInReset { cycle }) } else { Ok(()) };
        }
        self.cycles_in_reset = 0;
        if let Some(before) = self.waiting {
            if !beat.valid {
                return Err(Violation::ValidDropped { cycle, data: before.data });
            }
            if beat != before {
                return Err(Violation::PayloadChanged { cycle, before, after: beat });
            }
        }
        self.waiting = (beat.valid && !ready).then_some(beat);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer(valid: bool, data: u128, last: bool) -> Outputs {
        Outputs { ready: true, sink: Beat { valid, data, last, keep: 0xF } }
    }

    fn watch(cycles: &[(bool, bool, Outputs)]) -> Result<(), Violation> {
        let mut checker = Checker::default();
        (0..).zip(cycles).try_for_each(|(cycle, (run, ready, outputs))| checker.watch(cycle, *run, *ready, outputs))
    }

    #[test]
    fn a_beat_that_waits_unchanged_is_fine() {
        let beat = offer(true, 5, true);
        let idle = offer(false, 0, false);
        assert_eq!(watch(&[(true, false, beat), (true, true, beat), (true, false, idle)]), Ok(()));
    }

    #[test]
    fn a_withdrawn_beat_is_caught() {
        let cycles = [(true, false, offer(true, 5, false)), (true, true, offer(false, 5, false))];
        assert_eq!(watch(&cycles), Err(Violation::ValidDropped { cycle: 1, data: 5 }));
    }

    #[test]
    fn changed_data_and_changed_last_are_caught() {
        for after in [offer(true, 6, false), offer(true, 5, true)] {
            let cycles = [(true, false, offer(true, 5, false)), (true, false, after)];
            assert!(matches!(watch(&cycles), Err(Violation::PayloadChanged { cycle: 1, .. })));
        }
    }

    #[test]
    fn valid_in_reset_is_caught_after_an_edge() {
        let beat = offer(true, 5, false);
        assert_eq!(watch(&[(false, false, beat)]), Ok(()));
        assert_eq!(watch(&[(false, false, beat); 2]), Err(Violation::ValidInReset { cycle: 1 }));
    }
}
