//! Partition of a product: its rows go to the PEs, its results to write-back slots.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, VecDeque};

use super::matrix::{Entry, QuantisedMatrix};
use super::pe::{MAX_SEGMENT, PeProgram, RESULT_BUFFERS, Segment, SegmentKind, WriteBackSlot};
use crate::timing::latency::ISSUE_TO_RESULT;

/// A piece of a row in a PE, before its time is known.
struct Piece {
    kind: SegmentKind,
    row: u32,
    macs: u64,
}

/// What the PEs shall work through: rows as they follow each other, each with the number of its result.
pub(super) struct Stream<'a> {
    /// Index of the product.
    pub product: u32,
    /// Index of its stored matrix.
    pub matrix: usize,
    /// `(number of the result, entries)`.
    pub rows: Vec<(u32, &'a [Entry])>,
    /// Whether the entries go into the ROMs, rather than being there already.
    pub store: bool,
    /// Cycle of the first issue, at the earliest.
    pub start: u64,
    /// Fewest cycles from taking one of its results to taking the next one.
    pub spacing: u64,
}

impl<'a> Stream<'a> {
    /// The rows of `preload` as results `from..`, then those of `matrix` as results `0..`.
    pub fn rows_of(preload: Option<&'a QuantisedMatrix>, matrix: &'a QuantisedMatrix) -> Vec<(u32, &'a [Entry])> {
        let numbered = |first: usize, matrix: &'a QuantisedMatrix| {
            matrix.rows.iter().enumerate().map(move |(row, entries)| ((first + row) as u32, entries.as_slice()))
        };
        let preload = preload.into_iter().flat_map(|preload| numbered(matrix.rows.len(), preload));
        preload.chain(numbered(0, matrix)).collect()
    }
}

/// From when on the PEs may read the operand in a column, in cycles of the program; 0 where an earlier one has made it.
pub(super) type Readable<'a> = &'a dyn Fn(u32) -> u64;

/// When a product runs.
pub(super) struct Timing {
    /// Cycle of the first issue.
    pub start: u64,
    /// Issue cycles.
    pub length: u64,
    /// Cycle in which the last result is taken.
    pub last_slot: u64,
}

/// The PEs' programs while they grow.
pub(super) struct Partitioner {
    pub programs: Vec<PeProgram>,
    /// Cycles in which the collector takes a PE's latest results, as many as the PE has buffers.
    taken: Vec<VecDeque<u64>>,
    pub slots: Vec<WriteBackSlot>,
    /// When the collector may take the next result.
    collector_free: u64,
    /// Where the words of a stored matrix begin, in each PE.
    words_of: BTreeMap<usize, Vec<usize>>,
}

impl Partitioner {
    pub fn new(pes: usize) -> Self {
        Self {
            programs: vec![PeProgram::default(); pes],
            taken: vec![VecDeque::with_capacity(RESULT_BUFFERS); pes],
            slots: Vec::new(),
            collector_free: 0,
            words_of: BTreeMap::new(),
        }
    }

    /// Starts a program that owes nothing to the one before: every PE's data begins at the same address, all buffers
    /// for results are empty. Returns the addresses of `(words, segments, slots)`.
    pub fn begin(&mut self) -> (usize, usize, usize) {
        let words = self.programs.iter().map(|pe| pe.words.len()).max().unwrap_or(0);
        let segments = self.programs.iter().map(|pe| pe.segments.len()).max().unwrap_or(0);
        for pe in &mut self.programs {
            pe.words.resize(words, Entry::default());
            pe.segments.resize(segments, Segment { kind: SegmentKind::Idle, macs: 1 });
        }
        self.taken.iter_mut().for_each(VecDeque::clear);
        self.collector_free = 0;
        (words, segments, self.slots.len())
    }

    /// Distributes one product, which starts as soon as each MAC finds its operand.
    pub fn partition(&mut self, stream: &Stream<'_>, readable: Readable<'_>) -> Timing {
        let pieces = self.cut(stream, readable);
        let start = stream.start.max(self.soonest(stream.matrix, &pieces, readable));
        let used = self.place(stream, start, pieces);
        let length = used.iter().copied().max().unwrap_or(0);
        for (program, used) in self.programs.iter_mut().zip(used) {
            push(&mut program.segments, SegmentKind::Idle, length - used);
        }
        Timing { start, length, last_slot: self.slots.last().map_or(start, |slot| slot.cycle) }
    }

    /// The first cycle from which on no MAC is issued before its operand can be read. Idle cycles only delay.
    fn soonest(&self, matrix: usize, pieces: &[VecDeque<Piece>], readable: Readable<'_>) -> u64 {
        let pes = self.programs.iter().zip(&self.words_of[&matrix]).zip(pieces);
        let cycles = pes.flat_map(|((pe, &begin), pieces)| {
            let macs: u64 = pieces.iter().map(|piece| piece.macs).sum();
            let words = &pe.words[begin..begin + macs as usize];
            (0..).zip(words).map(|(issue, &(column, _))| readable(column).saturating_sub(issue))
        });
        cycles.max().unwrap_or(0)
    }

