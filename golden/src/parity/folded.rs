//! Matrices as four blocks.

use std::ops::{Mul, Neg};

use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};

use super::{COMPONENTS, Orbits, butterfly, sign};

/// A matrix of m by m entries that keeps or changes parity, as its four blocks of n by n.
///
/// For `y = M x`, `fold(y)[c ^ parity] = blocks[c] * fold(x)[c]`. Rows and columns of orbits that do not exist in a
/// component are exactly zero.
#[derive(Clone, Debug, PartialEq)]
pub struct FoldedMatrix {
    /// Its mirror symmetry: bit 0 if it changes even into odd in x and back, bit 1 in y.
    pub parity: usize,
    /// The orbits that are its rows and columns.
    pub orbits: Orbits,
    /// The blocks, by the component of the operand.
    pub blocks: [DMatrix<f64>; COMPONENTS],
}

impl FoldedMatrix {
    /// Folds the matrix with the entries `entry(row, column)`, of the mirror symmetry `parity`; its rows at image 0 of each
    /// orbit are enough.
    ///
    /// `Block_c[q][q']` is the sum over the distinct images `(s, j)` of q' of `sign(c, s) * M[image 0 of q][j]`.
    pub fn from_fn(parity: usize, orbits: &Orbits, entry: impl Fn(usize, usize) -> f64) -> Self {
        let n = orbits.count();
        let mut blocks = [0, 1, 2, 3].map(|_| DMatrix::zeros(n, n));
        let all = orbits.all();
        let exist: [Vec<bool>; COMPONENTS] =
            std::array::from_fn(|component| (0..n).map(|q| orbits.exists(component, q)).collect());
        for (column, &images) in all.iter().enumerate() {
            // Each image that is there twice is summed twice; the share is a power of two, so nothing is lost.
            let share = orbits.size(column) as f64 / 4.0;
            for (q, &[row, ..]) in all.iter().enumerate() {
                let sums = butterfly(images.map(|taxel| entry(row, taxel)));
                for (component, sum) in sums.into_iter().enumerate() {
                    if exist[component ^ parity][q] && exist[component][column] {
                        blocks[component][(q, column)] = share * sum;
                    }
                }
            }
        }
        Self { parity, orbits: *orbits, blocks }
    }

    /// The matrix of m by m entries.
    pub fn dense(&self) -> DMatrix<f64> {
        let (n, m) = (self.orbits.count(), self.orbits.taxels());
        let distinct: Vec<Vec<(usize, usize)>> = (0..n).map(|q| self.orbits.distinct(q).collect()).collect();
        let mut dense = DMatrix::zeros(m, m);
        for (column, of_column) in distinct.iter().enumerate() {
            for (q, of_row) in distinct.iter().enumerate() {
                let values = self.values(q, column);
                for &(t, j) in of_column {
                    for &(s, i) in of_row {
                        dense[(i, j)] = sign(self.parity, s) * values[s ^ t];
                    }
                }
            }
        }
        dense
    }

    /// What stands in row `image 0 of q` at the four images of orbit `column`; the row of image s has
    /// `sign(parity, s)` times the same at image `s ^ t` in place of t.
    pub(crate) fn values(&self, q: usize, column: usize) -> [f64; 4] {
        let share = 1.0 / self.orbits.size(column) as f64;
        butterfly(self.blocks.each_ref().map(|block| block[(q, column)])).map(|value| share * value)
    }

    /// The blocks of the product of both matrices.
    #[must_use]
    pub fn times(&self, right: &Self) -> Self {
        let blocks = [0, 1, 2, 3].map(|component| &self.blocks[component ^ right.parity] * &right.blocks[component]);
        Self { parity: self.parity ^ right.parity, orbits: self.orbits, blocks }
    }

    /// The blocks of `self - right`; both of the same parity.
    #[must_use]
    pub fn minus(&self, right: &Self) -> Self {
        let blocks = [0, 1, 2, 3].map(|component| &self.blocks[component] - &right.blocks[component]);
        Self { parity: self.parity, orbits: self.orbits, blocks }
    }

    /// The product with a folded vector.
    pub fn apply(&self, x: &[Vec<f64>; COMPONENTS]) -> [Vec<f64>; COMPONENTS] {
        let mut product = [0, 1, 2, 3].map(|_| vec![0.0; self.orbits.count()]);
        self.add_to(&mut product, x);
        product
    }

    /// Adds the product with a folded vector.
    pub(crate) fn add_to(&self, sum: &mut [Vec<f64>; COMPONENTS], x: &[Vec<f64>; COMPONENTS]) {
        let n = self.orbits.count();
        for (component, block) in self.blocks.iter().enumerate() {
            let mut sum = DVectorViewMut::from_slice(&mut sum[component ^ self.parity], n);
            sum.gemv(1.0, block, &DVectorView::from_slice(&x[component], n), 1.0);
        }
    }
}

impl Mul<&DVector<f64>> for &FoldedMatrix {
    type Output = DVector<f64>;

    /// The product with a vector of m values.
    fn mul(self, x: &DVector<f64>) -> DVector<f64> {
        DVector::from_vec(self.orbits.unfold(&self.apply(&self.orbits.fold(x.as_slice()))))
    }
}

impl Neg for FoldedMatrix {
    type Output = Self;

    fn neg(self) -> Self {
        Self { blocks: self.blocks.map(DMatrix::neg), ..self }
    }
}
