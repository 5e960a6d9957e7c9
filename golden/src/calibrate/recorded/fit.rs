//! Curve and gains from holds, in turns, each with the other as it is.

use super::folds::{Folds, levels};
use super::gains::{NOISES, Prior, RANGES, Shares};
use super::holds::Holds;
use super::readings::Readings;
use super::rows::Rows;
use super::shape::{self, Kind, Shape, Terms};
use crate::design::Design;
use crate::numbers::{correlation, mean, middle};

/// Loads below this share of the largest count as that much: their relative error is the scale's.
const LIGHT: f64 = 0.1;
/// A simpler choice is taken if its error is at most this many times the best,
pub(super) const AS_GOOD: f64 = 1.05;
/// and this share of the load more: the model of a contact is no better.
pub(super) const ALIKE: f64 = 3e-3;
/// A better error that is within so many of its standard deviations is chance.
const CHANCE: f64 = 1.5;
/// Fewer places tell no gains of taxels.
const PLACES: usize = 6;
/// Straight pieces need so many holds.
const MANY: usize = 20;
/// Gains must lower the error to this share to be fitted.
const BETTER: f64 = 0.95;
/// Rounds of curve and gains in turns.
const ROUNDS: usize = 3;
/// Penalties on the slopes of pieces that are tried.
const SMOOTH: [f64; 4] = [1.0, 0.1, 0.01, 0.001];

/// Holds with everything that the fits of one recording share.
pub(super) struct Fitter<'a> {
    design: &'a Design,
    pub(super) holds: &'a Holds,
    pub(super) loads: Vec<f64>,
    /// Ranges of loads that are one, from the smallest on.
    pub(super) levels: Vec<[f64; 2]>,
    pub(super) folds: Option<Folds>,
    trust: Vec<f64>,
    pub(super) readings: Readings,
    /// Gains that the design has already.
    pub(super) before: Vec<f64>,
    /// For each hold: newtons for a pascal of each taxel, as the last stress has them.
    rows: Vec<Vec<f64>>,
}

/// What was found: a curve, and factors on the taxels' gains.
#[derive(Clone, Debug)]
pub(super) struct Constants {
    pub(super) shape: Shape,
    pub(super) delta: Vec<f64>,
    pub(super) kind: Kind,
    /// What the gains were found with; nothing if they stay as they are.
    pub(super) prior: Option<Prior>,
}

/// Errors that cross-validation found, as shares of the loads: one a hold.
#[derive(Clone, Debug)]
pub(super) struct Validated {
    pub(super) errors: Vec<f64>,
    pub(super) rms: f64,
}

impl<'a> Fitter<'a> {
    /// Of holds that the solver can answer; the number of those that it cannot.
    pub(super) fn new(design: &'a Design, holds: &'a mut Holds, solver: &mut Rows) -> (Self, usize) {
        let before = (0..design.sensor.taxels()).map(|taxel| {
            let (gain, _) = design.input.of_taxel(taxel);
            if gain == 0.0 { 1.0 } else { gain }
        });
        let before: Vec<f64> = before.collect();
        let all = holds.all.len();
        let mut rows = Vec::with_capacity(all);
        holds.all.retain(|hold| {
            let stress: Vec<f64> = hold.x.iter().zip(&before).map(|(x, gain)| x * gain).collect();
            let row = solver.row(&stress);
            let answered = row.is_some();
            rows.extend(row);
            answered
        });
        let lost = all - holds.all.len();
        let holds = &*holds;
        let loads: Vec<f64> = holds.all.iter().map(|hold| hold.load).collect();
        let largest = loads.iter().fold(0.0_f64, |most, &load| most.max(load));
        let of_contact = |contact| holds.all.iter().filter(|hold| hold.contact == contact).count() as f64;
        let trust =
            holds.all.iter().map(|hold| 1.0 / (of_contact(hold.contact).sqrt() * hold.load.max(LIGHT * largest)));
        let trust = trust.collect();
        let readings = Readings::new(holds, &design.input);
        let (levels, folds) = (levels(loads.iter().copied()), Folds::new(&holds.all));
        (Self { design, holds, loads, levels, folds, trust, readings, before, rows }, lost)
    }

