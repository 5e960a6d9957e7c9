//! The program that makes the words of several bodies of the headers of the core's answers: `sptfra_records` executes it, and
//! so does the model. Designs with a limit of slip have one of their own; all else that a design decides are its [`Constants`].

use golden::design::{Design, Slip};
use golden::solver::{CHANGE, REACH};

use crate::plan::words;

use super::writer::Writer;

pub use super::instructions::{FRAME, INSTRUCTION_BITS, Instruction, Place, What, run};

pub use crate::plan::words::RECORD_WORDS;
/// Words 2 and 3 of the round before, in a body's page.
pub const BEFORE: u8 = 14;
/// What a body's page holds in words that its record has no use for: what is felt of the others,
const FELT: u8 = 9;
/// where it acts, along x and y,
const CENTRE: u8 = 10;
/// and its standard error with what is not known of the others;
const ERROR: u8 = 13;
/// where bodies slip, its limit of friction in the next frame, in the word of the timestamp, which the output adds.
const RELEASE: u8 = 1;
/// What is kept of each body for the next frame: where it acts, along x and y, and its limit of friction there.
const LAST_CENTRE: u8 = 0;
const LAST_LIMIT: u8 = 2;
/// On the scratch page: sums of forces and torques as in the frame's words, of the errors' squares, and what is between.
const ERRORS: u8 = 8;
const FIRST: u8 = 9;
const SECOND: u8 = 10;
/// Of the bodies of the last frame the square of the distance to the nearest, and its limit.
const NEAREST: u8 = 11;
const NEAREST_LIMIT: u8 = 12;
use Place::{Constant, Frame, I, J, Last, OutFrame, OutRecord, Scratch};

const ZERO: Place = Constant(0);
const ONE: Place = Constant(1);
const CHANGE_SQUARED: Place = Constant(2);
const MIDDLE: u8 = 3;
const NEARNESS: Place = Constant(5);
const LIMIT: Place = Constant(6);
const FAR: Place = Constant(7);
const SLIPS_FROM: Place = Constant(8);
const SLIPS_STILL: Place = Constant(9);

/// Which program a design has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    /// Records.
    pub contacts: usize,
    /// Whether the status of a body says that it slips.
    pub slips: bool,
}

impl Program {
    /// That of a design.
    pub fn of(design: &Design) -> Self {
        Self { contacts: design.algorithm.contacts, slips: design.algorithm.slip.is_some() }
    }

    /// Its instructions, the same for any number of records.
    pub fn instructions(self) -> Vec<Instruction> {
        program(self.slips)
    }

    /// The words of the ROM.
    pub fn rom(self) -> Vec<u32> {
        self.instructions().into_iter().map(Instruction::bits).collect()
    }

    /// Cycles from start to done with so many bodies kept.
    pub fn cycles(self, kept: usize) -> u64 {
        run(&self.instructions(), [kept as u8, self.contacts as u8], |_, _, _, _| ())
    }
}

/// What a design decides of the records, float32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constants {
    /// The grid's middle from the first taxel, in metres.
    pub middle: [f32; 2],
    /// 1 over the square of the length within which bodies feel each other, in 1/m^2.
    pub nearness: f32,
    /// A body is doubtful whose standard error is above so many `|F_z|`.
    pub limit: f32,
    /// Friction from which on a body slips, and at which it still does if it did in the last frame.
    pub slip: Option<[f32; 2]>,
}

impl Constants {
    /// Those of a design.
    pub fn of(design: &Design) -> Self {
        let sensor = &design.sensor;
        let middle = sensor.position_m(sensor.taxels() - 1).map(|last| (0.5 * last) as f32);
        let [x, y] = sensor.pitch_mm;
        let reach = 1e-3 * REACH * x.max(y);
        let slip =
            design.algorithm.slip.map(|Slip { limit, hysteresis }| [limit, limit - hysteresis].map(|of| of as f32));
        Self { middle, nearness: (1.0 / (reach * reach)) as f32, limit: design.algorithm.joint.doubt as f32, slip }
    }

    /// All constants, as places number them.
    pub fn words(&self) -> [u32; 10] {
        let [x, y] = self.middle;
        let [from, still] = self.slip.unwrap_or_default();
        [0.0, 1.0, (CHANGE * CHANGE) as f32, x, y, self.nearness, self.limit, f32::MAX, from, still].map(f32::to_bits)
    }
}

