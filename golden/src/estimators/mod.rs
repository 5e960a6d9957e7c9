//! The friction estimators, and what all of them have in common.
//!
//! An estimator finds the friction components of a frame from what either plan knows of it, [`Inputs`]. Each has a folder of
//! its own. Outside of it its name is known to the registry here, the design file's parser, the warning of thin layers, and
//! the calibration, which is the joint one's. `docs/explanation/estimators.md` compares them.

pub mod joint;
pub mod line;
pub(crate) mod standard_error;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::products::ByPq;
use crate::sensor::Sensor;
use crate::status::Status;
use crate::words::print_as_words;
use joint::{Joint, JointConstants, JointScratch};
use line::LineScratch;
pub use standard_error::{BORDER, ERROR_FRACTION, ERROR_RANGE, StandardError, log as error_log};

/// A friction component found is within this on either side of 0.
pub const RANGE: f64 = 2.0;

/// What the contact analysis finds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Sum of |b| over all taxels in pascals.
    pub stress_sum: f64,
    /// Whether that sum reaches the noise floor of `m` taxels.
    pub touched: bool,
    /// Centroid of the compressed taxels minus that of the taxels in tension, in metres; its direction is the
    /// direction of push. `None` where no taxel reaches the noise floor on one of the two sides.
    pub direction: Option<[f64; 2]>,
    /// Noise in the stress over that of a frame: below 1 where frames are averaged.
    pub noise_left: f64,
}

/// What an estimator finds of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    /// Bits to raise.
    pub(crate) status: Status,
    /// Friction components.
    pub(crate) mu: [f64; 2],
}

/// What an estimator sees of a frame; either plan has all of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inputs<'a> {
    /// Stress in pascals, m values.
    pub(crate) b: &'a [f64],
    pub(crate) contact: Contact,
    /// Sums `G_pq` in newtons, and those of the torques in N m.
    pub(crate) sums: &'a ByPq<f64>,
    /// Stresses `u_q = C33 g_3q` in pascals, m values each.
    pub(crate) u: [&'a [f64]; 3],
}

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
