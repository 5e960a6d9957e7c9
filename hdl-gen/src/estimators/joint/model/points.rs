//! The level set of the points that have a cell each, in integers.

use super::super::super::Seen;
use super::super::PointsPlan;
use super::super::WEIGHT_DROP;
use super::super::points::{VALUE_BITS, Values};
use super::Centroid;
use crate::cores::divider;
use crate::plan::format::FRICTION_FRACTION;

/// Finds the centroid of the points below the level, each weighing as its depth squared.
pub fn search(plan: &PointsPlan, seen: &Seen) -> Centroid {
    let Values { values, margin, clipped } = plan.values(seen.u, seen.contact);
    let (side, grid) = (plan.side, plan.grid);
    let reach = i64::from(grid.reach);
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
        let numerator = (i64::from(grid.numerator) * moment).unsigned_abs() << (FRICTION_FRACTION - grid.shift);
        let magnitude = divider::divide(numerator, sum as u64) as i64;
        if moment < 0 { -magnitude } else { magnitude }
    };
    Centroid {
        mu: moments.map(quotient),
        unknown: corners == 4,
        on_border: on_border < inside,
        saturated: clipped || inside.min(on_border) == (1 << VALUE_BITS) - 1,
    }
}
