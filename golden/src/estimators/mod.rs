//! The friction estimators, and what all of them have in common.
//!
//! An estimator finds the friction components of a frame from what either plan knows of it, [`Inputs`]. Each has a folder of
//! its own; outside of it the registry here, the design file's parser and the calibration, which is the joint one's, know
//! its name. `docs/explanation/estimators.md` compares them.

mod interface;
pub mod joint;
pub mod line;
pub(crate) mod standard_error;
mod thin;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::kernel::Kernel;
use crate::sensor::Sensor;
use crate::words::print_as_words;
pub use interface::{Contact, RANGE};
pub(crate) use interface::{Estimate, Inputs};
use joint::{Joint, JointConstants, JointScratch};
use line::LineScratch;
pub use standard_error::{BORDER, ERROR_FRACTION, ERROR_RANGE, StandardError, log as error_log};
pub(crate) use thin::Thin;

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

/// An estimator as a design has it, with its constants.
#[derive(Clone, Copy, Debug)]
pub enum Constants<'a> {
    /// It has none.
    Line,
    /// Those that `sptfra calibrate` finds.
    Joint(&'a JointConstants),
}

impl<'a> Constants<'a> {
    /// Those of an estimator; what a design has of another one is left aside.
    pub(crate) fn of(estimator: Estimator, joint: &'a JointConstants) -> Self {
        match estimator {
            Estimator::Line => Self::Line,
            Estimator::Joint => Self::Joint(joint),
        }
    }

    /// How thin a layer may be for this estimator.
    pub(crate) fn thin(self, sensor: &Sensor, kernel: Kernel) -> Thin {
        match self {
            Self::Line => line::thin(sensor, kernel),
            Self::Joint(joint) => joint.thin(sensor, kernel),
        }
    }

    /// What all forces are multiplied by, if the estimator has a gain.
    pub fn gain(&self) -> Option<f64> {
        match self {
            Self::Line => None,
            Self::Joint(joint) => Some(joint.gain),
        }
    }
}

/// An estimator, ready for frames.
#[derive(Clone, Debug)]
pub(crate) enum Friction {
    Line,
    Joint(Box<Joint>),
}

/// Memory of an estimator, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrictionScratch {
    line: LineScratch,
    joint: JointScratch,
}

impl Friction {
    /// The estimator of a design.
    pub(crate) fn new(constants: Constants, sensor: &Sensor) -> Self {
        match constants {
            Constants::Line => Self::Line,
            Constants::Joint(joint) => Self::Joint(Box::new(Joint::new(joint, sensor.columns))),
        }
    }

    /// Finds the components `[mu_x, mu_y]`, and the status bits to raise.
    pub(crate) fn find(&self, inputs: &Inputs, scratch: &mut FrictionScratch) -> Estimate {
        match self {
            Self::Line => {
                let (status, mu) =
                    line::friction(&inputs.contact, inputs.sums, inputs.u, line::LEVEL, &mut scratch.line);
                Estimate { status, mu }
            }
            Self::Joint(joint) => joint.find(inputs, &mut scratch.joint),
        }
    }

    /// What all forces are multiplied by, if the estimator has a gain.
    pub(crate) fn gain(&self) -> Option<f64> {
        match self {
            Self::Line => None,
            Self::Joint(joint) => Some(joint.gain),
        }
    }
}
