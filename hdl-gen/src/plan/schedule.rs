//! Who computes what, and when: the static schedule of the SpMV lanes.
//!
//! Nothing in the lanes' timing depends on data, so the whole frame is laid out here, cycle by cycle, and the
//! hardware needs neither arbiter nor stall. The MACs of a product form one long stream, row after row, that is
//! cut into equal pieces, one per lane: all lanes finish together. A row cut in two leaves its end as a *tail*
//! in the next lane, kept in that lane's carry register, and its beginning as a *head* that adds the carry.
//! A collector takes one result a cycle, in the order in which they become ready. Where rows are so short that a
//! lane would finish another before there is room for it, idle cycles are inserted.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use serde::Serialize;

use super::product::{Block, Epilogue, Product, Vector};
use super::quantise::QuantisedMatrix;

/// Cycles from the issue of a row's last MAC to its sum standing in the lane's result register.
pub const ISSUE_TO_RESULT: u64 = 7;
/// Results that a lane holds until the collector comes.
pub const RESULT_PLACES: usize = 2;
/// Cycles from a collector visit to the first issue that may read the value as an operand.
pub const VISIT_TO_OPERAND: u64 = 6;
/// Cycles without issue when the lanes pass from one block to the next.
pub const TURN_GAP: u64 = 1;
/// Cycles from the last collector visit of a frame to the `drained` pulse.
pub const VISIT_TO_DRAINED: u64 = 4;
/// A count in the MACs-per-row ROM has 14 bits.
pub const MAX_SEGMENT: u32 = (1 << 14) - 1;

/// What a lane does with the sum of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SegmentKind {
    /// A whole row: its sum is a result.
    Row = 0,
    /// The end of a row that the lane before began: its sum goes to the carry register.
    Tail = 1,
    /// The beginning of a row that the next lane ends: its sum plus that lane's carry is a result.
    Head = 2,
    /// No MAC at all: waiting.
    Idle = 3,
}

/// A run of consecutive MACs of one row in one lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Segment {
    /// What happens to the sum.
    pub kind: SegmentKind,
    /// MACs (or idle cycles), 1 to [`MAX_SEGMENT`].
    pub macs: u32,
}

/// The MCSR data of one lane, in the order in which it is read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LaneProgram {
    /// `(column, coefficient)` pairs; a matrix that several products share stands here once.
    pub words: Vec<(u32, i32)>,
    /// MACs per row, product after product.
    pub segments: Vec<Segment>,
}

/// When a product runs, in cycles from the first issue of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Window {
    /// First issue cycle.
    pub start: u64,
    /// Issue cycles.
    pub length: u64,
    /// Idle cycles before `start`, beyond the turn gap, until the operand is complete.
    pub wait: u64,
    /// MACs of all lanes in this window.
    pub macs: u64,
}

/// The collector takes a result from a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Visit {
    /// Cycle, counted from the first issue of the frame.
    pub cycle: u64,
    /// The lane that holds the result.
    pub lane: u32,
    /// The product it belongs to.
    pub product: u32,
    /// The row of that product.
    pub row: u32,
}

/// The lanes' work for one frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// Per lane.
    pub lanes: Vec<LaneProgram>,
    /// Per product.
    pub windows: Vec<Window>,
    /// Every result in the order in which the collector takes them.
    pub visits: Vec<Visit>,
    /// Cycle of the `drained` pulse.
    pub drained: u64,
}

impl Schedule {
    /// Lays out `products` on `lanes` lanes.
    pub fn new(products: &[Product], matrices: &[QuantisedMatrix], lanes: usize) -> Self {
        let mut builder = Builder::new(lanes, matrices.len());
        let mut complete: Vec<(Vector, u64)> = Vec::new();
        let mut block = products.first().map_or(Block::We, |product| product.block);
        let mut next_start = 0;
        let mut windows: Vec<Window> = Vec::with_capacity(products.len());
        for (index, product) in products.iter().enumerate() {
            if product.block != block {
                next_start += TURN_GAP;
                block = product.block;
            }
            let visited = |vector| complete.iter().find(|&&(name, _)| name == vector).map_or(0, |&(_, visit)| visit);
            let mut start = next_start;
            if product.operand != Vector::Stress {
                start = start.max(visited(product.operand) + VISIT_TO_OPERAND);
            }
            if let Epilogue::Add(partial) = product.epilogue {
                start = start.max(visited(partial));
            }
            let (length, last_visit) = builder.deal(index, product.matrix, &matrices[product.matrix], start);
            let macs = matrices[product.matrix].nnz() as u64;
            windows.push(Window { start, length, wait: start - next_start, macs });
            complete.push((product.result, last_visit));
            next_start = start + length;
        }
        let last_visit = builder.visits.last().map_or(0, |visit| visit.cycle);
        Self { lanes: builder.programs, windows, visits: builder.visits, drained: last_visit + VISIT_TO_DRAINED }
    }

    /// Words in the values and columns ROMs: the longest lane's.
    pub fn word_depth(&self) -> usize {
        self.lanes.iter().map(|lane| lane.words.len()).max().unwrap_or(0).max(1)
    }

    /// Words in the MACs-per-row ROMs: the longest lane's.
    pub fn segment_depth(&self) -> usize {
        self.lanes.iter().map(|lane| lane.segments.len()).max().unwrap_or(0).max(1)
    }

    /// Cycles from the first issue to the last.
    pub fn issue_cycles(&self) -> u64 {
        self.windows.last().map_or(0, |window| window.start + window.length)
    }

