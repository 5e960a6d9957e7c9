//! The friction estimators, and what all of them have in common.
//!
//! An estimator finds the friction components of a frame from what either plan knows of it, [`Inputs`]. Each has a folder of
//! its own. Outside of it its name is known to the registry here, the design file's parser, the warning of thin layers, and
//! the calibration, which is the joint one's. `docs/explanation/estimators.md` compares them.

mod interface;
pub mod joint;
pub mod line;
pub(crate) mod standard_error;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sensor::Sensor;
use crate::words::print_as_words;
pub use interface::{Contact, RANGE};
pub(crate) use interface::{Estimate, Inputs};
use joint::{Joint, JointConstants, JointScratch};
use line::LineScratch;
pub use standard_error::{BORDER, ERROR_FRACTION, ERROR_RANGE, StandardError, log as error_log};

/// How the friction components are found once the optimisation problem is set up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Estimator {
    /// Along the line that the direction of push fixes in the plane of the friction components.
    Line,
    /// Over the whole plane of the friction components at once, without a direction: the centroid of a level set of
    /// Condition 1, calibrated on scenes.
    #[default]
    Joint,
}

print_as_words!(Estimator);

impl Estimator {
    /// Whether it has constants that are found by calibration, without which it tells little.
    pub fn is_calibrated(self) -> bool {
        self == Self::Joint
    }
}

/// An estimator, ready for frames: the grid search, or else the line search.
#[derive(Clone, Debug)]
pub(crate) struct Friction(Option<Box<Joint>>);

/// Memory of an estimator, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrictionScratch {
    line: LineScratch,
    joint: JointScratch,
}

impl Friction {
    /// The estimator of a design.
    pub(crate) fn new(constants: Option<&JointConstants>, sensor: &Sensor) -> Self {
        Self(constants.map(|joint| Box::new(Joint::new(joint, sensor.columns))))
    }

    /// Finds the components `[mu_x, mu_y]`, and the status bits to raise.
    pub(crate) fn find(&self, inputs: &Inputs, scratch: &mut FrictionScratch) -> Estimate {
        if let Some(joint) = &self.0 {
            return joint.find(inputs, &mut scratch.joint);
        }
        let (status, mu) = line::friction(&inputs.contact, inputs.sums, inputs.u, line::LEVEL, &mut scratch.line);
        Estimate { status, mu }
    }

    /// What all forces are multiplied by, if the estimator has a gain.
    pub(crate) fn gain(&self) -> Option<f64> {
        self.0.as_ref().map(|joint| joint.gain)
    }
}
