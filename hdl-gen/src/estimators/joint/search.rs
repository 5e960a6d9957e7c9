//! The grid search in integers: formats of its values, by each frame's own scale, and its cycles.

use golden::design::{Design, Optimise};
use golden::estimators::joint::{DEAD_ZONE, Grid, LEVEL};
use golden::parity::{COMPONENTS, Orbits};
use golden::sensor::Sensor;
use serde::Serialize;

use crate::estimators::Contact;
use crate::format::{MANY_LANES, largest, round_shift};
use crate::timing::latency;

/// The grid.
pub const GRID: Grid = Grid::SEARCH;
/// Points along an axis.
pub const SIDE: usize = GRID.side();
/// A step of a value is this many bits below the leading bit of `sum |b|`.
pub const FRACTION: u32 = 21;
/// Width of a normalised `u`: what is beyond is clipped, with a status bit.
pub const U_BITS: u32 = FRACTION + 1;
/// Width of a value, unsigned; a sum that leaves it is the largest number. The least value is about `sum |b|` at most,
/// which `u_0` sums to at `mu = 0`.
pub const VALUE_BITS: u32 = FRACTION + 2;
/// Both the dead zone and the level are `2^-SHARE_SHIFT`, of the largest and of the sum of |b|.
const SHARE_SHIFT: u32 = 8;
/// Width of the margin of the level, and so of a depth below it.
pub const MARGIN_BITS: u32 = FRACTION - SHARE_SHIFT + 1;
/// Width of a weight, the square of a depth.
pub const WEIGHT_BITS: u32 = 24;
/// Bits dropped from that square.
pub const WEIGHT_DROP: u32 = 2 * MARGIN_BITS - WEIGHT_BITS;
/// Points weighed in a cycle, where one taxel is read in one; else all of a row.
const FIVE: usize = 5;
/// Multipliers of both moments.
const MOMENTS: usize = 2;

// The shifts above are those of the solver.
const _: () = assert!((1.0 / LEVEL) as u32 == 1 << SHARE_SHIFT && (1.0 / DEAD_ZONE) as u32 == 1 << SHARE_SHIFT);

/// The search of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SearchPlan {
    /// Points along an axis.
    pub side: usize,
    /// Points evaluated at a time: all of them, or with `optimise = "area"` a row.
    pub parallel: usize,
    /// Taxels read in a cycle: two where lanes are many, and then a row of points is weighed in one, not five.
    pub taxels: usize,
    /// Left shift of `u` before the right shift by the bits of `sum |b|`: to one bit finer than a value.
    pub u_left: u32,
}

/// Condition 1 of a frame.
pub struct Values {
    /// Row by row.
    pub values: Vec<i64>,
    /// Above the least value, to the level.
    pub margin: i64,
    /// A `u` was clipped.
    pub clipped: bool,
}

impl SearchPlan {
    /// The search for `u` with steps `2^-finer` times those of `b`.
    pub(super) fn new(finer: i32, design: &Design) -> Self {
        // `u` holds the stress and more: its steps are those of the stress but for a few bits.
        let u_left = (FRACTION as i32 + 1 - finer).max(1) as u32;
        let all = Self { side: SIDE, parallel: SIDE * SIDE, taxels: 1, u_left };
        if design.hardware.optimise == Optimise::Area {
            return Self { parallel: SIDE, ..all };
        }
        let two = Self { taxels: 2, ..all.clone() };
        // A count of contacts, a taxel a cycle, must be there before the search is.
        let counted =
            || !design.algorithm.count_contacts || latency::count_contacts(&design.sensor) < two.cycles(&design.sensor);
        if design.hardware.lanes > MANY_LANES && counted() { two } else { all }
    }

    /// Whether the points are evaluated a row at a time.
    pub fn is_serial(&self) -> bool {
        self.parallel == self.side
    }

    /// Cycles in which all taxels are read.
    fn pass(&self, sensor: &Sensor) -> u64 {
        (COMPONENTS * Orbits::new(sensor.columns, sensor.rows).count() / self.taxels) as u64
    }

    /// Cycles from the start of the search to the first row of points: the tensions of several taxels are added up before
    /// they are in the sums.
    pub(super) fn first_row(&self, sensor: &Sensor) -> u64 {
        self.pass(sensor) + 12 + self.taxels as u64
    }

    /// From there to the centroid: the weights of all of a row need one more stage to be added up.
    pub(super) fn level(&self, sensor: &Sensor) -> u64 {
        let side = self.side as u64;
        let row = if self.is_serial() { self.pass(sensor) + 1 } else { 1 };
        let weighing = side * self.side.div_ceil(self.weighed()) as u64;
        (side - 1) * row + weighing + if self.weighed() == self.side { 38 } else { 37 }
    }

    /// Start to end.
    pub(super) fn cycles(&self, sensor: &Sensor) -> u64 {
        self.first_row(sensor) + self.level(sensor)
    }

    /// Points weighed in a cycle.
    pub fn weighed(&self) -> usize {
        if self.taxels > 1 { self.side } else { FIVE }
    }

    /// The squares, and both moments.
    pub fn multipliers(&self) -> usize {
        self.weighed() + MOMENTS
    }

    /// Condition 1 at every point.
    pub(super) fn values(&self, u: &[Vec<i64>; 3], contact: Contact) -> Values {
        let Self { side, u_left, .. } = *self;
        let sum_bits = 64 - contact.stress_sum.leading_zeros();
        let share = |value: i64| (value << (FRACTION - SHARE_SHIFT)) >> sum_bits;
        let mut clipped = false;
        let mut normal = |u: i64| {
            let rounded = round_shift((u << u_left) >> sum_bits, 1);
            let limited = rounded.clamp(-largest(U_BITS) - 1, largest(U_BITS));
            clipped |= limited != rounded;
            limited
        };
        let dead_zone = share(contact.largest);
        let most = (1 << VALUE_BITS) - 1;
        let mut values = vec![0_i64; side * side];
        for ((u0, u1), u2) in u[0].iter().zip(&u[1]).zip(&u[2]) {
            let [u0, u1, u2] = [*u0, *u1, *u2].map(&mut normal);
            let steps = |point: usize| point as i64 - i64::from(GRID.reach);
            let x = |column: usize| u0 - dead_zone + ((steps(column) * u1) >> GRID.shift);
            let y = |row: usize| (steps(row) * u2) >> GRID.shift;
            for (index, value) in values.iter_mut().enumerate() {
                let stress = x(index % side) + y(index / side);
                *value = (*value + stress.max(0)).min(most);
            }
        }
        Values { values, margin: share(contact.stress_sum) + 1, clipped }
    }
}
