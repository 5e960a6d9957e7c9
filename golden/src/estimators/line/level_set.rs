//! Exact minimum of a sum of rectifiers along a line.

/// Range of the variable on the line: friction components beyond one are not searched.
const RANGE: [f64; 2] = [-1.0, 1.0];

/// Result of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LevelSet {
    /// Least value in the range.
    pub(super) minimum: f64,
    /// Whether it is taken at an end of the range.
    pub(super) at_bound: bool,
    /// Ends of the interval in which the value exceeds the minimum by no more than the allowance.
    pub(super) interval: [f64; 2],
}

/// Memory of the search, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub struct LineScratch {
    /// The rectifiers.
    pub(super) alpha: Vec<f64>,
    pub(super) beta: Vec<f64>,
    knots: Vec<f64>,
}

/// Finds where `B(t) = sum_i max(0, alpha_i + t beta_i)` on [-1, 1] is within `allowance` of its minimum.
///
/// B is convex and piecewise linear, so the leftmost minimum is found by bisection over its breakpoints on the sign
/// of the slope, and the ends of the level set by bisection and one interpolation: exact up to rounding. The rectifiers
/// are those in `scratch`.
pub(super) fn level_set(scratch: &mut LineScratch, allowance: f64) -> LevelSet {
    let LineScratch { alpha, beta, knots } = scratch;
    let (alpha, beta) = (&*alpha, &*beta);
    let terms = || alpha.iter().zip(beta);
    let value = |t: f64| -> f64 { terms().map(|(a, b)| (a + t * b).max(0.0)).sum() };
    let slope = |t: f64| -> f64 { terms().filter(|(a, b)| *a + t * *b > 0.0).map(|(_, b)| b).sum() };

    knots.clear();
    knots.extend(terms().map(|(a, b)| -a / b).filter(|t| t.abs() < 1.0).chain(RANGE));
    // Equal knots are one, so that an unstable sort, which needs no memory, will do.
    knots.sort_unstable_by(f64::total_cmp);
    knots.dedup();

    // Between neighbouring knots the slope is constant; it is taken in the middle, away from the rounding of the
    // knots themselves.
    let (mut falling, mut end) = (0, knots.len() - 1);
    while falling < end {
        let middle = falling.midpoint(end);
        if slope(knots[middle].midpoint(knots[middle + 1])) < 0.0 {
            falling = middle + 1;
        } else {
            end = middle;
        }
    }
    let optimum = knots[falling];
    let minimum = value(optimum);
    let level = minimum + allowance;

    // Values at the knots fall up to the optimum and rise from there on.
    let first_low = knots[..falling].partition_point(|&t| value(t) > level);
    let last_low = falling + knots[falling..].partition_point(|&t| value(t) <= level) - 1;
    let crossing = |inside: f64, outside: f64| {
        let (low, high) = (value(inside), value(outside));
        inside + (outside - inside) * ((level - low) / (high - low)).clamp(0.0, 1.0)
    };
    let left = match first_low {
        0 => knots[0],
        index => crossing(knots[index], knots[index - 1]),
    };
    let right = match knots.get(last_low + 1) {
        None => knots[last_low],
        Some(&outside) => crossing(knots[last_low], outside),
    };
    LevelSet { minimum, at_bound: slope(RANGE[0]) >= 0.0 || slope(RANGE[1]) < 0.0, interval: [left, right] }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp)] // every number of these tests is a sum of powers of two

    use super::*;
    use proptest::prelude::*;

    fn level_set(alpha: &[f64], beta: &[f64], allowance: f64) -> LevelSet {
        let mut scratch = LineScratch { alpha: alpha.to_vec(), beta: beta.to_vec(), ..LineScratch::default() };
        super::level_set(&mut scratch, allowance)
    }

    fn value(alpha: &[f64], beta: &[f64], t: f64) -> f64 {
        let terms = alpha.iter().zip(beta);
        terms.map(|(a, b)| (a + t * b).max(0.0)).sum()
    }

    #[test]
    fn a_flat_valley_is_found_whole() {
        // Rectifiers that rise to the left of -0.25 and to the right of 0.75, with slope 2 and 1.
        let found = level_set(&[-0.5, -0.75], &[-2.0, 1.0], 0.0);
        assert_eq!((found.minimum, found.interval), (0.0, [-0.25, 0.75]));
        assert!(!found.at_bound);
        let found = level_set(&[-0.5, -0.75], &[-2.0, 1.0], 0.125);
        assert_eq!(found.interval, [-0.3125, 0.875]);
    }

    #[test]
    fn a_minimum_at_an_end_is_reported() {
        let rising = level_set(&[5.0], &[1.0], 0.5);
        assert_eq!((rising.at_bound, rising.interval), (true, [-1.0, -0.5]));
        let falling = level_set(&[5.0], &[-1.0], 0.5);
        assert_eq!((falling.at_bound, falling.interval), (true, [0.5, 1.0]));
    }

    #[test]
    fn no_rectifier_at_all_leaves_the_whole_range() {
        let found = level_set(&[0.0, -3.0], &[0.0, 1.0], 0.0);
        assert_eq!(found.interval, [-1.0, 1.0]);
    }

    proptest! {
        #[test]
        fn no_point_of_a_fine_scan_contradicts_it(
            terms in proptest::collection::vec((-10.0..10.0_f64, -10.0..10.0_f64), 1..30),
            allowance in 0.0..5.0_f64,
        ) {
            let (alpha, beta): (Vec<f64>, Vec<f64>) = terms.into_iter().unzip();
            let found = level_set(&alpha, &beta, allowance);
            let level = found.minimum + allowance;
            let rounding = 1e-10;
            for step in -1000..=1000 {
                let t = f64::from(step) / 1000.0;
                let value = value(&alpha, &beta, t);
                prop_assert!(value >= found.minimum - rounding);
                let inside = (found.interval[0]..=found.interval[1]).contains(&t);
                let excess = if inside { value - level } else { level - value };
                prop_assert!(excess <= rounding, "{excess} at {t}");
            }
        }
    }
}
