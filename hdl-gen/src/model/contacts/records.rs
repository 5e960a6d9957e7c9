//! The words before the field of a frame of several bodies: what `sptfra_records` makes of the headers of the core's answers.

use golden::bodies::Body;
use golden::status::Status;

use super::float;
use crate::plan::SUMMARY_WORDS;
use crate::plan::contacts::records::{BEFORE, Constants, FRAME, Instruction, Place, Program, RECORD_WORDS, What, run};

/// Words of a page: of a body, of the frame, of what is between.
const PAGE: usize = 16;
const PAGES: usize = 16;
const SCRATCH: usize = 9;
/// First of what is kept for the next frame, of so many words each body.
const LAST: usize = 10 * PAGE;
const LAST_WORDS: usize = 4;

/// What there is of a frame's bodies beside the headers.
#[derive(Clone, Copy, Debug)]
pub struct Counted<'a> {
    /// Bodies with a record.
    pub kept: usize,
    /// All that there are.
    pub bodies: u8,
    /// Taxels that each of the first touches.
    pub taxels: &'a [u16],
    /// Whether a number did not fit on the way to them.
    pub saturated: bool,
}

/// The hardware's state.
#[derive(Clone, Debug)]
pub struct Records {
    contacts: usize,
    constants: [u32; 10],
    program: Vec<Instruction>,
    memory: Vec<u32>,
    /// Bodies of the last frame.
    last: u8,
}

/// What is noted of a frame on the way.
struct Notes {
    /// Bodies in front of each.
    ranks: Vec<usize>,
    /// The last comparison found less.
    less: bool,
    /// Whether the body slips.
    slips: bool,
    /// Bits of all bodies, and of what is between them.
    bits: u32,
}

impl Records {
    /// For so many records.
    pub fn new(contacts: usize, constants: &Constants) -> Self {
        let program = Program { contacts, slips: constants.slip.is_some() }.instructions();
        Self { contacts, constants: constants.words(), program, memory: vec![0; PAGE * PAGES], last: 0 }
    }

    /// As after the hardware's reset: there was no frame before the next one.
    pub fn reset(&mut self) {
        self.last = 0;
    }

    /// Takes a header of an answer, 16 words: of a body in the last round or the one before, or of the frame ([`FRAME`]).
    pub fn take(&mut self, body: u8, before: bool, header: &[u32]) {
        header.iter().enumerate().for_each(|(word, &data)| self.write(body, before, word, data));
    }

    /// Takes one of its words.
    pub fn write(&mut self, body: u8, before: bool, word: usize, data: u32) {
        let page = PAGE * usize::from(body);
        if before && body < FRAME && (word == 2 || word == 3) {
            self.memory[page + usize::from(BEFORE) + word - 2] = data;
        } else if !before && (body == FRAME || word < usize::from(BEFORE)) {
            self.memory[page + word] = data;
        }
    }

    /// The words before the field.
    pub fn finish(&mut self, counted: Counted) -> Vec<u32> {
        let mut words = vec![0; SUMMARY_WORDS + RECORD_WORDS * self.contacts];
        let bits = if counted.saturated { Status::SATURATED.0 } else { 0 };
        let mut notes = Notes { ranks: vec![0; self.contacts], less: false, slips: false, bits };
        let program = std::mem::take(&mut self.program);
        run(
            &program,
            [counted.kept, self.contacts].map(|bodies| bodies as u8),
            |what, [to, a, b], magnitude, [i, j]| {
                let bodies = [usize::from(i), usize::from(j)];
                // The frame's record is the first.
                let [own, other] = bodies.map(|body| body % usize::from(FRAME));
                let [a, b] = [a, b].map(|place| self.source(place, bodies));
                let b = if magnitude { b & !(1 << 31) } else { b };
                let result = match what {
                    What::Less => return notes.less = float::is_below(a, b),
                    What::Rank => return notes.ranks[if float::is_below(a, b) { own } else { other }] += 1,
                    What::OwnStatus => {
                        let noted = [(notes.less, Status::DOUBTFUL), (notes.slips, Status::SLIP)];
                        let of_core = Body::bits_of(Status(a & 0xFFFF)).0;
                        let bits = noted.iter().filter(|noted| noted.0).fold(of_core, |bits, noted| bits | noted.1.0);
                        notes.bits |= bits | (a & Status::SATURATED.0);
                        bits << 16 | u32::from(counted.taxels[own])
                    }
                    What::FrameStatus => {
                        let more = usize::from(counted.bodies) > self.contacts;
                        a & !Body::bits_of(Status(a & 0xFFFF)).0
                            | notes.bits
                            | if more { Status::MORE_BODIES.0 } else { 0 }
                    }
                    What::Census => a & !0xFF | u32::from(counted.bodies),
                    What::Move => a,
                    What::Nearer if notes.less && j < self.last => a,
                    What::Slip => {
                        notes.slips = !std::mem::take(&mut notes.less);
                        if notes.slips {
                            return;
                        }
                        a
                    }
                    What::Nearer => return,
                    What::Remember => {
                        if counted.kept > 0 || a & Status::NO_CONTACT.0 != 0 {
                            self.last = counted.kept as u8;
                        }
                        return;
                    }
                    What::Choose => {
                        if float::value(a) > 0.0 {
                            b
                        } else {
                            0
                        }
                    }
                    What::Add => float::add(a, b),
                    What::Subtract => float::subtract(a, b),
                    What::Multiply => float::multiply(a, b),
                    What::Divide => float::divide(a, b),
                    What::Root => float::root(a),
                    What::Angle => float::angle(a, b),
                };
                match to {
                    Place::OutFrame(word) => words[usize::from(word)] = result,
                    Place::OutRecord(word) => {
                        words[SUMMARY_WORDS + RECORD_WORDS * notes.ranks[own] + usize::from(word)] = result;
                    }
                    place => {
                        if let Some(address) = address(place, bodies, own) {
                            self.memory[address] = result;
                        }
                    }
                }
            },
        );
        self.program = program;
        words
    }

    fn source(&self, place: Place, bodies: [usize; 2]) -> u32 {
        match place {
            Place::Constant(word) => self.constants[usize::from(word)],
            place => address(place, bodies, bodies[1]).map_or(0, |address| self.memory[address]),
        }
    }
}

/// Where a word stands in the memory, if it does; of what is kept for the next frame the one of body `last`.
fn address(place: Place, [i, j]: [usize; 2], last: usize) -> Option<usize> {
    let (page, word) = match place {
        Place::I(word) => (i, word),
        Place::J(word) => (j, word),
        Place::Frame(word) => (usize::from(FRAME), word),
        Place::Scratch(word) => (SCRATCH, word),
        Place::Last(word) => return Some(LAST + LAST_WORDS * last + usize::from(word)),
        Place::Constant(_) | Place::OutFrame(_) | Place::OutRecord(_) => return None,
    };
    Some(PAGE * page + usize::from(word))
}