impl Writer {
    /// `to^2 = a^2 + b^2`, in the first scratch word; the second one is used.
    fn squares(&mut self, a: Place, b: Place) {
        self.push(What::Multiply, Scratch(FIRST), a, a);
        self.push(What::Multiply, Scratch(SECOND), b, b);
        self.push(What::Add, Scratch(FIRST), Scratch(FIRST), Scratch(SECOND));
    }

    /// Where body i acts: `middle - T_y / F_z` and `middle + T_x / F_z`.
    fn centre(&mut self, to: fn(u8) -> Place, first: u8) {
        const NORMAL: u8 = words::FORCE as u8 + 2;
        const TORQUE: u8 = words::TORQUE as u8;
        self.push(What::Divide, Scratch(FIRST), ONE, I(NORMAL));
        self.push(What::Multiply, Scratch(SECOND), I(TORQUE + 1), Scratch(FIRST));
        self.push(What::Subtract, to(first), Constant(MIDDLE), Scratch(SECOND));
        self.push(What::Multiply, Scratch(SECOND), I(TORQUE), Scratch(FIRST));
        self.push(What::Add, to(first + 1), Constant(MIDDLE + 1), Scratch(SECOND));
    }

    /// Of body i's record what is not its centre; it is doubtful if the last comparison found less.
    fn record(&mut self, error: Place) {
        const FORCE: u8 = words::FORCE as u8;
        self.push(What::OwnStatus, OutRecord(0), I(words::STATUS as u8), ZERO);
        for axis in 0..3 {
            self.take(OutRecord(3 + axis), I(FORCE + axis));
        }
        self.take(OutRecord(6), I(words::MU as u8));
        self.take(OutRecord(7), error);
    }

    /// Centres and sums of all bodies.
    fn sums(&mut self) {
        const FIRST_SUM: u8 = words::FORCE as u8;
        (FIRST_SUM..FIRST_SUM + 6).chain([ERRORS]).for_each(|word| self.take(Scratch(word), ZERO));
        let body = self.here();
        self.take(I(FELT), ZERO);
        self.centre(I, CENTRE);
        (FIRST_SUM..FIRST_SUM + 6).for_each(|word| self.push(What::Add, Scratch(word), Scratch(word), I(word)));
        self.add(Instruction::NextI { ahead: 1, target: body });
    }

    /// For each pair of bodies, what one feels of the other and which one comes first.
    fn pairs(&mut self) {
        const NORMAL: u8 = words::FORCE as u8 + 2;
        let outer = self.here();
        self.add(Instruction::Pair);
        let inner = self.here();
        let near = Scratch(FIRST);
        self.push(What::Subtract, Scratch(FIRST), I(CENTRE), J(CENTRE));
        self.push(What::Subtract, Scratch(SECOND), I(CENTRE + 1), J(CENTRE + 1));
        self.squares(Scratch(FIRST), Scratch(SECOND));
        self.push(What::Multiply, near, near, NEARNESS);
        self.push(What::Multiply, near, near, near);
        self.push(What::Add, near, near, ONE);
        self.push(What::Divide, near, ONE, near);
        self.push_with_magnitude(What::Multiply, Scratch(SECOND), near, J(NORMAL));
        self.push(What::Add, I(FELT), I(FELT), Scratch(SECOND));
        self.push_with_magnitude(What::Multiply, Scratch(SECOND), near, I(NORMAL));
        self.push(What::Add, J(FELT), J(FELT), Scratch(SECOND));
        self.push(What::Rank, Scratch(SECOND), I(NORMAL), J(NORMAL));
        self.add(Instruction::NextJ { target: inner });
        self.add(Instruction::NextI { ahead: 2, target: outer });
    }

    /// Whether body i slips: its friction against the limit of the body that was nearest in the last frame. Ends with the limit
    /// that is its own in the next one.
    fn slip(&mut self) {
        self.take(Scratch(NEAREST), FAR);
        self.take(Scratch(NEAREST_LIMIT), SLIPS_FROM);
        self.add(Instruction::FirstLast);
        let last = self.here();
        self.push(What::Subtract, Scratch(FIRST), I(CENTRE), Last(LAST_CENTRE));
        self.push(What::Subtract, Scratch(SECOND), I(CENTRE + 1), Last(LAST_CENTRE + 1));
        self.squares(Scratch(FIRST), Scratch(SECOND));
        self.push(What::Less, Scratch(FIRST), Scratch(FIRST), Scratch(NEAREST));
        self.push(What::Nearer, Scratch(NEAREST), Scratch(FIRST), ZERO);
        self.push(What::Nearer, Scratch(NEAREST_LIMIT), Last(LAST_LIMIT), ZERO);
        self.add(Instruction::NextLast { target: last });
        self.push(What::Less, Scratch(FIRST), I(words::MU as u8), Scratch(NEAREST_LIMIT));
        self.take(I(RELEASE), SLIPS_STILL);
        self.push(What::Slip, I(RELEASE), SLIPS_FROM, ZERO);
    }

