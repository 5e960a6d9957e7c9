//! The `[hardware]` table: choices that change only speed, size and rounding.

use serde::{Deserialize, Serialize};

use crate::words::print_as_words;

/// Largest number of `SpMV` lanes. A product of 10 x 10 taxels has work for 100 in the reduced plan, larger ones for more.
pub const MAX_LANES: usize = 128;
/// Key `hardware.full_scale_pa` when absent.
pub const DEFAULT_FULL_SCALE_PA: f64 = 100_000.0;

/// Widths of a beat on the streams, in bits.
pub const STREAM_BITS: [u32; 3] = [32, 64, 128];

/// Numbers of dead taxels for which a bank of a calibration can have room.
pub const REPLACEABLE: [usize; 5] = [0, 1, 2, 4, 8];

/// What the hardware spends its area on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Optimise {
    /// Frames a second.
    #[default]
    Interval,
    /// Time from the last value of a frame to its result; with the reduced plan.
    Latency,
    /// Nothing: as for the interval, but the joint estimator walks its grid with the fewest cells; with the reduced plan.
    Area,
}

/// What a sample on the stream is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Samples {
    /// IEEE 754, single precision: pascals or counts.
    #[default]
    Float32,
    /// A count of 16 bits in two's complement.
    Int16,
    /// A count of 16 bits from 0 on.
    Uint16,
}

impl Samples {
    /// Least and largest count of an integer sample.
    pub fn range(self) -> Option<[f64; 2]> {
        match self {
            Self::Float32 => None,
            Self::Int16 => Some([i16::MIN, i16::MAX].map(f64::from)),
            Self::Uint16 => Some([u16::MIN, u16::MAX].map(f64::from)),
        }
    }

    /// What to do about a value that is none of them.
    pub fn remedy(self) -> String {
        let [low, high] = self.range().unwrap_or([f64::from(f32::MIN), f64::from(f32::MAX)]);
        format!(
            "give whole numbers from {low} to {high}; if these are pascals, divide them by pa_per_count, or leave that out and \
             write samples = \"float32\""
        )
    }

    /// Bits of a sample.
    pub fn bits(self) -> u32 {
        if self.range().is_none() { 32 } else { 16 }
    }

    /// Whether a frame's value can be one.
    pub fn takes(self, value: f64) -> bool {
        self.range().is_none_or(|[low, high]| (low..=high).contains(&value) && value.fract() == 0.0)
    }

    /// The sample next to a value that is whole already.
    pub fn clip(self, value: f64) -> f64 {
        self.range().map_or(value, |[low, high]| value.clamp(low, high))
    }
}

/// Where gains, offsets and the contact threshold stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CalibrationIn {
    /// Fixed when the hardware is generated.
    #[default]
    Rom,
    /// In two banks of memory, written through the register bank while frames run.
    Ram,
}

/// Against what the hardware's numbers are scaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputRange {
    /// The full scale, every frame alike.
    #[default]
    FullScale,
    /// The largest stress of each frame.
    Frame,
}

/// What becomes of a frame for which the core has no room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Overrun {
    /// It waits: the source is held.
    #[default]
    Stall,
    /// It is dropped whole, and counted: the source is never held.
    Drop,
}

/// The `[hardware]` table.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardware {
    /// Width of matrix entries, 8 to 27 bits; beyond 18 a lane has two multipliers.
    pub coefficient_bits: u32,
    /// Width of vector entries, 16 to 35 bits; beyond 27 a lane has two multipliers.
    pub data_bits: u32,
    /// Largest stress magnitude in pascals; input of that and more is reported, and clamped.
    pub full_scale_pa: f64,
    /// Whether numbers are scaled against the full scale or against each frame's own largest stress.
    pub range: InputRange,
    /// `SpMV` lanes, 1 to [`MAX_LANES`]; with the reduced plan a multiple of 4. With a target time the generator
    /// chooses, and this is the default until then.
    pub lanes: usize,
    /// Time in microseconds a frame may take; with the reduced plan, in place of the lanes.
    pub target_us: Option<f64>,
    /// What the area is spent on.
    pub optimise: Optimise,
    /// Bits of a beat on both streams, one of [`STREAM_BITS`].
    pub stream_bits: u32,
    /// What a sample on the stream is; integers only with counts.
    pub samples: Samples,
    /// What becomes of a frame for which there is no room.
    pub overrun: Overrun,
    /// Whether the core has a register bank on AXI4-Lite.
    pub control: bool,
    /// Where the calibration stands; in RAM only with `control`, and with counts that `pa_per_count` makes pascals.
    pub calibration: CalibrationIn,
    /// Dead taxels that a bank of a calibration in RAM can have replaced, one of [`REPLACEABLE`]; 0: those of the design,
    /// for good.
    pub replaceable: usize,
    /// Whether nets are marked for a logic analyser in the FPGA.
    pub debug: bool,
    /// Clock in megahertz, 1 to 1000.
    pub clock_mhz: f64,
    /// FPGA part name.
    pub part: String,
}

impl Hardware {
    /// The largest float32 that is no more than the full scale, in pascals: a frame cannot bring more of it. From here
    /// on a stress counts as saturated.
    pub fn full_scale_in_frames(&self) -> f64 {
        let nearest = self.full_scale_pa as f32;
        f64::from(if f64::from(nearest) > self.full_scale_pa { nearest.next_down() } else { nearest })
    }
}

print_as_words!(InputRange, Optimise, Samples, Overrun, CalibrationIn);
