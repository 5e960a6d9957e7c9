//! The grid search: both friction components at once, without the direction of push.
//!
//! Condition 1, `B(mu_x, mu_y) = sum_i max(0, u0_i + mu_x u1_i + mu_y u2_i)`, is convex in both components together.
//! Here it is evaluated on a fixed grid by additions alone, and the estimate is the weighted centroid of a level set.
//! `docs/explanation/estimators.md` gives the steps as the hardware takes them.

mod constants;
mod features;
mod grid;
mod level_set;
mod network;
mod weights;

use super::{Estimate, Inputs, RANGE};
use crate::numbers::magnitude;
use crate::status::Status;
pub use constants::{
    CUBIC_LIMIT, Correction, EXTRA_INPUTS, JointConstants, MAX_HIDDEN, TrainingSet, WEIGHT_FRACTION, WEIGHT_LIMIT,
};
pub(crate) use features::Features;
pub use features::{STRESS_SCALE, TIE};
pub use grid::Grid;
use level_set::{GridScratch, search};
pub(crate) use network::EXTRA_COMPONENTS;
pub use network::LARGEST;
pub(crate) use network::{Network, NetworkScratch};

/// The level set holds every point whose value exceeds the least one by less than this times the sum of |b|.
pub const LEVEL: f64 = 1.0 / 256.0;
/// Tension up to this times the largest |b| does not count: below it noise would be taken for tension.
pub const DEAD_ZONE: f64 = 1.0 / 256.0;

/// Memory of the estimator, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointScratch {
    grid: GridScratch,
    /// Stress of the normal forces at the centroid, in pascals.
    normal: Vec<f64>,
    /// The contact as the correction sees it.
    pub(crate) features: Features,
    network: NetworkScratch,
}

/// The estimate before it is calibrated.
pub(crate) fn raw(inputs: &Inputs, scratch: &mut JointScratch) -> Estimate {
    let largest = magnitude(inputs.b);
    search(Grid::SEARCH, inputs.u, DEAD_ZONE * largest, LEVEL * inputs.contact.stress_sum, &mut scratch.grid)
}

/// The features of the stress that the normal forces alone would cause at the friction `mu`, in a grid of `columns`.
pub(crate) fn features(
    inputs: &Inputs,
    mu: [f64; 2],
    columns: usize,
    half_window: [usize; 2],
    tie: f64,
    scratch: &mut JointScratch,
) {
    let JointScratch { normal, features, .. } = scratch;
    let [u0, u1, u2] = inputs.u;
    normal.clear();
    normal.extend(u0.iter().zip(u1).zip(u2).map(|((u0, u1), u2)| u0 + u1 * mu[0] + u2 * mu[1]));
    features.take(normal, columns, half_window, inputs.contact.stress_sum, mu, tie);
}

/// The grid search with the constants of one design.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    /// Factor on all forces.
    pub(crate) gain: f64,
    friction_correction: [f64; 2],
    columns: usize,
    network: Option<Network>,
}

impl Joint {
    pub(crate) fn new(constants: &JointConstants, columns: usize) -> Self {
        Self {
            gain: constants.gain,
            friction_correction: constants.friction_correction,
            columns,
            network: constants.correction.as_ref().map(Network::new),
        }
    }

    /// Finds the friction components.
    pub(crate) fn find(&self, inputs: &Inputs, scratch: &mut JointScratch) -> Estimate {
        let raw @ Estimate { status, mu } = raw(inputs, scratch);
        if status.contains(Status::DIRECTION_UNKNOWN) {
            return raw;
        }
        let mu = match &self.network {
            None => scaled(mu, self.friction_correction),
            Some(network) => {
                features(inputs, mu, self.columns, network.half_window, TIE, scratch);
                self.corrected(mu, &scratch.features, &mut scratch.network)
            }
        };
        let (status, mu) = within(status, mu);
        Estimate { status, mu }
    }

    /// The friction components for the centroid of the level set and what the network sees; not clipped.
    pub(crate) fn corrected(&self, mu: [f64; 2], features: &Features, scratch: &mut NetworkScratch) -> [f64; 2] {
        let scaled = scaled(mu, self.friction_correction);
        let Some(network) = &self.network else { return scaled };
        let added = network.correct(features, scratch);
        [scaled[0] + added[0], scaled[1] + added[1]]
    }
}

/// Keeps the components to their range, which no sensible constants let them leave.
pub(crate) fn within(mut status: Status, mu: [f64; 2]) -> (Status, [f64; 2]) {
    let clamped = mu.map(|component| component.clamp(-RANGE, RANGE));
    if clamped.iter().zip(mu).any(|(clamped, component)| clamped.to_bits() != component.to_bits()) {
        status.insert(Status::AT_BOUND);
    }
    (status, clamped)
}

/// `c1 mu + c3 mu |mu|^2`.
pub(crate) fn scaled(mu: [f64; 2], [c1, c3]: [f64; 2]) -> [f64; 2] {
    let factor = c1 + c3 * (mu[0] * mu[0] + mu[1] * mu[1]);
    mu.map(|component| factor * component)
}
