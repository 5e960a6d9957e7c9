//! Executes a schedule literally, cycle by cycle, with the registers that the lanes have.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use golden::parity::CLASSES;
use hdl_gen::plan::matrix::{Entry, QuantisedMatrix, product as product_of};
use hdl_gen::plan::product::{Epilogue, Product, Vector, mirror, visit_to_operand};
use hdl_gen::plan::schedule::{LaneProgram, Program, RESULT_PLACES, Schedule, SegmentKind, Visit};
use hdl_gen::timing::latency::ISSUE_TO_RESULT;

/// The sums of one row, a way each.
pub type Sums = [i64; CLASSES];

/// What a lane holds for the collector.
struct Held {
    /// First cycle in which it stands in the register.
    from: u64,
    sums: Sums,
}

/// A tail's sum in the carry register.
struct Carry {
    /// Issue of its last MAC.
    issued: u64,
    sums: Sums,
}

#[derive(Default)]
struct Lane {
    next_word: usize,
    marked_word: usize,
    segment: usize,
    /// Words and segments that some program has read.
    read: (BTreeSet<usize>, BTreeSet<usize>),
    results: VecDeque<Held>,
    /// Every tail of the program so far.
    carries: Vec<Carry>,
    /// Heads whose sum waits for the next lane's carry, with the cycle of their last issue.
    heads: Vec<(u64, Sums)>,
}

/// The row sums that the collector takes, by `(product, row)`, before rounding. Rows of a lead come after the others.
pub type RowSums = BTreeMap<(u32, u32), Sums>;

/// What the lanes read of their operand memories: `element` of vector `part` of the product's, by way.
pub type Operands<'a> = dyn Fn(&Product, usize, usize) -> Sums + 'a;

/// Runs the lanes' programs and the collector on vectors of `elements`. Of the matrices, which stand in the programs, only
/// what lanes drop of a product is looked at.
///
/// Panics where the hardware would go wrong: an operand is read before it is written, a result register
/// overflows, a result is taken before it is there, two results are taken in one cycle, a word is never read.
pub fn execute(
    schedule: &Schedule,
    products: &[Product],
    matrices: &[QuantisedMatrix],
    elements: usize,
    operands: &Operands,
) -> RowSums {
    let mut lanes: Vec<Lane> = schedule.lanes.iter().map(|_| Lane::default()).collect();
    let mut sums = RowSums::new();
    let ends = schedule.programs.iter().skip(1).map(|next| next.visit).chain([schedule.visits.len()]);
    for (program, end) in schedule.programs.iter().zip(ends) {
        let visits = &schedule.visits[program.visit..end];
        let run = Run { schedule, products, matrices, program, elements, operands };
        run.issue(&mut lanes, visits);
        complete_heads(&mut lanes);
        collect(products, visits, &mut lanes, &mut sums);
    }
    let begin = schedule.programs.last().expect("a program");
    for (lane, data) in lanes.iter().zip(&schedule.lanes) {
        // What nobody reads fills up a lane that has less of a program than another, and is nothing.
        let fills = |address: usize, end: usize, read: &BTreeSet<usize>| address < end || read.contains(&address);
        let (words, segments) = &lane.read;
        for (address, &word) in data.words.iter().enumerate() {
            assert!(words.contains(&address) || word == Entry::default(), "word {address} is not read");
            assert!(fills(address, begin.word, words), "word {address} is not read");
        }
        for (address, segment) in data.segments.iter().enumerate() {
            assert!(segments.contains(&address) || segment.kind == SegmentKind::Idle, "segment {address} is not read");
            assert!(fills(address, begin.segment, segments), "segment {address} is not read");
        }
    }
    sums
}

/// One program under way.
struct Run<'a> {
    schedule: &'a Schedule,
    products: &'a [Product],
    matrices: &'a [QuantisedMatrix],
    program: &'a Program,
    elements: usize,
    operands: &'a Operands<'a>,
}