    /// Smallest and largest load.
    pub(super) fn range(&self) -> [f64; 2] {
        [self.levels[0][0], self.levels[self.levels.len() - 1][1]]
    }

    /// The largest load by the smallest.
    pub(super) fn span(&self) -> f64 {
        let [low, high] = self.range();
        high / low
    }

    /// For each part that cross-validation leaves out, the holds to fit to and those left out.
    fn parts(&self) -> impl Iterator<Item = [Vec<usize>; 2]> {
        self.folds.iter().flat_map(Folds::parts)
    }

    /// Readings of the holds.
    fn x(&self) -> Vec<&[f64]> {
        self.holds.all.iter().map(|hold| hold.x.as_slice()).collect()
    }

    fn terms<'b>(&'b self, weights: &'b [Vec<f64>], x: &'b [&'b [f64]]) -> Terms<'b> {
        Terms { weights, x, loads: &self.loads, trust: &self.trust, counts: &self.readings.counts }
    }

    /// Stress that presses in pascals, of readings above rest.
    pub(super) fn stress(&self, found: &Constants, x: &[f64]) -> Vec<f64> {
        let gain = |taxel: usize| self.before[taxel] * (1.0 + found.delta[taxel]);
        x.iter().enumerate().map(|(taxel, &x)| gain(taxel) * found.shape.at(taxel, x, &self.readings.counts)).collect()
    }

    /// What the stress weighs, for a curve and gains.
    fn look(&mut self, found: &Constants, solver: &mut Rows) {
        for hold in 0..self.rows.len() {
            let stress = self.stress(found, &self.holds.all[hold].x);
            // One that has no answer any more keeps its weights.
            if let Some(row) = solver.row(&stress) {
                self.rows[hold] = row;
            }
        }
    }

    /// The weights with gains.
    fn weights(&self, delta: &[f64]) -> Vec<Vec<f64>> {
        let gains: Vec<f64> = self.before.iter().zip(delta).map(|(before, delta)| before * (1.0 + delta)).collect();
        self.rows.iter().map(|row| row.iter().zip(&gains).map(|(weight, gain)| weight * gain).collect()).collect()
    }

    /// Relative errors of the loads of some holds.
    fn errors(&self, shape: &Shape, weights: &[Vec<f64>], holds: &[usize]) -> Vec<(usize, f64)> {
        let x = self.x();
        let load = |h: usize| -> f64 {
            weights[h]
                .iter()
                .zip(x[h])
                .enumerate()
                .map(|(taxel, (weight, &x))| weight * shape.at(taxel, x, &self.readings.counts))
                .sum()
        };
        holds.iter().map(|&h| (h, load(h) / self.loads[h] - 1.0)).collect()
    }

    /// Errors of all holds as one figure, each contact counting the same.
    fn figure(&self, errors: Vec<(usize, f64)>) -> Validated {
        let mut of = vec![0.0; self.loads.len()];
        let mut sums = [0.0; 2];
        for (hold, error) in errors {
            of[hold] = error;
            let trust = (self.trust[hold] * self.loads[hold]).powi(2);
            sums[0] += trust * error * error;
            sums[1] += trust;
        }
        Validated { errors: of, rms: (sums[0] / sums[1].max(f64::MIN_POSITIVE)).sqrt() }
    }

    /// The error of a kind of curve, with gains as they are.
    fn validate_kind(&self, kind: Kind, weights: &[Vec<f64>]) -> Validated {
        let x = self.x();
        let terms = self.terms(weights, &x);
        let errors =
            self.parts().flat_map(|[kept, left]| self.errors(&shape::fit(kind, &terms, &kept), weights, &left));
        self.figure(errors.collect())
    }

    /// Chooses the kind of curve, in the order of how much they ask: the first that is as good as the best.
    fn choose_kind(&self, delta: &[f64]) -> Kind {
        let kinds = self.kinds();
        let [first, _, ..] = kinds[..] else { return kinds[0] };
        let weights = self.weights(delta);
        let scores: Vec<Validated> = kinds.iter().map(|&kind| self.validate_kind(kind, &weights)).collect();
        let Some(best) = scores.iter().min_by(|a, b| a.rms.total_cmp(&b.rms)) else { return first };
        let good =
            scores.iter().position(|score| score.rms <= AS_GOOD * best.rms + ALIKE || self.is_chance(score, best));
        good.map_or(first, |good| kinds[good])
    }

    /// Whether the second errs less by chance only: by its squared errors, hold by hold.
    fn is_chance(&self, simple: &Validated, best: &Validated) -> bool {
        let gains: Vec<f64> = (0..self.loads.len())
            .map(|hold| {
                let trust = (self.trust[hold] * self.loads[hold]).powi(2);
                trust * (simple.errors[hold].powi(2) - best.errors[hold].powi(2))
            })
            .collect();
        let mean = mean(&gains);
        let variance =
            gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (gains.len() as f64 - 1.0).max(1.0);
        mean <= CHANCE * (variance / gains.len() as f64).sqrt()
    }

    fn fit_shape(&self, kind: Kind, delta: &[f64], holds: &[usize]) -> Shape {
        let (weights, x) = (self.weights(delta), self.x());
        shape::fit(kind, &self.terms(&weights, &x), holds)
    }

    /// The taxels' shares in the loads without deviations of their gains.
    fn shares(&self, shape: &Shape) -> Shares {
        let (x, counts) = (self.x(), &self.readings.counts);
        let row = |h: usize| -> Vec<f64> {
            let share = |taxel: usize| {
                self.rows[h][taxel] * self.before[taxel] * shape.at(taxel, x[h][taxel], counts) / self.loads[h]
            };
            (0..self.before.len()).map(share).collect()
        };
        let rows: Vec<Vec<f64>> = (0..self.loads.len()).map(row).collect();
        Shares::new(&rows, self.trust.iter().zip(&self.loads).map(|(trust, load)| (trust * load).powi(-2)).collect())
    }

    /// The prior under which gains err least, if they make the error clearly less than none do.
    fn choose_prior(&self, shape: &Shape) -> Option<Prior> {
        let shares = self.shares(shape);
        let plain: Vec<f64> = shares.loads(&vec![0.0; self.before.len()]);
        let wanted: Vec<f64> = plain.iter().map(|load| 1.0 - load).collect();
        let without = self.figure(plain.iter().map(|load| load - 1.0).enumerate().collect());
        let mut best = (BETTER * without.rms - ALIKE, None);
        for range in RANGES {
            let field = shares.with(&self.design.sensor, range);
            for noise in NOISES {
                let errors = self.parts().flat_map(|[kept, left]| {
                    let loads = shares.loads(&field.fit(&kept, &wanted, noise));
                    left.into_iter().map(move |hold| (hold, loads[hold] - 1.0))
                });
                let score = self.figure(errors.collect());
                if score.rms < best.0 && !self.is_chance(&without, &score) {
                    best = (score.rms, Some(Prior { range, noise }));
                }
            }
        }
        best.1
    }

    fn fit_gains(&self, shape: &Shape, prior: Prior, holds: &[usize]) -> Vec<f64> {
        let shares = self.shares(shape);
        let wanted: Vec<f64> = shares.loads(&vec![0.0; self.before.len()]).iter().map(|load| 1.0 - load).collect();
        let delta = shares.with(&self.design.sensor, prior.range).fit(holds, &wanted, prior.noise);
        shares.around_mean(holds, &delta)
    }

    /// Whether the recording says more of each taxel's gain than was assumed; nothing of one that no contact was on.
    pub(super) fn told(&self, found: &Constants) -> Vec<Option<bool>> {
        let shares = self.shares(&found.shape);
        let Prior { range, noise } = found.prior.unwrap_or(Prior { range: 0.0, noise: f64::INFINITY });
        shares.with(&self.design.sensor, range).told(noise.min(1e12))
    }

    /// The kinds of curve that loads so many and so far apart may tell.
    pub(super) fn kinds(&self) -> Vec<Kind> {
        let (levels, span) = (self.levels.len(), self.span());
        let has_curve = self.design.input.curve.is_some();
        let mut kinds = if has_curve { vec![Kind::Own, Kind::Line] } else { vec![Kind::Line] };
        if self.folds.is_none() || levels < 2 || span < 1.5 {
            kinds.truncate(1);
            return kinds;
        }
        kinds.push(Kind::Power);
        if levels > 2 && span >= 2.0 && self.loads.len() >= MANY {
            kinds.extend(SMOOTH.map(Kind::Pieces));
        }
        kinds
    }

    /// Whether contacts are at places enough to tell gains of taxels.
    pub(super) fn tells_gains(&self) -> bool {
        self.holds.places >= PLACES && self.folds.as_ref().is_some_and(|folds| folds.what == "places")
    }

    /// Finds curve and gains.
    pub(super) fn find(&mut self, solver: &mut Rows) -> Constants {
        let all: Vec<usize> = (0..self.loads.len()).collect();
        let none = vec![0.0; self.before.len()];
        let kind = self.kinds()[0];
        let mut found = Constants { shape: self.fit_shape(kind, &none, &all), delta: none.clone(), kind, prior: None };
        for round in 0..ROUNDS {
            self.look(&found, solver);
            if round < 2 {
                found.kind = self.choose_kind(&found.delta);
            }
            found.shape = self.fit_shape(found.kind, &found.delta, &all);
            if round < 2 && self.tells_gains() {
                found.prior = self.choose_prior(&found.shape).filter(|&prior| self.is_better(found.kind, prior));
            }
            found.delta = found.prior.map_or_else(|| none.clone(), |prior| self.fit_gains(&found.shape, prior, &all));
            found.shape = self.fit_shape(found.kind, &found.delta, &all);
        }
        found
    }

    /// Whether gains clearly lower the error at what was left out while everything was fitted, and do not raise its median.
    fn is_better(&self, kind: Kind, prior: Prior) -> bool {
        let [with, without] = [Some(prior), None].map(|prior| self.validate(kind, prior));
        let median = |of: &Validated| middle(of.errors.iter().map(|error| error.abs()));
        with.rms < BETTER * without.rms - ALIKE && median(&with) <= median(&without) && !self.is_chance(&without, &with)
    }

    /// The errors at what was left out while everything was fitted to the rest.
    pub(super) fn validate(&self, kind: Kind, prior: Option<Prior>) -> Validated {
        let errors = self.parts().flat_map(|[kept, left]| {
            let mut delta = vec![0.0; self.before.len()];
            let mut shape = self.fit_shape(kind, &delta, &kept);
            if let Some(prior) = prior {
                for _ in 1..ROUNDS {
                    delta = self.fit_gains(&shape, prior, &kept);
                    shape = self.fit_shape(kind, &delta, &kept);
                }
            }
            self.errors(&shape, &self.weights(&delta), &left)
        });
        self.figure(errors.collect())
    }

    /// Standard deviation of the gains, and how far those of one half of the parts are from the other's: root mean square over
    /// the square root of two.
    pub(super) fn halves(&self, found: &Constants, prior: Prior) -> [f64; 2] {
        let half =
            |odd: usize| -> Vec<usize> { self.parts().skip(odd).step_by(2).flat_map(|[_, left]| left).collect() };
        let [a, b] = [0, 1].map(|odd| self.fit_gains(&found.shape, prior, &half(odd)));
        let touched: Vec<usize> = (0..a.len()).filter(|&taxel| found.delta[taxel] != 0.0).collect();
        let rms = |of: &dyn Fn(usize) -> f64| mean(touched.iter().map(|&taxel| of(taxel).powi(2))).sqrt();
        let mean = mean(touched.iter().map(|&taxel| found.delta[taxel]));
        [rms(&|taxel| found.delta[taxel] - mean), rms(&|taxel| a[taxel] - b[taxel]) / 2_f64.sqrt()]
    }

    /// The errors at what it was fitted to.
    pub(super) fn fitted(&self, found: &Constants) -> Validated {
        let all: Vec<usize> = (0..self.loads.len()).collect();
        self.figure(self.errors(&found.shape, &self.weights(&found.delta), &all))
    }

    /// Whether what is found goes with the loads: their correlation.
    pub(super) fn follows(&self, found: &Constants) -> f64 {
        let errors = self.fitted(found).errors;
        correlation(errors.iter().zip(&self.loads).map(|(error, load)| (load * (1.0 + error), *load)))
    }
}
