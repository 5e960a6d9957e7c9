//! `CeAn` of the line search in integers: centroids of compression and tension, direction of the push (Eq. 24, as a vector).

use super::super::Inputs;
use super::{CENTROID_BITS, CENTROID_FRACTION, PITCH_FRACTION};
use crate::cores::ratio;
use crate::format::round_shift;

/// The direction of push of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Direction {
    /// `d = c - t`, in units of the larger pitch with [`CENTROID_FRACTION`] fraction bits.
    pub push: [i64; 2],
    /// No taxel above, or none below, the noise floor.
    pub unknown: bool,
}

impl Direction {
    /// Of the frame `inputs`; `pitch` is that of [`super::LinePlan`].
    pub fn new(inputs: &Inputs, pitch: [i64; 2]) -> Self {
        let columns = inputs.sensor.columns;
        let compression = Moments::of(inputs.stress, columns, |value| (value < 0).then_some(-value));
        let tension = Moments::of(inputs.stress, columns, |value| (value >= 0).then_some(value));
        let push = std::array::from_fn(|axis| {
            let difference = compression.centroid(axis) - tension.centroid(axis);
            round_shift(difference * pitch[axis], PITCH_FRACTION)
        });
        let beyond = |sign: i64| inputs.stress.iter().any(|&value| sign * value > inputs.noise_floor);
        Self { push, unknown: !beyond(1) || !beyond(-1) }
    }
}

struct Moments {
    sum: i64,
    by_axis: [i64; 2],
}

impl Moments {
    fn of(stress: &[i64], columns: usize, magnitude: impl Fn(i64) -> Option<i64>) -> Self {
        let mut moments = Self { sum: 0, by_axis: [0; 2] };
        for (taxel, &value) in stress.iter().enumerate() {
            if let Some(magnitude) = magnitude(value) {
                moments.sum += magnitude;
                moments.by_axis[0] += magnitude * (taxel % columns) as i64;
                moments.by_axis[1] += magnitude * (taxel / columns) as i64;
            }
        }
        moments
    }

    /// Only a division by zero, whose frame has no direction, has more than [`CENTROID_BITS`].
    fn centroid(&self, axis: usize) -> i64 {
        let quotient = ratio::divide((self.by_axis[axis] as u64) << CENTROID_FRACTION, self.sum as u64);
        (quotient & ((1 << CENTROID_BITS) - 1)) as i64
    }
}
