//! From counts to pascals, for all taxels: which curve the recording asks for.
//!
//! The unknowns of a line, of a power law and of straight pieces are found by least squares of the relative error of the
//! load, the slopes of the pieces none below zero, and smooth by a penalty on how they differ.

use nalgebra::{DMatrix, DVector};

use crate::numbers::sorted;

/// Pieces of a curve.
const PIECES: usize = 8;
/// Range of a power law's exponent, as the design file has it.
const POWERS: [f64; 2] = [0.25, 4.0];
/// Up to this share of the largest reading a power law is straight.
pub(super) const STRAIGHT: f64 = 0.02;
/// No piece is flatter than this share of the mean slope: a flat one has no count for a stress.
const FLATTEST: f64 = 0.01;

/// A kind of curve, in the order of how much it asks of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// The design's own, times a factor.
    Own,
    Line,
    Power,
    /// Straight pieces; the penalty on the differences of their slopes.
    Pieces(f64),
}

/// The design's own curve over readings above rest, in pascals that press.
pub(super) type Own = dyn Fn(usize, f64) -> f64 + Sync;

/// A curve with its size.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// The design's own, times this.
    Own(f64),
    /// Pascals of a count.
    Line(f64),
    /// `scale * count^power`, counts from the base on; up to `straight` a line, so that noise around rest stays noise.
    Power { power: f64, scale: f64, straight: f64 },
    /// Knots in counts above the unloaded reading, from 0 on, and the pascals of a count between them.
    Pieces { knots: Vec<f64>, slopes: Vec<f64> },
}

/// The counts of a sensor that curves are made for.
pub(super) struct Counts {
    /// Unloaded readings, with the sign that makes pressing positive: one curve serves taxels of several.
    pub(super) rest: Vec<f64>,
    /// The middle one: curves begin there.
    pub(super) base: f64,
    pub(super) own: Box<Own>,
    /// Where pieces begin above the base, from 0 to the largest reading.
    pub(super) knots: Vec<f64>,
}

impl Counts {
    /// How much of a reading above rest lies in each piece.
    fn parts(&self, knots: &[f64], taxel: usize, x: f64) -> impl Iterator<Item = f64> {
        let from = self.rest[taxel] - self.base;
        basis(knots, x + from).into_iter().zip(basis(knots, from)).map(|(to, from)| to - from)
    }

    /// The largest reading above the base.
    pub(super) fn largest(&self) -> f64 {
        self.knots.last().copied().unwrap_or(1.0)
    }
}

/// What a curve is fitted to: weights of the taxels in the load, with their gains, and readings above rest.
pub(super) struct Terms<'a> {
    /// For each hold: the weights.
    pub(super) weights: &'a [Vec<f64>],
    /// For each hold: the readings.
    pub(super) x: &'a [&'a [f64]],
    pub(super) loads: &'a [f64],
    /// What an error of a hold counts: the inverse of a load.
    pub(super) trust: &'a [f64],
    pub(super) counts: &'a Counts,
}

impl Shape {
    /// Pascals of a taxel's reading above rest, before its gain.
    pub(super) fn at(&self, taxel: usize, x: f64, counts: &Counts) -> f64 {
        match self {
            Self::Own(factor) => factor * (counts.own)(taxel, x),
            Self::Line(slope) => slope * x,
            Self::Power { power, scale, straight } => {
                let from = counts.rest[taxel] - counts.base;
                scale * (powered(x + from, *power, *straight) - powered(from, *power, *straight))
            }
            Self::Pieces { knots, slopes } => {
                counts.parts(knots, taxel, x).zip(slopes).map(|(part, slope)| part * slope).sum()
            }
        }
    }
}

/// A power law that begins with a straight piece.
pub(super) fn powered(x: f64, power: f64, straight: f64) -> f64 {
    if x < straight { x * straight.powf(power - 1.0) } else { x.powf(power) }
}

/// How much of a reading lies in each piece; below the first and beyond the last these go on.
fn basis(knots: &[f64], x: f64) -> Vec<f64> {
    let last = knots.len() - 2;
    let part = |(index, pair): (usize, &[f64])| {
        let low = if index == 0 { f64::NEG_INFINITY } else { 0.0 };
        let high = if index == last { f64::INFINITY } else { pair[1] - pair[0] };
        (x - pair[0]).clamp(low, high)
    };
    knots.windows(2).enumerate().map(part).collect()
}

/// Knots such that every piece has the same share of what is read.
pub(super) fn knots(x: &[&[f64]], noise: f64) -> Vec<f64> {
    let read = sorted(x.iter().flat_map(|x| x.iter().copied()).filter(|&x| x > 3.0 * noise && x > 0.0));
    let largest = read.last().copied().unwrap_or(1.0);
    let total: f64 = read.iter().sum();
    let mut knots = vec![0.0];
    let mut sum = 0.0;
    for &x in &read {
        sum += x;
        let wanted = total * knots.len() as f64 / PIECES as f64;
        // Far enough apart that each says something.
        if sum >= wanted && knots.len() < PIECES && x > knots[knots.len() - 1] + 0.02 * largest && x < 0.97 * largest {
            knots.push(x);
        }
    }
    // Below the first one most curves bend.
    if knots.len() > 1 && knots[1] > 0.1 * largest {
        knots.insert(1, 0.4 * knots[1]);
    }
    knots.push(largest);
    knots
}

