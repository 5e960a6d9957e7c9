//! What readings are like: their noise, and whether they show tension.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::words::print_as_words;

/// Standard deviation of a reading's noise where a design names none, as a share of the frame's largest reading.
pub const DEFAULT_NOISE: f64 = 0.005;
/// The largest, beyond which a frame tells nothing of shear.
pub const MAX_NOISE: f64 = 0.1;

/// Noise in the units of frames, alike in all of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredNoise {
    /// Standard deviation of a reading, as `sptfra check --unloaded` measures it.
    #[schemars(range(min = 0.0))]
    pub deviation: f64,
    /// The largest reading of a typical contact, without the offset.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub largest: f64,
}

impl MeasuredNoise {
    /// The share of a typical contact's largest reading.
    pub fn share(self) -> f64 {
        self.deviation / self.largest
    }

    /// With `unit` in place of 1.
    pub(super) fn times(self, unit: f64) -> Self {
        Self { deviation: self.deviation * unit, largest: self.largest * unit }
    }
}

/// What a taxel reads that is pulled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Tension {
    /// Tension, as a positive stress.
    #[default]
    Read,
    /// Nothing, as of most resistive and capacitive arrays.
    Clipped,
}

print_as_words!(Tension);

impl Tension {
    /// What is read of a stress in pascals.
    pub fn of(self, stress: f64) -> f64 {
        match self {
            Self::Read => stress,
            Self::Clipped => stress.min(0.0),
        }
    }
}
