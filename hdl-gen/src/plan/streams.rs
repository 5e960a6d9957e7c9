//! The two streams of a core: how samples and words fill their beats.

use golden::design::{CalibrationIn, Design, Outputs, Overrun, PlanKind, Samples};

use super::SUMMARY_WORDS;

/// Bits of a word of the output, and of memory.
pub const WORD_BITS: usize = 32;
/// How the samples of a beat get to the lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Intake {
    /// A beat is a sample.
    Single,
    /// A beat's samples are handed on one by one. So it is where taxels are not folded, dead ones are replaced,
    /// crosstalk or creep is removed, or gains stand in RAM.
    Unpacked,
    /// All samples of a beat at once.
    Whole,
}

/// The shape of both streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Streams {
    /// Bits of a beat.
    pub bits: usize,
    /// What a sample is.
    pub sample: Samples,
    /// Its bits.
    pub sample_bits: usize,
    /// Words of every output frame: 16, and for the field 3 m more.
    pub words_out: usize,
    /// How samples get to the lanes.
    pub intake: Intake,
    /// Whether a frame that finds no room is dropped, and the source never held.
    pub drops: bool,
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
        let words_out = SUMMARY_WORDS + field;
        let sample = design.hardware.samples;
        let [bits, sample_bits] = [design.hardware.stream_bits, sample.bits()].map(|bits| bits as usize);
        let intake = if bits == sample_bits {
            Intake::Single
        } else if design.algorithm.plan == PlanKind::Paper
            || !design.input.dead.is_empty()
            || design.input.crosstalk > 0.0
            || design.input.creep.is_some()
            || design.hardware.calibration == CalibrationIn::Ram
        {
            Intake::Unpacked
        } else {
            Intake::Whole
        };
        let drops = design.hardware.overrun == Overrun::Drop;
        Self { bits, sample, sample_bits, words_out, intake, drops, taxels }
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

    /// The packet of a frame, as it lies in memory; values that no sample can be take the nearest.
    pub fn packet(self, values: &[f64]) -> Vec<u32> {
        let sample = |value: f64| match self.sample {
            Samples::Float32 => (value as f32).to_bits(),
            Samples::Int16 => u32::from((value.round() as i16).cast_unsigned()),
            Samples::Uint16 => u32::from(value.round() as u16),
        };
        let packed = |values: &[f64]| {
            values
                .iter()
                .rev()
                .fold(0, |word: u32, &value| word.checked_shl(self.sample_bits as u32).unwrap_or(0) | sample(value))
        };
        values.chunks(WORD_BITS / self.sample_bits).map(packed).collect()
    }

    /// The samples of words in memory's order, as float32.
    pub fn samples_of(self, words: impl IntoIterator<Item = u32>) -> impl Iterator<Item = u32> {
        let step = self.sample_bits as u32;
        words.into_iter().flat_map(move |word| {
            (0..WORD_BITS as u32 / step).map(move |place| {
                let bits = word >> (step * place);
                match self.sample {
                    Samples::Float32 => bits,
                    Samples::Int16 => f32::from((bits as u16).cast_signed()).to_bits(),
                    Samples::Uint16 => f32::from(bits as u16).to_bits(),
                }
            })
        })
    }

    /// The values of a frame as a packet brings them.
    pub fn received(self, packet: &[u32]) -> Vec<f64> {
        let samples = self.samples_of(packet.iter().copied()).take(self.taxels);
        samples.map(|bits| f64::from(f32::from_bits(bits))).collect()
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
