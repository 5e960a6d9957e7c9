//! Load kernels: the normal stress that a force on the surface causes at a taxel below it.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::half_space;
use crate::parity::{FoldedMatrix, Orbits};
use crate::sensor::Sensor;
use crate::words::print_as_words;

/// How a force on one surface point loads a taxel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Kernel {
    /// Point force on an elastic half-space, as in the paper (Eq. 4).
    Point,
    /// The same force spread evenly over a cell of one pitch by one pitch around its place (Love's closed form).
    ///
    /// Forces stay in newtons for each place. To choose where the normal force matters: the coarser the pitch for the
    /// depth, the more a point force overstates the stress straight below it, so that `F_z` falls short, by 10 and
    /// 20 % on the sensors of the paper; with cells it is right to 1 %. The line search's tangential forces fall
    /// short with either kernel, so that friction, their quotient, is better with the point kernel. On layers of less
    /// than half a pitch, where a point force beside a taxel hardly reaches it, this one is better for both.
    Cell,
}

print_as_words!(Kernel);

impl Kernel {
    /// The key `kernel` of a design that leaves it out.
    pub(crate) fn usual(sensor: &Sensor) -> Self {
        if sensor.wants_cells() { Self::Cell } else { Self::Point }
    }
}

/// Stress in pascals at a taxel `depth` metres below the surface for a force of one newton at `offset` metres from
/// it, along x, y and z: the entries of C31, C32, C33.
///
/// `offset` is the position of the force minus that of the taxel. The point force acts on an elastic half-space
/// (Boussinesq and Cerruti; Pinto-Salamanca et al., Sensors 2024, Eq. 4). With this sign a force along +x puts
/// taxels behind it, at smaller x, under tension: tension trails the push.
pub fn point(offset: [f64; 2], depth: f64) -> [f64; 3] {
    let [x, y] = offset;
    let square = x * x + y * y + depth * depth;
    let common = 3.0 * depth * depth / (2.0 * PI * square * square * square.sqrt());
    [common * x, common * y, common * depth]
}

/// As [`point`], but with the force spread evenly over a cell of `pitch` metres around its place.
///
/// The cells of all places cover the surface without a gap, so a smooth pressure is represented without the gain
/// error of point forces, which sample it: equal forces everywhere cause the stress of the pressure they mean.
pub fn cell(offset: [f64; 2], depth: f64, pitch: [f64; 2]) -> [f64; 3] {
    // Seen from the force the taxel lies at minus `offset`. The stress under a normal load is even in it; and z
    // points out of the body here, so that pressing is negative.
    let [normal, along_x, along_y] = half_space::rectangle(pitch.map(|side| 0.5 * side), offset, depth);
    [-along_x, -along_y, -normal]
}

/// Stress of equal forces on all places of an endless grid, relative to the pressure that they mean: what the normal
/// force of a wide contact is divided by. 1 is right; point forces have more, the more the shallower the sensor is.
pub fn gain(sensor: &Sensor, kernel: Kernel) -> f64 {
    /// So many depths away nothing is felt but a thousandth.
    const REACH: f64 = 12.0;
    let depth = sensor.depth_m();
    let pitch = sensor.pitch_mm.map(|side| side * 1e-3);
    let [x, y] = pitch.map(|side| (REACH * depth / side).ceil() as i32);
    let at = |ix: i32, iy: i32| {
        let offset = [f64::from(ix) * pitch[0], f64::from(iy) * pitch[1]];
        match kernel {
            Kernel::Point => point(offset, depth)[2],
            Kernel::Cell => cell(offset, depth, pitch)[2],
        }
    };
    let sum: f64 = (-y..=y).flat_map(|iy| (-x..=x).map(move |ix| (ix, iy))).map(|(ix, iy)| at(ix, iy)).sum();
    pitch[0] * pitch[1] * sum
}

/// C31, C32, C33 of a sensor, each `m` by `m` in Pa/N: row = taxel, column = place of the force.
pub fn matrices(sensor: &Sensor, kernel: Kernel) -> [DMatrix<f64>; 3] {
    let entries = Entries::new(sensor, kernel);
    let taxels = sensor.taxels();
    [0, 1, 2].map(|axis| DMatrix::from_fn(taxels, taxels, |row, column| entries.at(axis, row, column)))
}

/// C31, C32, C33 of a sensor as blocks: the first is odd in x, the second in y.
pub fn folded(sensor: &Sensor, kernel: Kernel) -> [FoldedMatrix; 3] {
    let entries = Entries::new(sensor, kernel);
    let orbits = Orbits::new(sensor.columns, sensor.rows);
    [(0, 1), (1, 2), (2, 0)]
        .map(|(axis, parity)| FoldedMatrix::from_fn(parity, &orbits, |row, column| entries.at(axis, row, column)))
}

/// The entries of C31, C32, C33 by the distance in grid steps, on which alone they depend: m of each.
struct Entries {
    columns: usize,
    /// For a force at larger x and y.
    ahead: Vec<[f64; 3]>,
}

impl Entries {
    fn new(sensor: &Sensor, kernel: Kernel) -> Self {
        let columns = sensor.columns;
        let depth = sensor.depth_m();
        let pitch = sensor.pitch_mm.map(|side| side * 1e-3);
        let ahead = (0..sensor.taxels())
            .map(|steps| {
                let offset = [(steps % columns) as f64 * pitch[0], (steps / columns) as f64 * pitch[1]];
                match kernel {
                    Kernel::Point => point(offset, depth),
                    Kernel::Cell => cell(offset, depth, pitch),
                }
            })
            .collect();
        Self { columns, ahead }
    }

    // Distances come from steps, not from differences of positions, and signs are put in afterwards: the symmetries of
    // the grid hold to the bit.
    fn at(&self, axis: usize, row: usize, column: usize) -> f64 {
        let (x, y) = (row % self.columns, row / self.columns);
        let (force_x, force_y) = (column % self.columns, column / self.columns);
        let entry = self.ahead[force_y.abs_diff(y) * self.columns + force_x.abs_diff(x)][axis];
        let behind = [force_x < x, force_y < y, false][axis];
        if behind { -entry } else { entry }
    }
}
