//! Cores that break the rules are caught, and the message says where.

use crate::stub::{load, packets};
use testbench::stream::{Pattern, StreamError, Traffic, Violation, exchange};

const TIMEOUT: u64 = 300;

fn run(fault: u32, sink: Pattern) -> Result<usize, StreamError> {
    let packets = packets(6);
    let traffic = Traffic { sink, ..Traffic::new(&packets, TIMEOUT) };
    exchange(&mut load(fault), &traffic, |_| ()).map(|outcome| outcome.exchanges.len())
}

const STALLS: Pattern = Pattern::Random { seed: 5, willing: 0.4 };

#[test]
fn withdrawn_valid() {
    assert_eq!(run(1, Pattern::Free).expect("no stall, no fault"), 6);
    let error = run(1, STALLS).expect_err("must be caught");
    assert!(matches!(error, StreamError::Violation(Violation::ValidDropped { .. })), "{error}");
    assert!(error.to_string().contains("m_axis_tvalid fell"), "{error}");
}

#[test]
fn changed_payload() {
    assert_eq!(run(2, Pattern::Free).expect("no stall, no fault"), 6);
    let error = run(2, STALLS).expect_err("must be caught");
    assert!(matches!(error, StreamError::Violation(Violation::PayloadChanged { .. })), "{error}");
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
    assert!(matches!(error, StreamError::Violation(Violation::UnexpectedFrame { .. })), "{error}");
}

#[test]
fn an_answer_without_an_end() {
    let packets = packets(6);
    let traffic = Traffic { longest_answer: 4, ..Traffic::new(&packets, TIMEOUT) };
    let error = exchange(&mut load(5), &traffic, |_| ()).expect_err("must be caught");
    assert!(matches!(error, StreamError::Violation(Violation::NoEnd { frame: 0, excess: 1, .. })), "{error}");
    assert!(error.to_string().contains("no m_axis_tlast after 4 words"), "{error}");
    // Without a plan the longest answer of any design bounds it.
    let error = exchange(&mut load(5), &Traffic::new(&packets, TIMEOUT), |_| ()).expect_err("must be caught");
    assert!(matches!(error, StreamError::Violation(Violation::NoEnd { longest: 12_304, .. })), "{error}");
}
