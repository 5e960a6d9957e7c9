//! The joint estimator in integers: formats and constants of its grid, its friction and its network.
//!
//! The steps are those of `docs/estimators.md`. Stresses `u_q` come as the taxels have them; the values on the grid are
//! 8 times finer, so that a step of the grid adds `u_1` or `u_2` as they are.

mod network;
pub mod timing;

use golden::design::{Design, Estimator};
use golden::estimators::joint::{DEAD_ZONE, LARGEST, LEVEL, REACH, STEP, TIE};
use serde::Serialize;

use super::Formats;
use super::format::{address_bits, pow2};
use super::optimum::FRICTION_FRACTION;
pub use network::{
    INPUT_BITS, INPUT_FRACTION, NORMAL_DROP, NetworkPlan, RECIPROCAL_BITS, STRESS_BITS, UNIT_BITS, UNITS,
};

/// A step of the grid is `2^-STEP_SHIFT`.
pub const STEP_SHIFT: u32 = 3;
/// Points of the grid along one axis.
pub const SIDE: usize = 2 * REACH as usize + 1;
/// Points of the grid.
pub const POINTS: usize = SIDE * SIDE;
/// Both the dead zone and the level are `2^-SHARE_SHIFT`, of the largest and of the sum of |b|.
const SHARE_SHIFT: i32 = 8;
/// Width of a taxel's stress on the grid, `8 (u0 - dead zone) + i u1 + j u2`: the last two up to `REACH` times 27 bits.
pub const POINT_BITS: u32 = 32;
/// Leading bits of the level that a weight is the square of.
pub const DEPTH_BITS: u32 = 17;
/// Bits dropped from the square.
pub const WEIGHT_DROP: u32 = 8;
/// Fraction bits of c3.
pub const CUBIC_FRACTION: u32 = 15;
/// Fraction bits of c1 and of `|mu|^2`.
pub const LINEAR_FRACTION: u32 = 22;
/// Fraction bits of `c1 + c3 |mu|^2`.
pub const FACTOR_FRACTION: u32 = 21;
/// The largest correction, as a friction component.
pub const CORRECTION_LIMIT: i64 = (LARGEST * ONE) as i64;
/// Left of a pitch from where a contact's centre belongs to the second of two taxels, in the steps of the friction.
pub const CENTRE_HALF: i64 = (ONE / 2.0 + TIE * ONE) as i64;
/// One, in the steps of the friction.
const ONE: f64 = (1_u32 << FRICTION_FRACTION) as f64;
/// Taxels of a cell are visited anew after this many cycles at the earliest: the depth of its pipeline.
const LEAST_ELEMENTS: usize = 4;
/// Most cells worth their adders.
const MOST_CELLS: usize = 32;

// The shifts above are those of the solver.
const _: () = assert!((1.0 / STEP) as u32 == 1 << STEP_SHIFT);
const _: () = assert!((1.0 / LEVEL) as u32 == 1 << SHARE_SHIFT && (1.0 / DEAD_ZONE) as u32 == 1 << SHARE_SHIFT);

/// Formats and constants of the joint estimator of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointPlan {
    /// Bits dropped from `max |b|` for the dead zone, and from `sum |b|` for the level above the least value, both in
    /// steps of the grid's values.
    pub share_shift: u32,
    /// Width of a value on the grid, unsigned: a sum over the taxels.
    pub value_bits: u32,
    /// `c1` of the friction, [`LINEAR_FRACTION`] fraction bits.
    pub linear: i64,
    /// `c3` of the friction, [`CUBIC_FRACTION`] fraction bits.
    pub cubic: i64,
    /// The correction, if the design has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub network: Option<NetworkPlan>,
}

impl JointPlan {
    /// Of a design with the joint estimator; nothing for any other.
    pub fn new(design: &Design, formats: &Formats) -> Option<Self> {
        if design.algorithm.estimator != Estimator::Joint {
            return None;
        }
        let constants = &design.algorithm.joint;
        let [c1, c3] = constants.tangential;
        let finer = formats.stress.lsb - formats.u.lsb;
        let fixed = |value: f64, fraction: u32| (value * pow2(fraction as i32)).round() as i64;
        Some(Self {
            // `u` holds the stress itself and more: its steps are hardly ever finer, and never by a factor of 8.
            share_shift: (SHARE_SHIFT - STEP_SHIFT as i32 - finer).max(0) as u32,
            value_bits: POINT_BITS - 1 + address_bits(design.sensor.taxels()),
            linear: fixed(c1, LINEAR_FRACTION),
            cubic: fixed(c3, CUBIC_FRACTION),
            network: constants.correction.as_ref().map(|correction| NetworkPlan::new(correction, -finer)),
        })
    }

    /// `value * 2^-share_shift`, rounded down.
    pub fn share(&self, value: i64) -> i64 {
        value >> self.share_shift
    }
}

/// Cells and taxels of a cell for `elements` quads: as many cells as are worth their adders.
pub(super) fn cells(elements: usize, ways: usize) -> (usize, usize) {
    let each = elements.div_ceil(MOST_CELLS / ways).next_power_of_two().max(LEAST_ELEMENTS);
    (ways * elements.div_ceil(each), each)
}
