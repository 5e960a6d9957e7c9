//! Op's line and search in integers.

use golden::products::ByPq;

use super::super::{Estimate, Inputs};
use super::direction::Direction;
use super::{LINE_FRACTION, LINE_SUM_BITS, LinePlan, RECTIFIER_DROP, SEARCH_STEPS};
use crate::cores::{LONG_BITS, ratio};
use crate::format::{FRICTION_BITS, FRICTION_FRACTION, largest, round_shift};

/// Ratios of this magnitude (4.0) and more make the line meaningless.
const WILD: u64 = 1 << (LINE_FRACTION + 2);
const ONE: i64 = 1 << FRICTION_FRACTION;

/// The line in the (`mu_x`, `mu_y`) plane: the dependent component is `c0 + c1 t` (Eqs. 22 and 23).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Whether t is `mu_x` (rather than `mu_y`).
    pub x_is_free: bool,
    /// No direction, or a line without sense.
    pub unknown: bool,
    /// Offset, [`LINE_FRACTION`] fraction bits.
    pub c0: i64,
    /// Slope, [`LINE_FRACTION`] fraction bits.
    pub c1: i64,
}

impl Line {
    pub fn new(sums: &ByPq<i64>, direction: &Direction) -> Self {
        let spread = sums[..2].iter().flatten().fold(0, |spread, &sum| spread | (sum ^ (sum >> 63)));
        let shift = (64 - spread.leading_zeros()).saturating_sub(LINE_SUM_BITS);
        let scaled: [[i64; 3]; 2] = std::array::from_fn(|p| sums[p].map(|sum| sum >> shift));
        let [g1, g2] = scaled;
        let [push_x, push_y] = direction.push;
        let a = g1[1] * push_y - g2[1] * push_x;
        let e = g1[2] * push_y - g2[2] * push_x;
        let k = g2[0] * push_x - g1[0] * push_y;
        let x_is_free = push_x.abs() >= push_y.abs() || direction.unknown;
        let (denominator, other) = if x_is_free { (e, a) } else { (a, e) };
        match (direction.unknown, ratio(-other, denominator), ratio(k, denominator)) {
            (false, Some(c1), Some(c0)) => Self { x_is_free, unknown: false, c0, c1 },
            _ => Self { x_is_free: true, unknown: true, c0: 0, c1: 0 },
        }
    }
}

/// `numerator / denominator` towards zero, with [`LINE_FRACTION`] fraction bits; none if it is 4 or more.
fn ratio(numerator: i64, denominator: i64) -> Option<i64> {
    let quotient = ratio::divide(numerator.unsigned_abs() << LINE_FRACTION, denominator.unsigned_abs());
    let magnitude = (quotient < WILD).then_some(quotient as i64)?;
    Some(if (numerator < 0) == (denominator < 0) { magnitude } else { -magnitude })
}

/// Finds the friction on the line of the push.
pub fn friction(plan: &LinePlan, inputs: &Inputs) -> Estimate {
    let line = Line::new(inputs.sums, &Direction::new(inputs, plan.pitch));
    let Optimum { t, at_bound, saturated } = search(&Rectifiers::new(&line, inputs.u), inputs.contact.stress_sum, plan);
    let exact = round_shift((line.c0 << FRICTION_FRACTION) + line.c1 * t, LINE_FRACTION);
    let dependent = exact.clamp(-largest(FRICTION_BITS) - 1, largest(FRICTION_BITS));
    let friction = match (line.unknown, line.x_is_free) {
        (true, _) => [0, 0],
        (false, true) => [t, dependent],
        (false, false) => [dependent, t],
    };
    Estimate { friction, unknown: line.unknown, at_bound: at_bound || dependent != exact, saturated }
}

/// Where the search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Optimum {
    /// Midpoint of the level set, [`FRICTION_FRACTION`] fraction bits.
    pub t: i64,
    /// The minimum lies at an end of [-1, 1].
    pub at_bound: bool,
    /// An `alpha` or `beta` was clipped.
    pub saturated: bool,
}

