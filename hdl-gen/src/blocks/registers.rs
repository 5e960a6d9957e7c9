//! The register bank `sptfra_registers`: what it says of a design.

use crate::parameters::Parameters;
use crate::plan::Plan;

/// Version of the register map: one more whenever a register moves or changes its meaning.
pub const MAP_VERSION: u8 = 3;

/// What a sample is, in `FEATURES` and for `sptfra_samples`: 0 float32, 1 int16, 2 uint16.
pub fn samples(plan: &Plan) -> u8 {
    plan.streams().sample as u8
}

/// What the read-only registers hold: name, width of the field, base and digits. The bank's instance has a parameter of the
/// name, the register map's template the same in small letters. Truths are 0 or 1: they are reset values in the register
/// map.
#[derive(Clone, Debug)]
pub struct Constants(Vec<(&'static str, u32, char, String)>);

impl Constants {
    /// Those of a design with the given hash of sixteen hexadecimal digits.
    pub fn new(plan: &Plan, hash: &str) -> Self {
        let (design, hardware) = (&plan.design, &plan.design.hardware);
        let decimal = |name, bits, value: &dyn ToString| (name, bits, 'd', value.to_string());
        let hexadecimal = |name, bits, digits: String| (name, bits, 'h', digits);
        let full_scale = (hardware.full_scale_pa as f32).to_bits();
        Self(vec![
            decimal("MAP_VERSION", 8, &MAP_VERSION),
            decimal("MAJOR", 8, &env!("CARGO_PKG_VERSION_MAJOR")),
            decimal("MINOR", 8, &env!("CARGO_PKG_VERSION_MINOR")),
            decimal("PATCH", 8, &env!("CARGO_PKG_VERSION_PATCH")),
            hexadecimal("HASH", 64, hash.to_owned()),
            decimal("COLUMNS", 8, &design.sensor.columns),
            decimal("ROWS", 8, &design.sensor.rows),
            decimal("LANES", 8, &hardware.lanes),
            decimal("WORDS_IN", 16, &plan.streams().words_in()),
            decimal("WORDS_OUT", 16, &plan.words_out()),
            decimal("HAS_FIELD", 1, &u8::from(plan.field_words() > 0)),
            decimal("IS_REDUCED", 1, &u8::from(plan.channels() > 1)),
            decimal("HAS_COUNTS", 1, &u8::from(design.input.counts())),
            decimal("DROPS", 1, &u8::from(plan.streams().drops)),
            decimal("SMOOTHING_RATE", 4, &plan.smoothing.as_ref().map_or(0, |of| of.rate)),
            decimal("STREAM_BYTES", 8, &(plan.streams().bits / 8)),
            decimal("SAMPLES", 2, &samples(plan)),
            decimal("CLOCK_KHZ", 32, &((hardware.clock_mhz * 1e3).round() as u64)),
            // In Pa, float32.
            hexadecimal("FULL_SCALE", 32, format!("{full_scale:08x}")),
            decimal("LATENCY_CYCLES", 32, &plan.timeline.latency_cycles),
            decimal("INTERVAL_CYCLES", 32, &plan.timeline.interval_cycles),
        ])
    }

    /// The parameters of the bank's instance.
    pub fn parameters(&self) -> Parameters {
        self.0.iter().fold(Parameters::new(), |all, (name, bits, base, digits)| all.digits(name, *bits, *base, digits))
    }

    /// Their names in small letters, and their digits.
    pub fn digits(&self) -> impl Iterator<Item = (String, &str)> {
        self.0.iter().map(|(name, .., digits)| (name.to_lowercase(), digits.as_str()))
    }
}
