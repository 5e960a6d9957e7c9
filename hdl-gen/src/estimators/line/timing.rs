//! Cycles of the line estimator's modules: counts of the emitted pipelines, exact.

use super::{LINE_FRACTION, LinePlan, PART_BITS, SEARCH_STEPS};
use crate::cores::divider;

/// From the last write of a frame to its direction: two divisions, each for both axes, and two products.
pub const DIRECTION_LATENCY: u64 = 10 + 2 * (divider::LATENCY as u64 + 1);
/// From the line's start to its end: products, then both divisions at a time, a cycle for each bit of a quotient and one.
pub const LINE_LATENCY: u64 = 18 + LINE_FRACTION as u64 + 2 + 1;

/// Start to end of the search: both passes, the rounds for the minimum, the floor with a comparison, the rounds for the
/// ends of the level set; a cycle between a decision and the next evaluation, in which the new points are computed. While
/// one end of the level set waits for its decision, the other's taxels are read.
pub fn search(of: &LinePlan) -> u64 {
    let elements = of.cells.elements as u64;
    // From a pass's last taxel's address to the decision, with a stage more for several points at a time.
    let decision = 5 + u64::from(of.eighths) + u64::from(of.cells.tree_levels());
    // Passes of a round; points of the floor at a time, of two.
    let (rounds, passes, floor) = if of.eighths {
        (PART_BITS.len() as u64, 2 * elements, elements)
    } else {
        (SEARCH_STEPS.into(), elements, 2 * elements)
    };
    let slope = rounds * (passes + decision + 1);
    let level = (rounds - 1) * (2 * passes).max(passes + decision + 1) + 2 * passes + decision;
    2 * elements + 9 + slope + floor + decision + level
}
