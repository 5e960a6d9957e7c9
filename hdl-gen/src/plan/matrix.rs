//! Coefficients as integers: one power-of-two scale per matrix.

use golden::parity::{COMPONENTS, mirror, swapped};
use nalgebra_sparse::CsrMatrix;

use super::PlanError;
use crate::format::{ACCUMULATOR_LIMIT, Factors, Format, largest, pow2};

/// As [`QuantisedMatrix::new`] takes it where the matrix alone decides; its reciprocal is still a normal f64.
pub const ANY_LSB: i32 = -900;
/// Coefficients with fewer significant bits than this reconstruct nothing worth having.
const FEWEST_USEFUL_BITS: u32 = 6;

/// A column and its coefficients, one a channel. The paper's plan has one channel; in the reduced plan the four channels
/// are the parity components of the operand.
pub type Entry = (u32, [i32; COMPONENTS]);

/// Rows of real coefficients, before they are quantised; the same shape as [`QuantisedMatrix::rows`].
pub type RealRows = Vec<Vec<(u32, [f64; COMPONENTS])>>;

/// A sparse matrix with integer coefficients, `value = coefficient * 2^lsb`, rows in order, columns ascending.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuantisedMatrix {
    /// Name of the matrix as stored, for instance `A1` or `-(I + D30)`.
    pub name: String,
    /// Per row, the `(column, coefficients)` pairs of the MCSR form. No row is empty.
    pub rows: Vec<Vec<Entry>>,
    /// Exponent of a coefficient's last bit.
    pub lsb: i32,
    /// Largest row sum of coefficient magnitudes, of any channel.
    pub row_sum: i64,
    /// Bits of each product that the lanes drop before they add it.
    pub dropped: u32,
}

/// What the accumulator adds: a coefficient times a value, less its dropped bits, to the nearest integer and upwards from
/// between two.
pub const fn product(coefficient: i32, value: i64, dropped: u32) -> i64 {
    if dropped == 0 {
        return coefficient as i64 * value;
    }
    ((coefficient as i128 * value as i128 + (1 << (dropped - 1))) >> dropped) as i64
}

/// The one channel of the paper's plan, times `factor`.
pub fn one_channel(matrix: &CsrMatrix<f64>, factor: f64) -> RealRows {
    let row = |row: nalgebra_sparse::csr::CsrRow<f64>| {
        let entries = row.col_indices().iter().zip(row.values());
        entries.map(|(&column, &value)| (column as u32, [factor * value, 0.0, 0.0, 0.0])).collect()
    };
    matrix.row_iter().map(row).collect()
}

impl QuantisedMatrix {
    /// Rounds `matrix` to `bits`-bit coefficients, as finely as both the coefficient width and the 48-bit
    /// accumulator allow for operands of magnitude up to `operand_bound`, but with a last bit worth `2^least_lsb`
    /// or more.
    ///
    /// # Errors
    /// [`PlanError::Key`] when the accumulator leaves the coefficients less than six bits.
    pub fn new(
        name: &str,
        matrix: &RealRows,
        factors: Factors,
        operand_bound: i64,
        least_lsb: i32,
    ) -> Result<Self, PlanError> {
        let bits = factors.coefficient_bits;
        let values = || matrix.iter().flatten().flat_map(|(_, values)| values);
        let largest_entry = values().fold(0.0_f64, |top, value| top.max(value.abs()));
        let top = largest(bits);
        // A filter may leave nothing but zeros, whose logarithm is minus infinity.
        let mut lsb = ((largest_entry / top as f64).log2().floor() - 1.0).max(f64::from(least_lsb)) as i32;
        while (largest_entry * pow2(-lsb)).round() > top as f64 {
            lsb += 1;
        }
        let finest = lsb;
        loop {
            let quantised = Self { dropped: factors.dropped(), ..Self::at(name, matrix, lsb) };
            if quantised.largest_sum(operand_bound) <= i128::from(ACCUMULATOR_LIMIT) {
                return Ok(quantised);
            }
            lsb += 1;
            if (lsb - finest) as u32 + FEWEST_USEFUL_BITS > bits {
                return Err(PlanError::Key(format!(
                    "[hardware] coefficient_bits = {bits}: matrix {name} keeps fewer than {FEWEST_USEFUL_BITS} bits beside a \
                     48-bit accumulator; lower data_bits or filter more"
                )));
            }
        }
    }

    fn at(name: &str, matrix: &RealRows, lsb: i32) -> Self {
        let scale = pow2(-lsb);
        let integer = |&(column, values): &(u32, [f64; COMPONENTS])| -> Entry {
            (column, values.map(|value| (value * scale).round() as i32))
        };
        let rows = matrix.iter().map(|row| row.iter().map(integer).collect()).collect();
        Self::from_rows(name, rows, lsb)
    }

    /// From coefficients that are integers already.
    pub fn from_rows(name: &str, rows: Vec<Vec<Entry>>, lsb: i32) -> Self {
        let sum = |row: &Vec<Entry>, channel: usize| -> i64 {
            row.iter().map(|(_, channels)| i64::from(channels[channel].abs())).sum()
        };
        let row_sum = rows.iter().flat_map(|row| (0..COMPONENTS).map(|channel| sum(row, channel))).max().unwrap_or(0);
        Self { name: name.to_owned(), rows, lsb, row_sum, dropped: 0 }
    }