    /// Keeps of each body what the next frame asks.
    fn remember(&mut self) {
        let body = self.here();
        for (word, of) in [(LAST_CENTRE, CENTRE), (LAST_CENTRE + 1, CENTRE + 1), (LAST_LIMIT, RELEASE)] {
            self.take(Last(word), I(of));
        }
        self.add(Instruction::NextI { ahead: 1, target: body });
        self.forget();
    }

    /// The bodies of the last frame are those of this one.
    fn forget(&mut self) {
        self.push(What::Remember, Scratch(FIRST), Frame(words::STATUS as u8), ZERO);
    }

    /// Whether each body slips, its standard error, and its record. Where it can slip, so that an only body's record is begun
    /// here, too: the first result is where, the second one the jump back.
    fn bodies(&mut self, slips: bool) -> (u8, Option<usize>) {
        const FORCE: u8 = words::FORCE as u8;
        const OWN: Place = I(words::STANDARD_ERROR as u8);
        let sum = Scratch(FIRST);
        let body = self.here();
        let only = slips.then(|| {
            self.slip();
            self.jump_on(2)
        });
        self.push(What::Subtract, Scratch(FIRST), I(FORCE), I(BEFORE));
        self.push(What::Subtract, Scratch(SECOND), I(FORCE + 1), I(BEFORE + 1));
        self.squares(Scratch(FIRST), Scratch(SECOND));
        self.push(What::Multiply, sum, sum, CHANGE_SQUARED);
        for part in [OWN, I(FELT)] {
            self.push(What::Multiply, Scratch(SECOND), part, part);
            self.push(What::Add, sum, sum, Scratch(SECOND));
        }
        self.push(What::Root, sum, sum, ZERO);
        self.push(What::Choose, I(ERROR), OWN, sum);
        self.push_with_magnitude(What::Multiply, sum, LIMIT, I(FORCE + 2));
        self.push(What::Less, sum, sum, I(ERROR));
        self.push(What::Multiply, sum, I(ERROR), I(ERROR));
        self.push(What::Add, Scratch(ERRORS), Scratch(ERRORS), sum);
        self.centre_found();
        self.record(I(ERROR));
        self.add(Instruction::NextI { ahead: 1, target: body });
        (body, only)
    }

    /// Of body i's record the centre.
    fn centre_found(&mut self) {
        self.take(OutRecord(1), I(CENTRE));
        self.take(OutRecord(2), I(CENTRE + 1));
    }

    /// What follows from the sums.
    fn sum_up(&mut self) {
        const FORCE: u8 = words::FORCE as u8;
        const MU: u8 = words::MU as u8;
        const MU_XY: u8 = words::MU_XY as u8;
        (FORCE..FORCE + 6).for_each(|word| self.take(OutFrame(word), Scratch(word)));
        let (x, y) = (Scratch(FORCE), Scratch(FORCE + 1));
        self.squares(x, y);
        self.push(What::Root, Scratch(FIRST), Scratch(FIRST), ZERO);
        self.push_with_magnitude(What::Divide, Scratch(SECOND), ONE, Scratch(FORCE + 2));
        self.push(What::Multiply, OutFrame(MU), Scratch(FIRST), Scratch(SECOND));
        self.push(What::Angle, OutFrame(MU + 1), x, y);
        self.push(What::Multiply, OutFrame(MU_XY), x, Scratch(SECOND));
        self.push(What::Multiply, OutFrame(MU_XY + 1), y, Scratch(SECOND));
        self.push(What::Root, OutFrame(words::STANDARD_ERROR as u8), Scratch(ERRORS), ZERO);
    }
}

