//! `CeAn` in integers: centroids of compression and tension, direction of the push (Eq. 24, as a vector).

use crate::cores::divider;
use crate::plan::Plan;
use crate::plan::format::round_shift;
use crate::plan::optimum::{CENTROID_FRACTION, PITCH_FRACTION};

/// What `CeAn` tells Op about a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Direction {
    /// `d = c - t`, in units of the larger pitch with [`CENTROID_FRACTION`] fraction bits.
    pub push: [i64; 2],
    /// `sum |b|` in steps of the stress.
    pub stress_sum: i64,
    /// `max |b|` in steps of the stress.
    pub largest: i64,
    /// `sum |b|` lies below the noise floor.
    pub no_contact: bool,
    /// No taxel above, or none below, the noise floor.
    pub unknown: bool,
}

impl Direction {
    pub fn new(stress: &[i64], plan: &Plan) -> Self {
        let columns = plan.design.sensor.columns;
        let compression = Moments::of(stress, columns, |value| (value < 0).then_some(-value));
        let tension = Moments::of(stress, columns, |value| (value >= 0).then_some(value));
        let push = std::array::from_fn(|axis| {
            let difference = compression.centroid(axis) - tension.centroid(axis);
            round_shift(difference * plan.direction.pitch[axis], PITCH_FRACTION)
        });
        let floor = plan.thresholds.taxel;
        let stress_sum = compression.sum + tension.sum;
        Self {
            push,
            stress_sum,
            largest: stress.iter().map(|value| value.abs()).max().unwrap_or(0),
            no_contact: stress_sum < plan.thresholds.contact,
            unknown: !stress.iter().any(|&value| value > floor) || !stress.iter().any(|&value| value < -floor),
        }
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

    /// The hardware keeps 26 bits of the quotient; only a division by zero, whose frame has no direction, has more.
    fn centroid(&self, axis: usize) -> i64 {
        let quotient = divider::divide((self.by_axis[axis] as u64) << CENTROID_FRACTION, self.sum as u64);
        (quotient & ((1 << 26) - 1)) as i64
    }
}
