//! Crosstalk of a row-column array: a cross that the readings beside a single contact have in common with its row and column
//! sums.

use nalgebra::{DMatrix, DVector};

use super::{LOADED, count, largest};
use crate::crosstalk::{Crosstalk, Factors};
use crate::design::Design;
use crate::numbers::middle;

/// Fewer frames show none.
const FRAMES: usize = 3;
/// Readings of this share of the largest are those of the contact.
const TOUCHED: f64 = 0.25;
/// Fewer taxels in its rows or columns, a depth away from it, show nothing.
const ARM: usize = 3;
/// Rounds of share and sums in turns.
const ROUNDS: usize = 6;
/// A share is one from so many standard errors on,
const CLEAR: f64 = 3.0;
/// in this part of the frames,
const MOST: f64 = 0.75;
/// and from this size on.
const LEAST: f64 = 0.003;
/// Rows and columns have the same share if each alone has it within this factor.
const ALIKE: f64 = 2.0;

/// A share that a frame shows.
#[derive(Clone, Copy)]
struct Share {
    share: f64,
    error: f64,
}

/// What one frame shows.
#[derive(Clone, Copy)]
struct Estimate {
    both: Share,
    /// Of rows and columns alone.
    each: Option<[Share; 2]>,
}

/// Shares of rows and columns, rounded, that frames of single contacts show and the design does not state, and what to say
/// of it. Values are as they are in the file.
pub(super) fn check(design: &Design, frames: &[Vec<f64>]) -> Option<([f64; 2], String)> {
    let known = design.input.crosstalk;
    let of_taxels = |frame: &Vec<f64>| {
        frame.iter().enumerate().map(|(taxel, &value)| design.input.to_pa(taxel, value)).collect::<Vec<f64>>()
    };
    let stress: Vec<Vec<f64>> = frames.iter().map(of_taxels).collect();
    let peak = stress.iter().map(|frame| largest(frame)).fold(0.0, f64::max);
    let loaded: Vec<&Vec<f64>> = stress.iter().filter(|frame| peak > 0.0 && largest(frame) >= LOADED * peak).collect();
    let found: Vec<Estimate> = loaded.iter().filter_map(|stress| estimate(design, stress)).collect();
    if found.len() < FRAMES {
        return None;
    }
    let is_clear = |shares: &[Share], share: f64| {
        let clear = shares.iter().filter(|one| (one.share - known).abs() >= CLEAR * one.error).count();
        shares.len() >= FRAMES
            && clear as f64 >= MOST * shares.len() as f64
            && share >= LEAST
            && (share - known).abs() >= LEAST
    };
    let both: Vec<Share> = found.iter().map(|one| one.both).collect();
    let each = [0, 1].map(|axis| found.iter().filter_map(|one| Some(one.each?[axis])).collect::<Vec<Share>>());
    let share = mean(&both);
    let shares = if each[0].is_empty() {
        [share; 2]
    } else {
        each.each_ref().map(|each| middle(each.iter().map(|one| one.share)))
    };
    let is_equal = shares.iter().all(|each| (share / ALIKE..=share * ALIKE).contains(each));
    let is_found =
        if is_equal { is_clear(&both, share) } else { (0..2).any(|axis| is_clear(&each[axis], shares[axis])) };
    is_found.then_some(())?;
    let rounded = |share: f64| (share.max(0.0) * 1e3).round() / 1e3;
    let [row, column] = if is_equal { [rounded(share); 2] } else { shares.map(rounded) };
    let crosstalk = Crosstalk::of(&design.sensor, [row, column]);
    let stated = Crosstalk::new(&design.sensor, known);
    let excess = 100.0 * (crosstalk.under_uniform_pressure() / stated.under_uniform_pressure() - 1.0);
    let of = count(found.len());
    let has = if known > 0.0 { format!(", and sensor.crosstalk is {known}") } else { String::new() };
    let (size, what) = (excess.abs(), if excess > 0.0 { "large" } else { "small" });
    let (reads, remedy) = if is_equal {
        (format!("{:.1} % of its row and of its column", 100.0 * row), format!("Write sensor.crosstalk = {row}"))
    } else {
        let Factors { row: of_row, column: of_column, total } = crosstalk.factors();
        let of_frame = if total > 0.0 { format!(", and add {total:.5} of its frame's") } else { String::new() };
        let named = |of: [f64; 2], say: &dyn Fn(f64, &str) -> String| {
            let lines = of.into_iter().zip(["row", "column"]).filter(|(share, _)| *share > 0.0);
            lines.map(|(share, line)| say(share, line)).collect::<Vec<_>>().join(" and ")
        };
        let sums = named([of_row, of_column], &|share, line| format!("{share:.4} of its {line}'s sum"));
        (
            named([row, column], &|share, line| format!("{:.1} % of its {line}", 100.0 * share)),
            format!(
                "sensor.crosstalk corrects equal shares alone: lessen it in the read-out, or before `sptfra` reads the frames \
                 subtract from each taxel {sums}{of_frame}"
            ),
        )
    };
    let message = format!(
        "crosstalk: in {of} of single contacts each taxel reads {reads} as well{has}; F_z comes out about {size:.0} % too \
         {what}. {remedy}"
    );
    Some(([row, column], message))
}

