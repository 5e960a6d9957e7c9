//! Cycles of the joint estimator's modules: counts of the emitted pipelines, exact.

use golden::parity::Quads;
use golden::sensor::Sensor;

use super::super::Stage;
use super::points::PointsPlan;
use super::{JointPlan, NetworkPlan, POINTS};

/// From the last stress of a frame to its sum and maximum.
pub const CONTACT_LATENCY: u64 = 4;
/// From the centroid to the friction, without a correction.
pub const FRICTION: u64 = 20;
/// From the correction to the friction: the rest of it is done while the network is at work.
pub const CORRECTED: u64 = 2;
/// From the start of the window to its first word.
pub const FIRST_WORD: u64 = 11;

/// From the first row of points, or from the last value of the walk, to the centroid: the level, the depths below it,
/// the divisions.
pub fn level(plan: &JointPlan) -> u64 {
    plan.points.as_ref().map_or(POINTS as u64 + 34, PointsPlan::level)
}

/// From the start of the search to the first row of points, when all taxels are in; or to the first value of the walk:
/// two starts and a point, then the sums.
pub fn first_value(sensor: &Sensor, plan: &JointPlan) -> u64 {
    let walk =
        || 3 * plan.cells.elements as u64 + 3 + u64::from(plan.block_cells()) + u64::from(plan.cells.tree_levels());
    plan.points.as_ref().map_or_else(walk, |points| points.first_row(sensor))
}

/// Start to end of the search.
fn search(sensor: &Sensor, plan: &JointPlan) -> u64 {
    let walk = if plan.points.is_some() { 0 } else { (POINTS as u64 - 1) * plan.cells.elements as u64 };
    first_value(sensor, plan) + walk + level(plan)
}

/// Centroid of the level set to that of the contact: two cycles a quad, the divisions.
pub fn look(sensor: &Sensor) -> u64 {
    2 * quads(sensor) + 33
}

/// Start of the window to its last word.
pub fn window(network: &NetworkPlan) -> u64 {
    FIRST_WORD + network.length as u64 - 1
}

/// First word of the window to the correction: a cycle for each word of each pass, and the way of the last unit.
pub fn network(network: &NetworkPlan) -> u64 {
    (network.weights.len() + network.at_once) as u64 + 14
}

/// The stages, each with a frame of its own: the search of the plane, the look, and the correction from its window to the
/// friction. Without a network there is no look.
pub fn stages(sensor: &Sensor, plan: &JointPlan) -> Vec<Stage> {
    let stage = |cycles| Stage { cycles, shows: 0 };
    let search = stage(search(sensor, plan));
    match &plan.network {
        Some(of) => {
            let look = Stage { cycles: look(sensor), shows: window(of) };
            vec![search, look, stage(FIRST_WORD + network(of) + CORRECTED)]
        }
        None => vec![search, stage(FRICTION)],
    }
}

/// The stage of which a frame, when it leaves, frees the place of its `u_q`: points hand them on as they are searched, after
/// a walk the look has the same ones.
pub fn releases(plan: &JointPlan) -> usize {
    usize::from(plan.points.is_none() && plan.network.is_some())
}

fn quads(sensor: &Sensor) -> u64 {
    Quads::new(sensor.columns, sensor.rows).count() as u64
}
