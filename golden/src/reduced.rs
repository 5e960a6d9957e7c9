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
//! and for the line and the resultants the sums `G_pq` and those of the torques, which are dot products. All this is the
//! paper's mathematics (Eqs. 8 to 16) put together otherwise: without a filter the results are the same but for rounding.

use nalgebra::{DMatrix, RowDVector};

use crate::design::{Filter, MatrixFilter};
use crate::filter::FilterError;
use crate::float::Float;
use crate::matrices::Matrices;
use crate::names::MatrixName;
pub use crate::names::ReducedName;
use crate::parity::{COMPONENTS, FoldedMatrix, Orbits};
use crate::sums::{ByPq, RESULTANTS};

/// The four blocks of a matrix, sparse, row by row.
///
/// All components keep the same entries, so that one column number serves four coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct FoldedRows {
    /// Its mirror symmetry, as in [`FoldedMatrix`].
    pub parity: usize,
    /// For each orbit its entries, columns ascending: the orbit multiplied, and a coefficient for each component of the
    /// operand. No row is empty.
    pub rows: Vec<Vec<(u32, [f64; COMPONENTS])>>,
}

impl FoldedRows {
    /// The product with a folded vector, the four components of each element together.
    pub fn times<T: Float>(&self, x: &[[T; COMPONENTS]], result: &mut [[T; COMPONENTS]]) {
        for (row, result) in self.rows.iter().zip(result) {
            let mut sums = [T::default(); COMPONENTS];
            for (column, [a, b, c, d]) in row {
                let x = &x[*column as usize];
                sums[0] = sums[0] + T::of(*a) * x[0];
                sums[1] = sums[1] + T::of(*b) * x[1];
                sums[2] = sums[2] + T::of(*c) * x[2];
                sums[3] = sums[3] + T::of(*d) * x[3];
            }
            *result = [0, 1, 2, 3].map(|component| sums[component ^ self.parity]);
        }
    }
}

impl From<&FoldedMatrix> for FoldedRows {
    /// All entries, unfiltered.
    fn from(folded: &FoldedMatrix) -> Self {
        let n = folded.orbits.count();
        let entry = |row, column: usize| (column as u32, folded.blocks.each_ref().map(|block| block[(row, column)]));
        Self {
            parity: folded.parity,
            rows: (0..n).map(|row| (0..n).map(|column| entry(row, column)).collect()).collect(),
        }
    }
}

/// A sum over all taxels as a dot product: `sum_q weights[q] * operand[component][q]` of a folded operand.
#[derive(Clone, Debug, PartialEq)]
pub struct SumRow {
    /// The component that has the sum in it; the others add up to zero.
    pub component: usize,
    /// One weight for each orbit.
    pub weights: Vec<f64>,
}

impl SumRow {
    /// The row of this sum and another one of the same component.
    fn plus(mut self, other: &Self) -> Self {
        self.weights.iter_mut().zip(&other.weights).for_each(|(weight, other)| *weight += other);
        self
    }
}

/// The rows of all sums of a frame, see [`ReducedMatrices::sums`] and [`ReducedMatrices::weight_shares`].
#[derive(Clone, Debug)]
pub(crate) struct SumRows {
    /// By `[p][q]`.
    pub(crate) rows: ByPq<SumRow>,
    pub(crate) shares: [SumRow; 3],
}

impl SumRows {
    /// Each resultant is a sum over the taxels of their forces times an arm: one, x or y from the middle of the grid, or
    /// minus that.
    fn new(matrices: &Matrices, orbits: &Orbits, a: [&FoldedMatrix; 3]) -> Self {
        let sensor = matrices.sensor();
        let over = |component: usize, arm: &dyn Fn(usize) -> f64| {
            let of_orbit = |q: usize| orbits.size(q) as f64 / 4.0 * arm(orbits.images(q)[0]);
            let weights = (0..orbits.count()).map(|q| if orbits.exists(component, q) { of_orbit(q) } else { 0.0 });
            SumRow { component, weights: weights.collect() }
        };
        let one = over(0, &|_| 1.0);
        let [x, minus_x] = [1.0, -1.0].map(|sign| over(1, &|taxel| sign * sensor.arm_m(taxel)[0]));
        let [y, minus_y] = [1.0, -1.0].map(|sign| over(2, &|taxel| sign * sensor.arm_m(taxel)[1]));
        // The arms of f_x, f_y and f_z in each resultant.
        let arms: [[Option<&SumRow>; 3]; RESULTANTS] = [
            [Some(&one), None, None],
            [None, Some(&one), None],
            [None, None, Some(&one)],
            [None, None, Some(&y)],
            [None, None, Some(&minus_x)],
            [Some(&minus_y), Some(&x), None],
        ];
        let row = |p: usize, q: usize| {
            let c = [&matrices.c33, &matrices.c31, &matrices.c32][q];
            let mut parts = arms[p].iter().zip(a).filter_map(|(arm, a)| arm.map(|arm| sum_row(&sum_row(arm, a), c)));
            // Every resultant has a part, and all parts of one are of one component.
            let first = parts.next().unwrap_or_else(|| SumRow { component: 0, weights: vec![0.0; orbits.count()] });
            let mut row = parts.fold(first, |row, part| row.plus(&part));
            if q > 0 {
                row.weights.iter_mut().for_each(|weight| *weight = -*weight);
                // mu_x |w| and mu_y |w| themselves.
                if let Some(arm) = arms[p][q - 1] {
                    row = row.plus(arm);
                }
            }
            row
        };
        Self {
            rows: std::array::from_fn(|p| std::array::from_fn(|q| row(p, q))),
            shares: [one.clone(), y.clone(), minus_x.clone()],
        }
    }
}

