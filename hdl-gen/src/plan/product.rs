//! The products of a plan: the steps of its list, bound to what the hardware does with them.

use std::ops::Deref;

use golden::parity::CLASSES;
pub use golden::products::{Coefficients, Epilogue, Step, Vector, mirror, swapped};
use serde::Serialize;

use super::format::round_shift;
use super::matrix::{Entry, QuantisedMatrix};

/// The block that owns the lanes while a product runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Block {
    /// Weights.
    We,
    /// Coefficients.
    Co,
    /// Optimum.
    Op,
}

/// Fewest cycles from taking one result to taking the next: both halves of a parted one are written.
pub fn spacing(epilogue: Epilogue) -> u64 {
    if epilogue == Epilogue::Part { 2 } else { 1 }
}

/// Cycles from the collector's visit to the first issue that may read the value as an operand.
pub fn visit_to_operand(epilogue: Epilogue) -> u64 {
    match epilogue {
        Epilogue::Part => PARTED_VISIT_TO_OPERAND,
        Epilogue::Store => STORED_VISIT_TO_OPERAND,
        Epilogue::ClipNegate | Epilogue::Keep | Epilogue::Add(_) | Epilogue::Unfold | Epilogue::AddStress => {
            VISIT_TO_OPERAND
        }
    }
}

/// Cycles from a collector visit to the first issue that may read the value as an operand.
pub const VISIT_TO_OPERAND: u64 = 6;
/// The same where results are written as they come.
const STORED_VISIT_TO_OPERAND: u64 = 4;
/// The same where they are unfolded, parted and folded again; the second half is a cycle later than the first.
const PARTED_VISIT_TO_OPERAND: u64 = 13;

/// Rows in front of a product's own, whose results are sums over the frame and go to Co.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Lead {
    /// Index of the stored matrix.
    pub matrix: usize,
    /// Bits dropped, with rounding, between accumulator and result.
    pub shift: u32,
}

/// Coefficient codes of the friction products: one, `mu_x`, `mu_y`.
pub const SELECT_ONE: i32 = 0;
/// See [`SELECT_ONE`].
pub const SELECT_MU_X: i32 = 1;
/// See [`SELECT_ONE`].
pub const SELECT_MU_Y: i32 = 2;
/// Rows of the sums in front of `K0 y+`: `G_p0`, `G_p1`, `G_p2`, `sum |w|`. The first three have a p in each of three
/// ways, see [`sum_way`].
pub const SUM_ROWS: usize = 4;

/// The way in which sum row `q` holds `G_pq`: the class of the operand on which the sum depends. `p` from 0.
pub fn sum_way(p: usize, q: usize) -> usize {
    let of_p = [1, 2, 0];
    let of_q = [0, 1, 2];
    of_p[p] ^ of_q[q]
}

/// A step of the list in hardware; it reads as its step. The stored matrix is one of [`super::Plan::matrices`], and its
/// operands stand next to each other in the operand memory: column `k n + i` is element i of vector k.
#[derive(Clone, Debug, Serialize)]
pub struct Product {
    /// What it computes.
    pub step: Step,
    /// Rows in front of the matrix, of the same operands.
    pub lead: Option<Lead>,
    /// The block it belongs to.
    pub block: Block,
    /// Its program: products of one program follow each other at fixed distances.
    pub program: usize,
    /// Zeros of the operand cost nothing: the lanes pass over its quads that are zero, see [`super::schedule::Rounds`].
    pub skips: bool,
    /// Bits dropped, with rounding, between accumulator and result.
    pub shift: u32,
}

impl Deref for Product {
    type Target = Step;

    fn deref(&self) -> &Step {
        &self.step
    }
}

impl Product {
    /// Whether the lanes pass from this product's block to that of `next` by a start pulse: so in the paper's plan; in
    /// the reduced plan a program runs through.
    pub fn hands_over_to(&self, next: &Self) -> bool {
        self.block != next.block && self.epilogue != Epilogue::Part
    }

    /// Largest magnitude of a rounded result before the epilogue, for operands up to `operand_bound`.
    pub fn result_bound(matrix: &QuantisedMatrix, operand_bound: i64, shift: u32) -> i64 {
        // An accumulator has 48 bits: beyond that, and well within the 64 of this word, nothing is left.
        round_shift(matrix.row_sum * operand_bound, shift.min(62))
    }

    /// For each class of the result, the way of the lanes that computes it.
    pub fn ways(&self) -> [usize; CLASSES] {
        std::array::from_fn(|class| if self.mirrored.is_some() { swapped(class) } else { class } ^ self.parity)
    }

    /// Gives the rows of the stored matrix the numbers that their results have.
    pub(super) fn relabel(&self, rows: &mut [(u32, &[Entry])]) {
        if let Some(side) = self.mirrored {
            for (row, _) in rows {
                *row = mirror(*row as usize, side) as u32;
            }
        }
    }
}
