//! The taxels' gains, as far as a recording tells them.
//!
//! A gain is 1 plus a deviation, which is taken for a random field of the covariance `exp(-d / range)`, d being the
//! distance of two taxels in pitches; with a range of 0 each taxel is for itself. What the holds say then has one answer,
//! that of Gaussian process regression: `delta = C Xᵀ (X C Xᵀ + lambda W⁻¹)⁻¹ e`.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::sensor::Sensor;

/// Ranges that are tried, in pitches.
pub(super) const RANGES: [f64; 3] = [0.0, 1.5, 5.0];
/// Variance of the error of a hold's load over that of a gain.
pub(super) const NOISES: [f64; 6] = [0.03, 0.1, 0.3, 1.0, 3.0, 10.0];
/// A taxel that never has this share of a load was not touched.
const TOUCHED: f64 = 0.01;
/// A taxel is told if its variance is less than this share of what it was before.
const TOLD: f64 = 0.5;
/// Gains stay within this factor: what is beyond is no gain.
const LIMITS: [f64; 2] = [0.2, 5.0];

/// What is assumed of the gains before the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Prior {
    pub(super) range: f64,
    pub(super) noise: f64,
}

/// Shares of the taxels in the loads: rows of X, `weight * pascals / load`, one a hold.
pub(super) struct Shares {
    x: DMatrix<f64>,
    /// Variance of a hold's relative error, as a multiple.
    variance: Vec<f64>,
    touched: Vec<bool>,
}

impl Shares {
    pub(super) fn new(rows: &[Vec<f64>], variance: Vec<f64>) -> Self {
        let taxels = rows.first().map_or(0, Vec::len);
        let mut x = DMatrix::from_fn(rows.len(), taxels, |hold, taxel| rows[hold][taxel]);
        let touched: Vec<bool> = x.column_iter().map(|column| column.amax() >= TOUCHED).collect();
        for (taxel, _) in touched.iter().enumerate().filter(|(_, touched)| !**touched) {
            x.column_mut(taxel).fill(0.0);
        }
        Self { x, variance, touched }
    }

    /// With the covariance of a range: what several fits have in common.
    pub(super) fn with(&self, sensor: &Sensor, range: f64) -> Field<'_> {
        let covariance = covariance(sensor, range);
        // For each taxel, what the holds have to do with it.
        let across = &covariance * self.x.transpose();
        let among = &self.x * &across;
        Field { shares: self, across, among }
    }

    /// Deviations such that the mean gain is 1 over what some holds load, as the fit weighs them: the rest is the curve's,
    /// so that taxels which nothing touched have the mean too.
    pub(super) fn around_mean(&self, holds: &[usize], delta: &[f64]) -> Vec<f64> {
        let mut sums = [0.0; 2];
        for &hold in holds {
            for (share, delta) in self.x.row(hold).iter().zip(delta) {
                let weight = share.max(0.0) / self.variance[hold];
                sums[0] += weight * (1.0 + delta);
                sums[1] += weight;
            }
        }
        let mean = if sums[1] > 0.0 { sums[0] / sums[1] } else { 1.0 };
        let of = |(delta, touched): (&f64, &bool)| if *touched { (1.0 + delta) / mean - 1.0 } else { 0.0 };
        delta.iter().zip(&self.touched).map(of).collect()
    }

    /// The share of each hold's load that gains of `1 + delta` give.
    pub(super) fn loads(&self, delta: &[f64]) -> Vec<f64> {
        let delta = DVector::from_column_slice(delta);
        (0..self.x.nrows()).map(|hold| self.x.row(hold).sum() + self.x.row(hold).transpose().dot(&delta)).collect()
    }
}

/// The holds under one covariance.
pub(super) struct Field<'a> {
    shares: &'a Shares,
    across: DMatrix<f64>,
    among: DMatrix<f64>,
}

impl Field<'_> {
    /// Deviations of the gains from some of the holds, whose relative errors are what they leave to be explained.
    pub(super) fn fit(&self, holds: &[usize], errors: &[f64], noise: f64) -> Vec<f64> {
        let taxels = self.across.nrows();
        let Some(factors) = self.factors(holds, noise) else { return vec![0.0; taxels] };
        let solved = factors.solve(&DVector::from_iterator(holds.len(), holds.iter().map(|&hold| errors[hold])));
        (0..taxels)
            .map(|taxel| {
                if !self.shares.touched[taxel] {
                    return 0.0;
                }
                let delta: f64 =
                    holds.iter().zip(solved.iter()).map(|(&hold, solved)| self.across[(taxel, hold)] * solved).sum();
                (1.0 + delta).clamp(LIMITS[0], LIMITS[1]) - 1.0
            })
            .collect()
    }

    /// Whether all holds together say more of each taxel than the prior does; nothing of one that no contact was on.
    pub(super) fn told(&self, noise: f64) -> Vec<Option<bool>> {
        let holds: Vec<usize> = (0..self.among.nrows()).collect();
        let factors = self.factors(&holds, noise);
        (0..self.across.nrows())
            .map(|taxel| {
                let factors = factors.as_ref().filter(|_| self.shares.touched[taxel])?;
                let row = self.across.row(taxel).transpose();
                // The variance before is 1 for every range.
                Some(1.0 - row.dot(&factors.solve(&row)) < TOLD)
            })
            .collect()
    }

    fn factors(&self, holds: &[usize], noise: f64) -> Option<Cholesky<f64, Dyn>> {
        let variance = |hold: usize| noise * self.shares.variance[hold];
        let matrix = DMatrix::from_fn(holds.len(), holds.len(), |i, j| {
            self.among[(holds[i], holds[j])] + if i == j { variance(holds[i]) } else { 0.0 }
        });
        matrix.cholesky()
    }
}

fn covariance(sensor: &Sensor, range: f64) -> DMatrix<f64> {
    let at = |taxel: usize| [(taxel % sensor.columns) as f64, (taxel / sensor.columns) as f64];
    DMatrix::from_fn(sensor.taxels(), sensor.taxels(), |i, j| {
        let ([ax, ay], [bx, by]) = (at(i), at(j));
        match (i == j, range > 0.0) {
            (true, _) => 1.0,
            (false, true) => (-(ax - bx).hypot(ay - by) / range).exp(),
            (false, false) => 0.0,
        }
    })
}
