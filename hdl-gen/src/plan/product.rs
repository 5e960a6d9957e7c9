//! The products of a plan: the steps of its list, bound to what the hardware does with them.

use std::ops::Deref;

pub use golden::parity::mirror;
pub use golden::products::{Coefficients, Epilogue, Step, Vector};

use super::matrix::{Entry, QuantisedMatrix};
use crate::format::{FEWEST_ELEMENTS, round_shift};
use crate::timing::latency::{TAKE_TO_BUS, WRITE_TO_ISSUE, bus_to_taxels, bus_to_write, taxels_to_write};

/// What becomes of a result, as the ROM of write-back slots and the collector (`sptfra_spmv_collector`) have it.
pub fn destination(result: Vector) -> usize {
    match result {
        Vector::Stress | Vector::Weight | Vector::Pull => 0,
        Vector::U(q) => 1 + usize::from(q),
        Vector::Residual(q) => 5 + usize::from(q),
        Vector::Explained => 8,
        Vector::Force(p) => 8 + usize::from(p),
        Vector::Partial(p) => 3 + usize::from(p),
        Vector::G(p, q) => 7 + 3 * usize::from(p - 1) + usize::from(q),
    }
}

/// The destination of sums over the frame.
pub const SUMS_DESTINATION: usize = 4;

/// Bits of a destination in the ROM of write-back slots: the first eight are all there is without a field.
pub const fn destination_bits(field: bool) -> u32 {
    if field { 4 } else { 3 }
}

/// Numbers that a destination can have.
pub const DESTINATIONS: usize = 16;

/// The block that owns the lanes while a product runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// Weights.
    We,
    /// Coefficients.
    Co,
    /// Optimum.
    Op,
}

/// Fewest cycles from taking one result to taking the next: both halves of a separated one are written.
pub fn spacing(epilogue: Epilogue) -> u64 {
    if epilogue == Epilogue::Part { 2 } else { 1 }
}

/// Cycles from taking a result to the first issue that may read the value as an operand.
pub fn take_to_operand(epilogue: Epilogue) -> u64 {
    let after_bus = match epilogue {
        Epilogue::Part => bus_to_taxels(true) + taxels_to_write(true),
        Epilogue::Store | Epilogue::Unfold | Epilogue::AddStress => bus_to_write(true),
        Epilogue::ClipNegate => bus_to_taxels(false) + taxels_to_write(false),
        Epilogue::Keep | Epilogue::Add(_) => bus_to_write(false),
    };
    TAKE_TO_BUS + after_bus + WRITE_TO_ISSUE
}

/// Rows in front of a product's own, whose results are sums over the frame and go to Co.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preload {
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
/// Rows of the sums in front of `K0 y+`, see [`sum_row`].
pub const SUM_ROWS: usize = 7;
const _: () = assert!(SUM_ROWS <= FEWEST_ELEMENTS);
/// The row of what `|w|` takes from `F_z`, `T_x` and `T_y` for q = 0, each in its [`sum_channel`].
pub const SHARE_ROW: usize = 3;

/// The row that holds `G_pq`, p as in [`golden::products::ByPq`]. Row q has those of `F_x`, `F_y`, `F_z` and `T_z`, row
/// 4 + q those of `T_x` and `T_y`. Each has a channel of its own, see [`sum_channel`].
pub fn sum_row(p: usize, q: usize) -> usize {
    if matches!(p, 3 | 4) { 4 + q } else { q }
}

/// The channel in which its row holds `G_pq`: the component of the operand on which the sum depends. `p` from 0.
pub fn sum_channel(p: usize, q: usize) -> usize {
    let of_p = [1, 2, 0, 2, 1, 3];
    let of_q = [0, 1, 2];
    of_p[p] ^ of_q[q]
}

/// A step of the list in hardware; it reads as its step. The stored matrix is one of [`super::Plan::matrices`], and its
/// operands stand next to each other in the operand memory: column `k n + i` is element i of vector k.
#[derive(Clone, Debug)]
pub struct Product {
    /// What it computes.
    pub step: Step,
    /// Rows in front of the matrix, of the same operands.
    pub preload: Option<Preload>,
    /// The block it belongs to.
    pub block: Block,
    /// Its program: products of one program follow each other at fixed distances.
    pub program: usize,
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
    /// Largest magnitude of a rounded result before the epilogue, for operands up to `operand_bound`.
    pub fn result_bound(matrix: &QuantisedMatrix, operand_bound: i64, shift: u32) -> i64 {
        // An accumulator has 48 bits: beyond that, and well within the 64 of this word, nothing is left.
        round_shift(matrix.largest_sum(operand_bound) as i64, shift.min(62))
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
