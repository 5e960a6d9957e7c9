//! The register bank `sptfra_registers`: what it says of a design.

use crate::parameters::Parameters;
use crate::plan::Plan;

/// Version of the register map: one more whenever a register moves or changes its meaning.
pub const MAP_VERSION: u8 = 3;

/// What a sample is, in `FEATURES` and for `sptfra_samples`: 0 float32, 1 int16, 2 uint16.
pub fn samples(plan: &Plan) -> u8 {
    plan.streams().sample as u8
}

/// Names of the read-only registers, from address 0 on.
const NAMES: [&str; 11] = [
    "identity",
    "version",
    "hash, low",
    "hash, high",
    "geometry",
    "frame",
    "features",
    "clock in kHz",
    "full scale in Pa",
    "predicted latency",
    "predicted interval",
];

/// A field of a read-only register, by its name in the register map's template.
#[derive(Clone, Debug)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Its register's address in words.
    word: usize,
    /// Its lowest bit.
    low: u32,
    /// What it holds.
    pub value: u32,
}

/// The fields of the read-only registers of a design with the given hash of sixteen digits. Truths are 0 or 1.
///
/// # Panics
///
/// If the hash is none.
pub fn constants(plan: &Plan, hash: &str) -> Vec<Field> {
    let (design, hardware) = (&plan.design, &plan.design.hardware);
    let calibration = plan.calibration.as_ref();
    let version = |part: &str| part.parse().expect("a number");
    let hash = |digits| u32::from_str_radix(&hash[digits], 16).expect("hexadecimal digits");
    let field = |word, low, name, value| Field { name, word, low, value };
    vec![
        field(0, 0, "magic", u32::from_be_bytes(*b"TFRA")),
        field(1, 0, "patch", version(env!("CARGO_PKG_VERSION_PATCH"))),
        field(1, 8, "minor", version(env!("CARGO_PKG_VERSION_MINOR"))),
        field(1, 16, "major", version(env!("CARGO_PKG_VERSION_MAJOR"))),
        field(1, 24, "map_version", MAP_VERSION.into()),
        field(2, 0, "hash_low", hash(8..16)),
        field(3, 0, "hash_high", hash(0..8)),
        field(4, 0, "columns", design.sensor.columns as u32),
        field(4, 8, "rows", design.sensor.rows as u32),
        field(4, 16, "lanes", hardware.lanes as u32),
        field(5, 0, "words_in", plan.streams().words_in() as u32),
        field(5, 16, "words_out", plan.words_out() as u32),
        field(6, 0, "has_field", u32::from(plan.field_words() > 0)),
        field(6, 1, "is_reduced", u32::from(plan.channels() > 1)),
        field(6, 2, "has_counts", u32::from(design.input.counts())),
        field(6, 4, "has_calibration", u32::from(calibration.is_some())),
        field(6, 5, "drops", u32::from(plan.streams().drops)),
        field(6, 6, "has_curve", u32::from(calibration.is_some_and(|of| of.curve().is_some()))),
        field(6, 7, "averages", u32::from(plan.smoothing.is_some())),
        field(6, 8, "stream_bytes", (plan.streams().bits / 8) as u32),
        field(6, 16, "samples", samples(plan).into()),
        field(6, 20, "replaceable", calibration.map_or(0, |of| of.power_up.dead.room as u32)),
        field(7, 0, "clock_khz", (hardware.clock_mhz * 1e3).round() as u32),
        // In Pa, float32.
        field(8, 0, "full_scale", (hardware.full_scale_pa as f32).to_bits()),
        field(9, 0, "latency_cycles", plan.timeline.latency_cycles as u32),
        field(10, 0, "interval_cycles", plan.timeline.interval_cycles as u32),
    ]
}

/// Parameters of `sptfra_registers`.
pub fn parameters(plan: &Plan, constants: &[Field]) -> Parameters {
    let mut words = NAMES.map(|name| (0, name.to_owned()));
    for field in constants {
        words[field.word].0 |= u64::from(field.value) << field.low;
    }
    let drops = plan.streams().drops.into();
    let rate = plan.smoothing.as_ref().map_or(0, |of| of.rate.into());
    Parameters::new().words("CONSTANTS", &words).unsigned("DROPS", 1, drops).unsigned("SMOOTHING_RATE", 4, rate)
}
