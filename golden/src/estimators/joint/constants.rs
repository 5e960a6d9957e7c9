//! What `sptfra calibrate` finds for the grid search.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::words::print_as_words;

/// Weights of a correction are whole numbers of `2^-WEIGHT_FRACTION`.
pub const WEIGHT_FRACTION: u32 = 12;
/// A weight is at least minus this many steps and less than this many, 32 either way.
pub const WEIGHT_LIMIT: i32 = 32 << WEIGHT_FRACTION;
/// Most hidden units of a correction.
pub const MAX_HIDDEN: usize = 256;
/// Largest magnitude of `c3`, less than 4, as far as the hardware's word for it reaches. Sensors that read no tension
/// need more than 2.
pub const CUBIC_LIMIT: f64 = 3.9;
/// Inputs of a correction besides the window: two friction components, two fractions of the centre, one.
pub const EXTRA_INPUTS: usize = 5;

/// Contacts that the constants are trained on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TrainingSet {
    /// Round or nearly so, sliding, with a pressure that is the same in front and behind.
    #[default]
    Sliding,
    /// Of any shape, tilted, held, turning, over the grid's edge, on a sensor that is not quite what the design says.
    General,
}

print_as_words!(TrainingSet);

/// Constants of the grid search for one design.
#[derive(Clone, Debug, PartialEq)]
pub struct JointConstants {
    /// Contacts that the other constants are trained on.
    pub training_set: TrainingSet,
    /// Factor on all forces; what a kernel of point forces lacks at long waves.
    pub gain: f64,
    /// `[c1, c3]`: the friction vector is `c1 mu + c3 mu |mu|^2` of the centroid of the level set.
    pub friction_correction: [f64; 2],
    /// What a small network adds to that; nothing unless trained.
    pub correction: Option<Correction>,
    /// What they were calibrated for, as [`crate::design::conditions`] states it; a design of other conditions is refused. `None` for
    /// constants of unknown origin.
    pub calibrated_for: Option<String>,
}

impl Default for JointConstants {
    fn default() -> Self {
        Self {
            training_set: TrainingSet::default(),
            gain: 1.0,
            friction_correction: [1.0, 0.0],
            correction: None,
            calibrated_for: None,
        }
    }
}

/// Weights of the network that corrects the friction vector, in steps of `2^-WEIGHT_FRACTION`.
///
/// It sees a window of `2 half + 1` taxels along each axis around the centre of the contact, row by row, and then
/// [`EXTRA_INPUTS`] more values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Correction {
    /// Taxels on either side of the centre of the window, along x and y.
    pub half_window: [usize; 2],
    /// One row of weights for each hidden unit: the window, then the other inputs.
    pub hidden: Vec<Vec<i32>>,
    /// Weights of the hidden units in the x and the y component of the correction.
    pub output: [Vec<i32>; 2],
}

impl Correction {
    /// Number of inputs of a hidden unit.
    pub fn inputs(half_window: [usize; 2]) -> usize {
        (2 * half_window[0] + 1) * (2 * half_window[1] + 1) + EXTRA_INPUTS
    }
}
