//! The estimators of friction: what finds `mu_x` and `mu_y` from the sums and stresses of a frame.
//!
//! An estimator is a slot: its constants and formats, its steps in integers, its latencies, memories, multipliers and
//! modules stand in a folder of its own, and the rest of the generator asks [`Slot`]. A new one is a folder, a line in
//! each function of [`EstimatorPlan`], and its modules in the list of `emit::rtl`.

pub mod joint;
pub mod line;
mod slot;

use golden::design::{Design, Estimator, PlanKind};

use joint::JointPlan;
use line::LinePlan;
pub use slot::{Cells, Contact, Found, Given, Metadata, Seen, Slot, WEIGHT_BITS};

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
    pub fn new(given: &Given) -> Self {
        match given.design.algorithm.estimator {
            Estimator::Line => Self::Line(LinePlan::new(given)),
            Estimator::Joint => Self::Joint(Box::new(JointPlan::new(given))),
        }
    }

    /// What the rest of the generator knows of it.
    pub fn slot(&self) -> &dyn Slot {
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
