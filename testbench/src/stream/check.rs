//! The rules of AXI4-Stream that the core's output must keep, watched cycle by cycle.

use thiserror::Error;

use crate::dut::{Beat, Outputs};

/// A rule that the core broke.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("cycle {cycle}: {rule}")]
pub struct Violation {
    /// When.
    pub cycle: u64,
    /// Which rule, and how.
    pub rule: String,
}

impl Violation {
    pub(super) fn new(cycle: u64, rule: impl Into<String>) -> Self {
        Self { cycle, rule: rule.into() }
    }
}

/// A beat for people.
pub(super) fn show(beat: Beat) -> String {
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
            let valid = settled && beat.valid;
            return if valid { Err(Violation::new(cycle, "m_axis_tvalid is high in reset")) } else { Ok(()) };
        }
        self.cycles_in_reset = 0;
        if let Some(before) = self.waiting {
            if !beat.valid {
                let rule = format!("m_axis_tvalid fell before the beat {:#010x} was taken", before.data);
                return Err(Violation::new(cycle, rule));
            }
            if beat != before {
                let rule = format!("the waiting output beat changed from {} to {}", show(before), show(beat));
                return Err(Violation::new(cycle, rule));
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
        let rule = "m_axis_tvalid fell before the beat 0x00000005 was taken";
        assert_eq!(watch(&cycles), Err(Violation::new(1, rule)));
    }

    #[test]
    fn changed_data_and_changed_last_are_caught() {
        for after in [offer(true, 6, false), offer(true, 5, true)] {
            let cycles = [(true, false, offer(true, 5, false)), (true, false, after)];
            let error = watch(&cycles).expect_err("must be caught").to_string();
            assert!(error.starts_with("cycle 1: the waiting output beat changed from 0x00000005 to "), "{error}");
        }
    }

    #[test]
    fn valid_in_reset_is_caught_after_an_edge() {
        let beat = offer(true, 5, false);
        assert_eq!(watch(&[(false, false, beat)]), Ok(()));
        assert_eq!(watch(&[(false, false, beat); 2]), Err(Violation::new(1, "m_axis_tvalid is high in reset")));
    }
}
