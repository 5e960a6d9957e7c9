//! A frame by the paper's plan, without memory of its own: the stages [`super::we`], [`super::co`] and [`super::op`] on
//! vectors that are used again.

use nalgebra_sparse::CsrMatrix;

use super::Solution;
use super::cean::Contact;
use super::fours::{Fours, Members, times};
use crate::estimators::{Friction, FrictionScratch, Seen};
use crate::filter::FilteredMatrices;
use crate::matrices::{Matrices, MatrixName as Name};
use crate::parity::CLASSES;
use crate::reduced::FoldedRows;

/// Everything of the paper's plan that stays the same from frame to frame.
#[derive(Clone, Debug)]
pub(super) struct Paper {
    pub(super) filtered: FilteredMatrices,
    /// C33, which no filter touches, needs no more than its blocks.
    c33: FoldedRows,
    members: Members,
}

/// Memory of a frame.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    /// `w_z` and its magnitude.
    w: Vec<f64>,
    magnitude: Vec<f64>,
    /// `g_pq` at `[p - 1][q]`, their sums `G_pq`, and `u_q`.
    g: [[Vec<f64>; 3]; 3],
    pub(super) sums: [[f64; 3]; 3],
    pub(super) u: [Vec<f64>; 3],
    folded: Fours,
    product: Fours,
    pub(super) friction: FrictionScratch,
}

impl Paper {
    pub(super) fn new(matrices: &Matrices, filtered: FilteredMatrices) -> Self {
        Self { filtered, c33: FoldedRows::from(&matrices.c33), members: Members::new(matrices.quads()) }
    }

    pub(super) fn scratch(&self, taxels: usize) -> Scratch {
        let vector = || vec![0.0; taxels];
        let three = || std::array::from_fn(|_| vector());
        let fours = || vec![[0.0; CLASSES]; self.members.quads()];
        Scratch {
            w: vector(),
            magnitude: vector(),
            g: std::array::from_fn(|_| three()),
            sums: [[0.0; 3]; 3],
            u: three(),
            folded: fours(),
            product: fours(),
            friction: FrictionScratch::default(),
        }
    }

    /// Finds the forces for the stress `b` (pascals, length m).
    pub(super) fn solve(
        &self,
        friction: &Friction,
        b: &[f64],
        contact: Contact,
        scratch: &mut Scratch,
        solution: &mut Solution,
    ) {
        self.coefficients(b, scratch);
        let Scratch { g, sums, u, .. } = scratch;
        let seen = Seen { b, contact, sums, u: u.each_ref().map(Vec::as_slice) };
        let (status, mu) = friction.find(&seen, &mut scratch.friction);
        solution.status.insert(status);
        for ([g0, g1, g2], field) in g.iter().zip(&mut solution.field) {
            for (taxel, force) in field.iter_mut().enumerate() {
                *force = g0[taxel] + mu[0] * g1[taxel] + mu[1] * g2[taxel];
            }
        }
        solution.put_friction(mu, solution.field.each_ref().map(|component| component.iter().sum()));
    }

    /// Finds the coefficients `g_pq`, their sums, and `u_q`.
    pub(super) fn coefficients(&self, b: &[f64], scratch: &mut Scratch) {
        let Scratch { w, magnitude, g, sums, u, folded, product, .. } = scratch;
        w.fill(0.0);
        add_product(self.filtered.get(Name::C33inv), b, w);
        for (w, magnitude) in w.iter_mut().zip(&mut *magnitude) {
            *w = w.min(0.0);
            *magnitude = -*w;
        }
        // What stands in g_pq besides products.
        for (p, g) in g.iter_mut().enumerate() {
            for (q, g) in g.iter_mut().enumerate() {
                match (p, q) {
                    (0, 1) | (1, 2) => g.copy_from_slice(magnitude),
                    (2, 0) => g.copy_from_slice(w),
                    _ => g.fill(0.0),
                }
            }
        }
        let of_stress = [Name::A1, Name::A2, Name::A3];
        let of_weights =
            [[Name::D10, Name::D11, Name::D12], [Name::D20, Name::D21, Name::D22], [Name::D30, Name::D31, Name::D32]];
        for p in 0..3 {
            add_product(self.filtered.get(of_stress[p]), b, &mut g[p][0]);
            for q in 0..3 {
                add_product(self.filtered.get(of_weights[p][q]), if q == 0 { w } else { magnitude }, &mut g[p][q]);
            }
        }
        for (g, u) in g[2].iter().zip(&mut *u) {
            for (q, folded) in folded.iter_mut().enumerate() {
                *folded = self.members.fold(g, q);
            }
            times(&self.c33, folded, product);
            self.members.unfold(|q| product[q], |_, _, taxel, stress| u[taxel] = stress);
        }
        *sums = g.each_ref().map(|g| g.each_ref().map(|g| g.iter().sum()));
    }
}

/// Adds the product of a sparse matrix with a vector.
fn add_product(matrix: &CsrMatrix<f64>, x: &[f64], result: &mut [f64]) {
    let (offsets, columns, values) = matrix.csr_data();
    for (row, result) in offsets.windows(2).zip(result) {
        let entries = row[0]..row[1];
        let (columns, columns_left) = columns[entries.clone()].as_chunks::<4>();
        let (values, values_left) = values[entries].as_chunks::<4>();
        // Four sums at a time: one alone would wait for each addition before it could begin the next.
        let mut sums = [0.0; 4];
        for (&[i, j, k, l], &[a, b, c, d]) in columns.iter().zip(values) {
            sums[0] += a * x[i];
            sums[1] += b * x[j];
            sums[2] += c * x[k];
            sums[3] += d * x[l];
        }
        let left: f64 = columns_left.iter().zip(values_left).map(|(&column, value)| value * x[column]).sum();
        *result += (sums[0] + sums[1]) + (sums[2] + sums[3]) + left;
    }
}
