//! The interface of an estimator: its inputs, its estimate, and the range of that.

use crate::products::ByPq;
use crate::status::Status;

/// A friction component found is within this on either side of 0.
pub const RANGE: f64 = 2.0;

/// What the contact analysis finds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Sum of |b| over all taxels in pascals.
    pub stress_sum: f64,
    /// Whether that sum reaches the noise floor of `m` taxels.
    pub touched: bool,
    /// Centroid of the compressed taxels minus that of the taxels in tension, in metres; its direction is the
    /// direction of push. `None` where no taxel reaches the noise floor on one of the two sides.
    pub direction: Option<[f64; 2]>,
    /// Noise in the stress over that of a frame: below 1 where frames are averaged.
    pub noise_left: f64,
}

/// What an estimator finds of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    /// Bits to raise.
    pub(crate) status: Status,
    /// Friction components.
    pub(crate) mu: [f64; 2],
}

/// What an estimator sees of a frame; either plan has all of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inputs<'a> {
    /// Stress in pascals, m values.
    pub(crate) b: &'a [f64],
    pub(crate) contact: Contact,
    /// Sums `G_pq` in newtons, and those of the torques in N m.
    pub(crate) sums: &'a ByPq<f64>,
    /// Stresses `u_q = C33 g_3q` in pascals, m values each.
    pub(crate) u: [&'a [f64]; 3],
}
