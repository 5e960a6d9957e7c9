//! Who computes what, and when: the static schedule of the SpMV PEs.
//!
//! Nothing in the PEs' timing depends on data: a frame is laid out here, cycle by cycle, and the hardware needs
//! neither arbiter nor stall. The MACs of a product form one long stream, row after row,
//! that is cut into equal pieces, one per PE: all PEs finish together. A row cut in two leaves its end as a *tail*
//! in the next PE, kept in that PE's carry register, and its beginning as a *head* that adds the carry.
//! A collector takes one result a cycle, in the order in which they become ready. Where rows are so short that a
//! PE would finish another before there is room for it, idle cycles are inserted.
//!
//! Products that always follow each other at the same distance form a *program*. The paper's plan is one program a
//! frame, and so are resultants alone; a field that the PEs put together takes two more. The hardware starts a program
//! when its data and the PEs are there.

use super::matrix::QuantisedMatrix;
use super::partition::{Partitioner, Stream, Timing};
pub use super::pe::{MACS_BITS, MAX_SEGMENT, PeProgram, RESULT_BUFFERS, Segment, SegmentKind, WriteBackSlot};
use super::product::{Epilogue, Product, Vector, mirror, spacing, take_to_operand};
use crate::timing::latency::{PROGRAM_GAP, collector_jump};

/// When a product runs, in cycles from the first issue of its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First issue cycle.
    pub start: u64,
    /// Issue cycles.
    pub length: u64,
    /// Idle cycles before `start`, until every MAC finds its operand.
    pub wait: u64,
    /// MACs of all PEs in this window; with four channels a PE counts once.
    pub macs: u64,
}

/// Products that follow each other at fixed distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    /// Its first product.
    pub first: usize,
    /// The one after its last.
    pub end: usize,
    /// Address of its first word in the values and columns ROMs, the same in every PE.
    pub word: usize,
    /// Address of its first word in the MACs-per-row ROMs, the same in every PE.
    pub segment: usize,
    /// Address of its first write-back slot.
    pub slot: usize,
    /// Cycles from the first issue to the last, inclusive.
    pub length: u64,
    /// Cycle of its first write-back slot.
    pub first_slot: u64,
    /// Cycle of its last write-back slot.
    pub last_slot: u64,
    /// Cycles without issue between the last issue of whatever program runs before and its first, at least.
    pub gap: u64,
}

/// The PEs' work for one frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Schedule {
    /// Per PE.
    pub pes: Vec<PeProgram>,
    /// Per program.
    pub programs: Vec<Program>,
    /// Per product.
    pub windows: Vec<Window>,
    /// Every result in the order in which the collector takes them, program after program.
    pub slots: Vec<WriteBackSlot>,
    /// Whether the collector looks ahead to the next program while the last result of one waits.
    pub ahead: bool,
}

