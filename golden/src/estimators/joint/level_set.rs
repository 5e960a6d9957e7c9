//! Condition 1 on a grid over the plane of both friction components, and the centroid of its level set.

use super::grid::Grid;
use crate::estimators::Estimate;
use crate::status::Status;

/// Sums side by side, so that a processor may form several at once.
const LANES: usize = 8;
/// Share of a value by which rounding may make it less than convexity has it, and much more.
const ROUNDING: f64 = 1e-9;

/// Memory of the search, to be used again for the next frame.
#[derive(Clone, Debug, Default)]
pub(super) struct GridScratch {
    /// `u_q` of the taxels that may be in tension somewhere on the grid, the dead zone taken off.
    u: [Vec<f64>; 3],
    /// Parts of the rectifiers' arguments that depend on the point's column, and on its row: taxel by taxel for each.
    columns: Vec<f64>,
    rows: Vec<f64>,
    /// The rectifiers' sums at all points.
    values: Vec<f64>,
}

/// `sum max(0, a + b)` over pairs.
fn rectifiers(a: &[f64], b: &[f64]) -> f64 {
    let rectifier = |(a, b): (&f64, &f64)| {
        let stress = a + b;
        if stress > 0.0 { stress } else { 0.0 }
    };
    let (chunks_a, rest_a) = a.as_chunks::<LANES>();
    let (chunks_b, rest_b) = b.as_chunks::<LANES>();
    let rest: f64 = rest_a.iter().zip(rest_b).map(rectifier).sum();
    let mut sums = [0.0; LANES];
    for (a, b) in chunks_a.iter().zip(chunks_b) {
        for (sum, pair) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += rectifier(pair);
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// Condition 1 at the points of the grid, row by row, as far as they may be in the level set; the others are left at
/// infinity.
///
/// It is convex. Past a point of a row that is above the level, and not below the point before it, all are; the level is
/// the least value plus the allowance, and so at most what it is of the values that are known. Rows are walked from the
/// middle of the grid outwards, each from the place where the one before was least.
fn evaluate(side: usize, value: impl Fn(usize, usize) -> f64, allowance: f64, values: &mut Vec<f64>) {
    values.clear();
    values.resize(side * side, f64::INFINITY);
    let mut least = f64::INFINITY;
    let mut walk = |row: usize, start: usize| {
        let values = &mut values[row * side..][..side];
        let mut best = start;
        values[start] = value(row, start);
        least = least.min(values[start]);
        for step in [1, -1] {
            let mut column = start;
            while let Some(next) = column.checked_add_signed(step).filter(|&next| next < side) {
                values[next] = value(row, next);
                least = least.min(values[next]);
                if values[next] < values[best] {
                    best = next;
                }
                if values[next] >= values[column] && values[next] > (least + allowance) * (1.0 + ROUNDING) {
                    break;
                }
                column = next;
            }
        }
        best
    };
    let middle = side / 2;
    let mut above = walk(middle, middle);
    let mut below = above;
    for row in middle + 1..side {
        above = walk(row, above);
    }
    for row in (0..middle).rev() {
        below = walk(row, below);
    }
}

/// Searches the grid for `u_q` in pascals, the dead zone in pascals and the allowance above the least value.
pub(super) fn search(
    grid: Grid,
    u: [&[f64]; 3],
    dead_zone: f64,
    allowance: f64,
    scratch: &mut GridScratch,
) -> Estimate {
    let GridScratch { u: pulled, columns, rows, values } = scratch;
    let (side, reach) = (grid.side(), f64::from(grid.reach));
    let largest = grid.step() * reach;
    pulled.iter_mut().for_each(Vec::clear);
    for ((&u0, &u1), &u2) in u[0].iter().zip(u[1]).zip(u[2]) {
        if u0 - dead_zone + largest * (u1.abs() + u2.abs()) > 0.0 {
            pulled.iter_mut().zip([u0 - dead_zone, u1, u2]).for_each(|(kept, value)| kept.push(value));
        }
    }
    let (u, taxels) = (&*pulled, pulled[0].len());
    columns.clear();
    rows.clear();
    for point in -grid.reach..=grid.reach {
        let mu = grid.step() * f64::from(point);
        columns.extend(u[0].iter().zip(&u[1]).map(|(u0, u1)| u0 + u1 * mu));
        rows.extend(u[2].iter().map(|u2| u2 * mu));
    }
    let at = |point: usize| point * taxels..(point + 1) * taxels;
    evaluate(side, |row, column| rectifiers(&columns[at(column)], &rows[at(row)]), allowance, values);

    // The least value inside the grid and on its border.
    let (mut inside, mut on_border) = (f64::INFINITY, f64::INFINITY);
    let least = |least: f64, values: &[f64]| values.iter().copied().fold(least, f64::min);
    for (row, values) in values.chunks_exact(side).enumerate() {
        let ends = 1..side - 1;
        if ends.contains(&row) {
            inside = least(inside, &values[ends]);
            on_border = on_border.min(values[0]).min(values[side - 1]);
        } else {
            on_border = least(on_border, values);
        }
    }
    let level = inside.min(on_border) + allowance;
    let mut status = Status::default();
    if [0, side - 1, side * (side - 1), side * side - 1].iter().all(|&corner| values[corner] < level) {
        status.insert(Status::DIRECTION_UNKNOWN);
        return Estimate { status, mu: [0.0; 2] };
    }
    if on_border < inside {
        status.insert(Status::AT_BOUND);
    }
    let mut sums = [0.0; 3];
    for (row, values) in values.chunks_exact(side).enumerate() {
        for (column, value) in values.iter().enumerate().filter(|(_, value)| **value < level) {
            // A point at the edge of the level set weighs nothing, so that the grid can be coarse.
            let weight = (level - value).powi(2);
            sums[0] += weight;
            sums[1] += weight * (column as f64 - reach);
            sums[2] += weight * (row as f64 - reach);
        }
    }
    // With an allowance above 0 the best point has a weight.
    let mu = if sums[0] > 0.0 { [sums[1], sums[2]].map(|sum| grid.step() * sum / sums[0]) } else { [0.0; 2] };
    Estimate { status, mu }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vectors(rows: [[f64; 3]; 4]) -> [Vec<f64>; 3] {
        [0, 1, 2].map(|q| rows.iter().map(|row| row[q]).collect())
    }

    fn search(u: &[Vec<f64>; 3], dead_zone: f64, allowance: f64) -> Estimate {
        super::search(Grid::SEARCH, u.each_ref().map(Vec::as_slice), dead_zone, allowance, &mut GridScratch::default())
    }

    #[test]
    fn a_symmetric_valley_has_its_centre_on_the_grid() {
        // Rectifiers that rise away from (0.25, -0.5) along both axes.
        let u = vectors([[-0.25, 1.0, 0.0], [0.25, -1.0, 0.0], [0.5, 0.0, 1.0], [-0.5, 0.0, -1.0]]);
        let found = search(&u, 0.0, 0.5);
        assert_eq!(found.status, Status::default());
        assert!((found.mu[0] - 0.25).abs() < 1e-12 && (found.mu[1] + 0.5).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn the_dead_zone_widens_the_valley_evenly() {
        let u = vectors([[-0.25, 1.0, 0.0], [0.25, -1.0, 0.0], [0.5, 0.0, 1.0], [-0.5, 0.0, -1.0]]);
        let found = search(&u, 0.2, 0.1);
        assert!((found.mu[0] - 0.25).abs() < 1e-12 && (found.mu[1] + 0.5).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn between_grid_points_the_weights_interpolate() {
        // The valley moves by a quarter of a step at a time, and the estimate with it. The level set is 8 steps wide.
        let allowance = 4.0 * Grid::SEARCH.step();
        for quarter in 0..8 {
            let at = Grid::SEARCH.step() * f64::from(quarter) / 4.0;
            let u = vectors([[-at, 1.0, 0.0], [at, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]);
            let found = search(&u, 0.0, allowance);
            assert!((found.mu[0] - at).abs() < 0.02 * Grid::SEARCH.step(), "{at} {found:?}");
        }
    }

    /// The steps of `docs/explanation/estimators.md` in integers: `u_q` of 27 bits, weights of 18.
    fn search_in_integers(u: &[Vec<i64>; 3], dead_zone: i64, allowance: i64) -> [f64; 2] {
        let mut values = Vec::new();
        // Finer by the grid's step, so that a step adds `u_1` or `u_2` as they are.
        let finer = 1_i64 << Grid::SEARCH.shift;
        let (side, reach) = (Grid::SEARCH.side(), i64::from(Grid::SEARCH.reach));
        let terms = u[0].iter().zip(&u[1]).zip(&u[2]);
        let mut row: Vec<i64> = terms.map(|((u0, u1), u2)| finer * (u0 - dead_zone) - reach * (u1 + u2)).collect();
        for _ in 0..side {
            let mut point = row.clone();
            for _ in 0..side {
                values.push(point.iter().map(|&stress| stress.max(0)).sum::<i64>());
                point.iter_mut().zip(&u[1]).for_each(|(stress, step)| *stress += step);
            }
            row.iter_mut().zip(&u[2]).for_each(|(stress, step)| *stress += step);
        }
        let allowance = finer * allowance;
        let level = values.iter().min().unwrap() + allowance;
        // The weights keep the 18 leading bits of the allowance.
        let shift = (64 - allowance.leading_zeros()).saturating_sub(18);
        let mut sums = [0_i64; 3];
        for (index, value) in values.iter().enumerate() {
            let weight = ((level - value).max(0) >> shift).pow(2);
            sums[0] += weight;
            sums[1] += weight * ((index % side) as i64 - reach);
            sums[2] += weight * ((index / side) as i64 - reach);
        }
        [sums[1], sums[2]].map(|sum| Grid::SEARCH.step() * sum as f64 / sums[0] as f64)
    }

    #[test]
    fn integers_find_the_same() {
        // A contact pushed along x and y: compression, with tension behind it, and u_1, u_2 of either sign.
        let taxel = |i: usize| [(i % 10) as f64 - 4.6, (i / 10) as f64 - 4.3];
        let bell = |i: usize| (-taxel(i).iter().map(|x| x * x).sum::<f64>() / 8.0).exp();
        let tilt = |i: usize, axis: usize| 0.4 * taxel(i)[axis] * bell(i);
        let u: [Vec<f64>; 3] = [
            (0..100).map(|i| -50_000.0 * (bell(i) + 0.3 * tilt(i, 0) - 0.2 * tilt(i, 1))).collect(),
            (0..100).map(|i| 50_000.0 * tilt(i, 0)).collect(),
            (0..100).map(|i| 50_000.0 * tilt(i, 1)).collect(),
        ];
        // The full scale of 10^5 Pa in 27 bits.
        let steps = 26_f64.exp2() / 1e5;
        let whole = u.each_ref().map(|u| u.iter().map(|stress| (stress * steps).round() as i64).collect());
        let found = search(&u, 150.0, 2000.0);
        let integers = search_in_integers(&whole, (150.0 * steps) as i64, (2000.0 * steps) as i64);
        assert!(found.mu[0] > 0.2 && found.mu[1] < -0.1, "{found:?}");
        for (found, integer) in found.mu.iter().zip(integers) {
            assert!((found - integer).abs() < 1e-5, "{found} {integer}");
        }
    }

    /// What is left out of the grid is above the level set, and the rest is as it is.
    #[test]
    fn points_that_are_left_out_are_above_the_level() {
        let mut left_out = 0;
        for seed in 0..200_u32 {
            let number =
                |at: u32| f64::from((seed * 7919 + at * 104_729).wrapping_mul(2_654_435_761) >> 12) / 524_288.0 - 1.0;
            let taxels = 1 + seed % 23;
            let u = [0, 1, 2].map(|q| -> Vec<f64> { (0..taxels).map(|taxel| number(3 * taxel + q) - 0.3).collect() });
            let (side, allowance) = (21, 0.02 * f64::from(1 + seed % 9));
            let value = |row: usize, column: usize| {
                let [x, y] = [column, row].map(|at| (at as f64 - 10.0) / 8.0);
                (0..taxels as usize).map(|i| (u[0][i] + x * u[1][i] + y * u[2][i]).max(0.0)).sum::<f64>()
            };
            let mut values = Vec::new();
            evaluate(side, value, allowance, &mut values);
            let all = (0..side * side).map(|index| value(index / side, index % side));
            let level = all.clone().fold(f64::INFINITY, f64::min) + allowance;
            for (found, value) in values.iter().zip(all) {
                assert!(found.to_bits() == value.to_bits() || (*found == f64::INFINITY && value > level), "{seed}");
                left_out += usize::from(*found == f64::INFINITY);
            }
        }
        assert!(left_out > 200 * 100, "{left_out}");
    }

    #[test]
    fn nothing_that_limits_friction_means_no_direction() {
        let u = vectors([[-1.0, 0.0, 0.0]; 4]);
        let found = search(&u, 0.0, 0.5);
        assert_eq!(found, Estimate { status: Status::DIRECTION_UNKNOWN, mu: [0.0; 2] });
    }

    #[test]
    fn a_slope_across_the_grid_ends_at_its_bound() {
        let u = vectors([[5.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0; 3]]);
        let found = search(&u, 0.0, 0.5);
        assert_eq!(found.status, Status::AT_BOUND);
        assert!(found.mu[0] < -1.0 && found.mu[1].abs() < 1e-12, "{found:?}");
    }
}