    /// Share of the lane cycles between first and last issue that do a MAC, 0 to 1.
    pub fn busy_fraction(&self) -> f64 {
        let macs: u64 = self.windows.iter().map(|window| window.macs).sum();
        macs as f64 / (self.issue_cycles() * self.lanes.len() as u64) as f64
    }
}

/// A piece of a row as dealt to a lane, before its time is known.
struct Piece {
    kind: SegmentKind,
    row: u32,
    macs: u64,
}

struct Builder {
    programs: Vec<LaneProgram>,
    /// Cycles in which the collector takes a lane's latest results, as many as the lane has places.
    taken: Vec<VecDeque<u64>>,
    visits: Vec<Visit>,
    stored: Vec<bool>,
}

impl Builder {
    fn new(lanes: usize, matrices: usize) -> Self {
        Self {
            programs: vec![LaneProgram::default(); lanes],
            taken: vec![VecDeque::with_capacity(RESULT_PLACES); lanes],
            visits: Vec::new(),
            stored: vec![false; matrices],
        }
    }

    /// Deals one product's rows; returns its length and the cycle in which its last result is taken.
    fn deal(&mut self, product: usize, matrix_index: usize, matrix: &QuantisedMatrix, start: u64) -> (u64, u64) {
        let store = !std::mem::replace(&mut self.stored[matrix_index], true);
        let pieces = self.cut(matrix, store);
        let used = self.place(product as u32, pieces, start);
        let length = used.iter().copied().max().unwrap_or(0);
        for (program, used) in self.programs.iter_mut().zip(used) {
            push(&mut program.segments, SegmentKind::Idle, length - used);
        }
        (length, self.visits.last().map_or(start, |visit| visit.cycle))
    }

    /// Cuts the product's stream of MACs into equal shares; appends the words to the lanes' ROMs if `store`.
    fn cut(&mut self, matrix: &QuantisedMatrix, store: bool) -> Vec<VecDeque<Piece>> {
        let lanes = self.programs.len();
        let total = matrix.nnz();
        let longest_row = matrix.rows.iter().map(Vec::len).max().unwrap_or(1).max(1);
        // No more lanes than leave each a share as long as the longest row: a row then spans two lanes at most.
        let active = (total / longest_row).clamp(1, lanes);
        let share = total.div_ceil(active);
        let mut pieces: Vec<VecDeque<Piece>> = (0..lanes).map(|_| VecDeque::new()).collect();
        let mut begin = 0;
        for (row, entries) in matrix.rows.iter().enumerate() {
            let end = begin + entries.len();
            let mut at = begin;
            while at < end {
                let lane = at / share;
                let stop = end.min((lane + 1) * share);
                let kind = match (at == begin, stop == end) {
                    (true, true) => SegmentKind::Row,
                    (false, _) => SegmentKind::Tail,
                    (true, false) => SegmentKind::Head,
                };
                if store {
                    self.programs[lane].words.extend_from_slice(&entries[at - begin..stop - begin]);
                }
                pieces[lane].push_back(Piece { kind, row: row as u32, macs: (stop - at) as u64 });
                at = stop;
            }
            begin = end;
        }
        pieces
    }

    /// Gives every piece its time, results in the order in which they become ready; returns the cycles that each
    /// lane needs.
    fn place(&mut self, product: u32, mut pieces: Vec<VecDeque<Piece>>, start: u64) -> Vec<u64> {
        let mut used = vec![0_u64; pieces.len()];
        let mut ready = BinaryHeap::new();
        for lane in 0..pieces.len() {
            if let Some(cycle) = self.next_result(lane, &mut pieces[lane], &mut used[lane], start) {
                ready.push(Reverse((cycle, lane)));
            }
        }
        while let Some(Reverse((cycle, lane))) = ready.pop() {
            let room = match self.taken[lane].front() {
                Some(&oldest) if self.taken[lane].len() == RESULT_PLACES => oldest + 1,
                _ => 0,
            };
            if cycle < room {
                push(&mut self.programs[lane].segments, SegmentKind::Idle, room - cycle);
                used[lane] += room - cycle;
                ready.push(Reverse((room, lane)));
                continue;
            }
            if self.taken[lane].len() == RESULT_PLACES {
                self.taken[lane].pop_front();
            }
            let visit = self.visits.last().map_or(cycle, |last| cycle.max(last.cycle + 1));
            self.taken[lane].push_back(visit);
            if let Some(piece) = pieces[lane].pop_front() {
                self.visits.push(Visit { cycle: visit, lane: lane as u32, product, row: piece.row });
                used[lane] += piece.macs;
                push(&mut self.programs[lane].segments, piece.kind, piece.macs);
            }
            if let Some(cycle) = self.next_result(lane, &mut pieces[lane], &mut used[lane], start) {
                ready.push(Reverse((cycle, lane)));
            }
        }
        used
    }

    /// Passes over tails, which give no result; returns when the next piece's result would be ready.
    fn next_result(&mut self, lane: usize, pieces: &mut VecDeque<Piece>, used: &mut u64, start: u64) -> Option<u64> {
        while let Some(tail) = pieces.pop_front_if(|piece| piece.kind == SegmentKind::Tail) {
            *used += tail.macs;
            push(&mut self.programs[lane].segments, tail.kind, tail.macs);
        }
        pieces.front().map(|piece| start + *used + piece.macs - 1 + ISSUE_TO_RESULT)
    }
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
