//! Load kernels: the normal stress that a force on the surface causes at a taxel below it.

use nalgebra::DMatrix;
use std::f64::consts::PI;

use crate::design::Sensor;

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

/// C31, C32, C33 of a sensor, each `m` by `m` in Pa/N: row = taxel, column = place of the force.
pub fn point_matrices(sensor: &Sensor) -> [DMatrix<f64>; 3] {
    let taxels = sensor.taxels();
    let depth = sensor.depth_m();
    [0, 1, 2].map(|axis| {
        DMatrix::from_fn(taxels, taxels, |row, column| {
            // From grid steps, not from differences of positions, so that equal steps give equal bits and the
            // symmetries of the grid hold exactly.
            let n = sensor.columns;
            let steps_x = (column % n) as f64 - (row % n) as f64;
            let steps_y = (column / n) as f64 - (row / n) as f64;
            let offset = [steps_x * sensor.pitch_mm[0] * 1e-3, steps_y * sensor.pitch_mm[1] * 1e-3];
            point(offset, depth)[axis]
        })
    })
}
