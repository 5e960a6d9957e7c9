//! Who computes what, and when: the static schedule of the SpMV lanes.
//!
//! Unless zeros are passed over, nothing in the lanes' timing depends on data: a frame is laid out here, cycle by
//! cycle, and the hardware needs neither arbiter nor stall. The MACs of a product form one long stream, row after row,
//! that is cut into equal pieces, one per lane: all lanes finish together. A row cut in two leaves its end as a *tail*
//! in the next lane, kept in that lane's carry register, and its beginning as a *head* that adds the carry.
//! A collector takes one result a cycle, in the order in which they become ready. Where rows are so short that a
//! lane would finish another before there is room for it, idle cycles are inserted.
//!
//! Products that always follow each other at the same distance form a *program*. The paper's plan is one program a
//! frame, and so are resultants alone; a field that the lanes put together takes two more. The hardware starts a program
//! when its data and the lanes are there.

use serde::Serialize;

use super::dealing::{Dealer, Stream, rounds_period};
pub use super::lane::{LaneProgram, MAX_SEGMENT, RESULT_PLACES, Segment, SegmentKind, Visit};
use super::matrix::{Entry, QuantisedMatrix};
use super::product::{Epilogue, Product, Vector, spacing, visit_to_operand};
use crate::blocks::latency::{COLLECTOR_JUMP, ISSUE_TO_RESULT, ROUNDS_FETCH, TURN_GAP, WRITE_TO_LIST};

/// When a product runs, in cycles from the first issue of its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Window {
    /// First issue cycle.
    pub start: u64,
    /// Issue cycles.
    pub length: u64,
    /// Idle cycles before `start`, until the operand is complete.
    pub wait: u64,
    /// MACs of all lanes in this window; with four ways a lane counts once.
    pub macs: u64,
    /// Of a product that passes over zeros.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounds: Option<Rounds>,
}

/// How a product passes over zeros: whole rows are dealt to the lanes, one a lane and round, and all lanes multiply the
/// same column at a time, from a list of the operand's quads that are not zero. The window's length is that of an
/// operand without zeros; the hardware takes `count * max(nonzeros, lanes)` cycles after the rows of sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rounds {
    /// Issue cycles of the rows of sums in front.
    pub lead: u64,
    /// Rounds.
    pub count: usize,
    /// First word of the dense rows, from the first dense row of the ROM.
    pub word: usize,
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
    /// Cycles without issue between the last issue of a program and the first of the next, at least.
    pub program_gap: u64,
}

impl Schedule {
    /// Lays out `products` on `lanes` lanes; the products of a program stand next to each other.
    pub fn new(products: &[Product], matrices: &[QuantisedMatrix], lanes: usize) -> Self {
        let mut dealer = Dealer::new(lanes);
        let mut stored = vec![false; matrices.len()];
        let mut programs = Vec::new();
        let mut windows: Vec<Window> = Vec::with_capacity(products.len());
        let mut first = 0;
        for chunk in products.chunk_by(|one, other| one.program == other.program) {
            let (word, segment, visit) = dealer.begin();
            let mut complete: Vec<(Vector, u64)> = Vec::new();
            let mut next_start = 0;
            for (offset, product) in chunk.iter().enumerate() {
                let start = earliest(product, chunk, &complete).max(next_start);
                let main = &matrices[product.matrix];
                let lead = product.lead.as_ref().map(|lead| &matrices[lead.matrix]);
                let new = |matrix: usize| !std::mem::replace(&mut stored[matrix], true);
                let index = (first + offset) as u32;
                let work = Work { product, index, lead, main, start };
                let (length, last_visit, macs, rounds) =
                    if product.skips { work.in_rounds(&mut dealer, new) } else { work.in_pieces(&mut dealer, new) };
                windows.push(Window { start, length, wait: start - next_start, macs, rounds });
                complete.push((product.result, last_visit));
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
                // Where zeros are passed over, the first round may be as short as the lanes are many.
                first_visit: match windows[first].rounds {
                    Some(Rounds { lead: 0, .. }) => ROUNDS_FETCH + rounds_period(0, lanes) - 1 + ISSUE_TO_RESULT,
                    _ => cycles(dealer.visits.get(visit)),
                },
                last_visit: cycles(dealer.visits.last()),
            });
            first += chunk.len();
        }
        let program_gap = program_gap(&programs, &windows, lanes);
        Self { lanes: dealer.programs, programs, windows, visits: dealer.visits, program_gap }
    }

    /// Words in the values ROMs: those with a column, then the dense rows.
    pub fn value_depth(&self) -> usize {
        self.word_depth() + self.lanes.first().map_or(0, |lane| lane.rounds.len())
    }

    /// Words in the columns ROMs: the longest lane's.
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

