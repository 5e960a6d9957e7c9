//! Matrices as four blocks.

use std::ops::{Mul, Neg};

use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};

use super::{CLASSES, Quads, butterfly, sign};

/// A matrix of m by m entries that keeps or changes parity, as its four blocks of n by n.
///
/// For `y = M x`, `fold(y)[c ^ parity] = blocks[c] * fold(x)[c]`. Rows and columns of quads that do not exist in a
/// class are exactly zero.
#[derive(Clone, Debug, PartialEq)]
pub struct FoldedMatrix {
    /// What the matrix does to a class: bit 0 changes even and odd in x, bit 1 in y.
    pub parity: usize,
    /// The quads that are its rows and columns.
    pub quads: Quads,
    /// The blocks, by the class of the operand.
    pub blocks: [DMatrix<f64>; CLASSES],
}

impl FoldedMatrix {
    /// Folds a matrix of m by m entries with the mirror symmetry `parity`; its rows at member 0 of each quad are
    /// enough.
    pub fn new(matrix: &DMatrix<f64>, parity: usize, quads: &Quads) -> Self {
        Self::from_fn(parity, quads, |row, column| matrix[(row, column)])
    }

    /// Folds the matrix with the entries `entry(row, column)`.
    ///
    /// `Block_c[q][q']` is the sum over the distinct members `(s, j)` of q' of `sign(c, s) * M[member 0 of q][j]`.
    pub fn from_fn(parity: usize, quads: &Quads, entry: impl Fn(usize, usize) -> f64) -> Self {
        let n = quads.count();
        let mut blocks = [0, 1, 2, 3].map(|_| DMatrix::zeros(n, n));
        let all = quads.all();
        let exist: [Vec<bool>; CLASSES] = std::array::from_fn(|class| (0..n).map(|q| quads.exists(class, q)).collect());
        for (column, &members) in all.iter().enumerate() {
            // Each member that is there twice is summed twice; the share is a power of two, so nothing is lost.
            let share = quads.size(column) as f64 / 4.0;
            for (q, &[row, ..]) in all.iter().enumerate() {
                let sums = butterfly(members.map(|taxel| entry(row, taxel)));
                for (class, sum) in sums.into_iter().enumerate() {
                    if exist[class ^ parity][q] && exist[class][column] {
                        blocks[class][(q, column)] = share * sum;
                    }
                }
            }
        }
        Self { parity, quads: *quads, blocks }
    }

    /// The matrix of m by m entries.
    pub fn dense(&self) -> DMatrix<f64> {
        let (n, m) = (self.quads.count(), self.quads.taxels());
        let distinct: Vec<Vec<(usize, usize)>> = (0..n).map(|q| self.quads.distinct(q).collect()).collect();
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

    /// What stands in row `member 0 of q` at the four members of quad `column`; the row of member s has
    /// `sign(parity, s)` times the same at member `s ^ t` in place of t.
    pub(crate) fn values(&self, q: usize, column: usize) -> [f64; 4] {
        let share = 1.0 / self.quads.size(column) as f64;
        butterfly(self.blocks.each_ref().map(|block| block[(q, column)])).map(|value| share * value)
    }

    /// The blocks of the product of both matrices.
    #[must_use]
    pub fn times(&self, right: &Self) -> Self {
        let blocks = [0, 1, 2, 3].map(|class| &self.blocks[class ^ right.parity] * &right.blocks[class]);
        Self { parity: self.parity ^ right.parity, quads: self.quads, blocks }
    }

    /// The blocks of `self - right`; both of the same parity.
    #[must_use]
    pub fn minus(&self, right: &Self) -> Self {
        let blocks = [0, 1, 2, 3].map(|class| &self.blocks[class] - &right.blocks[class]);
        Self { parity: self.parity, quads: self.quads, blocks }
    }

    /// The product with a folded vector.
    pub fn apply(&self, x: &[Vec<f64>; CLASSES]) -> [Vec<f64>; CLASSES] {
        let mut product = [0, 1, 2, 3].map(|_| vec![0.0; self.quads.count()]);
        self.add_to(&mut product, x);
        product
    }

    /// Adds the product with a folded vector.
    pub(crate) fn add_to(&self, sum: &mut [Vec<f64>; CLASSES], x: &[Vec<f64>; CLASSES]) {
        let n = self.quads.count();
        for (class, block) in self.blocks.iter().enumerate() {
            let mut sum = DVectorViewMut::from_slice(&mut sum[class ^ self.parity], n);
            sum.gemv(1.0, block, &DVectorView::from_slice(&x[class], n), 1.0);
        }
    }
}

impl Mul<&DVector<f64>> for &FoldedMatrix {
    type Output = DVector<f64>;

    /// The product with a vector of m values.
    fn mul(self, x: &DVector<f64>) -> DVector<f64> {
        DVector::from_vec(self.quads.unfold(&self.apply(&self.quads.fold(x.as_slice()))))
    }
}

impl Neg for FoldedMatrix {
    type Output = Self;

    fn neg(self) -> Self {
        Self { blocks: self.blocks.map(DMatrix::neg), ..self }
    }
}
