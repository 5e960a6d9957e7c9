//! Worst cases of products, and the finest formats that hold them.

use golden::parity::COMPONENTS;

use super::super::matrix::QuantisedMatrix;
use super::super::product::Product;
use super::super::vector_formats::FOLD_BITS;
use crate::format::{Format, largest};

/// An operand: its format, folded if the list is, and that of the taxels' values it is folded from.
#[derive(Clone, Copy)]
pub(super) struct Operand {
    pub folded: Format,
    pub taxel: Format,
}

/// A matrix and what it multiplies.
pub(super) type Term<'a> = (&'a QuantisedMatrix, Operand);

/// The finest format of `bits` bits for results of these terms, whose worst case at a step of `2^lsb` is `bound`.
pub(super) fn finest<'a>(terms: impl IntoIterator<Item = Term<'a>>, bits: u32, bound: impl Fn(i32) -> i64) -> Format {
    let accumulators = terms.into_iter().map(|(matrix, operand)| matrix.accumulator_lsb(operand.folded));
    let mut lsb = accumulators.max().unwrap_or(0);
    while bound(lsb) > largest(bits) {
        lsb += 1;
    }
    Format { bits, lsb, bound: bound(lsb) }
}

/// `value * 2^(from - to)`, rounded up.
fn scaled(value: i128, from: i32, to: i32) -> i128 {
    if to <= from { value << (from - to).min(60) } else { (value >> (to - from).min(100)) + 1 }
}

/// Largest result of the lanes at a step of `2^lsb`.
pub(super) fn folded((matrix, operand): Term, lsb: i32) -> i64 {
    let shift = (lsb - matrix.accumulator_lsb(operand.folded)) as u32;
    Product::result_bound(matrix, operand.folded.bound, shift)
}

/// Largest sum of four such results, as unfolding makes it: no larger than the taxels' operands allow, and what the
/// rounding of operands and results adds.
pub(super) fn unfolded((matrix, operand): Term, lsb: i32) -> i64 {
    let product_lsb = matrix.lsb + operand.folded.lsb;
    let exact = i128::from(matrix.unfolded_row_sum()) * i128::from(operand.taxel.bound);
    let of_operand = i128::from(matrix.row_sum) * COMPONENTS as i128 / 2;
    let sum = scaled(exact, matrix.lsb + operand.taxel.lsb, lsb) + scaled(of_operand, product_lsb, lsb);
    let dropped = match i128::from(matrix.dropped_steps()) * COMPONENTS as i128 {
        0 => 0,
        steps => scaled(steps, matrix.accumulator_lsb(operand.folded), lsb),
    };
    narrowed(sum + dropped + COMPONENTS as i128)
}

/// What a folded operand adds to results, folded and unfolded, at a step of `2^lsb`.
pub(super) fn added(operand: Operand, lsb: i32) -> i64 {
    let bound = i128::from(operand.taxel.bound) << FOLD_BITS;
    narrowed(scaled(bound, operand.taxel.lsb, lsb) + 1) + 4
}

/// A bound as a word; one that fits no format at all stays one that does not, also in a sum.
fn narrowed(bound: i128) -> i64 {
    i64::try_from(bound).unwrap_or(i64::MAX).min(i64::MAX / 4)
}
