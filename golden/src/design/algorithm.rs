//! The `[algorithm]` table: choices that change the result.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ExpectedError, Filter, Regularisation};
use crate::estimators::joint::JointConstants;
use crate::estimators::{Estimator, StandardError};
use crate::kernel::Kernel;
use crate::words::print_as_words;

/// What a frame yields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Outputs {
    /// The summary and three force components for each taxel.
    #[default]
    Field,
    /// The summary only; with the reduced plan.
    Resultants,
}

/// Standard error as a share of the normal force above which a frame has low confidence, unless a design says otherwise.
pub const DEFAULT_MAX_STANDARD_ERROR: f64 = 0.1;

/// How the mathematics is put into products.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PlanKind {
    /// As in the paper: thirteen matrices of m by m, then three products with C33.
    Paper,
    /// The same result from ten matrices in four mirror-symmetric blocks of m/4 by m/4.
    #[default]
    Reduced,
}

/// The `[algorithm]` table.
#[derive(Clone, Debug, PartialEq)]
pub struct Algorithm {
    /// Products behind the result.
    pub plan: PlanKind,
    /// Load model behind C31, C32 and C33.
    pub kernel: Kernel,
    /// What C33 is made better conditioned by.
    pub regularisation: Regularisation,
    /// Sparsity of the matrices.
    pub filter: Filter,
    /// Friction estimator.
    pub estimator: Estimator,
    /// Constants of the grid search; the line search has none and leaves them at their default.
    pub joint: Box<JointConstants>,
    /// The standard error of the tangential force, if it was fitted.
    pub standard_error: Option<StandardError>,
    /// A frame whose standard error is a larger share of the normal force has low confidence.
    pub max_standard_error: f64,
    /// The error of the tangential force by noise, if it was found.
    pub expected_error: Option<ExpectedError>,
    /// Most contacts that are separated, 1 to [`crate::contacts::MOST`]; with 1 a frame is solved as that of one contact.
    pub contacts: usize,
    /// Whether the contacts of a frame are counted where it is solved as that of one, so that a frame of more says so.
    pub count_contacts: bool,
    /// Contents of the output.
    pub outputs: Outputs,
    /// Stress in pascals below which a taxel tells nothing; full scale / 65536 unless given.
    pub noise_floor_pa: f64,
    /// When what is held counts as sliding; never, if absent.
    pub slip: Option<Slip>,
}

/// Where the friction of a frame raises [`crate::status::Status::SLIP`], for controllers of a grip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// The bit is raised when the friction coefficient reaches this.
    pub limit: f64,
    /// It is lowered when the coefficient is below the limit by more than this.
    pub hysteresis: f64,
}

impl Slip {
    /// Largest limit.
    pub const LARGEST: f64 = 3.9;

    /// Whether a frame of friction `mu` slips, if the one before did so or not.
    pub fn slips(self, mu: f64, before: bool) -> bool {
        mu >= if before { self.limit - self.hysteresis } else { self.limit }
    }
}

impl Algorithm {
    /// Constants of the estimator, if it has any: what a design has of another one is left aside.
    pub fn constants(&self) -> Option<&JointConstants> {
        self.estimator.is_calibrated().then_some(&*self.joint)
    }

    /// Takes the errors of `other` if that finds forces alike; else none are known until `sptfra calibrate` finds them.
    pub fn take_errors(&mut self, other: &Self) {
        let finds = |of: &Self| (of.estimator, of.kernel, of.regularisation);
        let is_alike =
            finds(self) == finds(other) && (&self.filter, self.constants()) == (&other.filter, other.constants());
        (self.standard_error, self.max_standard_error, self.expected_error) = if is_alike {
            (other.standard_error, other.max_standard_error, other.expected_error.clone())
        } else {
            (None, DEFAULT_MAX_STANDARD_ERROR, None)
        };
    }

    /// What all forces are multiplied by.
    pub fn gain(&self) -> f64 {
        self.constants().map_or(1.0, |joint| joint.gain)
    }
}

print_as_words!(Outputs, PlanKind);
