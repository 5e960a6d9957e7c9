//! Cycles of the line estimator's modules: counts of the emitted pipelines, exact.

use super::super::Cells;
use super::SEARCH_STEPS;
use crate::cores::divider;

/// From the last write of a frame to its direction: two divisions, each for both axes, and two products.
pub const DIRECTION_LATENCY: u64 = 10 + 2 * (divider::LATENCY as u64 + 1);
/// From the line's start to its end: products, then both divisions at a time.
pub const LINE_LATENCY: u64 = 18 + divider::LATENCY as u64;

/// Cycles from the last taxel's address in an evaluation to the decision.
pub fn decision(cells: Cells) -> u32 {
    5 + cells.tree_levels()
}

/// Start to end of the search: both passes, the slope bisections, the floor with a comparison, the level bisections; a
/// cycle between a bisection and the next evaluation, in which the new middle is computed. While one end of the level set
/// waits for its decision, the other's taxels are read.
pub fn search(cells: Cells) -> u64 {
    let elements = cells.elements as u64;
    let decision = u64::from(decision(cells));
    let steps = u64::from(SEARCH_STEPS);
    let slope = steps * (elements + decision + 1);
    let pair = 2 * elements + decision;
    let level = (steps - 1) * (2 * elements).max(elements + decision + 1) + pair;
    2 * elements + 9 + slope + pair + level
}
