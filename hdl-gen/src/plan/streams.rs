//! The two streams of a core: how samples and words fill their beats.

use golden::design::{Design, Outputs, PlanKind};

use super::SUMMARY_WORDS;

/// Bits of a word of the output, and of memory.
pub const WORD_BITS: usize = 32;
/// Bits of a sample.
const SAMPLE_BITS: usize = 32;

/// How the samples of a beat get to the lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Intake {
    /// A beat is a sample.
    Single,
    /// A beat's samples are handed on one by one: where taxels are not folded, or dead ones are replaced.
    Unpacked,
    /// All samples of a beat at once.
    Whole,
}

/// The shape of both streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Streams {
    /// Bits of a beat.
    pub bits: usize,
    /// Bits of a sample.
    pub sample_bits: usize,
    /// Words of every output frame: 16, and for the field 3 m more.
    pub words_out: usize,
    /// How samples get to the lanes.
    pub intake: Intake,
    taxels: usize,
}

impl Streams {
    /// Those of a design.
    pub fn of(design: &Design) -> Self {
        let taxels = design.sensor.taxels();
        let field = match design.algorithm.outputs {
            Outputs::Field => 3 * taxels,
            Outputs::Resultants => 0,
        };
        let bits = design.hardware.stream_bits as usize;
        let intake = if bits == SAMPLE_BITS {
            Intake::Single
        } else if design.algorithm.plan == PlanKind::Paper || !design.input.dead.is_empty() {
            Intake::Unpacked
        } else {
            Intake::Whole
        };
        Self { bits, sample_bits: SAMPLE_BITS, words_out: SUMMARY_WORDS + field, intake, taxels }
    }

    /// Words of a beat.
    pub fn words(self) -> usize {
        self.bits / WORD_BITS
    }

    /// Samples of a beat.
    pub fn samples(self) -> usize {
        self.bits / self.sample_bits
    }

    /// Samples that are converted at a time.
    pub fn conversions(self) -> usize {
        if self.intake == Intake::Whole { self.samples() } else { 1 }
    }

    /// Words of an input frame as it lies in memory, the last filled with zeros.
    pub fn words_in(self) -> usize {
        (self.taxels * self.sample_bits).div_ceil(WORD_BITS)
    }

    /// Words of the beats that so many words fill, the last one with zeros.
    pub fn whole_beats(self, words: usize) -> usize {
        words.next_multiple_of(self.words())
    }

    /// Whether a packet of so many words has the beats of a frame.
    pub fn is_frame(self, words: usize) -> bool {
        words.div_ceil(self.words()) == self.beats_in()
    }

    /// Beats of an input frame.
    pub fn beats_in(self) -> usize {
        self.taxels.div_ceil(self.samples())
    }

    /// Beats of an output frame.
    pub fn beats_out(self) -> usize {
        self.words_out.div_ceil(self.words())
    }

    /// TKEEP of the last beat out: a bit for each byte that counts.
    pub fn last_keep(self) -> u32 {
        let words = self.words_out - (self.beats_out() - 1) * self.words();
        (1 << (words * WORD_BITS / 8)) - 1
    }
}
