//! Cycles of the line search's modules: counts of the emitted pipelines, exact.

use super::{CENTROID_BITS, LINE_FRACTION, LinePlan, SEARCH_STEPS};
use crate::cores::ratio;

/// From the last write of a frame to its direction: two divisions, each for both axes, and two products.
pub const DIRECTION_LATENCY: u64 = 10 + 2 * (ratio::latency(CENTROID_BITS) + 1);
/// From the line's start to its end: products, then both divisions at a time.
pub const LINE_LATENCY: u64 = 18 + ratio::latency(LINE_FRACTION + 2);

/// Rounds of the search for the minimum, and for each end of the level set.
pub fn rounds(of: &LinePlan) -> u64 {
    let bits = if of.points > 1 { 2 } else { 1 };
    u64::from(SEARCH_STEPS).div_ceil(bits)
}

/// Start to end of the search: both passes, the rounds for the minimum, the floor with a comparison, the rounds for the
/// ends of the level set. A cycle between a decision and the next evaluation computes the new points. While one end of
/// the level set waits for its decision, the other's taxels are read.
pub fn search(of: &LinePlan) -> u64 {
    let elements = of.cells.elements as u64;
    // From an evaluation's last taxel's address to the decision, with a stage more for several points at a time.
    let decision = 5 + u64::from(of.points > 1) + u64::from(of.cells.tree_levels());
    let slope = rounds(of) * (elements + decision + 1);
    let level = (rounds(of) - 1) * (2 * elements).max(elements + decision + 1) + 2 * elements + decision;
    2 * elements + 9 + slope + 2 * elements + decision + level
}
