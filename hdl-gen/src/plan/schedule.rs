//! Who computes what, and when: the static schedule of the SpMV lanes.
//!
//! Nothing in the lanes' timing depends on data: a frame is laid out here, cycle by cycle, and the hardware needs
//! neither arbiter nor stall. The MACs of a product form one long stream, row after row,
//! that is cut into equal pieces, one per lane: all lanes finish together. A row cut in two leaves its end as a *tail*
//! in the next lane, kept in that lane's carry register, and its beginning as a *head* that adds the carry.
//! A collector takes one result a cycle, in the order in which they become ready. Where rows are so short that a
//! lane would finish another before there is room for it, idle cycles are inserted.
//!
//! Products that always follow each other at the same distance form a *program*. The paper's plan is one program a
//! frame, and so are resultants alone; a field that the lanes put together takes two more. The hardware starts a program
//! when its data and the lanes are there.

use serde::Serialize;

use super::dealing::{Dealer, Dealt, Stream};
pub use super::lane::{LaneProgram, MAX_SEGMENT, RESULT_PLACES, Segment, SegmentKind, Visit};
use super::matrix::{Entry, QuantisedMatrix};
use super::product::{Epilogue, Product, Vector, mirror, spacing, visit_to_operand};
use crate::timing::latency::{TURN_GAP, collector_jump};

/// When a product runs, in cycles from the first issue of its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Window {
    /// First issue cycle.
    pub start: u64,
    /// Issue cycles.
    pub length: u64,
    /// Idle cycles before `start`, until every MAC finds its operand.
    pub wait: u64,
    /// MACs of all lanes in this window; with four ways a lane counts once.
    pub macs: u64,
}

/// Products that follow each other at fixed distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    /// Its first product.
    pub first: usize,
    /// The one after its last.
    pub end: usize,
    /// Address of its first word in the values and columns ROMs, the same in every lane.
    pub word: usize,
    /// Address of its first word in the MACs-per-row ROMs, the same in every lane.
    pub segment: usize,
    /// Address of its first visit.
    pub visit: usize,
    /// Cycles from the first issue to the last, inclusive.
    pub length: u64,
    /// Cycle of its first visit.
    pub first_visit: u64,
    /// Cycle of its last visit.
    pub last_visit: u64,
    /// Cycles without issue between the last issue of whatever program runs before and its first, at least.
    pub gap: u64,
}

/// The lanes' work for one frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// Per lane.
    pub lanes: Vec<LaneProgram>,
    /// Per program.
    pub programs: Vec<Program>,
    /// Per product.
    pub windows: Vec<Window>,
    /// Every result in the order in which the collector takes them, program after program.
    pub visits: Vec<Visit>,
    /// Whether the collector looks ahead to the next program while the last result of one waits.
    pub ahead: bool,
}

impl Schedule {
    /// Lays out `products` on `lanes` lanes; the products of a program stand next to each other. The collector looks
    /// `ahead` to the next program, or not.
    pub fn new(products: &[Product], matrices: &[QuantisedMatrix], lanes: usize, ahead: bool) -> Self {
        let mut dealer = Dealer::new(lanes);
        let mut stored = vec![false; matrices.len()];
        let mut programs = Vec::new();
        let mut windows: Vec<Window> = Vec::with_capacity(products.len());
        let mut first = 0;
        for chunk in products.chunk_by(|one, other| one.program == other.program) {
            let (word, segment, visit) = dealer.begin();
            let mut made: Vec<Made> = Vec::new();
            let mut next_start = 0;
            for (offset, product) in chunk.iter().enumerate() {
                let main = &matrices[product.matrix];
                let lead = product.lead.as_ref().map(|lead| &matrices[lead.matrix]);
                let new = |matrix: usize| !std::mem::replace(&mut stored[matrix], true);
                let index = (first + offset) as u32;
                let work = Work { product, index, lead, main, start: next_start.max(addend(product, &made)) };
                let first_visit = dealer.visits.len();
                let (Dealt { start, length, last_visit }, macs) = work.deal(&mut dealer, &made, new);
                windows.push(Window { start, length, wait: start - next_start, macs });
                made.push(Made::new(product, main.rows.len(), &dealer.visits[first_visit..], last_visit));
                next_start = start + length;
            }
            let cycles = |visit: Option<&Visit>| visit.map_or(0, |visit| visit.cycle);
            programs.push(Program {
                first,
                end: first + chunk.len(),
                word,
                segment,
                visit,
                length: next_start,
                first_visit: cycles(dealer.visits.get(visit)),
                last_visit: cycles(dealer.visits.last()),
                gap: 0,
            });
            first += chunk.len();
        }
        let longest_drain = programs.iter().map(|program| program.last_visit - program.length).max().unwrap_or(0);
        for program in &mut programs {
            program.gap = gap(program, longest_drain, longest_drain + collector_jump(ahead));
        }
        Self { lanes: dealer.programs, programs, windows, visits: dealer.visits, ahead }
    }

