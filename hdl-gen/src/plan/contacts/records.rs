//! The program that makes the words of several bodies of the headers of the core's answers: `sptfra_records` executes it, and
//! so does the model. It is the same for every design; what a design decides are its [`Constants`].

use golden::bodies::MOST;
use golden::design::Design;
use golden::solver::{CHANGE, REACH};

use crate::plan::words;

pub use super::instructions::{FRAME, INSTRUCTION_BITS, Instruction, Place, What, run};

pub use crate::plan::words::RECORD_WORDS;
/// Words 2 and 3 of the round before, in a body's page.
pub const BEFORE: u8 = 14;
/// What a body's page holds in words that its record has no use for: what is felt of the others,
const FELT: u8 = 9;
/// where it acts, along x and y,
const CENTRE: u8 = 10;
/// and its standard error with what is not known of the others.
const ERROR: u8 = 13;
/// On the scratch page: sums of forces and torques as in the frame's words, of the errors' squares, and what is between.
const ERRORS: u8 = 8;
const FIRST: u8 = 9;
const SECOND: u8 = 10;
use Place::{Constant, Frame, I, J, OutFrame, OutRecord, Scratch};

const ZERO: Place = Constant(0);
const ONE: Place = Constant(1);
const CHANGE_SQUARED: Place = Constant(2);
const MIDDLE: u8 = 3;
const NEARNESS: Place = Constant(5);
const LIMIT: Place = Constant(6);

/// Cycles from start to done with so many bodies kept.
pub fn cycles(kept: usize) -> u64 {
    run(&program(), kept as u8, |_, _, _, _| ())
}

/// The words of the ROM.
pub fn rom() -> Vec<u32> {
    program().into_iter().map(Instruction::bits).collect()
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
}

impl Constants {
    /// Those of a design.
    pub fn of(design: &Design) -> Self {
        let sensor = &design.sensor;
        let middle = sensor.position_m(sensor.taxels() - 1).map(|last| (0.5 * last) as f32);
        let [x, y] = sensor.pitch_mm;
        let reach = 1e-3 * REACH * x.max(y);
        Self { middle, nearness: (1.0 / (reach * reach)) as f32, limit: design.algorithm.joint.doubt as f32 }
    }

    /// All constants, as places number them.
    pub fn words(&self) -> [u32; 7] {
        let [x, y] = self.middle;
        [0.0, 1.0, (CHANGE * CHANGE) as f32, x, y, self.nearness, self.limit].map(f32::to_bits)
    }
}

/// The program under way.
#[derive(Default)]
struct Writer(Vec<Instruction>);

impl Writer {
    fn here(&self) -> u8 {
        self.0.len() as u8
    }

    fn push(&mut self, what: What, to: Place, a: Place, b: Place) {
        self.0.push(Instruction::Do { what, to, a, b, magnitude: false });
    }

    fn push_with_magnitude(&mut self, what: What, to: Place, a: Place, b: Place) {
        self.0.push(Instruction::Do { what, to, a, b, magnitude: true });
    }

    fn take(&mut self, to: Place, from: Place) {
        self.push(What::Move, to, from, from);
    }

    /// A jump to a place that comes later.
    fn jump_on(&mut self, fewer: u8) -> usize {
        self.0.push(Instruction::Jump { fewer, target: 0 });
        self.0.len() - 1
    }

    fn land(&mut self, jump: usize) {
        if let Instruction::Jump { fewer, .. } = self.0[jump] {
            self.0[jump] = Instruction::Jump { fewer, target: self.here() };
        }
    }

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

