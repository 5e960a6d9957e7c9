//! The matrices of the reduced plan: ten in place of the paper's thirteen and three products with C33, each as four
//! blocks of a quarter of the size.
//!
//! With `y = C33inv b`, `|w| = max(-y, 0)`, `y+ = max(y, 0)` and `E = C33 A3`, a frame needs
//!
//! ```text
//! u0 = b - K0 y+    u1 = -K1 |w|    u2 = -K2 |w|      K0 = (I - E) C33    K1 = E C31    K2 = E C32
//! r = C33 y+ - mu_x C31 |w| - mu_y C32 |w|            f_p = A_p r + [mu_x |w|, mu_y |w|, -|w|]
//! ```
//!
//! and for the line the sums `G_pq`, which are dot products. All this is the paper's mathematics (Eqs. 8 to 16) put
//! together otherwise: without a filter the results are the same but for rounding.

use nalgebra::{DMatrix, RowDVector};

use crate::design::{Filter, MatrixFilter};
use crate::filter::FilterError;
use crate::matrices::Matrices;
use crate::names::MatrixName;
pub use crate::names::ReducedName;
use crate::parity::{CLASSES, FoldedMatrix, Quads};

/// The four blocks of a matrix, sparse, row by row.
///
/// All classes keep the same entries, so that one column number serves four coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct FoldedRows {
    /// What the matrix does to a class, as in [`FoldedMatrix`].
    pub parity: usize,
    /// For each quad its entries, columns ascending: the quad multiplied and the coefficient by the operand's class.
    /// No row is empty.
    pub rows: Vec<Vec<(u32, [f64; CLASSES])>>,
}

impl FoldedRows {
    /// The product with a folded vector.
    pub fn apply(&self, x: &[Vec<f64>; CLASSES]) -> [Vec<f64>; CLASSES] {
        let mut result: [Vec<f64>; CLASSES] = std::array::from_fn(|_| Vec::with_capacity(self.rows.len()));
        for row in &self.rows {
            let mut sums = [0.0; CLASSES];
            for &(column, coefficients) in row {
                for class in 0..CLASSES {
                    sums[class] += coefficients[class] * x[class][column as usize];
                }
            }
            for (class, sum) in sums.into_iter().enumerate() {
                result[class ^ self.parity].push(sum);
            }
        }
        result
    }
}

impl From<&FoldedMatrix> for FoldedRows {
    /// All entries, unfiltered.
    fn from(folded: &FoldedMatrix) -> Self {
        let n = folded.quads.count();
        let entry = |row, column: usize| (column as u32, folded.blocks.each_ref().map(|block| block[(row, column)]));
        Self {
            parity: folded.parity,
            rows: (0..n).map(|row| (0..n).map(|column| entry(row, column)).collect()).collect(),
        }
    }
}

/// A sum over all taxels as a dot product: `sum_q weights[q] * operand[class][q]` of a folded operand.
#[derive(Clone, Debug, PartialEq)]
pub struct SumRow {
    /// The class that has the sum in it; the others add up to zero.
    pub class: usize,
    /// One weight for each quad.
    pub weights: Vec<f64>,
}

impl SumRow {
    /// The sum for a folded operand.
    pub fn apply(&self, x: &[Vec<f64>; CLASSES]) -> f64 {
        self.weights.iter().zip(&x[self.class]).map(|(weight, value)| weight * value).sum()
    }
}

/// The rows of all sums of a frame, see [`ReducedMatrices::sums`] and [`ReducedMatrices::weight_sum`].
#[derive(Clone, Debug)]
pub(crate) struct SumRows {
    /// By `[p][q]`.
    pub(crate) rows: [[SumRow; 3]; 3],
    pub(crate) total: SumRow,
}

/// The ten matrices of the reduced plan after the filter, and the rows of its sums.
///
/// **What a filter means here.** It is applied to the folded blocks, whose rows and columns are quads. F2 with p keeps
/// of every row of every block the entries with `|B_ij| >= max_j |B_ij| / (1000 p)` (by magnitude: a folded row has no
/// sign of its own). F1 with l keeps `|i - j| <= (n - 1) (1 - l / (m - 1))`, rounded down: the same share of the
/// diagonals as of the whole matrix. An entry that one class keeps is kept for all four. The sums are never filtered.
#[derive(Clone, Debug)]
pub struct ReducedMatrices {
    ten: Vec<FoldedRows>,
    sums: SumRows,
}

