//! The error of the tangential force that a design is to be expected to have, by noise.

use std::fmt::{self, Display, Formatter};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::Check;
use super::{Design, DesignError};
use crate::smoothing;

/// The smoothing that is advised.
const ADVISED: u32 = 4;
/// It is advised where the error falls below this share.
const WORTH: f64 = 0.8;

/// Errors of contacts of all kinds inside the grid, which the design's constants were not fitted to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedError {
    /// Standard deviations of a reading, as shares of the frame's largest reading: from 0, rising.
    pub noise: Vec<f64>,
    /// Median error of the tangential force at each, in percent of the normal force.
    pub median: Vec<f64>,
    /// What 95 % of the errors are below, in percent of the normal force.
    pub p95: Vec<f64>,
}

impl ExpectedError {
    pub(super) fn check(self, check: &Check) -> Result<Self, DesignError> {
        let Self { noise, median, p95 } = &self;
        let refuse = |key: &str, problem: &str, remedy: &str| {
            Err(check.value(&format!("algorithm.expected_error.{key}"), problem, remedy))
        };
        let fitted = "or run `sptfra calibrate` anew, which writes it";
        if noise.first() != Some(&0.0) || !noise.is_sorted_by(|one, next| one < next) {
            return refuse("noise", "is no list of rising numbers from 0", &format!("write one {fitted}"));
        }
        for (key, errors) in [("median", median), ("p95", p95)] {
            if errors.len() != noise.len() || errors.iter().any(|error| !(0.0..f64::INFINITY).contains(error)) {
                let remedy = format!("write as many numbers of at least 0 as noise has, {fitted}");
                return refuse(key, "does not have a number for each noise", &remedy);
            }
        }
        Ok(self)
    }

    /// Median and 95 % of the errors at a noise, in percent of the normal force; beyond the last noise those of the last.
    pub fn at(&self, noise: f64) -> [f64; 2] {
        let next = self.noise.partition_point(|&known| known <= noise);
        let before = next.saturating_sub(1);
        let next = next.min(self.noise.len() - 1);
        let width = self.noise[next] - self.noise[before];
        let part = if width > 0.0 { (noise - self.noise[before]) / width } else { 0.0 };
        [&self.median, &self.p95].map(|errors| errors[before] + part * (errors[next] - errors[before]))
    }
}

/// The error to be expected of a design at a noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// Standard deviation of a reading, as a share of the frame's largest reading.
    pub noise: f64,
    /// Median error of the tangential force, in percent of the normal force.
    pub median_percent: f64,
    /// What 95 % of the errors are below, in percent of the normal force.
    pub p95_percent: f64,
    /// The sentence's words on smoothing, and whether the noise is beyond what is known.
    #[serde(skip)]
    averaged: String,
    #[serde(skip)]
    is_beyond: bool,
    #[serde(skip)]
    advised: Option<f64>,
}

impl Expected {
    /// The same without what smoothing would bring, which is for white noise.
    #[must_use]
    pub fn of_single_frames(self) -> Self {
        Self { advised: None, ..self }
    }
}

impl Display for Expected {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        let Self { noise, median_percent, p95_percent, averaged, is_beyond, advised } = self;
        let within = if *is_beyond { "no better than" } else { "within" };
        write!(
            to,
            "At a noise of {} %{averaged} expect the shear {within} {} % of F_z (median; 95 %: {})",
            (1e4 * noise).round() / 100.0,
            digits(*median_percent),
            digits(*p95_percent)
        )?;
        if let Some(advised) = advised {
            write!(to, "; smoothing = {ADVISED} would bring {}", digits(*advised))?;
        }
        write!(to, ".")
    }
}

impl Design {
    /// The error to be expected at the design's noise; nothing of a design without `algorithm.expected_error`.
    pub fn expected_error(&self) -> Option<Expected> {
        self.expected_error_at(self.input.noise)
    }

    /// The same where the readings' noise is this share of the frame's largest.
    pub fn expected_error_at(&self, noise: f64) -> Option<Expected> {
        let errors = self.algorithm.expected_error.as_ref()?;
        let smoothing = self.input.smoothing;
        let left = noise * smoothing::noise_left(smoothing);
        let [median_percent, p95_percent] = errors.at(left);
        let [advised, _] = errors.at(noise * smoothing::noise_left(ADVISED));
        Some(Expected {
            noise,
            median_percent,
            p95_percent,
            averaged: if smoothing > 0 { format!(" and smoothing = {smoothing}") } else { String::new() },
            is_beyond: errors.noise.last().is_some_and(|&last| left > last),
            advised: (smoothing == 0 && advised < WORTH * median_percent).then_some(advised),
        })
    }
}

/// With a decimal below 10.
fn digits(percent: f64) -> String {
    let decimals = usize::from(percent < 9.95);
    format!("{percent:.decimals$}")
}
