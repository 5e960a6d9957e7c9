//! Cycles of the joint estimator's modules: counts of the emitted pipelines, exact.

use golden::parity::Quads;
use golden::sensor::Sensor;

use super::points::{self, PointsPlan};
use super::{JointPlan, NetworkPlan, POINTS};

/// From the last stress of a frame to its sum and maximum.
pub const CONTACT_LATENCY: u64 = 4;
/// From the centroid, or from the correction, to the friction.
pub const FRICTION: u64 = 20;

/// From the first row of points, or from the last value of the walk, to the centroid: the level, the depths below it,
/// the divisions.
pub fn level(plan: &JointPlan) -> u64 {
    match &plan.points {
        Some(PointsPlan { side, .. }) => (side + side * side / points::AT_ONCE) as u64 + 37,
        None => POINTS as u64 + 34,
    }
}

/// From the start of the search to the first row of points, when all taxels are in; or to the first value of the walk:
/// two starts and a point, then the sums.
pub fn first_value(sensor: &Sensor, plan: &JointPlan) -> u64 {
    match plan.points {
        Some(_) => 4 * quads(sensor) + 11,
        None => 3 * plan.cells.elements as u64 + 3 + u64::from(plan.cells.tree_levels()),
    }
}

/// Start to end of the search.
fn search(sensor: &Sensor, plan: &JointPlan) -> u64 {
    let walk = if plan.points.is_some() { 0 } else { (POINTS as u64 - 1) * plan.cells.elements as u64 };
    first_value(sensor, plan) + walk + level(plan)
}

/// Centroid to the last input of the network: two cycles a quad, the divisions, a cycle a word.
pub fn look(sensor: &Sensor, network: &NetworkPlan) -> u64 {
    2 * quads(sensor) + network.length as u64 + 43
}

/// First to last of the network: its words, and the way of the last unit to the output.
pub fn network(network: &NetworkPlan) -> u64 {
    (network.weights.len() + network.at_once) as u64 + 14
}

/// The stages, each with a frame of its own: the search of the plane, then look, network and friction.
pub fn stages(sensor: &Sensor, plan: &JointPlan) -> [u64; 2] {
    let correction = plan.network.as_ref().map_or(0, |of| look(sensor, of) + network(of));
    [search(sensor, plan), correction + FRICTION]
}

fn quads(sensor: &Sensor) -> u64 {
    Quads::new(sensor.columns, sensor.rows).count() as u64
}