impl ReducedMatrices {
    /// Folds, multiplies and filters.
    ///
    /// # Errors
    ///
    /// [`FilterError::Reduced`] for F3, whose choices are for the thirteen matrices of the paper,
    /// [`FilterError::EmptyFoldedRow`] when a row loses every entry.
    pub fn new(matrices: &Matrices, quads: &Quads, filter: &Filter) -> Result<Self, FilterError> {
        let rule = match filter {
            Filter::None => MatrixFilter::None,
            Filter::F1 { l } => MatrixFilter::F1 { l: *l },
            Filter::F2 { p } => MatrixFilter::F2 { p: *p },
            Filter::F3 { .. } => return Err(FilterError::Reduced),
        };
        let Matrices { c31, c32, c33, .. } = matrices;
        let a = [MatrixName::A1, MatrixName::A2, MatrixName::A3].map(|name| matrices.folded(name));

        let weight_sum = SumRow { class: 0, weights: (0..quads.count()).map(|q| quads.size(q) as f64 / 4.0).collect() };
        let row = |p: usize, q: usize| {
            let mut row = sum_row(&sum_row(&weight_sum, &a[p]), [c33, c31, c32][q]);
            if q > 0 {
                row.weights.iter_mut().for_each(|weight| *weight = -*weight);
            }
            // |w| itself, in g11 and g22.
            if q == p + 1 {
                row.weights.iter_mut().zip(&weight_sum.weights).for_each(|(weight, one)| *weight += one);
            }
            row
        };
        let rows = std::array::from_fn(|p| std::array::from_fn(|q| row(p, q)));

        let e = c33.times(&a[2]);
        let sparse = |name: ReducedName, folded: &FoldedMatrix| filtered(name, folded, quads, rule);
        let ten = vec![
            sparse(ReducedName::C33inv, &matrices.folded(MatrixName::C33inv))?,
            sparse(ReducedName::K0, &c33.minus(&e.times(c33)))?,
            sparse(ReducedName::K1, &e.times(c31))?,
            sparse(ReducedName::K2, &e.times(c32))?,
            sparse(ReducedName::C33, c33)?,
            sparse(ReducedName::C31, c31)?,
            sparse(ReducedName::C32, c32)?,
            sparse(ReducedName::A1, &a[0])?,
            sparse(ReducedName::A2, &a[1])?,
            sparse(ReducedName::A3, &a[2])?,
        ];
        Ok(Self { ten, sums: SumRows { rows, total: weight_sum } })
    }

    /// One of the ten matrices.
    pub fn get(&self, name: ReducedName) -> &FoldedRows {
        &self.ten[name.index()]
    }

    /// The row of `G_(p+1)q`, p and q from 0 to 2. Its operand is the folded y+ for q = 0 and the folded |w| for q = 1
    /// and 2. The sum of |w| in G11 and G22 is included, that in G30 (`- sum |w|`) is not.
    pub fn sums(&self, p: usize, q: usize) -> &SumRow {
        &self.sums.rows[p][q]
    }

    /// The row of the sum of |w|, from the folded |w|.
    pub fn weight_sum(&self) -> &SumRow {
        &self.sums.total
    }

    /// Those of all sums.
    pub(crate) fn sum_rows(&self) -> &SumRows {
        &self.sums
    }

    /// Number of coefficients stored: four for each entry that any class keeps.
    pub fn nnz(&self, name: ReducedName) -> usize {
        CLASSES * self.get(name).rows.iter().map(Vec::len).sum::<usize>()
    }
}

/// The row of the sum of `M x` for a row that sums `M x` from what M makes of x.
fn sum_row(over_result: &SumRow, matrix: &FoldedMatrix) -> SumRow {
    let class = over_result.class ^ matrix.parity;
    let row = RowDVector::from_row_slice(&over_result.weights) * &matrix.blocks[class];
    SumRow { class, weights: row.as_slice().to_vec() }
}

fn filtered(
    name: ReducedName,
    folded: &FoldedMatrix,
    quads: &Quads,
    filter: MatrixFilter,
) -> Result<FoldedRows, FilterError> {
    let n = quads.count();
    // Row by row below, and the entries of a column are neighbours in memory.
    let blocks = folded.blocks.each_ref().map(DMatrix::transpose);
    let distance = match filter {
        // l is at most m - 2, so that the diagonal always stays.
        MatrixFilter::F1 { l } => (n - 1) * (quads.taxels() - 1 - l) / (quads.taxels() - 1),
        _ => n,
    };
    let rows = (0..n).map(|row| {
        let thresholds = blocks.each_ref().map(|block| match filter {
            MatrixFilter::F2 { p } => block.column(row).amax() / (1000.0 * p),
            _ => 0.0,
        });
        let keeps = |column: usize| match filter {
            MatrixFilter::None => true,
            MatrixFilter::F1 { .. } => row.abs_diff(column) <= distance,
            // A zero is never kept for its own sake: a row that does not exist in a class has nothing but zeros.
            MatrixFilter::F2 { .. } => blocks.iter().zip(thresholds).any(|(block, threshold)| {
                let entry = block[(column, row)].abs();
                entry > 0.0 && entry >= threshold
            }),
        };
        let entry = |column: usize| (column as u32, blocks.each_ref().map(|block| block[(column, row)]));
        let mut kept: Vec<_> = (0..n).filter(|&column| keeps(column)).map(entry).collect();
        if kept.is_empty() && thresholds.iter().all(|&threshold| threshold == 0.0) {
            kept.push(entry(row));
        }
        if kept.is_empty() { Err(FilterError::EmptyFoldedRow { matrix: name, row, filter }) } else { Ok(kept) }
    });
    Ok(FoldedRows { parity: folded.parity, rows: rows.collect::<Result<_, _>>()? })
}
