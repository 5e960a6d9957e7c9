//! The rows of the sums, in front of `K0 y+`.

use golden::parity::CLASSES;
use golden::reduced::ReducedMatrices;

use super::super::PlanError;
use super::super::format::{Format, largest};
use super::super::matrix::{ANY_LSB, QuantisedMatrix, RealRows};
use super::super::product::sum_way;
use super::bounds::{self, Operand};

/// The rows of all sums of `y+` and the weights, and their format.
pub(super) fn quantise(
    ten: &ReducedMatrices,
    coefficient_bits: u32,
    data_bits: u32,
    weights: Operand,
) -> Result<(QuantisedMatrix, Format), PlanError> {
    let total = &ten.weight_sum().weights;
    let count = total.len();
    let row = |q: usize| {
        // y+ stands first among the operands, |w| next to it.
        let first_column = if q == 0 { 0 } else { count };
        let ways = |quad: usize| {
            let mut ways = [0.0; CLASSES];
            for p in 0..3 {
                ways[sum_way(p, q)] = ten.sums(p, q).weights[quad];
            }
            ways
        };
        (0..count).map(|quad| ((first_column + quad) as u32, ways(quad))).collect::<Vec<_>>()
    };
    let total = total.iter().enumerate().map(|(quad, &one)| ((count + quad) as u32, [one, 0.0, 0.0, 0.0]));
    let rows: RealRows = (0..3).map(row).chain([total.collect()]).collect();
    let matrix = QuantisedMatrix::new("sums", &rows, coefficient_bits, weights.folded.bound, ANY_LSB)?;
    let term = [(&matrix, weights)];
    let mut format = bounds::finest(term, data_bits, |lsb| bounds::folded(term[0], lsb));
    // G30 is a row's result less the sum of the weights.
    while 2 * format.bound > largest(format.bits) {
        format.lsb += 1;
        format.bound = format.bound / 2 + 1;
    }
    format.bound *= 2;
    Ok((matrix, format))
}
