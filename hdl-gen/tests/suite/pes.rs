//! Executes a schedule literally, cycle by cycle, with the registers that the PEs have.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use golden::parity::COMPONENTS;
use hdl_gen::plan::matrix::{Entry, QuantisedMatrix, product as product_of};
use hdl_gen::plan::product::{Epilogue, Product, Vector, mirror, take_to_operand};
use hdl_gen::plan::schedule::{PeProgram, Program, RESULT_BUFFERS, Schedule, SegmentKind, WriteBackSlot};
use hdl_gen::timing::latency::ISSUE_TO_RESULT;

/// The sums of one row, a channel each.
pub type Sums = [i64; COMPONENTS];

/// What a PE holds for the collector.
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
struct Pe {
    next_word: usize,
    marked_word: usize,
    segment: usize,
    /// Words and segments that some program has read.
    read: (BTreeSet<usize>, BTreeSet<usize>),
    results: VecDeque<Held>,
    /// Every tail of the program so far.
    carries: Vec<Carry>,
    /// Heads whose sum waits for the next PE's carry, with the cycle of their last issue.
    heads: Vec<(u64, Sums)>,
}

/// The row sums that the collector takes, by `(product, row)`, before rounding. Rows of a preload come after the others.
pub type RowSums = BTreeMap<(u32, u32), Sums>;

/// What the PEs read of their operand memories: `element` of vector `part` of the product's, by channel.
pub type Operands<'a> = dyn Fn(&Product, usize, usize) -> Sums + 'a;