    /// Its image at the diagonal of a grid of `side` by `side` orbits.
    #[must_use]
    pub fn mirrored(&self, side: usize) -> Self {
        let entry = |&(column, channels): &Entry| {
            (mirror(column as usize, side) as u32, std::array::from_fn(|component| channels[swapped(component)]))
        };
        let row = |row: usize| self.rows[mirror(row, side)].iter().map(entry).collect();
        Self { rows: (0..self.rows.len()).map(row).collect(), ..self.clone() }
    }

    /// Exponent of the accumulator's last bit, for operands of this format.
    pub fn accumulator_lsb(&self, operand: Format) -> i32 {
        self.lsb + operand.lsb + self.dropped as i32
    }

    /// Largest magnitude in the accumulator, for operands up to `operand_bound`.
    pub fn largest_sum(&self, operand_bound: i64) -> i128 {
        let exact = i128::from(self.row_sum) * i128::from(operand_bound);
        (exact >> self.dropped) + i128::from(self.dropped_steps())
    }

    /// Most steps of the accumulator that a row's dropped bits can be worth.
    pub fn dropped_steps(&self) -> i64 {
        // Each product is rounded by half a step at most, and the bound itself down.
        if self.dropped == 0 { 0 } else { 1 + self.rows.iter().map(Vec::len).max().unwrap_or(0) as i64 }
    }

    /// Number of stored entries: cycles of a lane per product.
    pub fn nnz(&self) -> usize {
        self.rows.iter().map(Vec::len).sum()
    }

    /// What the rounding of the coefficients is worth, root mean square, as a share of the coefficients' own.
    pub fn rounding(&self) -> f64 {
        // A rounding is anywhere in a step.
        let of_step = 1.0 / 12.0;
        let channel = |channel: usize| {
            let values = || self.rows.iter().flatten().map(move |(_, channels)| f64::from(channels[channel]));
            let squares: f64 = values().map(|value| value * value).sum();
            if squares > 0.0 { values().count() as f64 * of_step / squares } else { 0.0 }
        };
        (0..COMPONENTS).map(channel).fold(0.0, f64::max).sqrt()
    }

    /// Row `row` times one channel's `operand` in the accumulator, exactly.
    pub fn row_product(&self, row: usize, channel: usize, operand: &[i64]) -> i64 {
        self.rows[row]
            .iter()
            .map(|&(column, channels)| product(channels[channel], operand[column as usize], self.dropped))
            .sum()
    }

    /// Largest row sum of the magnitudes of the four-channel matrix's unfolded coefficients, times four: with it, a bound
    /// of the taxels' operands is one of the taxels' results.
    pub fn unfolded_row_sum(&self) -> i64 {
        let mirrored = |channels: &[i32; COMPONENTS], image: usize| -> i64 {
            let signed = channels.iter().enumerate().map(|(component, &value)| {
                if golden::parity::sign(component, image) < 0.0 { -i64::from(value) } else { i64::from(value) }
            });
            signed.sum::<i64>().abs()
        };
        let of_row = |row: &Vec<Entry>| -> i64 {
            row.iter().map(|(_, channels)| (0..COMPONENTS).map(|image| mirrored(channels, image)).sum::<i64>()).sum()
        };
        self.rows.iter().map(of_row).max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra_sparse::CooMatrix;

    const ONE: Factors = Factors { coefficient_bits: 18, data_bits: 27 };

    fn csr(entries: &[(usize, usize, f64)], size: usize) -> RealRows {
        let mut coo = CooMatrix::new(size, size);
        for &(row, column, value) in entries {
            coo.push(row, column, value);
        }
        one_channel(&CsrMatrix::from(&coo), 1.0)
    }

    #[test]
    fn uses_the_whole_coefficient_width() {
        let matrix = csr(&[(0, 0, 0.75), (0, 1, -0.1), (1, 1, 0.2)], 2);
        let quantised = QuantisedMatrix::new("A1", &matrix, ONE, 1 << 26, ANY_LSB).unwrap();
        assert_eq!(quantised.rows[0][0].1[0], 98304);
        assert_eq!(quantised.lsb, -17);
        assert_eq!(quantised.nnz(), 3);
    }

    #[test]
    fn gives_up_bits_before_the_accumulator_overflows() {
        // 64 ones with 15 fraction bits times a full 27-bit operand fill the accumulator, but for the rounding.
        for (ones, lsb) in [(31, -16), (63, -15), (64, -14)] {
            let row: Vec<_> = (0..ones).map(|column| (0, column, 1.0)).collect();
            let quantised = QuantisedMatrix::new("A1", &csr(&row, 64), ONE, largest(27), ANY_LSB).unwrap();
            assert!(quantised.row_sum * largest(27) <= ACCUMULATOR_LIMIT);
            assert_eq!(quantised.lsb, lsb, "{ones} ones");
        }
    }

    #[test]
    fn is_no_finer_than_asked() {
        for (entry, expected) in [(1.0, 64), (0.001, 0), (0.0, 0)] {
            let quantised = QuantisedMatrix::new("D12", &csr(&[(0, 0, entry)], 1), ONE, 1 << 26, -6).unwrap();
            assert_eq!((quantised.lsb, quantised.rows[0][0].1[0]), (-6, expected));
        }
    }

    #[test]
    fn says_when_nothing_useful_is_left() {
        let dense: Vec<_> = (0..64).flat_map(|row| (0..64).map(move |column| (row, column, 1.0))).collect();
        let error = QuantisedMatrix::new(
            "A1",
            &csr(&dense, 64),
            Factors { coefficient_bits: 8, data_bits: 27 },
            largest(40),
            ANY_LSB,
        )
        .unwrap_err();
        assert!(error.to_string().contains("A1"), "{error}");
    }
}
