//! The `[hardware]` table: speed, size, rounding, range and interfaces of the core.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::words::print_as_words;

/// Largest number of `SpMV` lanes. A product of 10 x 10 taxels has work for 100 in the reduced plan, larger ones for more.
pub const MAX_LANES: usize = 128;
/// Key `hardware.full_scale_pa` when absent.
pub const DEFAULT_FULL_SCALE_PA: f64 = 100_000.0;

/// Widths of a beat on the streams, in bits.
pub const STREAM_BITS: [u32; 3] = [32, 64, 128];

/// What the hardware spends its area on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Optimise {
    /// Frames a second.
    #[default]
    Throughput,
    /// Time from the last value of a frame to its result; with the reduced plan.
    Latency,
    /// As throughput, but the grid search takes a row of points at a time; with the reduced plan.
    Area,
}

/// What a sample on the stream is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CalibrationIn {
    /// Fixed when the hardware is generated.
    #[default]
    Rom,
    /// In two banks of memory, written through the register bank while frames run.
    Ram,
}

/// How the hardware's numbers are scaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scaling {
    /// One scale for all frames, that of the full scale; a few cycles less.
    Fixed,
    /// Block floating point: each frame by its largest stress, so that weak contacts are as exact as strong ones.
    #[default]
    PerFrame,
}

/// What becomes of a frame for which the core has no room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Overrun {
    /// It waits: the source is held.
    #[default]
    Stall,
    /// It is dropped whole, and counted: the source is never held.
    Drop,
}

/// The hardware: speed, size and rounding of the core, its range, its interfaces, and what becomes of frames that find no
/// room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Hardware {
    /// Bits of the matrix entries; beyond 18 a lane has two DSPs.
    #[schemars(range(min = 8, max = 27))]
    pub coefficient_bits: u32,
    /// Bits of the vectors; beyond 27 a lane has two DSPs, with the reduced plan only.
    #[schemars(range(min = 16, max = 35))]
    pub data_bits: u32,
    /// Largest stress in pascals; more is clipped, with a status bit.
    // Far above the smallest float32, so that a stress or a force of one step has no denormal.
    #[schemars(range(min = 1e-3, max = 1e9))]
    pub full_scale_pa: f64,
    /// How numbers are scaled.
    pub scaling: Scaling,
    /// Multiply-accumulate lanes, one DSP each; with the reduced plan a multiple of 4.
    #[schemars(range(min = 1, max = MAX_LANES))]
    pub lanes: usize,
    /// What the area is spent on.
    pub optimise: Optimise,
    /// Bits of a beat on both streams.
    #[schemars(extend("enum" = STREAM_BITS))]
    pub stream_bits: u32,
    /// What a sample on the stream is; integers need `pa_per_count` or `curve`.
    pub samples: Samples,
    /// What becomes of a frame for which the core has no room.
    pub overrun: Overrun,
    /// Whether there is a register bank on AXI4-Lite: identity, counters, soft reset, interrupts.
    pub control: bool,
    /// Where gains, offsets and the contact threshold stand; `ram` needs `control`, and `pa_per_count` or `curve`.
    pub calibration: CalibrationIn,
    /// Clock in megahertz, for the times in reports and the constraints.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub clock_mhz: f64,
    /// FPGA part, as Vivado writes it.
    pub part: String,
    /// Vendor, library and version under which tools list the core. Its name there is the design's.
    #[schemars(extend("examples" = ["example.org:sensors:1.2"]))]
    pub vlnv: String,
}

impl Default for Hardware {
    fn default() -> Self {
        Self {
            coefficient_bits: 18,
            data_bits: 27,
            full_scale_pa: DEFAULT_FULL_SCALE_PA,
            scaling: Scaling::default(),
            lanes: 16,
            optimise: Optimise::default(),
            stream_bits: STREAM_BITS[0],
            samples: Samples::default(),
            overrun: Overrun::default(),
            control: false,
            calibration: CalibrationIn::default(),
            clock_mhz: 125.0,
            part: "xczu9eg-ffvb1156-2-e".to_owned(),
            vlnv: "user.org:tactile:1.0".to_owned(),
        }
    }
}

impl Hardware {
    /// Vendor, library and version of `vlnv`, where it has the three.
    pub fn vendor_library_version(&self) -> Option<[&str; 3]> {
        let parts: Vec<&str> = self.vlnv.split(':').collect();
        let legal =
            |part: &&str| !part.is_empty() && part.chars().all(|c| c.is_ascii_alphanumeric() || "._-".contains(c));
        let [vendor, library, version] = parts[..] else { return None };
        let numbers = version.split('.').filter(|number| number.parse::<u16>().is_ok()).count();
        let is_version = numbers == 2 && version.matches('.').count() == 1;
        (parts.iter().all(legal) && is_version).then_some([vendor, library, version])
    }

    /// The largest float32 that is no more than the full scale, in pascals: a frame cannot bring more of it. From here
    /// on a stress counts as saturated.
    pub fn full_scale_in_frames(&self) -> f64 {
        let nearest = self.full_scale_pa as f32;
        f64::from(if f64::from(nearest) > self.full_scale_pa { nearest.next_down() } else { nearest })
    }
}

print_as_words!(Scaling, Optimise, Samples, Overrun, CalibrationIn);