impl Schedule {
    /// Lays out `products` on `pes` PEs; the products of a program stand next to each other. The collector looks
    /// `ahead` to the next program, or not.
    pub fn new(products: &[Product], matrices: &[QuantisedMatrix], pes: usize, ahead: bool) -> Self {
        let mut partitioner = Partitioner::new(pes);
        let mut stored = vec![false; matrices.len()];
        let mut programs = Vec::new();
        let mut windows: Vec<Window> = Vec::with_capacity(products.len());
        let mut first = 0;
        for chunk in products.chunk_by(|one, other| one.program == other.program) {
            let (word, segment, slot) = partitioner.begin();
            let mut made: Vec<Made> = Vec::new();
            let mut next_start = 0;
            for (index, product) in (first as u32..).zip(chunk) {
                let main = &matrices[product.matrix];
                let preload = product.preload.as_ref().map(|preload| &matrices[preload.matrix]);
                let mut rows = Stream::rows_of(preload, main);
                product.relabel(&mut rows);
                let macs = rows.iter().map(|(_, entries)| entries.len() as u64).sum();
                let stream = Stream {
                    product: index,
                    matrix: product.matrix,
                    rows,
                    store: !std::mem::replace(&mut stored[product.matrix], true),
                    start: next_start.max(addend(product, &made)),
                    spacing: spacing(product.epilogue),
                };
                // It starts while the operand is still being made, if its MACs find what they need.
                let find = |operand: &Vector| made.iter().find(|made| made.result.holds(*operand));
                let sources: Vec<Option<&Made>> = product.operands.iter().map(find).collect();
                let size = main.rows.len();
                let readable = |column: u32| {
                    let (operand, element) = (column as usize / size, column as usize % size);
                    let element = product.mirrored.map_or(element, |side| mirror(element, side));
                    sources[operand].map_or(0, |made| made.readable[element])
                };
                let first_slot = partitioner.slots.len();
                let Timing { start, length, last_slot } = partitioner.partition(&stream, &readable);
                windows.push(Window { start, length, wait: start - next_start, macs });
                made.push(Made::new(product, size, &partitioner.slots[first_slot..], last_slot));
                next_start = start + length;
            }
            let cycles = |slot: Option<&WriteBackSlot>| slot.map_or(0, |slot| slot.cycle);
            programs.push(Program {
                first,
                end: first + chunk.len(),
                word,
                segment,
                slot,
                length: next_start,
                first_slot: cycles(partitioner.slots.get(slot)),
                last_slot: cycles(partitioner.slots.last()),
                gap: 0,
            });
            first += chunk.len();
        }
        let longest_drain = programs.iter().map(|program| program.last_slot - program.length).max().unwrap_or(0);
        for program in &mut programs {
            program.gap = gap(program, longest_drain, longest_drain + collector_jump(ahead));
        }
        Self { pes: partitioner.programs, programs, windows, slots: partitioner.slots, ahead }
    }

    /// Words in the values and columns ROMs: the longest PE's.
    pub fn word_depth(&self) -> usize {
        self.pes.iter().map(|pe| pe.words.len()).max().unwrap_or(0).max(1)
    }

    /// Words in the MACs-per-row ROMs: the longest PE's.
    pub fn segment_depth(&self) -> usize {
        self.pes.iter().map(|pe| pe.segments.len()).max().unwrap_or(0).max(1)
    }

    /// Cycles from a program's first issue to its last, all programs of a frame.
    pub fn issue_cycles(&self) -> u64 {
        self.programs.iter().map(|program| program.length).sum()
    }

    /// Share of the PE cycles between first and last issue that do a MAC, 0 to 1.
    pub fn busy_fraction(&self) -> f64 {
        let macs: u64 = self.windows.iter().map(|window| window.macs).sum();
        macs as f64 / (self.issue_cycles() * self.pes.len() as u64) as f64
    }
}

/// What a product of the program under way has made.
struct Made {
    result: Vector,
    /// Cycle in which the last result is taken.
    last_slot: u64,
    /// For each element, the first cycle in which a MAC may be issued that reads it.
    readable: Vec<u64>,
}

impl Made {
    fn new(product: &Product, size: usize, slots: &[WriteBackSlot], last_slot: u64) -> Self {
        let mut readable = vec![0; size];
        for slot in slots {
            // Sums over the frame are no operand.
            if let Some(element) = readable.get_mut(slot.row as usize) {
                *element = slot.cycle + take_to_operand(product.epilogue);
            }
        }
        Self { result: product.result, last_slot, readable }
    }
}

/// When the addend of a product is there, as far as its own program makes it.
fn addend(product: &Product, made: &[Made]) -> u64 {
    let Epilogue::Add(partial) = product.epilogue else { return 0 };
    made.iter().find(|made| made.result.holds(partial)).map_or(0, |made| made.last_slot)
}

/// The gap before a program. The results of the one before leave the PEs within `longest_drain` cycles of its last issue;
/// the collector goes on `left` cycles after that issue. Both come before the first result of this program is ready. The
/// collector remembers one program, so it goes on before the next but one starts.
fn gap(program: &Program, longest_drain: u64, left: u64) -> u64 {
    let before_result = left.saturating_sub(program.first_slot);
    let before_start = (longest_drain + 1).saturating_sub(program.length);
    before_result.max(before_start).max(PROGRAM_GAP)
}