impl Run<'_> {
    /// Every issue of the program, in every lane.
    fn issue(&self, lanes: &mut [Lane], visits: &[Visit]) {
        let mut written: BTreeMap<(Vector, usize), u64> = BTreeMap::new();
        for visit in visits {
            let product = &self.products[visit.product as usize];
            let there = visit.cycle + visit_to_operand(product.epilogue);
            if (visit.row as usize) < self.elements {
                written.insert((product.result, visit.row as usize), there);
                if product.epilogue == Epilogue::Part {
                    written.insert((Vector::Pull, visit.row as usize), there);
                }
            }
        }
        for lane in &mut *lanes {
            (lane.next_word, lane.segment) = (self.program.word, self.program.segment);
            lane.carries.clear();
        }
        let range = self.program.first..self.program.end;
        for index in range.clone() {
            let matrix = self.products[index].matrix;
            // The hardware has one mark: a matrix that is read again is read again without another in between.
            let again = self.products[range.start..index].iter().any(|before| before.matrix == matrix);
            let later = self.products[index + 1..range.end].iter().any(|after| after.matrix == matrix);
            for (lane, data) in lanes.iter_mut().zip(&self.schedule.lanes) {
                if again {
                    lane.next_word = lane.marked_word;
                } else if later {
                    lane.marked_word = lane.next_word;
                }
                self.product(index, lane, data, &written);
            }
        }
    }

    fn product(&self, index: usize, lane: &mut Lane, data: &LaneProgram, written: &BTreeMap<(Vector, usize), u64>) {
        let (product, window) = (&self.products[index], self.schedule.windows[index]);
        let dropped = self.matrices[product.matrix].dropped;
        let mut cycle = window.start;
        while cycle < window.start + window.length {
            let segment = data.segments[lane.segment];
            lane.read.1.insert(lane.segment);
            lane.segment += 1;
            let mut sums = Sums::default();
            for _ in 0..segment.macs {
                if segment.kind != SegmentKind::Idle {
                    let (column, ways) = data.words[lane.next_word];
                    lane.read.0.insert(lane.next_word);
                    lane.next_word += 1;
                    let (part, element) = (column as usize / self.elements, column as usize % self.elements);
                    let place = product.mirrored.map_or(element, |side| mirror(element, side));
                    if let Some(&there) = written.get(&(product.operands[part], place)) {
                        assert!(cycle >= there, "product {index} reads {place} of {part} at {cycle}, there at {there}");
                    }
                    let operand = (self.operands)(product, part, element);
                    for (sum, (way, value)) in sums.iter_mut().zip(ways.into_iter().zip(operand)) {
                        *sum += product_of(way, value, dropped);
                    }
                }
                cycle += 1;
            }
            let issued = cycle - 1;
            match segment.kind {
                SegmentKind::Row => lane.results.push_back(Held { from: issued + ISSUE_TO_RESULT, sums }),
                SegmentKind::Head => {
                    lane.heads.push((issued, sums));
                    lane.results.push_back(Held { from: issued + ISSUE_TO_RESULT, sums: [i64::MIN; CLASSES] });
                }
                SegmentKind::Tail => lane.carries.push(Carry { issued, sums }),
                SegmentKind::Idle => {}
            }
        }
        assert_eq!(cycle, window.start + window.length, "segments end with the product");
    }
}

/// A head finds, one cycle before its sum stands in the register, the latest tail of the next lane.
fn complete_heads(lanes: &mut [Lane]) {
    let count = lanes.len();
    for lane in 0..count {
        for (issued, head) in std::mem::take(&mut lanes[lane].heads) {
            let carries = &lanes[(lane + 1) % count].carries;
            // The carry register changes as late after a tail's last issue as the result register after a head's.
            let tail = carries.iter().rfind(|carry| carry.issued < issued).expect("a tail before the head's end");
            let sums = std::array::from_fn(|way| head[way] + tail.sums[way]);
            let waiting = |held: &&mut Held| held.from == issued + ISSUE_TO_RESULT;
            lanes[lane].results.iter_mut().find(waiting).expect("the head's own place").sums = sums;
        }
    }
}

/// Takes the results of a program in the order of its visits.
fn collect(products: &[Product], visits: &[Visit], lanes: &mut [Lane], sums: &mut RowSums) {
    let mut taken: Vec<Vec<(u64, u64)>> = lanes.iter().map(|_| Vec::new()).collect();
    let mut free = 0;
    for visit in visits {
        let held = lanes[visit.lane as usize].results.pop_front().expect("a result for every visit");
        // As soon as it is there and the collector is free, which is what the hardware does. After a result that is
        // parted the collector waits a cycle.
        assert_eq!(visit.cycle, held.from.max(free), "product {} row {}", visit.product, visit.row);
        let parted = products[visit.product as usize].epilogue == Epilogue::Part;
        free = visit.cycle + if parted { 2 } else { 1 };
        taken[visit.lane as usize].push((held.from, visit.cycle));
        assert!(sums.insert((visit.product, visit.row), held.sums).is_none(), "one result a row");
    }
    assert!(lanes.iter().all(|lane| lane.results.is_empty()), "every result is taken");
    for times in taken {
        for (newer, &(from, _)) in times.iter().enumerate() {
            let held = times[..=newer].iter().filter(|&&(_, until)| until >= from).count();
            assert!(held <= RESULT_PLACES, "{held} results in a lane at cycle {from}");
        }
    }
}
