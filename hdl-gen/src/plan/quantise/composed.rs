//! Worst case of the forces of deep sensors, through residual and pseudo-inverse together.
//!
//! The bound of `A_p r` from the bound of r alone supposes the worst r for every force. Of a deep sensor that is
//! thousands of times more than any frame can cause: where A+ amplifies, C33, C31 and C32 have damped before. So here
//! the products `A_p C33`, `A_p C31` and `A_p C32` of the stored coefficients are bounded, with what each rounding on
//! the way can add.

use golden::parity::COMPONENTS;
use nalgebra::DMatrix;

use crate::cores::LONG_BITS;

use super::super::matrix::QuantisedMatrix;
use super::super::vector_formats::FOLD_BITS;
use super::LARGEST_FRICTION;
use super::bounds::Operand;
use crate::format::{Format, largest, pow2};

/// Factor for the rounding of sums in f64.
const SLACK: f64 = 1.0 + 1e-9;

/// The vectors between weights and forces.
#[derive(Clone, Copy)]
pub(super) struct Path {
    pub weights: Operand,
    pub residual: Format,
    pub explained: Format,
}

/// Largest magnitudes, in newtons.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worst {
    /// Of a folded force.
    folded: f64,
    /// Of four times a taxel's force: the sum over the components.
    unfolded: f64,
    /// Of a taxel's force, the part that the roundings on the way to it can make.
    pub rounding: f64,
}

/// The worst case of `A_p (C33 y+ + mu_x C31 |w| + mu_y C32 |w|)`, all p, for matrices as stored.
pub(super) fn worst(c: &[QuantisedMatrix], a: &[QuantisedMatrix], path: Path) -> Worst {
    let count = c.first().map_or(0, |matrix| matrix.rows.len());
    let steep = LARGEST_FRICTION as f64;
    let friction = [1.0, steep, steep];
    // What the lanes drop of the products: of the parts of r, and of r, of three of them.
    let of_parts: f64 = c.iter().zip(friction).map(|(matrix, by)| by * dropped(matrix, path.weights.folded)).sum();
    let in_parts = if of_parts > 0.0 { of_parts + path.residual.step() } else { 0.0 };
    let c: Vec<[DMatrix<f64>; COMPONENTS]> = c.iter().map(|matrix| blocks(matrix, count)).collect();
    // |w| and y+ are rounded as they are folded, the parts of r as they are stored, and r again.
    let folding: f64 = c.iter().zip(friction).map(|(blocks, by)| by * row_sum(blocks)).sum();
    let rounding = 0.5
        * (folding * path.weights.folded.step()
            + friction.iter().sum::<f64>() * path.residual.step()
            + path.explained.step())
        + in_parts;
    let of_component = |stored: &QuantisedMatrix| {
        let a = blocks(stored, count);
        let mut exact = [DMatrix::zeros(count, 1), DMatrix::zeros(count, 1)];
        for ((parity, c), by) in c.iter().enumerate().zip(friction) {
            let product: [DMatrix<f64>; COMPONENTS] =
                std::array::from_fn(|component| &a[component ^ parity] * &c[component]);
            let [folded, unfolded] = sums(&product);
            exact[0] += by * path.weights.folded.bound as f64 * path.weights.folded.step() * folded;
            exact[1] += by * path.weights.taxel.bound as f64 * path.weights.taxel.step() * unfolded;
        }
        let rounded = row_sum(&a) * rounding + dropped(stored, path.explained);
        Worst {
            folded: exact[0].max() + rounded,
            unfolded: exact[1].max() + COMPONENTS as f64 * rounded,
            rounding: rounded,
        }
    };
    let all: Vec<Worst> = a.iter().map(of_component).collect();
    let most = |value: fn(&Worst) -> f64| all.iter().map(value).fold(0.0, f64::max) * SLACK;
    Worst {
        folded: most(|worst| worst.folded),
        unfolded: most(|worst| worst.unfolded),
        rounding: most(|worst| worst.rounding),
    }
}

/// The finest format for these results, which are unfolded afterwards, of products with a last bit worth `2^lsb`.
pub(super) fn format(worst: Worst, mut lsb: i32, bits: u32) -> Format {
    // Rounding of a result, and of the four of a taxel.
    let bound = |lsb: i32| {
        let steps = |value: f64, more: f64| (value / f64::from(lsb).exp2()).ceil() + more;
        steps(worst.folded, 1.0).max(steps(worst.unfolded, COMPONENTS as f64))
    };
    while bound(lsb) > largest(bits) as f64 {
        lsb += 1;
    }
    Format { bits, lsb, bound: bound(lsb) as i64 }
}

/// Whether a taxel's force at full scale, in newtons, has fewer steps in this folded format than a good sensor can use; in
/// words of two multipliers, fewer by their more bits than that.
pub(super) fn is_coarse(folded: Format, taxel_n: f64) -> bool {
    let enough = pow2(16 + folded.bits.saturating_sub(LONG_BITS) as i32);
    Format { lsb: folded.lsb - FOLD_BITS as i32, ..folded }.step() * enough > taxel_n
}

/// The blocks of a matrix by component of the operand, in its unit.
fn blocks(matrix: &QuantisedMatrix, count: usize) -> [DMatrix<f64>; COMPONENTS] {
    let step = f64::from(matrix.lsb).exp2();
    std::array::from_fn(|component| {
        let mut block = DMatrix::zeros(count, count);
        for (row, entries) in matrix.rows.iter().enumerate() {
            for &(column, channels) in entries {
                block[(row, column as usize)] = f64::from(channels[component]) * step;
            }
        }
        block
    })
}

/// Most that the dropped bits of a row's products add up to.
fn dropped(matrix: &QuantisedMatrix, operand: Format) -> f64 {
    matrix.dropped_steps() as f64 * f64::from(matrix.accumulator_lsb(operand)).exp2()
}

/// Largest sum of magnitudes of a row of any block.
fn row_sum(blocks: &[DMatrix<f64>; COMPONENTS]) -> f64 {
    let rows = |block: &DMatrix<f64>| block.row_iter().map(|row| row.lp_norm(1)).fold(0.0, f64::max);
    blocks.iter().map(rows).fold(0.0, f64::max)
}

/// For each row of orbits the largest sum of magnitudes of a block, and that of the unfolded matrix times four.
fn sums(blocks: &[DMatrix<f64>; COMPONENTS]) -> [DMatrix<f64>; 2] {
    let count = blocks[0].nrows();
    let folded =
        DMatrix::from_fn(count, 1, |row, _| blocks.iter().map(|block| block.row(row).lp_norm(1)).fold(0.0, f64::max));
    let unfolded = DMatrix::from_fn(count, 1, |row, _| {
        let of = |image: usize| {
            let signed = |column: usize| -> f64 {
                blocks
                    .iter()
                    .enumerate()
                    .map(|(component, block)| golden::parity::sign(component, image) * block[(row, column)])
                    .sum()
            };
            (0..count).map(|column| signed(column).abs()).sum::<f64>()
        };
        (0..COMPONENTS).map(of).sum()
    });
    [folded, unfolded]
}
