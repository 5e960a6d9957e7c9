//! Exponential moving average of each taxel over frames that follow each other.
//!
//! The average moves by `w = 2^-k` of the difference to a new frame. Where any living taxel differs from its average by more
//! than [`RESTART`] standard deviations of the noise, the frame itself is the new average of all taxels. Of a frame's variance
//! `v` is left: 1 then, `(1 - w)^2 v + w^2` a frame later, and `w / (2 - w)` in a steady state.

use crate::numbers::magnitude;

/// Steps of so many standard deviations restart the average. By noise alone less than one in 10⁴ frames of 100 taxels has one.
pub const RESTART: f64 = 6.0;

/// Noise of a steady average over that of a frame, with a weight of `2^-k`.
pub fn noise_left(k: u32) -> f64 {
    let weight = (-f64::from(k)).exp2();
    (weight / (2.0 - weight)).sqrt()
}

/// The average of one stream of frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Average {
    /// Empty before the first frame.
    stress: Vec<f64>,
    /// Variance of the noise in it, over that of a frame.
    variance: f64,
}

/// How frames are averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    weight: f64,
    limit: f64,
    /// Stress of which `limit` is a share; `None`: the frame's largest.
    typical_pa: Option<f64>,
}

impl Smoothing {
    /// A weight of `2^-k`, with noise that is this share of a stress in pascals, or else of a frame's largest.
    pub fn new(k: u32, noise: f64, typical_pa: Option<f64>) -> Self {
        Self { weight: 0.5_f64.powi(k as i32), limit: RESTART * noise, typical_pa }
    }

    /// Takes a good frame into the average and puts the average in its place; returns the noise that is left in it, over that
    /// of a frame. Steps of `dead` taxels, whose noise is that of the sum in their place, restart nothing.
    pub fn take(&self, average: &mut Average, frame: &mut [f64], dead: &[usize]) -> f64 {
        let limit = self.limit * self.typical_pa.unwrap_or_else(|| magnitude(&*frame));
        let pairs = average.stress.iter().zip(&*frame).enumerate();
        let mut living = pairs.filter(|(taxel, _)| !dead.contains(taxel));
        if average.stress.len() != frame.len() || living.any(|(_, (average, stress))| (stress - average).abs() > limit)
        {
            average.stress.clear();
            average.stress.extend_from_slice(frame);
            average.variance = 1.0;
            return 1.0;
        }
        for (average, stress) in average.stress.iter_mut().zip(frame) {
            *average += self.weight * (*stress - *average);
            *stress = *average;
        }
        average.variance = (1.0 - self.weight).powi(2) * average.variance + self.weight.powi(2);
        average.variance.sqrt()
    }
}
