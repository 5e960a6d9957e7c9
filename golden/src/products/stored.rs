//! Stored matrices that real vectors are multiplied with.

use nalgebra_sparse::CsrMatrix;

use super::list::Source;
use crate::filter::FilteredMatrices;
use crate::float::Float;
use crate::matrices::Matrices;
use crate::parity::{COMPONENTS, butterfly};
use crate::reduced::{FoldedRows, ReducedMatrices, SumRows};
use crate::sums::ByPq;

/// The matrices that the products of a list are with, for vectors of `W` values an element.
pub trait Stored<const W: usize> {
    /// The product with the matrix that `source` names. `scratch` has two vectors of four values an orbit.
    fn times<T: Float>(&self, source: Source, x: &[[T; W]], result: &mut [[T; W]], scratch: &mut Quarters<T>);

    /// The sums `G_pq` from y+ and the weights.
    fn sums<T: Float>(&self, pull: &[[T; W]], weight: &[[T; W]]) -> ByPq<T>;

    /// The arm of a taxel's force, in metres from the middle of the grid, for sums of vectors that are not folded.
    fn arm_m(&self, taxel: usize) -> [f64; 2];
}

/// Two folded vectors.
pub type Quarters<T> = [Vec<[T; COMPONENTS]>; 2];

impl Stored<4> for ReducedMatrices {
    fn times<T: Float>(&self, source: Source, x: &[[T; 4]], result: &mut [[T; 4]], _: &mut Quarters<T>) {
        if let Source::Ten(name) = source {
            self.get(name).times(x, result);
        }
    }

    fn sums<T: Float>(&self, pull: &[[T; 4]], weight: &[[T; 4]]) -> ByPq<T> {
        self.sum_rows().of(|orbit, component| pull[orbit][component], |orbit, component| weight[orbit][component])
    }

    /// Rows of sums have the arms in them.
    fn arm_m(&self, _: usize) -> [f64; 2] {
        [0.0; 2]
    }
}

impl SumRows {
    /// The sums `G_pq` from what y+ and the weights have at an orbit in a component.
    pub(super) fn of<T: Float>(&self, pull: impl Fn(usize, usize) -> T, weight: impl Fn(usize, usize) -> T) -> ByPq<T> {
        let mut sums = ByPq::<T>::default();
        for orbit in 0..self.shares[0].weights.len() {
            for (p, sums) in sums.iter_mut().enumerate() {
                for (q, sum) in sums.iter_mut().enumerate() {
                    let row = &self.rows[p][q];
                    let value = if q == 0 { pull(orbit, row.component) } else { weight(orbit, row.component) };
                    *sum = *sum + T::of(row.weights[orbit]) * value;
                }
            }
            for (sums, share) in sums[2..].iter_mut().zip(&self.shares) {
                sums[0] = sums[0] - T::of(share.weights[orbit]) * weight(orbit, share.component);
            }
        }
        sums
    }
}

/// The thirteen after the filter, and C33, which no filter touches and which needs no more than its blocks.
#[derive(Clone, Debug)]
pub struct PaperMatrices {
    /// The thirteen.
    pub filtered: FilteredMatrices,
    c33: FoldedRows,
    images: Vec<[usize; 4]>,
    arms_m: Vec<[f64; 2]>,
}

impl PaperMatrices {
    /// Of one sensor.
    pub fn new(matrices: &Matrices, filtered: FilteredMatrices) -> Self {
        let sensor = matrices.sensor();
        Self {
            filtered,
            c33: FoldedRows::from(&matrices.c33),
            images: matrices.orbits().all(),
            arms_m: (0..sensor.taxels()).map(|taxel| sensor.arm_m(taxel)).collect(),
        }
    }
}

impl Stored<1> for PaperMatrices {
    fn times<T: Float>(&self, source: Source, x: &[[T; 1]], result: &mut [[T; 1]], scratch: &mut Quarters<T>) {
        let (x, result) = (x.as_flattened(), result.as_flattened_mut());
        if let Source::Thirteen(name) = source {
            return row_by_row(self.filtered.get(name), x, result);
        }
        let [folded, product] = scratch;
        folded.clear();
        folded.extend(self.images.iter().map(|taxels| butterfly(taxels.map(|taxel| x[taxel]))));
        product.resize(folded.len(), Default::default());
        self.c33.times(folded, product);
        for (taxels, product) in self.images.iter().zip(product) {
            for (&taxel, sum) in taxels.iter().zip(butterfly(*product)) {
                result[taxel] = T::of(0.25) * sum;
            }
        }
    }

    /// The paper's sums are those of the vectors `g_pq`.
    fn sums<T: Float>(&self, _: &[[T; 1]], _: &[[T; 1]]) -> ByPq<T> {
        ByPq::default()
    }

    fn arm_m(&self, taxel: usize) -> [f64; 2] {
        self.arms_m[taxel]
    }
}

/// The product of a sparse matrix with a vector.
fn row_by_row<T: Float>(matrix: &CsrMatrix<f64>, x: &[T], result: &mut [T]) {
    let (offsets, columns, values) = matrix.csr_data();
    for (row, result) in offsets.windows(2).zip(result) {
        let entries = row[0]..row[1];
        let (columns, columns_left) = columns[entries.clone()].as_chunks::<4>();
        let (values, values_left) = values[entries].as_chunks::<4>();
        // Four sums at a time: one alone would wait for each addition before it could begin the next.
        let mut sums = [T::default(); 4];
        for (&[i, j, k, l], &[a, b, c, d]) in columns.iter().zip(values) {
            sums[0] = sums[0] + T::of(a) * x[i];
            sums[1] = sums[1] + T::of(b) * x[j];
            sums[2] = sums[2] + T::of(c) * x[k];
            sums[3] = sums[3] + T::of(d) * x[l];
        }
        let left = columns_left.iter().zip(values_left);
        let left = left.fold(T::default(), |sum, (&column, &value)| sum + T::of(value) * x[column]);
        *result = (sums[0] + sums[1]) + (sums[2] + sums[3]) + left;
    }
}
