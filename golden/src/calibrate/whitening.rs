//! What the correction sees of the samples, as its training takes it: by parity class, and whitened.
//!
//! Mirrored features only differ in the signs of what is odd in x or in y. In the basis of the parity classes one product
//! with the weights therefore gives the hidden units of all four mirror images, and the training sees the mean over
//! them that the solver and the hardware form. The values of neighbouring taxels are nearly the same; descent along
//! their small differences, which are what tells contacts apart, would take for ever. So each class is whitened: turned
//! and scaled until its values are uncorrelated and of one size.

use nalgebra::{DMatrix, SymmetricEigen};

use super::diagonal::{Diagonal, TRANSPOSED};
use super::observer::Sample;
use crate::design::Correction;
use crate::estimators::joint::EXTRA_CLASSES;
use crate::parity::{CLASSES, Quads, sign};

/// Variance below which a direction is noise and not worth its full length.
const LEAST_VARIANCE: f64 = 1e-3;

/// An orthonormal basis of the inputs by parity class, and its whitening.
pub(super) struct Basis {
    /// Of each class, the inputs of each vector with their factors.
    vectors: [Vec<Vec<(usize, f64)>>; CLASSES],
    /// Of each class, symmetric: from values in the basis to whitened ones.
    whitening: [DMatrix<f64>; CLASSES],
    /// Where x and y may change places.
    pub(super) diagonal: Option<Diagonal>,
}

impl Basis {
    /// The basis of a window and the inputs behind it, whitened for the samples; with `square` as symmetric as a square.
    pub(super) fn new(samples: &[Sample], half_window: [usize; 2], square: bool) -> Self {
        let vectors = vectors(half_window);
        let diagonal = square.then(|| diagonal(half_window));
        let mut basis = Self { whitening: [0, 1, 2, 3].map(|_| DMatrix::zeros(0, 0)), vectors, diagonal };
        let mut covariances = [0, 1, 2, 3].map(|class| {
            let size = basis.size(class);
            let mut covariance = DMatrix::zeros(size, size);
            let mut values = DMatrix::zeros(size, 1);
            for sample in samples {
                basis.split(class, &sample.features.values, values.as_mut_slice());
                covariance.syger(1.0 / samples.len() as f64, &values.column(0), &values.column(0), 1.0);
            }
            covariance.fill_upper_triangle_with_lower_triangle();
            covariance
        });
        if let Some(diagonal) = &basis.diagonal {
            diagonal.symmetrise(&mut covariances);
        }
        for (class, mut covariance) in covariances.into_iter().enumerate() {
            let size = basis.size(class);
            if class == 0 {
                // The constant input has no variance, and stays apart.
                covariance.row_mut(size - 1).fill(0.0);
                covariance.column_mut(size - 1).fill(0.0);
                covariance[(size - 1, size - 1)] = 1.0 - LEAST_VARIANCE;
            }
            let SymmetricEigen { eigenvectors, eigenvalues } = covariance.symmetric_eigen();
            let scales = eigenvalues.map(|variance| (variance.max(0.0) + LEAST_VARIANCE).sqrt().recip());
            basis.whitening[class] = &eigenvectors * DMatrix::from_diagonal(&scales) * eigenvectors.transpose();
        }
        if let Some(diagonal) = &basis.diagonal {
            diagonal.symmetrise(&mut basis.whitening);
        }
        basis
    }

    /// Number of whitened inputs of a class.
    pub(super) fn size(&self, class: usize) -> usize {
        self.vectors[class].len()
    }

    /// The values of one class in the basis, not whitened yet.
    fn split(&self, class: usize, inputs: &[f64], into: &mut [f64]) {
        for (value, vector) in into.iter_mut().zip(&self.vectors[class]) {
            *value = vector.iter().map(|&(input, factor)| factor * inputs[input]).sum();
        }
    }

    /// The whitened features of all samples by class, a column each.
    pub(super) fn features(&self, samples: &[Sample]) -> [DMatrix<f32>; CLASSES] {
        [0, 1, 2, 3].map(|class| {
            let mut values = DMatrix::zeros(self.size(class), 1);
            let mut features = DMatrix::zeros(self.size(class), samples.len());
            for (sample, mut column) in samples.iter().zip(features.column_iter_mut()) {
                self.split(class, &sample.features.values, values.as_mut_slice());
                let whitened = &self.whitening[class] * &values;
                column.iter_mut().zip(&whitened).for_each(|(into, value)| *into = *value as f32);
            }
            features
        })
    }

    /// Weights of the inputs themselves, a row for each hidden unit, from weights of whitened ones by class.
    pub(super) fn weights(&self, of_classes: [&DMatrix<f32>; CLASSES]) -> DMatrix<f64> {
        let inputs = self.vectors.iter().flatten().flatten().map(|&(input, _)| input + 1).max().unwrap_or(0);
        let mut weights = DMatrix::zeros(of_classes[0].nrows(), inputs);
        for ((vectors, whitening), of_class) in self.vectors.iter().zip(&self.whitening).zip(of_classes) {
            let of_class = of_class.map(f64::from) * whitening;
            for (vector, column) in vectors.iter().zip(of_class.column_iter()) {
                for &(input, factor) in vector {
                    weights.column_mut(input).axpy(factor, &column, 1.0);
                }
            }
        }
        weights
    }
}

/// Where the inputs of each class go when x and y change places.
fn diagonal([half, _]: [usize; 2]) -> Diagonal {
    let quads = Quads::new(2 * half + 1, 2 * half + 1);
    let of = |class: usize| (0..quads.count()).filter(move |&quad| quads.exists(class, quad));
    Diagonal::new([0, 1, 2, 3].map(|class| {
        let other = TRANSPOSED[class];
        let transposed = |quad: usize| quad % quads.columns() * quads.columns() + quad / quads.columns();
        let places = of(class).map(|quad| of(other).position(|at| at == transposed(quad)).unwrap_or(0));
        // The inputs behind the window come in the same order.
        let (window, behind) = (of(class).count(), EXTRA_CLASSES.iter().filter(|&&of| of == class).count());
        places.chain(window..window + behind).collect()
    }))
}

/// The basis: places of a quarter of the window, then the inputs behind it.
fn vectors([half_x, half_y]: [usize; 2]) -> [Vec<Vec<(usize, f64)>>; CLASSES] {
    let quads = Quads::new(2 * half_x + 1, 2 * half_y + 1);
    let mut vectors = [0, 1, 2, 3].map(|class| {
        (0..quads.count())
            .filter(|&quad| quads.exists(class, quad))
            .map(|quad| {
                let length = (quads.size(quad) as f64).sqrt();
                quads.distinct(quad).map(|(member, place)| (place, sign(class, member) / length)).collect()
            })
            .collect::<Vec<Vec<_>>>()
    });
    for (offset, class) in EXTRA_CLASSES.into_iter().enumerate() {
        vectors[class].push(vec![(quads.taxels() + offset, 1.0)]);
    }
    debug_assert_eq!(vectors.iter().map(Vec::len).sum::<usize>(), Correction::inputs([half_x, half_y]));
    vectors
}
