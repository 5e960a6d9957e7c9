//! Cycles of the joint estimator's modules: counts of the emitted pipelines, exact.

use super::super::optimum::OptimumPlan;
use super::{NetworkPlan, POINTS};
use crate::cores::divider;

/// From the last stress of a frame to its sum and maximum.
pub const CONTACT_LATENCY: u64 = 4;
/// From the centroid, or from the correction, to the friction.
pub const FRICTION: u64 = 20;
/// A division, with the start that it waits for.
const DIVISION: u64 = divider::LATENCY as u64 + 1;

/// Start to end of the walk and the level set: two starts and the points, the last sum, the depths, two divisions.
pub fn plane(optimum: &OptimumPlan) -> u64 {
    let points = POINTS as u64;
    (points + 2) * optimum.elements as u64 + u64::from(optimum.tree_levels()) + 7 + points + 11 + 2 * DIVISION
}

/// Centroid to the last input of the network: three cycles a taxel, two divisions, four cycles a place.
pub fn look(taxels: usize, network: &NetworkPlan) -> u64 {
    let places = network.places() as u64;
    3 * taxels as u64 + 14 + 2 * DIVISION + 16 + 4 * places + network.length as u64 - places
}

/// First to last of the network: its words, and the way of the last unit to the output.
pub fn network(network: &NetworkPlan) -> u64 {
    network.weights.len() as u64 + 18
}

/// Start to end of the search, all modules in turn.
pub fn search(taxels: usize, network: Option<&NetworkPlan>, optimum: &OptimumPlan) -> u64 {
    let correction = network.map_or(0, |of| look(taxels, of) + self::network(of));
    plane(optimum) + correction + FRICTION
}
