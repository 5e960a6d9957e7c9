//! What the processor beside a core does to its banks at a time, and what is wrong with that.

use super::log::What;

/// Bits of `CALIBRATION_ERRORS`.
const OUT_OF_RANGE: u32 = 1;
const BUSY: u32 = 1 << 1;
const WRONG_CRC: u32 = 1 << 2;
const NOT_AT_REST: u32 = 1 << 3;
const BAD_FRAME: u32 = 1 << 4;
const CONTRADICTION: u32 = 1 << 5;
/// What a tare can end with.
pub const TARE_ERRORS: u32 = OUT_OF_RANGE | NOT_AT_REST | BAD_FRAME;

/// What is wrong with a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Nothing.
    Nothing,
    /// The commit states another CRC.
    Crc,
    /// Not all of its words are written.
    Half,
    /// Then a word that is out of bounds is written, too.
    Word,
    /// Its words do not go together.
    Contradiction,
    /// A write comes right behind the commit.
    Early,
}

impl Fault {
    /// The error that must be there.
    pub fn error(self) -> u32 {
        match self {
            Self::Nothing => 0,
            Self::Crc | Self::Half => WRONG_CRC,
            Self::Word => OUT_OF_RANGE,
            Self::Contradiction => CONTRADICTION,
            Self::Early => BUSY,
        }
    }

    /// Whether the bank must not act.
    pub fn refuses(self) -> bool {
        matches!(self, Self::Crc | Self::Half | Self::Contradiction)
    }
}

/// What is under way.
pub struct Job {
    /// What it makes act.
    pub what: What,
    /// What is wrong with it.
    pub fault: Fault,
    /// A reset came: what it had done by then may or may not have happened, and errors are forgotten.
    pub interrupted: bool,
    /// What acts once it is over.
    pub version: u8,
    /// What was refused by then.
    pub errors: u32,
    /// When the core was seen to be no longer busy.
    pub over: u64,
}

impl Job {
    /// Before its first access.
    pub fn new(what: What, fault: Fault) -> Self {
        Self { what, fault, interrupted: false, version: 0, errors: 0, over: 0 }
    }
}
