//! The instructions of `sptfra_records_control`: what they are, their bits, their cycles and their order.

use golden::bodies::MOST;

/// The body whose words are the frame's, as solved in one piece.
pub const FRAME: u8 = MOST as u8;
/// Bits of an instruction.
pub const INSTRUCTION_BITS: u32 = 27;

/// Where a word stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the page of body i, or of body j.
    I(u8),
    /// See `I`.
    J(u8),
    /// In that of the frame as solved in one piece.
    Frame(u8),
    /// Between.
    Scratch(u8),
    /// One of [`Constants::words`].
    Constant(u8),
    /// Among the results: before the records,
    OutFrame(u8),
    /// and in the record of body i.
    OutRecord(u8),
    /// What is kept for the next frame: a source of what body j left, a destination for body i. The numbers of bodies are
    /// those of their frame.
    Last(u8),
}

impl Place {
    fn bits(self) -> u32 {
        let (place, word) = match self {
            Self::I(word) => (0, word),
            Self::J(word) => (1, word),
            Self::Frame(word) => (2, word),
            Self::Scratch(word) => (3, word),
            Self::Constant(word) => (4, word),
            Self::OutFrame(word) => (5, word),
            Self::OutRecord(word) => (6, word),
            Self::Last(word) => (7, word),
        };
        place << 4 | u32::from(word)
    }
}

/// What is done with two sources, `a` and `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// `a` as it is.
    Move,
    /// A record's first word, of the status in `a`.
    OwnStatus,
    /// The frame's first word, of that in `a`.
    FrameStatus,
    /// `a` with the number of bodies.
    Census,
    /// `b` where `a` is above 0, else 0.
    Choose,
    /// `a` where the last comparison found less, of a body j that was in the last frame; else nothing is written.
    Nearer,
    /// Body i slips unless the last comparison found less: then it does not, and `a` is written. That comparison is forgotten.
    Slip,
    /// The bodies of this frame are the last ones, unless the status in `a` is that of one which tells nothing.
    Remember,
    /// `a + b`,
    Add,
    /// `a - b`,
    Subtract,
    /// `a b`,
    Multiply,
    /// `a / b`, 0 where `b` is 0,
    Divide,
    /// the root of `a`,
    Root,
    /// and the angle of `(a, b)`.
    Angle,
    /// Compares: `|a| < |b|`. If so where its record's status is made, body i is doubtful.
    Less,
    /// Body i comes behind body j if `|a| < |b|`, else j behind i.
    Rank,
}

impl What {
    pub(super) fn bits(self) -> u32 {
        match self {
            Self::Move => 0,
            Self::OwnStatus => 1,
            Self::FrameStatus => 2,
            Self::Census => 3,
            Self::Choose => 4,
            Self::Nearer => 5,
            Self::Slip => 6,
            Self::Remember => 7,
            Self::Add => 8,
            Self::Subtract => 9,
            Self::Multiply => 10,
            Self::Divide => 11,
            Self::Root => 12,
            Self::Angle => 13,
            Self::Less => 14,
            Self::Rank => 15,
        }
    }

    /// Cycles of an instruction: to read the sources, of the unit (`sptfra_float_unit`), to write.
    fn cycles(self) -> u64 {
        const READ: u64 = 3;
        match self {
            Self::Move
            | Self::OwnStatus
            | Self::FrameStatus
            | Self::Census
            | Self::Nearer
            | Self::Slip
            | Self::Remember => 2,
            Self::Choose => READ,
            Self::Add | Self::Subtract | Self::Multiply => READ + 9,
            Self::Divide => READ + 33,
            Self::Root => READ + 32,
            Self::Angle => READ + 73,
            Self::Less | Self::Rank => READ + 2,
        }
    }
}

/// One step of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instruction {
    /// Puts what is done with two sources in its place.
    Do {
        /// What is done.
        what: What,
        /// Where it goes.
        to: Place,
        /// First source.
        a: Place,
        /// Second source,
        b: Place,
        /// without its sign.
        magnitude: bool,
    },
    /// Goes on elsewhere if few bodies are kept,
    Jump {
        /// fewer than so many.
        fewer: u8,
        /// Where.
        target: u8,
    },
    /// Goes on elsewhere with the next body i if there is body i + `ahead`; else i is 0.
    NextI {
        /// How far ahead.
        ahead: u8,
        /// Where.
        target: u8,
    },
    /// Goes on elsewhere with the next body j, if there is one.
    NextJ {
        /// Where.
        target: u8,
    },
    /// Body j is the one behind i.
    Pair,
    /// Body j is the first of the last frame.
    FirstLast,
    /// Goes on elsewhere with the next body j, up to as many as have a record.
    NextLast {
        /// Where.
        target: u8,
    },
    /// The words are there.
    End,
}

impl Instruction {
    /// Cycles that it takes.
    fn cycles(self) -> u64 {
        match self {
            Self::Do { what, .. } => what.cycles(),
            Self::End => 2,
            _ => 3,
        }
    }

    /// The word of the ROM.
    pub fn bits(self) -> u32 {
        // The highest bit of the target is above the number.
        let control = |what: u32, target: u8, number: u8| {
            let target = u32::from(target & 0x7F) << 15 | u32::from(target >> 7) << 14;
            (0b10_000 | what) << 22 | target | u32::from(number) << 8
        };
        match self {
            Self::Do { what, to, a, b, magnitude } => {
                what.bits() << 22 | to.bits() << 15 | a.bits() << 8 | b.bits() << 1 | u32::from(magnitude)
            }
            Self::Jump { fewer, target } => control(0, target, fewer),
            Self::NextI { ahead, target } => control(1, target, ahead),
            Self::NextJ { target } => control(2, target, 0),
            Self::Pair => control(3, 0, 0),
            Self::End => control(4, 0, 0),
            Self::FirstLast => control(5, 0, 0),
            Self::NextLast { target } => control(6, target, 0),
        }
    }
}

/// Executes instructions for so many bodies kept of those that have a record: `execute` is called with each that does something
/// and with bodies i and j. Says how many cycles pass from start to done.
pub fn run(
    program: &[Instruction],
    [kept, contacts]: [u8; 2],
    mut execute: impl FnMut(What, [Place; 3], bool, [u8; 2]),
) -> u64 {
    let (mut i, mut j, mut next) = (if kept == 1 { FRAME } else { 0 }, 0, 0);
    // The one in which it starts.
    let mut cycles = 1;
    loop {
        let instruction = program[next];
        next += 1;
        cycles += instruction.cycles();
        match instruction {
            Instruction::Do { what, to, a, b, magnitude } => {
                execute(what, [to, a, b], magnitude, [i, j]);
            }
            Instruction::Jump { fewer, target } if kept < fewer => next = target.into(),
            Instruction::NextI { ahead, target } if i + ahead < kept => (i, next) = (i + 1, target.into()),
            Instruction::NextI { .. } => i = 0,
            Instruction::NextJ { target } => {
                j += 1;
                if j < kept {
                    next = target.into();
                }
            }
            Instruction::Pair => j = i + 1,
            Instruction::FirstLast => j = 0,
            Instruction::NextLast { target } => {
                j += 1;
                if j < contacts {
                    next = target.into();
                }
            }
            Instruction::Jump { .. } => {}
            Instruction::End => return cycles,
        }
    }
}