/// The mean share by the standard errors, of frames that agree with the middle one.
fn mean(found: &[Share]) -> f64 {
    let centre = middle(found.iter().map(|one| one.share));
    // Without noise a frame's error is next to nothing.
    let error = |one: &Share| one.error.max(LEAST / 10.0);
    let (mut sum, mut weights) = (0.0, 0.0);
    for one in found.iter().filter(|one| (one.share - centre).abs() <= CLEAR * error(one)) {
        let weight = error(one).powi(-2);
        sum += weight * one.share;
        weights += weight;
    }
    if weights > 0.0 { sum / weights } else { centre }
}

/// The share by which the readings far from a contact are those of its rows and columns; nothing of frames without such.
fn estimate(design: &Design, stress: &[f64]) -> Option<Estimate> {
    let sensor = &design.sensor;
    let peak = largest(stress);
    let is_touched = |taxel: usize| stress[taxel].abs() >= TOUCHED * peak;
    let touched: Vec<usize> = (0..stress.len()).filter(|&taxel| is_touched(taxel)).collect();
    let centre = [0, 1]
        .map(|axis| touched.iter().map(|&taxel| sensor.position_m(taxel)[axis]).sum::<f64>() / touched.len() as f64);
    let from = |taxel: usize| {
        let [x, y] = sensor.position_m(taxel);
        [x - centre[0], y - centre[1]]
    };
    let distance = |taxel: usize| from(taxel)[0].hypot(from(taxel)[1]);
    let radius = touched.iter().map(|&taxel| distance(taxel)).fold(0.0, f64::max);
    let near = radius + 1e-3 * sensor.depth_mm;
    let is_live = |taxel: &usize| !design.input.dead.contains(taxel);
    let far: Vec<usize> = (0..stress.len()).filter(|&taxel| distance(taxel) >= near).filter(is_live).collect();
    let place = |taxel: usize| [taxel % sensor.columns, taxel / sensor.columns];
    // Whether the contact is in the taxel's column, and in its row.
    let crosses =
        |taxel: usize| [0, 1].map(|axis| touched.iter().any(|&other| place(other)[axis] == place(taxel)[axis]));
    let count = |of: &dyn Fn([bool; 2]) -> bool| far.iter().filter(|&&taxel| of(crosses(taxel))).count();
    let arms = [count(&|[_, row]| row), count(&|[column, _]| column)];
    let beside = count(&|crosses| crosses == [false; 2]);
    // Without a corner that has neither, a cross is no cross.
    if arms.iter().all(|&arm| arm < 2 * ARM) || beside < ARM {
        return None;
    }
    let both = arms.iter().all(|&arm| arm >= ARM);
    let read = DVector::from_iterator(far.len(), far.iter().map(|&taxel| stress[taxel]));
    // What a layer has far from a contact: an offset, a decaying pressure, and the pull on one side of it.
    let tails = |taxel: usize| {
        let [x, y] = from(taxel);
        let decay = (near / distance(taxel)).powi(3);
        [1.0, decay, decay * x / distance(taxel), decay * y / distance(taxel)]
    };
    // Both together, or each on its own.
    let shares = |alike: bool| -> Option<Vec<Share>> {
        let mut shares = [0.0; 2];
        let mut found = Vec::new();
        for _ in 0..ROUNDS {
            let (crosstalk, mut undone) = (Crosstalk::of(sensor, shares), stress.to_vec());
            crosstalk.remove(&mut undone);
            let [rows, columns] = crosstalk.sums(&undone);
            let terms = |taxel: usize| {
                let [row, column] = [rows[place(taxel)[1]], columns[place(taxel)[0]]];
                let sums = if alike { vec![row + column] } else { vec![row, column] };
                [&sums[..], &tails(taxel)].concat()
            };
            found = fit(&read, &far, terms)?;
            shares = [0, usize::from(!alike)].map(|axis| found[axis].share.clamp(0.0, 0.2));
        }
        Some(found)
    };
    let (both, each) = (shares(true)?[0], if both { Some(shares(false)?) } else { None });
    Some(Estimate { both, each: each.map(|each| [each[0], each[1]]) })
}

/// Least squares of readings at some taxels: the factor of each term.
fn fit(read: &DVector<f64>, taxels: &[usize], terms: impl Fn(usize) -> Vec<f64>) -> Option<Vec<Share>> {
    let rows: Vec<Vec<f64>> = taxels.iter().map(|&taxel| terms(taxel)).collect();
    let count = rows[0].len();
    if rows.len() <= count {
        return None;
    }
    // Columns of length 1, so that no unit makes the system singular.
    let mut matrix = DMatrix::from_fn(rows.len(), count, |i, j| rows[i][j]);
    let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    if lengths.iter().any(|&length| length <= 0.0) {
        return None;
    }
    for (mut column, length) in matrix.column_iter_mut().zip(&lengths) {
        column /= *length;
    }
    let inverse = (matrix.transpose() * &matrix).try_inverse()?;
    let factors = &inverse * (matrix.transpose() * read);
    let left = read - &matrix * &factors;
    let variance = left.norm_squared() / (rows.len() - count) as f64;
    let of = |term: usize| Share {
        share: factors[term] / lengths[term],
        error: (variance * inverse[(term, term)]).max(0.0).sqrt() / lengths[term],
    };
    Some((0..count).map(of).collect())
}
