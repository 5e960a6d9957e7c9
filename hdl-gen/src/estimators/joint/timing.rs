//! Cycles of the joint estimator's modules: counts of the emitted pipelines, exact.

use super::super::Cells;
use super::{NetworkPlan, POINTS};
use crate::cores::divider;

/// From the last stress of a frame to its sum and maximum.
pub const CONTACT_LATENCY: u64 = 4;
/// From the centroid, or from the correction, to the friction.
pub const FRICTION: u64 = 20;
/// A division, with the start that it waits for.
const DIVISION: u64 = divider::LATENCY as u64 + 1;

/// From the last value on the grid to the centroid: the level, the depths below it, two divisions.
pub const LEVEL: u64 = POINTS as u64 + 15 + 2 * DIVISION;

/// From the start of the walk to its first value: two starts and a point, then the sums.
pub fn first_value(cells: Cells) -> u64 {
    3 * cells.elements as u64 + 3 + u64::from(cells.tree_levels())
}

/// From the start of the walk to its last value.
fn last_value(cells: Cells) -> u64 {
    first_value(cells) + (POINTS as u64 - 1) * cells.elements as u64
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
pub fn search(taxels: usize, network: Option<&NetworkPlan>, cells: Cells) -> u64 {
    let correction = network.map_or(0, |of| look(taxels, of) + self::network(of));
    last_value(cells) + LEVEL + correction + FRICTION
}