    /// Of body i's record what is not its centre; with more to its status if `doubt` has found so.
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
        self.0.push(Instruction::NextI { ahead: 1, target: body });
    }

    /// For each pair of bodies, what one feels of the other and which one comes first.
    fn pairs(&mut self) {
        const NORMAL: u8 = words::FORCE as u8 + 2;
        let outer = self.here();
        self.0.push(Instruction::Pair);
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
        self.0.push(Instruction::NextJ { target: inner });
        self.0.push(Instruction::NextI { ahead: 2, target: outer });
    }

    /// The standard error of each body, and its record.
    fn bodies(&mut self) {
        const FORCE: u8 = words::FORCE as u8;
        const OWN: Place = I(words::STANDARD_ERROR as u8);
        let sum = Scratch(FIRST);
        let body = self.here();
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
        self.push(What::Doubt, sum, sum, I(ERROR));
        self.push(What::Multiply, sum, I(ERROR), I(ERROR));
        self.push(What::Add, Scratch(ERRORS), Scratch(ERRORS), sum);
        self.take(OutRecord(1), I(CENTRE));
        self.take(OutRecord(2), I(CENTRE + 1));
        self.record(I(ERROR));
        self.0.push(Instruction::NextI { ahead: 1, target: body });
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
pub fn program() -> Vec<Instruction> {
    const STATUS: u8 = words::STATUS as u8;
    const CENSUS: u8 = words::CENSUS as u8;
    let mut writer = Writer::default();
    let kept = (0..words::SUMMARY_WORDS as u8).filter(|&word| word != STATUS && word != CENSUS);
    kept.for_each(|word| writer.take(OutFrame(word), Frame(word)));
    let none = writer.jump_on(1);
    let one = writer.jump_on(2);
    writer.sums();
    writer.pairs();
    writer.bodies();
    writer.sum_up();
    let end = writer.here();
    writer.push(What::FrameStatus, OutFrame(STATUS), Frame(STATUS), ZERO);
    writer.push(What::Census, OutFrame(CENSUS), Frame(CENSUS), ZERO);
    writer.0.push(Instruction::End);
    // Body i is the frame.
    writer.land(one);
    writer.centre(OutRecord, 1);
    writer.record(I(words::STANDARD_ERROR as u8));
    // Always: no more than eight are kept.
    writer.0.push(Instruction::Jump { fewer: MOST as u8 + 1, target: end });
    writer.land(none);
    writer.take(OutFrame(STATUS), Frame(STATUS));
    writer.take(OutFrame(CENSUS), Frame(CENSUS));
    writer.0.push(Instruction::End);
    writer.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each word of a record once for each body kept, and no place outside a page.
    #[test]
    fn every_word_is_written() {
        for kept in 0..=MOST as u8 {
            let mut records = vec![[0; RECORD_WORDS]; kept.into()];
            let mut frame = [0; words::SUMMARY_WORDS];
            let mut pairs = 0;
            run(&program(), kept, |what, [to, ..], _, [i, _]| match to {
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
        let program = program();
        assert!(program.len() <= 128 && rom().iter().all(|&word| word < 1 << INSTRUCTION_BITS));
        for instruction in &program {
            match *instruction {
                Instruction::Do { to, a, b, .. } => {
                    assert!(!matches!(to, Constant(_) | Frame(_)), "{instruction:?}");
                    assert!(![a, b].iter().any(|of| matches!(of, OutFrame(_) | OutRecord(_))), "{instruction:?}");
                }
                Instruction::Jump { target, .. }
                | Instruction::NextI { target, .. }
                | Instruction::NextJ { target } => {
                    assert!(usize::from(target) < program.len(), "{instruction:?}");
                }
                Instruction::Pair | Instruction::End => {}
            }
        }
    }

    /// What is moved is written while the next instruction reads its first source.
    #[test]
    fn what_is_moved_is_not_read_at_once() {
        for kept in 0..=MOST as u8 {
            let mut last = None;
            run(&program(), kept, |what, [to, a, _], _, bodies| {
                assert_ne!(last, Some((a, bodies)), "{kept}");
                let moves =
                    matches!(what, What::Move | What::OwnStatus | What::FrameStatus | What::Census | What::Choose);
                last = moves.then_some((to, bodies));
            });
        }
    }

    #[test]
    fn a_program_is_the_same_each_time_and_its_bits_tell_instructions_apart() {
        let (program, rom) = (program(), rom());
        for (one, bits) in program.iter().zip(&rom) {
            for (other, others) in program.iter().zip(&rom) {
                assert_eq!(one == other, bits == others, "{one:?} {other:?}");
            }
        }
    }
}
