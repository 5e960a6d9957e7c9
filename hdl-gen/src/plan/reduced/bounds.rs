//! Worst cases of folded products, and the formats that hold them.

use golden::parity::CLASSES;

use super::super::format::{Format, largest};
use super::super::product::Product;
use super::super::quantise::QuantisedMatrix;
use super::FOLD_BITS;

/// An operand: its folded format and that of the taxels' values it is folded from.
#[derive(Clone, Copy)]
pub(super) struct Operand {
    pub folded: Format,
    pub taxel: Format,
}

/// The finest format for results that are unfolded afterwards: the folded ones and the sums of four both fit, with
/// the stress added if it is.
pub(super) fn unfolding(terms: &[(&QuantisedMatrix, Operand)], added: Option<Operand>, bits: u32) -> Format {
    finest(terms, bits, |lsb| {
        let folded = terms.iter().map(|term| folded_bound(term, lsb)).max().unwrap_or(0);
        let unfolded = terms.iter().map(|term| unfolded_bound(term, lsb)).max().unwrap_or(0);
        let more = added.map_or(0, |operand| {
            let bound = i128::from(operand.taxel.bound) << FOLD_BITS;
            narrowed(scaled(bound, operand.taxel.lsb, lsb) + 1) + 4
        });
        folded.max(unfolded) + more
    })
}

/// The finest format for results that stay folded.
pub(super) fn folded(terms: &[(&QuantisedMatrix, Operand)], bits: u32) -> Format {
    finest(terms, bits, |lsb| terms.iter().map(|term| folded_bound(term, lsb)).max().unwrap_or(0))
}

fn finest(terms: &[(&QuantisedMatrix, Operand)], bits: u32, bound: impl Fn(i32) -> i64) -> Format {
    let mut lsb = terms.iter().map(|(matrix, operand)| matrix.lsb + operand.folded.lsb).max().unwrap_or(0);
    while bound(lsb) > largest(bits) {
        lsb += 1;
    }
    Format { bits, lsb, bound: bound(lsb) }
}

/// Terms that share an operand.
pub(super) fn with(matrices: &[QuantisedMatrix], operand: Operand) -> Vec<(&QuantisedMatrix, Operand)> {
    matrices.iter().map(|matrix| (matrix, operand)).collect()
}

/// `value * 2^(from - to)`, rounded up.
fn scaled(value: i128, from: i32, to: i32) -> i128 {
    if to <= from { value << (from - to).min(60) } else { (value >> (to - from).min(100)) + 1 }
}

/// Largest result of the lanes at a step of `2^lsb`.
fn folded_bound(&(matrix, operand): &(&QuantisedMatrix, Operand), lsb: i32) -> i64 {
    let shift = (lsb - matrix.lsb - operand.folded.lsb) as u32;
    Product::result_bound(matrix, operand.folded.bound, shift)
}

/// Largest sum of four such results, as unfolding makes it: no larger than the taxels' operands allow, and what the
/// rounding of operands and results adds.
pub(super) fn unfolded_bound(&(matrix, operand): &(&QuantisedMatrix, Operand), lsb: i32) -> i64 {
    let accumulator_lsb = matrix.lsb + operand.folded.lsb;
    let exact = i128::from(matrix.unfolded_row_sum()) * i128::from(operand.taxel.bound);
    let of_operand = i128::from(matrix.row_sum) * CLASSES as i128 / 2;
    let sum = scaled(exact, matrix.lsb + operand.taxel.lsb, lsb) + scaled(of_operand, accumulator_lsb, lsb);
    narrowed(sum + CLASSES as i128)
}

/// A bound as a word; one that fits no format at all stays one that does not, also in a sum.
fn narrowed(bound: i128) -> i64 {
    i64::try_from(bound).unwrap_or(i64::MAX).min(i64::MAX / 4)
}
