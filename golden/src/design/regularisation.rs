//! The key `regularisation`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Sensor;

/// Depth in pitches beyond which a layer is regularised: noise would become force.
const DEEP: f64 = 1.5;
/// The noise that such a design of a sensor without noise allows for, as a share of the largest stress.
const LEAST_NOISE: f64 = 0.002;
/// Largest factor: beyond it the forces are those of the regularisation.
const MAX_FACTOR: f64 = 1.0;
/// Factor for each unit of noise, from the table of corner cases: least error over depths of 1 to 4 pitches.
const FACTOR_PER_NOISE: f64 = 4.0;

/// What is added to the diagonal of C33, as a share of its largest singular value (Tikhonov's regularisation in the
/// form of Lavrentiev, for a matrix that is symmetric and positive definite).
///
/// In effect each taxel is a little stiffer for a force straight above it than the layer says. Small singular values,
/// which would multiply noise, are lifted to this share of the largest; large ones stay as good as they are. Since it
/// is the same C33 everywhere, all of the method stays as it is: A f = b, the parities, the reduced plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "algorithm.regularisation is a share of the largest singular value, such as 0.01, or the noise, such as \
                 { noise = 0.002 }"
)]
pub enum Regularisation {
    /// Nothing.
    #[default]
    #[serde(skip)]
    None,
    /// This share, up to 1.
    Factor(#[schemars(range(min = 0.0, max = MAX_FACTOR))] f64),
    /// A share that suits this noise.
    Noise {
        /// Standard deviation of the noise, as a share of the largest stress of a frame.
        #[schemars(range(max = 0.25), extend("exclusiveMinimum" = 0.0))]
        noise: f64,
    },
}

impl Regularisation {
    /// The key `regularisation` of a design that leaves it out, for a noise as a share of the largest stress.
    pub(crate) fn usual(sensor: &Sensor, noise: f64) -> Self {
        let [x, y] = sensor.pitch_mm;
        if sensor.depth_mm > DEEP * x.min(y) { Self::Noise { noise: noise.max(LEAST_NOISE) } } else { Self::None }
    }

    /// The share of the largest singular value; 0 for none.
    pub fn factor(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Factor(factor) => factor,
            Self::Noise { noise } => (FACTOR_PER_NOISE * noise).min(MAX_FACTOR),
        }
    }
}