/// Runs the PEs' programs and the collector on vectors of `elements`. Of the matrices, which stand in the programs, only
/// what PEs drop of a product is looked at.
///
/// Panics where the hardware would go wrong: an operand is read before it is written, or a word never. A result buffer
/// overflows, a result is taken too early, or two are taken in one cycle.
pub fn execute(
    schedule: &Schedule,
    products: &[Product],
    matrices: &[QuantisedMatrix],
    elements: usize,
    operands: &Operands,
) -> RowSums {
    let mut pes: Vec<Pe> = schedule.pes.iter().map(|_| Pe::default()).collect();
    let mut sums = RowSums::new();
    let ends = schedule.programs.iter().skip(1).map(|next| next.slot).chain([schedule.slots.len()]);
    for (program, end) in schedule.programs.iter().zip(ends) {
        let slots = &schedule.slots[program.slot..end];
        let run = Run { schedule, products, matrices, program, elements, operands };
        run.issue(&mut pes, slots);
        complete_heads(&mut pes);
        collect(products, slots, &mut pes, &mut sums);
    }
    let begin = schedule.programs.last().expect("a program");
    for (pe, data) in pes.iter().zip(&schedule.pes) {
        // What nobody reads fills up a PE that has less of a program than another, and is nothing.
        let fills = |address: usize, end: usize, read: &BTreeSet<usize>| address < end || read.contains(&address);
        let (words, segments) = &pe.read;
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
    /// Every issue of the program, in every PE.
    fn issue(&self, pes: &mut [Pe], slots: &[WriteBackSlot]) {
        let mut written: BTreeMap<(Vector, usize), u64> = BTreeMap::new();
        for slot in slots {
            let product = &self.products[slot.product as usize];
            let there = slot.cycle + take_to_operand(product.epilogue);
            if (slot.row as usize) < self.elements {
                written.insert((product.result, slot.row as usize), there);
                if product.epilogue == Epilogue::Part {
                    written.insert((Vector::Pull, slot.row as usize), there);
                }
            }
        }
        for pe in &mut *pes {
            (pe.next_word, pe.segment) = (self.program.word, self.program.segment);
            pe.carries.clear();
        }
        let range = self.program.first..self.program.end;
        for index in range.clone() {
            let matrix = self.products[index].matrix;
            // The hardware has one mark: a matrix that is read again is read again without another in between.
            let again = self.products[range.start..index].iter().any(|before| before.matrix == matrix);
            let later = self.products[index + 1..range.end].iter().any(|after| after.matrix == matrix);
            for (pe, data) in pes.iter_mut().zip(&self.schedule.pes) {
                if again {
                    pe.next_word = pe.marked_word;
                } else if later {
                    pe.marked_word = pe.next_word;
                }
                self.product(index, pe, data, &written);
            }
        }
    }

    fn product(&self, index: usize, pe: &mut Pe, data: &PeProgram, written: &BTreeMap<(Vector, usize), u64>) {
        let (product, window) = (&self.products[index], self.schedule.windows[index]);
        let dropped = self.matrices[product.matrix].dropped;
        let mut cycle = window.start;
        while cycle < window.start + window.length {
            let segment = data.segments[pe.segment];
            pe.read.1.insert(pe.segment);
            pe.segment += 1;
            let mut sums = Sums::default();
            for _ in 0..segment.macs {
                if segment.kind != SegmentKind::Idle {
                    let (column, channels) = data.words[pe.next_word];
                    pe.read.0.insert(pe.next_word);
                    pe.next_word += 1;
                    let (part, element) = (column as usize / self.elements, column as usize % self.elements);
                    let place = product.mirrored.map_or(element, |side| mirror(element, side));
                    if let Some(&there) = written.get(&(product.operands[part], place)) {
                        assert!(cycle >= there, "product {index} reads {place} of {part} at {cycle}, there at {there}");
                    }
                    let operand = (self.operands)(product, part, element);
                    for (sum, (channel, value)) in sums.iter_mut().zip(channels.into_iter().zip(operand)) {
                        *sum += product_of(channel, value, dropped);
                    }
                }
                cycle += 1;
            }
            let issued = cycle - 1;
            match segment.kind {
                SegmentKind::Row => pe.results.push_back(Held { from: issued + ISSUE_TO_RESULT, sums }),
                SegmentKind::Head => {
                    pe.heads.push((issued, sums));
                    pe.results.push_back(Held { from: issued + ISSUE_TO_RESULT, sums: [i64::MIN; COMPONENTS] });
                }
                SegmentKind::Tail => pe.carries.push(Carry { issued, sums }),
                SegmentKind::Idle => {}
            }
        }
        assert_eq!(cycle, window.start + window.length, "segments end with the product");
    }
}

/// A head finds, one cycle before its sum stands in the register, the latest tail of the next PE.
fn complete_heads(pes: &mut [Pe]) {
    let count = pes.len();
    for pe in 0..count {
        for (issued, head) in std::mem::take(&mut pes[pe].heads) {
            let carries = &pes[(pe + 1) % count].carries;
            // The carry register changes as late after a tail's last issue as the result buffer after a head's.
            let tail = carries.iter().rfind(|carry| carry.issued < issued).expect("a tail before the head's end");
            let sums = std::array::from_fn(|channel| head[channel] + tail.sums[channel]);
            let waiting = |held: &&mut Held| held.from == issued + ISSUE_TO_RESULT;
            pes[pe].results.iter_mut().find(waiting).expect("the head's own place").sums = sums;
        }
    }
}

/// Takes the results of a program in the order of its slots.
fn collect(products: &[Product], slots: &[WriteBackSlot], pes: &mut [Pe], sums: &mut RowSums) {
    let mut taken: Vec<Vec<(u64, u64)>> = pes.iter().map(|_| Vec::new()).collect();
    let mut free = 0;
    for slot in slots {
        let held = pes[slot.pe as usize].results.pop_front().expect("a result for every slot");
        // As soon as it is there and the collector is free, which is what the hardware does. After a result that is
        // separated the collector waits a cycle.
        assert_eq!(slot.cycle, held.from.max(free), "product {} row {}", slot.product, slot.row);
        let separated = products[slot.product as usize].epilogue == Epilogue::Part;
        free = slot.cycle + if separated { 2 } else { 1 };
        taken[slot.pe as usize].push((held.from, slot.cycle));
        assert!(sums.insert((slot.product, slot.row), held.sums).is_none(), "one result a row");
    }
    assert!(pes.iter().all(|pe| pe.results.is_empty()), "every result is taken");
    for times in taken {
        for (newer, &(from, _)) in times.iter().enumerate() {
            let held = times[..=newer].iter().filter(|&&(_, until)| until >= from).count();
            assert!(held <= RESULT_BUFFERS, "{held} results in a PE at cycle {from}");
        }
    }
}
