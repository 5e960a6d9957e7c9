//! The symmetry of a square: on a square grid with a square pitch, x and y may change places.
//!
//! The parity components take care of both mirrors, whatever the weights. For the diagonal mirror weights are tied.
//! Each hidden unit has a partner, whose inputs are transposed and whose output is along the other axis. The network is
//! then as symmetric as the grid, at no cost.

use nalgebra::DMatrix;

use crate::design::Sensor;
use crate::estimators::joint::Correction;
use crate::parity::{COMPONENTS, mirror, swapped};

/// Whether x and y may change places on a sensor.
pub(super) fn has_diagonal(sensor: &Sensor) -> bool {
    let [x, y] = sensor.pitch_mm;
    sensor.columns == sensor.rows && x.to_bits() == y.to_bits()
}

/// The partner of a hidden unit: units stand in pairs, and the last one of an odd number is its own partner.
pub(super) fn partner(unit: usize, units: usize) -> usize {
    if unit + 1 == units && unit.is_multiple_of(2) { unit } else { unit ^ 1 }
}

/// Where the inputs of each component go when the features are transposed.
#[derive(Clone, Debug)]
pub(super) struct Diagonal {
    /// Of each input of a component, its place in the component that it goes to.
    places: [Vec<usize>; COMPONENTS],
}

impl Diagonal {
    pub(super) fn new(places: [Vec<usize>; COMPONENTS]) -> Self {
        Self { places }
    }

    /// Replaces the matrix of each component by its mean with that of the transposed features. Rows and columns are
    /// inputs.
    pub(super) fn symmetrise(&self, of_components: &mut [DMatrix<f64>; COMPONENTS]) {
        let before = of_components.clone();
        for (component, matrix) in of_components.iter_mut().enumerate() {
            let (places, other) = (&self.places[component], &before[swapped(component)]);
            for (row, &to_row) in places.iter().enumerate() {
                for (column, &to_column) in places.iter().enumerate() {
                    matrix[(row, column)] = 0.5 * (matrix[(row, column)] + other[(to_row, to_column)]);
                }
            }
        }
    }

    /// Adds to what belongs to each unit (a row) and input what belongs to its partner's; both are then the same.
    pub(super) fn add(&self, of_components: &mut [DMatrix<f32>; COMPONENTS]) {
        let before = of_components.clone();
        for (component, matrix) in of_components.iter_mut().enumerate() {
            let (other, units) = (&before[swapped(component)], matrix.nrows());
            for (mut column, &place) in matrix.column_iter_mut().zip(&self.places[component]) {
                for unit in 0..units {
                    column[unit] += other[(partner(unit, units), place)];
                }
            }
        }
    }
}

/// As [`Diagonal::add`], for the weights of the units (rows) along x and y.
pub(super) fn add_output(output: &mut DMatrix<f32>) {
    let (before, units) = (output.clone(), output.nrows());
    for unit in 0..units {
        for axis in 0..2 {
            output[(unit, axis)] += before[(partner(unit, units), 1 - axis)];
        }
    }
}

/// Makes partners of whole weights exact: those of the first of a pair count.
pub(super) fn tie(correction: &mut Correction) {
    let (units, width) = (correction.hidden.len(), 2 * correction.half_window[0] + 1);
    let window = width * width;
    let transposed = |row: &[i32]| -> Vec<i32> {
        let places = (0..window).map(|place| row[mirror(place, width)]);
        places.chain([1, 0, 3, 2, 4].map(|extra| row[window + extra])).collect()
    };
    for unit in 0..units {
        let other = partner(unit, units);
        let mirrored = transposed(&correction.hidden[unit]);
        if other > unit {
            correction.hidden[other] = mirrored;
            let [along_x, along_y] = &mut correction.output;
            (along_x[other], along_y[other]) = (along_y[unit], along_x[unit]);
        } else if other == unit {
            let row = &mut correction.hidden[unit];
            row.iter_mut().zip(mirrored).for_each(|(weight, other)| *weight = i32::midpoint(*weight, other));
            let [along_x, along_y] = &mut correction.output;
            let mean = i32::midpoint(along_x[unit], along_y[unit]);
            (along_x[unit], along_y[unit]) = (mean, mean);
        }
    }
}
