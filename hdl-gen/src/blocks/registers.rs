//! The register bank `sptfra_registers`: what it says of a design.

use serde::Serialize;

use super::Parameters;
use crate::plan::Plan;

/// Version of the register map: one more whenever a register moves or changes its meaning.
pub const MAP_VERSION: u8 = 2;

/// What a sample is, in `FEATURES`: 0 float32, 1 int16, 2 uint16.
pub fn samples(plan: &Plan) -> u8 {
    plan.streams().sample as u8
}

/// What the read-only registers hold. Truths are 0 or 1: they are reset values in the register map.
#[derive(Clone, Debug, Serialize)]
pub struct Constants {
    map_version: u8,
    major: &'static str,
    minor: &'static str,
    patch: &'static str,
    /// Hexadecimal digits.
    hash_high: String,
    hash_low: String,
    columns: usize,
    rows: usize,
    lanes: usize,
    words_in: usize,
    words_out: usize,
    has_field: u8,
    is_reduced: u8,
    has_counts: u8,
    skips_zeros: u8,
    stream_bytes: usize,
    samples: u8,
    clock_khz: u64,
    /// Hexadecimal digits of a float32.
    full_scale: String,
    latency_cycles: u64,
    interval_cycles: u64,
}

impl Constants {
    /// Those of a design with the given hash of sixteen hexadecimal digits.
    pub fn new(plan: &Plan, hash: &str) -> Self {
        let (design, hardware) = (&plan.design, &plan.design.hardware);
        let (hash_high, hash_low) = hash.split_at(8);
        Self {
            map_version: MAP_VERSION,
            major: env!("CARGO_PKG_VERSION_MAJOR"),
            minor: env!("CARGO_PKG_VERSION_MINOR"),
            patch: env!("CARGO_PKG_VERSION_PATCH"),
            hash_high: hash_high.to_owned(),
            hash_low: hash_low.to_owned(),
            columns: design.sensor.columns,
            rows: design.sensor.rows,
            lanes: hardware.lanes,
            words_in: plan.streams().words_in(),
            words_out: plan.words_out(),
            has_field: u8::from(plan.field_words() > 0),
            is_reduced: u8::from(plan.ways() > 1),
            has_counts: u8::from(plan.design.input.counts()),
            skips_zeros: u8::from(hardware.skip_zeros),
            stream_bytes: plan.streams().bits / 8,
            samples: samples(plan),
            clock_khz: (hardware.clock_mhz * 1e3).round() as u64,
            full_scale: format!("{:08x}", (hardware.full_scale_pa as f32).to_bits()),
            latency_cycles: plan.timeline.latency_cycles,
            interval_cycles: plan.timeline.interval_cycles,
        }
    }

    /// The parameters of the bank's instance, each as wide as its field.
    pub fn parameters(&self) -> Parameters {
        let decimal = |bits: u32, value: &dyn std::fmt::Display| format!("{bits}'d{value}");
        Parameters::new()
            .expression("MAP_VERSION", decimal(8, &self.map_version))
            .expression("MAJOR", decimal(8, &self.major))
            .expression("MINOR", decimal(8, &self.minor))
            .expression("PATCH", decimal(8, &self.patch))
            .expression("HASH", format!("64'h{}{}", self.hash_high, self.hash_low))
            .expression("COLUMNS", decimal(8, &self.columns))
            .expression("ROWS", decimal(8, &self.rows))
            .expression("LANES", decimal(8, &self.lanes))
            .expression("WORDS_IN", decimal(16, &self.words_in))
            .expression("WORDS_OUT", decimal(16, &self.words_out))
            .expression("HAS_FIELD", decimal(1, &self.has_field))
            .expression("IS_REDUCED", decimal(1, &self.is_reduced))
            .expression("HAS_COUNTS", decimal(1, &self.has_counts))
            .expression("SKIPS_ZEROS", decimal(1, &self.skips_zeros))
            .expression("STREAM_BYTES", decimal(8, &self.stream_bytes))
            .expression("SAMPLES", decimal(2, &self.samples))
            .expression("CLOCK_KHZ", decimal(32, &self.clock_khz))
            .expression("FULL_SCALE", format!("32'h{}", self.full_scale))
            .expression("LATENCY_CYCLES", decimal(32, &self.latency_cycles))
            .expression("INTERVAL_CYCLES", decimal(32, &self.interval_cycles))
    }
}