    /// Cuts the product's stream of MACs into equal shares; appends the words to the PEs' ROMs if they are new.
    fn cut(&mut self, stream: &Stream<'_>, readable: Readable<'_>) -> Vec<VecDeque<Piece>> {
        let pes = self.programs.len();
        let total: usize = stream.rows.iter().map(|(_, entries)| entries.len()).sum();
        let longest_row = stream.rows.iter().map(|(_, entries)| entries.len()).max().unwrap_or(1).max(1);
        // No more PEs than leave each a share as long as the longest row: a row then spans two PEs at most.
        let active = (total / longest_row).clamp(1, pes);
        let share = total.div_ceil(active);
        let mut pieces: Vec<VecDeque<Piece>> = (0..pes).map(|_| VecDeque::new()).collect();
        if stream.store {
            let begins = self.programs.iter().map(|pe| pe.words.len()).collect();
            self.words_of.insert(stream.matrix, begins);
        }
        let mut begin = 0;
        for &(row, entries) in &stream.rows {
            let end = begin + entries.len();
            let entries = if stream.store { arranged(entries, share - begin % share, readable) } else { Vec::new() };
            let mut at = begin;
            while at < end {
                let pe = at / share;
                let stop = end.min((pe + 1) * share);
                let kind = match (at == begin, stop == end) {
                    (true, true) => SegmentKind::Row,
                    (false, _) => SegmentKind::Tail,
                    (true, false) => SegmentKind::Head,
                };
                if stream.store {
                    self.programs[pe].words.extend_from_slice(&entries[at - begin..stop - begin]);
                }
                pieces[pe].push_back(Piece { kind, row, macs: (stop - at) as u64 });
                at = stop;
            }
            begin = end;
        }
        pieces
    }

    /// Gives every piece its time, results in the order in which they become ready; returns the cycles that each
    /// PE needs.
    fn place(&mut self, stream: &Stream<'_>, start: u64, mut pieces: Vec<VecDeque<Piece>>) -> Vec<u64> {
        let mut used = vec![0_u64; pieces.len()];
        let mut ready = BinaryHeap::new();
        for pe in 0..pieces.len() {
            if let Some(cycle) = self.next_result(pe, &mut pieces[pe], &mut used[pe], start) {
                ready.push(Reverse((cycle, pe)));
            }
        }
        while let Some(Reverse((cycle, pe))) = ready.pop() {
            let room = match self.taken[pe].front() {
                Some(&oldest) if self.taken[pe].len() == RESULT_BUFFERS => oldest + 1,
                _ => 0,
            };
            if cycle < room {
                push(&mut self.programs[pe].segments, SegmentKind::Idle, room - cycle);
                used[pe] += room - cycle;
                ready.push(Reverse((room, pe)));
                continue;
            }
            if self.taken[pe].len() == RESULT_BUFFERS {
                self.taken[pe].pop_front();
            }
            let slot = cycle.max(self.collector_free);
            self.collector_free = slot + stream.spacing;
            self.taken[pe].push_back(slot);
            if let Some(piece) = pieces[pe].pop_front() {
                self.slots.push(WriteBackSlot { cycle: slot, pe: pe as u32, product: stream.product, row: piece.row });
                used[pe] += piece.macs;
                push(&mut self.programs[pe].segments, piece.kind, piece.macs);
            }
            if let Some(cycle) = self.next_result(pe, &mut pieces[pe], &mut used[pe], start) {
                ready.push(Reverse((cycle, pe)));
            }
        }
        used
    }

    /// Passes over tails, which give no result; returns when the next piece's result would be ready.
    fn next_result(&mut self, pe: usize, pieces: &mut VecDeque<Piece>, used: &mut u64, start: u64) -> Option<u64> {
        while let Some(tail) = pieces.pop_front_if(|piece| piece.kind == SegmentKind::Tail) {
            *used += tail.macs;
            push(&mut self.programs[pe].segments, tail.kind, tail.macs);
        }
        pieces.front().map(|piece| start + *used + piece.macs - 1 + ISSUE_TO_RESULT)
    }
}

/// The entries of a row in the order in which their operands can be read, of equal ones by column. Of a row that goes on
/// in the next PE the first `room` stand at the end of a PE's share, the others at the beginning of one: these are
/// issued first.
fn arranged(entries: &[Entry], room: usize, readable: Readable<'_>) -> Vec<Entry> {
    let mut entries = entries.to_vec();
    if entries.iter().any(|&(column, _)| readable(column) > 0) {
        entries.sort_by_key(|&(column, _)| readable(column));
        let early = entries.len().saturating_sub(room);
        entries.rotate_left(early);
    }
    entries
}

/// Appends a segment, split where a count would not fit the ROM word.
fn push(segments: &mut Vec<Segment>, kind: SegmentKind, macs: u64) {
    let mut left = macs;
    while left > 0 {
        let part = left.min(u64::from(MAX_SEGMENT));
        segments.push(Segment { kind, macs: part as u32 });
        left -= part;
    }
}
