//! Cycles of the grid search's modules: counts of the emitted pipelines, exact.

use golden::parity::Orbits;
use golden::sensor::Sensor;

use super::{JointPlan, NetworkPlan};
use crate::timing::durations::Stage;

/// From the last stress of a frame to its sum and maximum.
pub const CONTACT_LATENCY: u64 = 4;
/// From the centroid to the friction, without a correction.
pub const FRICTION: u64 = 20;
/// From the correction to the friction: the rest of it is done while the network is at work.
pub const CORRECTED: u64 = 2;
/// From the start of the window to its first word.
pub const FIRST_WORD: u64 = 11;

/// Centroid of the level set to that of the contact: two cycles an orbit, the divisions.
pub fn features(sensor: &Sensor) -> u64 {
    2 * orbits(sensor) + 33
}

/// Start of the window to its last word.
pub fn window(network: &NetworkPlan) -> u64 {
    FIRST_WORD + network.length as u64 - 1
}

/// First word of the window to the correction: a cycle for each word of each pass, and the way of the last unit.
pub fn network(network: &NetworkPlan) -> u64 {
    (network.weights.len() + network.at_once) as u64 + 14
}

/// The stages, each with a frame of its own: the grid search, the features, and the correction from its window to the
/// friction. Without a network there are no features.
pub fn stages(sensor: &Sensor, plan: &JointPlan) -> Vec<Stage> {
    let stage = |cycles| Stage { cycles, shows: 0 };
    let search = stage(plan.search.cycles(sensor));
    match &plan.network {
        Some(of) => {
            let features = Stage { cycles: features(sensor), shows: window(of) };
            vec![search, features, stage(FIRST_WORD + network(of) + CORRECTED)]
        }
        None => vec![search, stage(FRICTION)],
    }
}

fn orbits(sensor: &Sensor) -> u64 {
    Orbits::new(sensor.columns, sensor.rows).count() as u64
}
