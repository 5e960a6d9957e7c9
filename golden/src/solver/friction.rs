//! The friction components of a frame, by the estimator that the design names.

use super::cean::Contact;
use super::joint::{Joint, JointScratch};
use super::line::LineScratch;
use super::{Solution, Status, op};
use crate::design::{Design, Estimator};

/// An estimator with its constants.
#[derive(Clone, Debug)]
pub(crate) enum Friction {
    Line,
    Joint(Box<Joint>),
}

/// What an estimator sees of a frame; either plan has all of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<'a> {
    /// Stress in pascals, m values.
    pub(crate) b: &'a [f64],
    pub(crate) contact: Contact,
    /// Sums `G_pq` in newtons, at `[p - 1][q]`.
    pub(crate) sums: &'a [[f64; 3]; 3],
    /// Stresses `u_q = C33 g_3q` in pascals, m values each.
    pub(crate) u: [&'a [f64]; 3],
}

/// Memory of an estimator, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrictionScratch {
    line: LineScratch,
    joint: JointScratch,
}

impl Friction {
    pub(crate) fn new(design: &Design) -> Self {
        match design.algorithm.estimator {
            Estimator::Line => Self::Line,
            Estimator::Joint => Self::Joint(Box::new(Joint::new(design))),
        }
    }

    /// Finds the components `[mu_x, mu_y]`, and the status bits to raise.
    pub(crate) fn find(&self, seen: &Seen, scratch: &mut FrictionScratch) -> (Status, [f64; 2]) {
        match self {
            Self::Line => op::friction(&seen.contact, seen.sums, seen.u, op::LEVEL, &mut scratch.line),
            Self::Joint(joint) => joint.find(seen, &mut scratch.joint),
        }
    }

    /// Multiplies all forces by the estimator's gain, if it has one.
    pub(crate) fn scale(&self, solution: &mut Solution) {
        if let Self::Joint(joint) = self {
            solution.field.iter_mut().flatten().chain(&mut solution.resultant).for_each(|force| *force *= joint.gain);
        }
    }
}
