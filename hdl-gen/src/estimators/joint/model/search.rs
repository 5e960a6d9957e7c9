//! The grid search in integers: the centroid of the level set of Condition 1.

use super::super::super::Inputs;
use super::super::SearchPlan;
use super::super::search::{GRID, Values, WEIGHT_DROP};
use crate::cores::ratio;
use crate::format::FRICTION_FRACTION;

/// The level set's centroid.
pub struct Centroid {
    /// Friction components.
    pub mu: [i64; 2],
    /// All corners of the grid are in the level set.
    pub unknown: bool,
    /// The least value lies on the border of the grid only.
    pub on_border: bool,
    /// A value was clipped.
    pub saturated: bool,
}

/// Finds the centroid of the points below the level, each weighing as its depth squared.
pub fn search(plan: &SearchPlan, inputs: &Inputs) -> Centroid {
    let Values { values, margin, clipped } = plan.values(inputs.u, inputs.contact);
    let (side, reach) = (plan.side, i64::from(GRID.reach));
    let place = |index: usize| [index % side, index / side].map(|at| at as i64 - reach);
    let least = |border: bool| {
        let points = (0..values.len()).filter(|&index| place(index).iter().any(|at| at.abs() == reach) == border);
        points.map(|index| values[index]).min().unwrap_or(0)
    };
    let (inside, on_border) = (least(false), least(true));
    let level = inside.min(on_border) + margin;
    let (mut sums, mut corners) = ([0; 3], 0);
    for (index, value) in values.iter().enumerate() {
        let depth = (level - value).max(0);
        let [x, y] = place(index);
        corners += u32::from(depth > 0 && x.abs() == reach && y.abs() == reach);
        let weight = (depth * depth) >> WEIGHT_DROP;
        sums = [sums[0] + weight, sums[1] + weight * x, sums[2] + weight * y];
    }
    let [sum, ref moments @ ..] = sums;
    let quotient = |moment: i64| {
        let numerator = moment.unsigned_abs() << (FRICTION_FRACTION - GRID.shift);
        let magnitude = ratio::divide(numerator, sum as u64) as i64;
        if moment < 0 { -magnitude } else { magnitude }
    };
    Centroid { mu: moments.map(quotient), unknown: corners == 4, on_border: on_border < inside, saturated: clipped }
}
