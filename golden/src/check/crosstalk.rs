//! Crosstalk of a row-column array: a cross that the readings beside a single contact have in common with its row and column
//! sums.

use nalgebra::{DMatrix, DVector};

use super::{LOADED, count, largest};
use crate::crosstalk::Crosstalk;
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
/// from this size on,
const LEAST: f64 = 0.003;
/// and if rows and columns alone have it within this factor.
const ALIKE: f64 = 2.0;

/// What the frames of contacts show.
pub(super) struct Found {
    /// The share, rounded.
    pub(super) share: f64,
    /// What to say of it.
    pub(super) message: String,
}

/// What one frame shows.
#[derive(Clone, Copy)]
struct Estimate {
    share: f64,
    /// Of rows and columns alone.
    each: Option<[f64; 2]>,
    error: f64,
}

/// A share that frames of single contacts, values as they are in the file, show and the design does not state.
pub(super) fn check(design: &Design, frames: &[Vec<f64>]) -> Option<Found> {
    let known = design.input.crosstalk;
    let of_taxels = |frame: &Vec<f64>| {
        frame.iter().enumerate().map(|(taxel, &value)| design.input.to_pa(taxel, value)).collect::<Vec<f64>>()
    };
    let stress: Vec<Vec<f64>> = frames.iter().map(of_taxels).collect();
    let peak = stress.iter().map(|frame| largest(frame)).fold(0.0, f64::max);
    let loaded: Vec<&Vec<f64>> = stress.iter().filter(|frame| peak > 0.0 && largest(frame) >= LOADED * peak).collect();
    let found: Vec<Estimate> = loaded.iter().filter_map(|stress| estimate(design, stress)).collect();
    let clear = found.iter().filter(|one| (one.share - known).abs() >= CLEAR * one.error).count();
    if found.len() < FRAMES || (clear as f64) < MOST * found.len() as f64 {
        return None;
    }
    let share = mean(&found);
    let each = |axis: usize| middle(found.iter().filter_map(|one| one.each.map(|each| each[axis])));
    let both = found.iter().any(|one| one.each.is_some());
    let alike = !both || [each(0), each(1)].iter().all(|each| (share / ALIKE..=share * ALIKE).contains(each));
    if share < LEAST || !alike || (share - known).abs() < LEAST {
        return None;
    }
    let share = (share * 1e3).round() / 1e3;
    let reads = |share: f64| Crosstalk::new(&design.sensor, share).under_uniform_pressure();
    let excess = 100.0 * (reads(share) / reads(known) - 1.0);
    let (percent, of) = (100.0 * share, count(found.len()));
    let has = if known > 0.0 { format!(", and sensor.crosstalk is {known}") } else { String::new() };
    let (size, what) = (excess.abs(), if excess > 0.0 { "large" } else { "small" });
    Some(Found {
        share,
        message: format!(
            "crosstalk: in {of} of single contacts each taxel reads {percent:.1} % of its row and of its column as well{has}; F_z \
             comes out about {size:.0} % too {what}. Write sensor.crosstalk = {share}"
        ),
    })
}

/// The mean share by the standard errors, of frames that agree with the middle one.
fn mean(found: &[Estimate]) -> f64 {
    let centre = middle(found.iter().map(|one| one.share));
    // Without noise a frame's error is next to nothing.
    let error = |one: &Estimate| one.error.max(LEAST / 10.0);
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
    let mut share = 0.0;
    let mut result = None;
    for _ in 0..ROUNDS {
        let (crosstalk, mut undone) = (Crosstalk::new(sensor, share), stress.to_vec());
        crosstalk.remove(&mut undone);
        let [rows, columns] = crosstalk.sums(&undone);
        let sums = |taxel: usize| [rows[place(taxel)[1]], columns[place(taxel)[0]]];
        let both_alike = |taxel: usize| [&[sums(taxel).iter().sum()], &tails(taxel)[..]].concat();
        let (fitted, error) = fit(&read, &far, both_alike)?;
        let (each, _) = fit(&read, &far, |taxel| [&sums(taxel)[..], &tails(taxel)].concat())?;
        share = fitted[0].clamp(0.0, 0.2);
        result = Some(Estimate { share: fitted[0], each: both.then(|| [each[0], each[1]]), error });
    }
    result
}

/// Least squares of readings at some taxels: factors of the terms, and the standard error of the first.
fn fit(read: &DVector<f64>, taxels: &[usize], terms: impl Fn(usize) -> Vec<f64>) -> Option<(Vec<f64>, f64)> {
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
    let error = (variance * inverse[(0, 0)]).max(0.0).sqrt() / lengths[0];
    Some((factors.iter().zip(&lengths).map(|(factor, length)| factor / length).collect(), error))
}