/// Length, cycle of the last visit, MACs, and the rounds if there are any.
type Dealt = (u64, u64, u64, Option<Rounds>);

impl<'a> Work<'a> {
    fn stream(&self, mut rows: Vec<(u32, &'a [Entry])>, store: bool, start: u64) -> Stream<'a> {
        self.product.relabel(&mut rows);
        Stream { product: self.index, rows, store, start, spacing: spacing(self.product.epilogue) }
    }

    fn in_pieces(&self, dealer: &mut Dealer, mut new: impl FnMut(usize) -> bool) -> Dealt {
        let rows = Stream::rows_of(self.lead, self.main);
        let macs = rows.iter().map(|(_, entries)| entries.len() as u64).sum();
        let (length, last_visit) = dealer.deal(&self.stream(rows, new(self.product.matrix), self.start));
        (length, last_visit, macs, None)
    }

    fn in_rounds(&self, dealer: &mut Dealer, mut new: impl FnMut(usize) -> bool) -> Dealt {
        let mut rows = Stream::rows_of(self.lead, self.main);
        let main = rows.split_off(rows.len() - self.main.rows.len());
        let macs = rows.iter().chain(&main).map(|(_, entries)| entries.len() as u64).sum();
        let (lead, _) = if rows.is_empty() { (0, 0) } else { dealer.deal(&self.stream(rows, true, self.start)) };
        let store = new(self.product.matrix);
        // A matrix that is read again stands where its first product put it.
        let end = dealer.round_words();
        let word = *dealer.rounds_of.entry(self.product.matrix).or_insert(end);
        let count = main.len().div_ceil(dealer.programs.len());
        let (length, last_visit) = dealer.deal_rounds(&self.stream(main, store, self.start + lead + ROUNDS_FETCH));
        (lead + ROUNDS_FETCH + length, last_visit, macs, Some(Rounds { lead, count, word }))
    }
}

/// When the operands and the addend of a product are there, as far as its own program makes them.
fn earliest(product: &Product, program: &[Product], complete: &[(Vector, u64)]) -> u64 {
    let made_by = |vector: Vector| {
        let (_, visit) = complete.iter().find(|&&(result, _)| result.holds(vector))?;
        let producer = program.iter().find(|other| other.result.holds(vector))?;
        Some((producer, *visit))
    };
    let operands = product.operands.iter().filter_map(|&operand| made_by(operand)).map(|(producer, visit)| {
        let list = if product.skips { WRITE_TO_LIST } else { 0 };
        visit + visit_to_operand(producer.epilogue) + list
    });
    let addend = match product.epilogue {
        Epilogue::Add(partial) => made_by(partial).map(|(_, visit)| visit),
        _ => None,
    };
    operands.chain(addend).max().unwrap_or(0)
}

/// Results of one program must have left the lanes before the first of the next is ready, and the collector must have
/// gone on to the next before the one after that is started: it remembers one. Whichever follow each other.
fn program_gap(programs: &[Program], windows: &[Window], lanes: usize) -> u64 {
    let longest_drain = programs.iter().map(|program| program.last_visit - program.length).max().unwrap_or(0);
    let soonest_result = programs.iter().map(|program| program.first_visit).min().unwrap_or(0);
    let saved = |window: &Window| {
        // An operand of nothing but zeros.
        let shortest = |rounds: Rounds| rounds.lead + ROUNDS_FETCH + rounds.count as u64 * rounds_period(0, lanes);
        window.rounds.map_or(0, |rounds| window.length - shortest(rounds))
    };
    let shortest = programs
        .iter()
        .map(|program| program.length - windows[program.first..program.end].iter().map(saved).sum::<u64>())
        .min()
        .unwrap_or(0);
    let before_result = (longest_drain + COLLECTOR_JUMP).saturating_sub(soonest_result);
    let before_start = (longest_drain + 1).saturating_sub(shortest);
    before_result.max(before_start).max(TURN_GAP)
}
