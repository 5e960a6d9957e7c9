//! A cell for each point of the grid: formats of its values, by the frame's own scale.

use golden::design::Design;
use golden::estimators::joint::Grid;
use golden::parity::{CLASSES, Quads};
use golden::sensor::Sensor;
use serde::Serialize;

use super::SHARE_SHIFT;
use crate::blocks::latency;
use crate::estimators::Contact;
use crate::plan::format::{MANY_LANES, largest, round_shift};

/// Most points that have a cell each: 15 x 15 take about as many LUTs as all else, 21 x 21 twice as many.
pub const MOST_POINTS: usize = 256;
/// A step of a value is this many bits below the leading bit of `sum |b|`.
pub const FRACTION: u32 = 23;
/// Width of a normalised `u`: what is beyond is clipped, with a status bit.
pub const U_BITS: u32 = 25;
/// Width of a value, unsigned; a sum that leaves it is the largest number.
pub const VALUE_BITS: u32 = 28;
/// Points weighed in a cycle, where they see one taxel in one; else all of a row.
const FIVE: usize = 5;
/// Multipliers of both moments.
const MOMENTS: usize = 2;

/// The cells of the points of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointsPlan {
    /// Points along an axis.
    pub side: usize,
    /// The grid.
    #[serde(skip)]
    pub grid: Grid,
    /// Taxels that they see in a cycle: two where lanes are many, and then a row of them is weighed in one, not five.
    pub taxels: usize,
    /// Left shift of `u` before the right shift by the bits of `sum |b|`: to one bit finer than a value.
    pub u_left: u32,
}

/// What the cells hold of a frame.
pub struct Values {
    /// Row by row.
    pub values: Vec<i64>,
    /// Above the least value, to the level.
    pub margin: i64,
    /// A `u` was clipped.
    pub clipped: bool,
}

impl PointsPlan {
    /// The cells of a grid, if they are few enough, for `u` with steps `2^-finer` times those of `b`.
    pub(super) fn new(grid: Grid, finer: i32, design: &Design) -> Option<Self> {
        // `u` holds the stress and more: its steps are those of the stress but for a few bits.
        let u_left = (FRACTION as i32 + 1 - finer).max(1) as u32;
        let one = Self { side: grid.side(), grid, taxels: 1, u_left };
        let two = Self { taxels: 2, ..one.clone() };
        // A count of contacts, a taxel a cycle, must be there before the search is.
        let counted =
            || !design.algorithm.count_contacts || latency::count_contacts(&design.sensor) < two.search(&design.sensor);
        let quick = design.hardware.lanes > MANY_LANES && counted();
        (grid.points() <= MOST_POINTS).then_some(if quick { two } else { one })
    }

    /// Cycles from the start of the search to the first row of points: the tensions of several taxels are added up before
    /// they are in the sums.
    pub(super) fn first_row(&self, sensor: &Sensor) -> u64 {
        let quads = Quads::new(sensor.columns, sensor.rows).count();
        ((CLASSES * quads) / self.taxels + 12 + self.taxels) as u64
    }

    /// From there to the centroid: the weights of all of a row need one more stage to be added up.
    pub(super) fn level(&self) -> u64 {
        let weighing = self.side * self.side / self.weighed();
        (self.side + weighing) as u64 + if self.weighed() == self.side { 38 } else { 37 }
    }

    /// Start to end of the search.
    pub(super) fn search(&self, sensor: &Sensor) -> u64 {
        self.first_row(sensor) + self.level()
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
        let Self { side, grid, u_left, .. } = *self;
        let sum_bits = 64 - contact.stress_sum.leading_zeros();
        let share = |value: i64| (value << (FRACTION - SHARE_SHIFT as u32)) >> sum_bits;
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
            let steps = |point: usize| i64::from(grid.numerator) * (point as i64 - i64::from(grid.reach));
            let x = |column: usize| (((u0 - dead_zone) << grid.shift) + steps(column) * u1) >> grid.shift;
            let y = |row: usize| (steps(row) * u2) >> grid.shift;
            for (index, value) in values.iter_mut().enumerate() {
                let stress = x(index % side) + y(index / side);
                *value = (*value + stress.max(0)).min(most);
            }
        }
        Values { values, margin: share(contact.stress_sum) + 1, clipped }
    }
}