/// Fits a kind of curve to some of the holds.
pub(super) fn fit(kind: Kind, terms: &Terms<'_>, holds: &[usize]) -> Shape {
    let load = |h: usize, at: &dyn Fn(usize, f64) -> f64| -> f64 {
        terms.weights[h].iter().zip(terms.x[h]).enumerate().map(|(taxel, (weight, &x))| weight * at(taxel, x)).sum()
    };
    // The factor of a curve, and the squares that are left.
    let factor = |at: &dyn Fn(usize, f64) -> f64| {
        let (mut found, mut square, mut all) = (0.0, 0.0, 0.0);
        for &h in holds {
            let (z, l, trust) = (load(h, at), terms.loads[h], terms.trust[h].powi(2));
            found += trust * z * l;
            square += trust * z * z;
            all += trust * l * l;
        }
        if square > 0.0 { (found / square, all - found * found / square) } else { (0.0, all) }
    };
    match kind {
        Kind::Own => Shape::Own(factor(&terms.counts.own).0),
        Kind::Line => Shape::Line(factor(&|_, x| x).0),
        Kind::Power => {
            // In the largest reading, so that no power overflows.
            let largest = terms.counts.largest();
            let law = |power: f64| {
                factor(&|taxel, x| {
                    let from = (terms.counts.rest[taxel] - terms.counts.base) / largest;
                    powered(x / largest + from, power, STRAIGHT) - powered(from, power, STRAIGHT)
                })
            };
            let log = minimum(POWERS.map(f64::ln), |log| law(log.exp()).1);
            let power = log.exp();
            Shape::Power { power, scale: law(power).0 / largest.powf(power), straight: STRAIGHT * largest }
        }
        Kind::Pieces(smooth) => pieces(terms, holds, smooth),
    }
}

fn pieces(terms: &Terms<'_>, holds: &[usize], smooth: f64) -> Shape {
    let knots = &terms.counts.knots;
    let count = knots.len() - 1;
    let (mut normal, mut right) = (DMatrix::zeros(count, count), DVector::zeros(count));
    let mut mean = [0.0; 2];
    for &h in holds {
        let mut z = DVector::zeros(count);
        for (taxel, (weight, &x)) in terms.weights[h].iter().zip(terms.x[h]).enumerate() {
            for (sum, part) in z.iter_mut().zip(terms.counts.parts(knots, taxel, x)) {
                *sum += weight * part;
            }
        }
        let trust = terms.trust[h].powi(2);
        let line: f64 = z.sum();
        mean[0] += trust * line * terms.loads[h];
        mean[1] += trust * line * line;
        normal += trust * &z * z.transpose();
        right += trust * terms.loads[h] * z;
    }
    let slope = if mean[1] > 0.0 { mean[0] / mean[1] } else { 0.0 };
    // The penalty in the same measure as the errors: slopes over their mean, so many holds.
    let strength = smooth * mean[1] / count as f64;
    for piece in 1..count {
        normal[(piece, piece)] += strength;
        normal[(piece - 1, piece - 1)] += strength;
        normal[(piece - 1, piece)] -= strength;
        normal[(piece, piece - 1)] -= strength;
    }
    let slopes = non_negative(&normal, &right, slope.max(0.0), FLATTEST * slope.max(0.0));
    Shape::Pieces { knots: knots.clone(), slopes }
}

/// Least squares with no unknown below a bound, by coordinate descent on the normal equations, from `start`.
fn non_negative(normal: &DMatrix<f64>, right: &DVector<f64>, start: f64, least: f64) -> Vec<f64> {
    let mut found = DVector::from_element(right.len(), start);
    for _ in 0..4000 {
        let mut moved = 0.0_f64;
        for k in 0..found.len() {
            let gradient = right[k] - normal.row(k).transpose().dot(&found);
            let diagonal = normal[(k, k)];
            if diagonal > 0.0 {
                let next = (found[k] + gradient / diagonal).max(least);
                moved = moved.max((next - found[k]).abs());
                found[k] = next;
            }
        }
        if moved <= 1e-7 * start {
            break;
        }
    }
    found.as_slice().to_vec()
}

/// Where a function of one minimum has it, by ternary search.
fn minimum([mut low, mut high]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    while high - low > 1e-4 {
        let third = (high - low) / 3.0;
        if f(low + third) < f(high - third) { high -= third } else { low += third }
    }
    0.5 * (low + high)
}
