//! Dead taxels: what their neighbours say in their place.
//!
//! The stress is taken for a smooth random field with the covariance `S = (C33 C33ᵀ)²`, and the stress of a dead taxel is
//! what is expected of it where all others are known: `b_d = S_do S_oo⁻¹ b_o`. That is a weighted sum whose weights fall off
//! within a few taxels. In the inverse P of S it reads `-P_dd⁻¹ P_do b_o`, so that the dead ones alone, few as they
//! are, take a system of equations.

use nalgebra::{DMatrix, DVector};

use crate::kernel::{self, Kernel};
use crate::parity::{COMPONENTS, Orbits};
use crate::sensor::Sensor;

/// Most taxels of a sensor that can be replaced.
pub const MOST_DEAD: usize = 8;
/// More than this share of a frame's stress in replaced taxels is a guess.
pub const GUESSED: f64 = 1.0 / 8.0;
/// What is added to the diagonal of the covariance, as a share of its mean: far below any sensor's noise.
const NUGGET: f64 = 1e-9;

/// The weights that give each dead taxel its stress.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeadTaxels {
    taxels: Vec<usize>,
    weights: Vec<Vec<f64>>,
}

impl DeadTaxels {
    /// The weights for the taxels `dead` of a sensor, each named once, at least one of the others being alive.
    pub fn new(sensor: &Sensor, kernel: Kernel, dead: &[usize]) -> Self {
        if dead.is_empty() {
            return Self::default();
        }
        let precision = precision(sensor, kernel, dead);
        let among = DMatrix::from_fn(dead.len(), dead.len(), |i, j| precision[j][dead[i]]);
        // Positive definite, as a part of a matrix that is.
        let inverse = among.clone().cholesky().map_or_else(|| among, |factors| factors.inverse());
        let weight = |row: usize, taxel: usize| -> f64 {
            -precision.iter().enumerate().map(|(column, of)| inverse[(row, column)] * of[taxel]).sum::<f64>()
        };
        let of_taxel = |row: usize, taxel: usize| if dead.contains(&taxel) { 0.0 } else { weight(row, taxel) };
        let weights = (0..dead.len()).map(|row| (0..sensor.taxels()).map(|taxel| of_taxel(row, taxel)).collect());
        Self { taxels: dead.to_vec(), weights: weights.collect() }
    }

    /// The dead taxels.
    pub fn taxels(&self) -> &[usize] {
        &self.taxels
    }

    /// The weight of each taxel of the sensor in the stress of each dead one; that of a dead one is 0.
    pub fn weights(&self) -> &[Vec<f64>] {
        &self.weights
    }

    /// Whether a taxel is dead.
    pub fn contains(&self, taxel: usize) -> bool {
        self.taxels.contains(&taxel)
    }

    /// Puts a stress in the place of each dead taxel's reading, in a frame of one value for each taxel.
    pub fn replace(&self, b: &mut [f64]) {
        for &taxel in &self.taxels {
            // Whatever it reads, even a NaN.
            b[taxel] = 0.0;
        }
        let sum = |weights: &Vec<f64>| weights.iter().zip(&*b).map(|(weight, stress)| weight * stress).sum();
        let replaced: Vec<f64> = self.weights.iter().map(sum).collect();
        for (&taxel, stress) in self.taxels.iter().zip(replaced) {
            b[taxel] = stress;
        }
    }
}

/// The columns of the inverse of the covariance at the dead taxels.
///
/// Like C33 the covariance commutes with both mirrors of the grid, so it is factorised in blocks of a quarter of its size.
fn precision(sensor: &Sensor, kernel: Kernel, dead: &[usize]) -> Vec<Vec<f64>> {
    let [_, _, c33] = &kernel::folded(sensor, kernel);
    let orbits = Orbits::new(sensor.columns, sensor.rows);
    // C33 is its own transpose: equal offsets, equal stresses.
    let square = c33.times(c33);
    let mut blocks = square.times(&square).blocks;
    let nugget = NUGGET * blocks.iter().map(DMatrix::trace).sum::<f64>() / sensor.taxels() as f64;
    for block in &mut blocks {
        (0..block.nrows()).for_each(|q| block[(q, q)] += nugget);
    }
    let factors = blocks.map(DMatrix::lu);
    let column = |&taxel: &usize| {
        let mut unit = vec![0.0; sensor.taxels()];
        unit[taxel] = 1.0;
        let folded = orbits.fold(&unit);
        let solved: [Vec<f64>; COMPONENTS] = std::array::from_fn(|component| {
            let right = DVector::from_column_slice(&folded[component]);
            // Regular by the nugget.
            factors[component].solve(&right).unwrap_or(right).as_slice().to_vec()
        });
        orbits.unfold(&solved)
    };
    dead.iter().map(column).collect()
}