/// The program, the same for any number of bodies.
fn program(slips: bool) -> Vec<Instruction> {
    const STATUS: u8 = words::STATUS as u8;
    const CENSUS: u8 = words::CENSUS as u8;
    const ERROR_OF_ONE: Place = I(words::STANDARD_ERROR as u8);
    let mut writer = Writer::default();
    let kept = (0..words::SUMMARY_WORDS as u8).filter(|&word| word != STATUS && word != CENSUS);
    kept.for_each(|word| writer.take(OutFrame(word), Frame(word)));
    let none = writer.jump_on(1);
    let one = writer.jump_on(2);
    writer.sums();
    writer.pairs();
    let (body, only) = writer.bodies(slips);
    writer.sum_up();
    let end = writer.here();
    if slips {
        writer.remember();
    }
    writer.push(What::FrameStatus, OutFrame(STATUS), Frame(STATUS), ZERO);
    writer.push(What::Census, OutFrame(CENSUS), Frame(CENSUS), ZERO);
    writer.end();
    // Body i is the frame.
    writer.land(one);
    if let Some(only) = only {
        writer.centre(I, CENTRE);
        writer.jump(body);
        writer.land(only);
        writer.centre_found();
    } else {
        writer.centre(OutRecord, 1);
    }
    writer.record(ERROR_OF_ONE);
    writer.jump(end);
    writer.land(none);
    if slips {
        writer.forget();
    }
    writer.take(OutFrame(STATUS), Frame(STATUS));
    writer.take(OutFrame(CENSUS), Frame(CENSUS));
    writer.end();
    writer.finish()
}

#[cfg(test)]
mod tests {
    use golden::bodies::MOST;

    use super::*;

    /// Any number of bodies kept of any number of records, with slip and without.
    fn runs() -> impl Iterator<Item = (bool, [u8; 2])> {
        const ALL: u8 = MOST as u8;
        let counts = (2..=ALL).flat_map(|contacts| (0..=contacts).map(move |kept| [kept, contacts]));
        counts.flat_map(|counts| [false, true].map(|slips| (slips, counts)))
    }

    /// Each word of a record once for each body kept, and no place outside a page.
    #[test]
    fn every_word_is_written() {
        for (slips, [kept, contacts]) in runs() {
            let mut records = vec![[0; RECORD_WORDS]; kept.into()];
            let mut frame = [0; words::SUMMARY_WORDS];
            let mut pairs = 0;
            run(&program(slips), [kept, contacts], |what, [to, ..], _, [i, _]| match to {
                OutRecord(word) => records[usize::from(i % FRAME)][usize::from(word)] += 1,
                OutFrame(word) => frame[usize::from(word)] += 1,
                _ => pairs += usize::from(what == What::Rank),
            });
            assert!(records.iter().flatten().all(|&times| times == 1), "{kept}: {records:?}");
            assert!(frame.iter().all(|times| (1..=2).contains(times)), "{kept}: {frame:?}");
            assert_eq!(pairs, usize::from(kept) * usize::from(kept.saturating_sub(1)) / 2, "{kept}");
        }
    }

    #[test]
    fn instructions_have_room() {
        let [without, program] = [false, true].map(program);
        // A place in the ROM has 8 bits.
        assert!(without.len() < program.len() && program.len() <= 256);
        for instruction in without.iter().chain(&program) {
            assert!(instruction.bits() < 1 << INSTRUCTION_BITS, "{instruction:?}");
            match *instruction {
                Instruction::Do { to, a, b, .. } => {
                    assert!(!matches!(to, Constant(_) | Frame(_)), "{instruction:?}");
                    assert!(![a, b].iter().any(|of| matches!(of, OutFrame(_) | OutRecord(_))), "{instruction:?}");
                }
                Instruction::Jump { target, .. }
                | Instruction::NextI { target, .. }
                | Instruction::NextJ { target }
                | Instruction::NextLast { target } => {
                    assert!(usize::from(target) < program.len(), "{instruction:?}");
                }
                Instruction::Pair | Instruction::FirstLast | Instruction::End => {}
            }
        }
    }

    /// What is moved is written while the next instruction reads its first source.
    #[test]
    fn what_is_moved_is_not_read_at_once() {
        for (slips, counts) in runs() {
            let mut last = None;
            run(&program(slips), counts, |what, [to, a, _], _, bodies| {
                assert_ne!(last, Some((a, bodies)), "{counts:?}");
                let moves = what.bits() < What::Add.bits();
                last = moves.then_some((to, bodies));
            });
        }
    }

    #[test]
    fn a_program_is_the_same_each_time_and_its_bits_tell_instructions_apart() {
        let program = Program { contacts: 4, slips: true };
        let (program, rom) = (program.instructions(), program.rom());
        for (one, bits) in program.iter().zip(&rom) {
            for (other, others) in program.iter().zip(&rom) {
                assert_eq!(one == other, bits == others, "{one:?} {other:?}");
            }
        }
    }
}
