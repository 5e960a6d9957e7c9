//! Load kernels: the normal stress that a force on the surface causes at a taxel below it.

use nalgebra::DMatrix;
use std::f64::consts::PI;

use crate::design::{Kernel, Sensor};
use crate::half_space;

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

/// C31, C32, C33 of a sensor, each `m` by `m` in Pa/N: row = taxel, column = place of the force.
pub fn matrices(sensor: &Sensor, kernel: Kernel) -> [DMatrix<f64>; 3] {
    let (columns, taxels) = (sensor.columns, sensor.taxels());
    let depth = sensor.depth_m();
    let pitch = sensor.pitch_mm.map(|side| side * 1e-3);
    // The entries depend on the distance in grid steps only, so each is computed once. Distances come from steps, not
    // from differences of positions, and signs are put in afterwards: the symmetries of the grid hold to the bit.
    let entries: Vec<[f64; 3]> = (0..taxels)
        .map(|steps| {
            let offset = [(steps % columns) as f64 * pitch[0], (steps / columns) as f64 * pitch[1]];
            match kernel {
                Kernel::Point => point(offset, depth),
                Kernel::Cell => cell(offset, depth, pitch),
            }
        })
        .collect();
    [0, 1, 2].map(|axis| {
        DMatrix::from_fn(taxels, taxels, |row, column| {
            let (x, y) = (row % columns, row / columns);
            let (force_x, force_y) = (column % columns, column / columns);
            let entry = entries[force_y.abs_diff(y) * columns + force_x.abs_diff(x)][axis];
            let behind = [force_x < x, force_y < y, false][axis];
            if behind { -entry } else { entry }
        })
    })
}