    /// Words in the values and columns ROMs: the longest lane's.
    pub fn word_depth(&self) -> usize {
        self.lanes.iter().map(|lane| lane.words.len()).max().unwrap_or(0).max(1)
    }

    /// Words in the MACs-per-row ROMs: the longest lane's.
    pub fn segment_depth(&self) -> usize {
        self.lanes.iter().map(|lane| lane.segments.len()).max().unwrap_or(0).max(1)
    }

    /// Cycles from a program's first issue to its last, all programs of a frame.
    pub fn issue_cycles(&self) -> u64 {
        self.programs.iter().map(|program| program.length).sum()
    }

    /// Share of the lane cycles between first and last issue that do a MAC, 0 to 1.
    pub fn busy_fraction(&self) -> f64 {
        let macs: u64 = self.windows.iter().map(|window| window.macs).sum();
        macs as f64 / (self.issue_cycles() * self.lanes.len() as u64) as f64
    }
}

/// A product to be dealt.
struct Work<'a> {
    product: &'a Product,
    index: u32,
    lead: Option<&'a QuantisedMatrix>,
    main: &'a QuantisedMatrix,
    start: u64,
}

impl<'a> Work<'a> {
    fn stream(&self, mut rows: Vec<(u32, &'a [Entry])>, store: bool, start: u64) -> Stream<'a> {
        let Self { product, index, .. } = *self;
        product.relabel(&mut rows);
        let spacing = spacing(product.epilogue);
        Stream { product: index, matrix: product.matrix, rows, store, start, spacing }
    }

    /// Starts while the operand is still being made, if its MACs find what they need. Returns its MACs, too.
    fn deal(&self, dealer: &mut Dealer, made: &[Made], mut new: impl FnMut(usize) -> bool) -> (Dealt, u64) {
        let rows = Stream::rows_of(self.lead, self.main);
        let macs = rows.iter().map(|(_, entries)| entries.len() as u64).sum();
        let sources: Vec<Option<&Made>> =
            self.product.operands.iter().map(|&operand| made.iter().find(|made| made.result.holds(operand))).collect();
        let size = self.main.rows.len();
        let readable = |column: u32| {
            let (operand, element) = (column as usize / size, column as usize % size);
            let element = self.product.mirrored.map_or(element, |side| mirror(element, side));
            sources[operand].map_or(0, |made| made.readable[element])
        };
        let stream = self.stream(rows, new(self.product.matrix), self.start);
        (dealer.deal(&stream, &readable), macs)
    }
}

/// What a product of the program under way has made.
struct Made {
    result: Vector,
    /// Cycle in which the last result is taken.
    last_visit: u64,
    /// For each element, the first cycle in which a MAC may be issued that reads it.
    readable: Vec<u64>,
}

impl Made {
    fn new(product: &Product, size: usize, visits: &[Visit], last_visit: u64) -> Self {
        let mut readable = vec![0; size];
        for visit in visits {
            // Sums over the frame are no operand.
            if let Some(element) = readable.get_mut(visit.row as usize) {
                *element = visit.cycle + visit_to_operand(product.epilogue);
            }
        }
        Self { result: product.result, last_visit, readable }
    }
}

/// When the addend of a product is there, as far as its own program makes it.
fn addend(product: &Product, made: &[Made]) -> u64 {
    let Epilogue::Add(partial) = product.epilogue else { return 0 };
    made.iter().find(|made| made.result.holds(partial)).map_or(0, |made| made.last_visit)
}

/// The gap before a program: the results of the one before, `longest_drain` cycles after its last issue at most, must
/// have left the lanes, and the collector gone on, `left` cycles after that issue, before the first of this one is ready;
/// and it must have done so before the one after it is started: it remembers one.
fn gap(program: &Program, longest_drain: u64, left: u64) -> u64 {
    let before_result = left.saturating_sub(program.first_visit);
    let before_start = (longest_drain + 1).saturating_sub(program.length);
    before_result.max(before_start).max(TURN_GAP)
}
