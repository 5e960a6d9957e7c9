//! Cores that break the rules are caught, and the message says where.

use crate::stub::{load, packets};
use testbench::stream::{Pattern, StreamError, Traffic, exchange};

const TIMEOUT: u64 = 300;

fn run(fault: u32, sink: Pattern) -> Result<usize, StreamError> {
    let packets = packets(6);
    let traffic = Traffic { sink, ..Traffic::new(&packets, TIMEOUT) };
    exchange(&mut load(fault), &traffic, |_| ()).map(|outcome| outcome.exchanges.len())
}

/// The rule of AXI4-Stream that was broken.
fn violation(error: &StreamError) -> &str {
    let StreamError::Violation(violation) = error else { panic!("{error}") };
    &violation.rule
}

const STALLS: Pattern = Pattern::Random { seed: 5, willing: 0.4 };

#[test]
fn withdrawn_valid() {
    assert_eq!(run(1, Pattern::Free).expect("no stall, no fault"), 6);
    let error = run(1, STALLS).expect_err("must be caught");
    assert!(violation(&error).starts_with("m_axis_tvalid fell before the beat"), "{error}");
}

#[test]
fn changed_payload() {
    assert_eq!(run(2, Pattern::Free).expect("no stall, no fault"), 6);
    let error = run(2, STALLS).expect_err("must be caught");
    assert!(violation(&error).starts_with("the waiting output beat changed from"), "{error}");
}

#[test]
fn no_answer() {
    let error = run(3, Pattern::Free).expect_err("must be caught");
    assert!(matches!(error, StreamError::Timeout { waited: TIMEOUT, received: 0, expected: 6, .. }), "{error}");
    assert!(error.to_string().contains("m_axis_tvalid stays low with 6 frames inside"), "{error}");
}

#[test]
fn two_answers() {
    let error = run(4, Pattern::Free).expect_err("must be caught");
    assert_eq!(violation(&error), "the core sends a frame that nothing was sent in for");
}

#[test]
fn an_answer_without_an_end() {
    let packets = packets(6);
    let traffic = Traffic { longest_answer: 4, ..Traffic::new(&packets, TIMEOUT) };
    let error = exchange(&mut load(5), &traffic, |_| ()).expect_err("must be caught");
    let no_end = |words| format!("the answer to frame 0 has 1 words too many: no m_axis_tlast after {words} words");
    assert_eq!(violation(&error), no_end(4));
    // Without a plan the longest answer of any design bounds it.
    let error = exchange(&mut load(5), &Traffic::new(&packets, TIMEOUT), |_| ()).expect_err("must be caught");
    assert_eq!(violation(&error), no_end(12_304));
}
