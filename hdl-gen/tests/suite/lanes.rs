//! Executes a schedule literally, cycle by cycle, with the registers that the lanes have.

use std::collections::{BTreeMap, VecDeque};

use hdl_gen::plan::product::{Block, Product, Vector};
use hdl_gen::plan::schedule::{ISSUE_TO_RESULT, RESULT_PLACES, Schedule, SegmentKind, VISIT_TO_OPERAND};

/// What a lane holds for the collector.
struct Held {
    /// First cycle in which it stands in the register.
    from: u64,
    sum: i64,
}

/// A tail's sum in the carry register.
struct Carry {
    /// Issue of its last MAC.
    issued: u64,
    sum: i64,
}

#[derive(Default)]
struct Lane {
    next_word: usize,
    marked_word: usize,
    segment: usize,
    results: VecDeque<Held>,
    /// Every tail so far.
    carries: Vec<Carry>,
    /// Heads whose sum waits for the next lane's carry, with the cycle of their last issue.
    heads: Vec<(u64, i64)>,
}

/// The row sums that the collector takes, by `(product, row)`, before rounding.
pub type RowSums = BTreeMap<(u32, u32), i64>;

/// Runs the lanes' programs and the collector. `operands` gives the vector that a product reads.
///
/// Panics where the hardware would go wrong: an operand is read before it is written, a result register
/// overflows, a result is taken before it is there, two results are taken in one cycle.
pub fn execute<'a>(schedule: &Schedule, products: &[Product], operands: impl Fn(Vector) -> &'a [i64]) -> RowSums {
    let mut written: BTreeMap<(Vector, u32), u64> = BTreeMap::new();
    for visit in &schedule.visits {
        written.insert((products[visit.product as usize].result, visit.row), visit.cycle);
    }
    let first_of_op = products.iter().position(|product| product.block == Block::Op);
    let mut lanes: Vec<Lane> = schedule.lanes.iter().map(|_| Lane::default()).collect();
    for (index, (product, window)) in products.iter().zip(&schedule.windows).enumerate() {
        let vector = operands(product.operand);
        for (lane, program) in lanes.iter_mut().zip(&schedule.lanes) {
            if Some(index) == first_of_op {
                lane.marked_word = lane.next_word;
            } else if first_of_op.is_some_and(|first| index > first) {
                lane.next_word = lane.marked_word;
            }
            let mut cycle = window.start;
            while cycle < window.start + window.length {
                let segment = program.segments[lane.segment];
                lane.segment += 1;
                let mut sum = 0;
                for _ in 0..segment.macs {
                    if segment.kind != SegmentKind::Idle {
                        let (column, coefficient) = program.words[lane.next_word];
                        lane.next_word += 1;
                        if product.operand != Vector::Stress {
                            let there = written[&(product.operand, column)] + VISIT_TO_OPERAND;
                            assert!(cycle >= there, "product {index} reads row {column} at {cycle}, there at {there}");
                        }
                        sum += i64::from(coefficient) * vector[column as usize];
                    }
                    cycle += 1;
                }
                let issued = cycle - 1;
                match segment.kind {
                    SegmentKind::Row => lane.results.push_back(Held { from: issued + ISSUE_TO_RESULT, sum }),
                    SegmentKind::Head => {
                        lane.heads.push((issued, sum));
                        lane.results.push_back(Held { from: issued + ISSUE_TO_RESULT, sum: i64::MIN });
                    }
                    SegmentKind::Tail => lane.carries.push(Carry { issued, sum }),
                    SegmentKind::Idle => {}
                }
            }
            assert_eq!(cycle, window.start + window.length, "segments end with the product");
        }
    }
    for (lane, program) in lanes.iter().zip(&schedule.lanes) {
        assert_eq!((lane.next_word, lane.segment), (program.words.len(), program.segments.len()), "all is used");
    }
    complete_heads(&mut lanes);
    collect(schedule, lanes)
}

/// A head finds, one cycle before its sum stands in the register, the latest tail of the next lane.
fn complete_heads(lanes: &mut [Lane]) {
    let count = lanes.len();
    for lane in 0..count {
        for (issued, head) in std::mem::take(&mut lanes[lane].heads) {
            let carries = &lanes[(lane + 1) % count].carries;
            // The carry register changes as late after a tail's last issue as the result register after a head's.
            let tail = carries.iter().rfind(|carry| carry.issued < issued).expect("a tail before the head's end");
            let sum = head + tail.sum;
            let waiting = |held: &&mut Held| held.from == issued + ISSUE_TO_RESULT;
            lanes[lane].results.iter_mut().find(waiting).expect("the head's own place").sum = sum;
        }
    }
}

/// Takes the results in the order of the visits.
fn collect(schedule: &Schedule, mut lanes: Vec<Lane>) -> RowSums {
    let mut sums = RowSums::new();
    let mut taken: Vec<Vec<(u64, u64)>> = lanes.iter().map(|_| Vec::new()).collect();
    let mut last = None;
    for visit in &schedule.visits {
        let held = lanes[visit.lane as usize].results.pop_front().expect("a result for every visit");
        // As soon as it is there and the collector is free, which is what the hardware does.
        let soonest = last.map_or(held.from, |last: u64| held.from.max(last + 1));
        assert_eq!(visit.cycle, soonest, "product {} row {}", visit.product, visit.row);
        last = Some(visit.cycle);
        taken[visit.lane as usize].push((held.from, visit.cycle));
        assert!(sums.insert((visit.product, visit.row), held.sum).is_none(), "one result a row");
    }
    assert!(lanes.iter().all(|lane| lane.results.is_empty()), "every result is taken");
    for times in taken {
        for (newer, &(from, _)) in times.iter().enumerate() {
            let held = times[..=newer].iter().filter(|&&(_, until)| until >= from).count();
            assert!(held <= RESULT_PLACES, "{held} results in a lane at cycle {from}");
        }
    }
    sums
}