/// Searches for the minimum of `B(t)` and for both ends of its level set, in the hardware's steps.
fn search(rectifiers: &Rectifiers, stress_sum: i64, plan: &LinePlan) -> Optimum {
    let low = distance(|distance| rectifiers.slope(distance - ONE) < 0) - ONE;
    let high = low + 1;
    let (at_low, at_high) = (rectifiers.value(low), rectifiers.value(high));
    let (lowest, floor) = if at_high < at_low { (high, at_high) } else { (low, at_low) };
    let margin = match plan.level_shift {
        shift if shift >= 0 => stress_sum << shift,
        shift => stress_sum >> -shift,
    };
    let below = |t| rectifiers.value(t) <= floor + margin;
    let left = lowest - distance(|distance| distance < lowest + ONE && below(lowest - distance));
    let right = lowest + distance(|distance| distance < ONE - lowest && below(lowest + distance));
    Optimum { t: (left + right) >> 1, at_bound: low == -ONE || high == ONE, saturated: rectifiers.saturated }
}

/// The largest distance of those before which all are kept, by bisection: bit by bit, the highest first.
fn distance(keep: impl Fn(i64) -> bool) -> i64 {
    (0..SEARCH_STEPS).rev().fold(0, |found, bit| {
        let trial = found | 1 << bit;
        if keep(trial) { trial } else { found }
    })
}

/// `alpha_i + t beta_i` for every taxel.
struct Rectifiers {
    lines: Vec<(i64, i64)>,
    saturated: bool,
}

impl Rectifiers {
    fn new(line: &Line, u: &[Vec<i64>; 3]) -> Self {
        let [fixed, x, y] = u;
        let (free, dependent) = if line.x_is_free { (x, y) } else { (y, x) };
        let mut saturated = false;
        let mut mixed = |addend: i64, factor: i64, value: i64| {
            let exact = round_shift((addend << LINE_FRACTION) + factor * value, LINE_FRACTION);
            let clipped = exact.clamp(-largest(LONG_BITS) - 1, largest(LONG_BITS));
            saturated |= clipped != exact;
            clipped
        };
        let lines = (0..fixed.len())
            .map(|i| (mixed(fixed[i], line.c0, dependent[i]), mixed(free[i], line.c1, dependent[i])))
            .collect();
        Self { lines, saturated }
    }

    fn positive(&self, t: i64) -> impl Iterator<Item = (i64, i64)> + '_ {
        let rectifier = move |&(alpha, beta): &(i64, i64)| ((alpha << FRICTION_FRACTION) + t * beta, beta);
        self.lines.iter().map(rectifier).filter(|&(rectifier, _)| rectifier > 0)
    }

    fn slope(&self, t: i64) -> i64 {
        self.positive(t).map(|(_, beta)| beta).sum()
    }

    fn value(&self, t: i64) -> i64 {
        self.positive(t).map(|(rectifier, _)| rectifier >> RECTIFIER_DROP).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimators::Cells;

    #[test]
    fn bisections_find_ends_and_flat_valleys() {
        let rectifiers = |lines: &[(i64, i64)]| Rectifiers { lines: lines.to_vec(), saturated: false };
        // No rectifier at all; one that rises, one that falls throughout; a valley between both.
        let valley = [(-1 << 19, 1 << 20), (-1 << 19, -1 << 20)];
        let cases = [
            (rectifiers(&[]), 0, true),
            (rectifiers(&[(1 << 24, 1 << 22)]), -ONE, true),
            (rectifiers(&[(1 << 24, -1 << 22)]), ONE, true),
            (rectifiers(&valley), 0, false),
        ];
        for (rectifiers, t, at_bound) in cases {
            let cells = Cells { cells: 28, elements: 4 };
            let of = search(&rectifiers, 0, &LinePlan { cells, points: 1, level_shift: -1, pitch: [1 << 16; 2] });
            assert!((of.t - t).abs() <= 1 && of.at_bound == at_bound, "{of:?} for {t}");
        }
    }
}