/// The ten matrices of the reduced plan after the filter, and the rows of its sums.
///
/// **What a filter means here.** It is applied to the folded blocks, whose rows and columns are orbits. F2 with p keeps
/// of every row of every block the entries with `|B_ij| >= max_j |B_ij| / (1000 p)` (by magnitude: a folded row has no
/// sign of its own). F1 with l keeps `|i - j| <= (n - 1) (1 - l / (m - 1))`, rounded down: the same share of the
/// diagonals as of the whole matrix. An entry that one component keeps is kept for all four. The sums are never
/// filtered.
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
    /// [`FilterError`] for F3, whose choices are for the thirteen matrices of the paper,
    /// or when a row loses every entry.
    pub fn new(matrices: &Matrices, orbits: &Orbits, filter: &Filter) -> Result<Self, FilterError> {
        let rule = match filter {
            Filter::None => MatrixFilter::None,
            Filter::F1 { l } => MatrixFilter::F1 { l: *l },
            Filter::F2 { p } => MatrixFilter::F2 { p: *p },
            Filter::F3 { .. } => {
                return Err(FilterError(
                    "the filter f3 chooses for each matrix of the paper, and the reduced plan has other matrices; write \
                     plan = \"paper\" under [algorithm], or another filter"
                        .to_owned(),
                ));
            }
        };
        let Matrices { c31, c32, c33, .. } = matrices;
        let a = [MatrixName::A1, MatrixName::A2, MatrixName::A3].map(|name| matrices.folded(name));

        let sums = SumRows::new(matrices, orbits, a.each_ref().map(AsRef::as_ref));
        let e = c33.times(&a[2]);
        let sparse = |name: ReducedName, folded: &FoldedMatrix| filtered(name, folded, orbits, rule);
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
        Ok(Self { ten, sums })
    }

    /// One of the ten matrices.
    pub fn get(&self, name: ReducedName) -> &FoldedRows {
        &self.ten[name.index()]
    }

    /// The row of `G_(p+1)q`, q from 0 to 2 and p from 0 to 5 as in [`ByPq`]. Its operand is the folded y+ for q = 0 and
    /// the folded |w| for q = 1 and 2. What |w| adds for q = 1 and 2 is included, what it adds to `f_z` is not: see
    /// [`ReducedMatrices::weight_shares`].
    pub fn sums(&self, p: usize, q: usize) -> &SumRow {
        &self.sums.rows[p][q]
    }

    /// What the folded |w| takes from `F_z`, `T_x` and `T_y` for q = 0: rows of the sums of |w|, `y |w|` and `-x |w|`.
    pub fn weight_shares(&self) -> &[SumRow; 3] {
        &self.sums.shares
    }

    /// Those of all sums.
    pub(crate) fn sum_rows(&self) -> &SumRows {
        &self.sums
    }

    /// Number of coefficients stored: four for each entry that any component keeps.
    pub fn nnz(&self, name: ReducedName) -> usize {
        COMPONENTS * self.get(name).rows.iter().map(Vec::len).sum::<usize>()
    }
}

/// The row of the sum of `M x` for a row that sums `M x` from what M makes of x.
fn sum_row(over_result: &SumRow, matrix: &FoldedMatrix) -> SumRow {
    let component = over_result.component ^ matrix.parity;
    let row = RowDVector::from_row_slice(&over_result.weights) * &matrix.blocks[component];
    SumRow { component, weights: row.as_slice().to_vec() }
}

fn filtered(
    name: ReducedName,
    folded: &FoldedMatrix,
    orbits: &Orbits,
    filter: MatrixFilter,
) -> Result<FoldedRows, FilterError> {
    let n = orbits.count();
    // Row by row below, and the entries of a column are neighbours in memory.
    let blocks = folded.blocks.each_ref().map(DMatrix::transpose);
    let distance = match filter {
        // l is at most m - 2, so that the diagonal always stays.
        MatrixFilter::F1 { l } => (n - 1) * (orbits.taxels() - 1 - l) / (orbits.taxels() - 1),
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
            // A zero is never kept for its own sake: a row that does not exist in a component has nothing but zeros.
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
        let empty = || FilterError::empty_row(&format!("the folded matrix {name}"), row, filter);
        if kept.is_empty() { Err(empty()) } else { Ok(kept) }
    });
    Ok(FoldedRows { parity: folded.parity, rows: rows.collect::<Result<_, _>>()? })
}
