//! The rows of the sums, in front of `K0 y+`.

use golden::parity::COMPONENTS;
use golden::products::RESULTANTS;
use golden::reduced::ReducedMatrices;

use super::super::PlanError;
use super::super::matrix::{ANY_LSB, QuantisedMatrix, RealRows};
use super::super::product::{SHARE_ROW, SUM_ROWS, sum_channel, sum_row};
use super::bounds::{self, Operand};
use crate::format::{Factors, Format, largest, pow2};

/// The rows of all sums of `y+` and the weights, and their format. Torques are in units of `2^arm_exponent` N m.
pub(super) fn quantise(
    ten: &ReducedMatrices,
    factors: Factors,
    weights: Operand,
    arm_exponent: i32,
) -> Result<(QuantisedMatrix, Format), PlanError> {
    let shares = ten.weight_shares();
    let count = shares[0].weights.len();
    let unit = |p: usize| if p < 3 { 1.0 } else { pow2(-arm_exponent) };
    let mut rows: RealRows = (0..SUM_ROWS)
        .map(|row| {
            // y+ stands first among the operands, |w| next to it.
            let first_column = if matches!(row, 0 | 4) { 0 } else { count };
            (0..count).map(|orbit| ((first_column + orbit) as u32, [0.0; COMPONENTS])).collect()
        })
        .collect();
    let mut put = |row: usize, channel: usize, weights: &[f64], unit: f64| {
        for ((_, channels), weight) in rows[row].iter_mut().zip(weights) {
            channels[channel] = unit * weight;
        }
    };
    for (p, q) in (0..RESULTANTS).flat_map(|p| (0..3).map(move |q| (p, q))) {
        put(sum_row(p, q), sum_channel(p, q), &ten.sums(p, q).weights, unit(p));
    }
    for (p, share) in (2..).zip(shares) {
        put(SHARE_ROW, sum_channel(p, 0), &share.weights, unit(p));
    }
    let matrix = QuantisedMatrix::new("sums", &rows, factors, weights.folded.bound, ANY_LSB)?;
    let term = [(&matrix, weights)];
    let mut format = bounds::finest(term, factors.data_bits, |lsb| bounds::folded(term[0], lsb));
    // G30 is a row's result less the sum of the weights, and so are T_x's and T_y's.
    while 2 * format.bound > largest(format.bits) {
        format.lsb += 1;
        format.bound = format.bound / 2 + 1;
    }
    format.bound *= 2;
    Ok((matrix, format))
}
