//! The estimators of friction: what finds `mu_x` and `mu_y` from the sums and stresses of a frame.
//!
//! An estimator is a block: its constants and formats, its steps in integers, its latencies, memories, multipliers and
//! modules stand in a folder of its own, and the rest of the generator asks [`EstimatorBlock`]. A new one is a folder, a
//! line in each function of [`EstimatorPlan`], and its modules in the list of `emit::rtl`.

mod block;
pub mod joint;
pub mod line;

use golden::design::{Design, Estimator, PlanKind};

pub use block::{Cells, Config, Contact, Estimate, EstimatorBlock, Inputs, Metadata, WEIGHT_BITS};
use joint::JointPlan;
use line::LinePlan;

/// The estimator of a design, with its constants.
#[derive(Clone, Debug)]
pub enum EstimatorPlan {
    /// That of the paper: the optimum on the line that the direction of push allows.
    Line(LinePlan),
    /// Both components at once.
    Joint(Box<JointPlan>),
}

impl EstimatorPlan {
    /// The estimator that the design names.
    pub fn new(config: &Config) -> Self {
        match config.design.algorithm.estimator {
            Estimator::Line => Self::Line(LinePlan::new(config)),
            Estimator::Joint => Self::Joint(Box::new(JointPlan::new(config))),
        }
    }

    /// What the rest of the generator knows of it.
    pub fn block(&self) -> &dyn EstimatorBlock {
        match self {
            Self::Line(line) => line,
            Self::Joint(joint) => joint.as_ref(),
        }
    }

    /// The grid search, if it is that one.
    pub fn joint(&self) -> Option<&JointPlan> {
        if let Self::Joint(joint) = self { Some(joint) } else { None }
    }
}

/// Whether the plan that the design names has hardware for its estimator.
pub fn has_hardware(design: &Design) -> bool {
    let algorithm = &design.algorithm;
    algorithm.estimator == Estimator::Line || algorithm.plan == PlanKind::Reduced
}

/// An estimator that needs fewer cycles, and the key of the design file that names it.
pub fn quicker(estimator: Estimator) -> Option<(Estimator, &'static str)> {
    (estimator == Estimator::Joint).then_some((Estimator::Line, "estimator = \"line\""))
}
