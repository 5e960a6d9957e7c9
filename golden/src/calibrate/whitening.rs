//! Features of the samples as the training takes them: by parity component, and whitened.
//!
//! Mirrored features only differ in the signs of what is odd in x or in y. In the basis of the parity components one
//! product with the weights gives the hidden units of all four mirror images. The training sees the mean over them that
//! the solver and the hardware form.
//!
//! Neighbouring taxels have nearly the same values, and contacts differ in the small differences. Descent along these
//! would take very long. So each component is whitened: rotated and scaled until its values are uncorrelated and of one
//! size.

use nalgebra::{DMatrix, SymmetricEigen};

use super::diagonal::Diagonal;
use super::observer::Sample;
use crate::design::Correction;
use crate::estimators::joint::EXTRA_COMPONENTS;
use crate::parity::{COMPONENTS, Orbits, mirror, sign, swapped};

/// Variance below which a direction is noise and not worth its full length.
const LEAST_VARIANCE: f64 = 1e-3;

/// An orthonormal basis of the inputs by parity component, and its whitening.
pub(super) struct Basis {
    /// Of each component, the inputs of each vector with their factors.
    vectors: [Vec<Vec<(usize, f64)>>; COMPONENTS],
    /// Of each component, symmetric: from values in the basis to whitened ones.
    whitening: [DMatrix<f64>; COMPONENTS],
    /// Where x and y may change places.
    pub(super) diagonal: Option<Diagonal>,
}

impl Basis {
    /// The basis of a window and the inputs behind it, whitened for the samples; with `square` as symmetric as a square.
    pub(super) fn new(samples: &[Sample], half_window: [usize; 2], square: bool) -> Self {
        let vectors = vectors(half_window);
        let diagonal = square.then(|| diagonal(half_window));
        let mut basis = Self { whitening: [0, 1, 2, 3].map(|_| DMatrix::zeros(0, 0)), vectors, diagonal };
        let mut covariances = [0, 1, 2, 3].map(|component| {
            let size = basis.size(component);
            let mut covariance = DMatrix::zeros(size, size);
            let mut values = DMatrix::zeros(size, 1);
            for sample in samples {
                basis.split(component, &sample.features.values, values.as_mut_slice());
                covariance.syger(1.0 / samples.len() as f64, &values.column(0), &values.column(0), 1.0);
            }
            covariance.fill_upper_triangle_with_lower_triangle();
            covariance
        });
        if let Some(diagonal) = &basis.diagonal {
            diagonal.symmetrise(&mut covariances);
        }
        for (component, mut covariance) in covariances.into_iter().enumerate() {
            let size = basis.size(component);
            if component == 0 {
                // The constant input has no variance, and stays apart.
                covariance.row_mut(size - 1).fill(0.0);
                covariance.column_mut(size - 1).fill(0.0);
                covariance[(size - 1, size - 1)] = 1.0 - LEAST_VARIANCE;
            }
            let SymmetricEigen { eigenvectors, eigenvalues } = covariance.symmetric_eigen();
            let scales = eigenvalues.map(|variance| (variance.max(0.0) + LEAST_VARIANCE).sqrt().recip());
            basis.whitening[component] = &eigenvectors * DMatrix::from_diagonal(&scales) * eigenvectors.transpose();
        }
        if let Some(diagonal) = &basis.diagonal {
            diagonal.symmetrise(&mut basis.whitening);
        }
        basis
    }

    /// Number of whitened inputs of a component.
    pub(super) fn size(&self, component: usize) -> usize {
        self.vectors[component].len()
    }

    /// The values of one component in the basis, not whitened yet.
    fn split(&self, component: usize, inputs: &[f64], into: &mut [f64]) {
        for (value, vector) in into.iter_mut().zip(&self.vectors[component]) {
            *value = vector.iter().map(|&(input, factor)| factor * inputs[input]).sum();
        }
    }

    /// The whitened features of all samples by component, a column each.
    pub(super) fn features(&self, samples: &[Sample]) -> [DMatrix<f32>; COMPONENTS] {
        [0, 1, 2, 3].map(|component| {
            let mut values = DMatrix::zeros(self.size(component), 1);
            let mut features = DMatrix::zeros(self.size(component), samples.len());
            for (sample, mut column) in samples.iter().zip(features.column_iter_mut()) {
                self.split(component, &sample.features.values, values.as_mut_slice());
                let whitened = &self.whitening[component] * &values;
                column.iter_mut().zip(&whitened).for_each(|(into, value)| *into = *value as f32);
            }
            features
        })
    }

    /// Weights of the inputs themselves, a row for each hidden unit, from weights of whitened ones by component.
    pub(super) fn weights(&self, of_components: [&DMatrix<f32>; COMPONENTS]) -> DMatrix<f64> {
        let inputs = self.vectors.iter().flatten().flatten().map(|&(input, _)| input + 1).max().unwrap_or(0);
        let mut weights = DMatrix::zeros(of_components[0].nrows(), inputs);
        for ((vectors, whitening), of_component) in self.vectors.iter().zip(&self.whitening).zip(of_components) {
            let of_component = of_component.map(f64::from) * whitening;
            for (vector, column) in vectors.iter().zip(of_component.column_iter()) {
                for &(input, factor) in vector {
                    weights.column_mut(input).axpy(factor, &column, 1.0);
                }
            }
        }
        weights
    }
}

/// Where the inputs of each component go when x and y change places.
fn diagonal([half, _]: [usize; 2]) -> Diagonal {
    let orbits = Orbits::new(2 * half + 1, 2 * half + 1);
    let of = |component: usize| (0..orbits.count()).filter(move |&orbit| orbits.exists(component, orbit));
    Diagonal::new([0, 1, 2, 3].map(|component| {
        let transposed = |orbit| mirror(orbit, orbits.columns());
        let places =
            of(component).map(|orbit| of(swapped(component)).position(|at| at == transposed(orbit)).unwrap_or(0));
        // The inputs behind the window come in the same order.
        let (window, behind) = (of(component).count(), EXTRA_COMPONENTS.iter().filter(|&&of| of == component).count());
        places.chain(window..window + behind).collect()
    }))
}

/// The basis: places of a quarter of the window, then the inputs behind it.
fn vectors([half_x, half_y]: [usize; 2]) -> [Vec<Vec<(usize, f64)>>; COMPONENTS] {
    let orbits = Orbits::new(2 * half_x + 1, 2 * half_y + 1);
    let mut vectors = [0, 1, 2, 3].map(|component| {
        (0..orbits.count())
            .filter(|&orbit| orbits.exists(component, orbit))
            .map(|orbit| {
                let length = (orbits.size(orbit) as f64).sqrt();
                orbits.distinct(orbit).map(|(image, place)| (place, sign(component, image) / length)).collect()
            })
            .collect::<Vec<Vec<_>>>()
    });
    for (offset, component) in EXTRA_COMPONENTS.into_iter().enumerate() {
        vectors[component].push(vec![(orbits.taxels() + offset, 1.0)]);
    }
    debug_assert_eq!(vectors.iter().map(Vec::len).sum::<usize>(), Correction::inputs([half_x, half_y]));
    vectors
}
