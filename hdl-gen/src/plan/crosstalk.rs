//! Crosstalk: the shares of sums that are taken from each taxel, in fixed point.

use golden::design::Design;

use crate::cores::SHORT_BITS;
use crate::format::{Format, largest, pow2, round_shift};

/// Width of a factor: the shorter operand of a multiplier.
const FACTOR_BITS: u32 = SHORT_BITS;
/// Bits of [`CrosstalkPlan::bits`].
pub const PARAMETER_BITS: u32 = 6 + 3 * FACTOR_BITS;

/// What removes crosstalk: `stress - term(row) - (term(column) - term(frame))`, clipped to the full scale, where a term is
/// `round(factor * floor(sum / 2^shift) / 2^fraction)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrosstalkPlan {
    /// Factors of the sums of a row, of a column and of the frame.
    pub factors: [i32; 3],
    /// Their fraction bits.
    pub fraction: u32,
    /// Bits that are dropped of the sum of a row or a column, and of the frame.
    pub shifts: [u32; 2],
    columns: usize,
}

impl CrosstalkPlan {
    /// That of a design, if it has crosstalk.
    pub fn new(design: &Design) -> Option<Self> {
        let exact = design.crosstalk()?.factors();
        let (columns, rows) = (design.sensor.columns, design.sensor.rows);
        let bits = |taxels: usize| taxels.next_power_of_two().ilog2();
        let shifts = [bits(columns.max(rows)), bits(columns) + bits(rows)];
        let scaled = [
            exact.row * pow2(shifts[0] as i32),
            exact.column * pow2(shifts[0] as i32),
            exact.total * pow2(shifts[1] as i32),
        ];
        let at = |fraction: u32| scaled.map(|factor| (factor * pow2(fraction as i32)).round() as i64);
        let fits = |&fraction: &u32| at(fraction).into_iter().all(|factor| factor <= largest(FACTOR_BITS));
        let fraction = (1..=40).rev().find(fits).unwrap_or(1);
        Some(Self { factors: at(fraction).map(|factor| factor as i32), fraction, shifts, columns })
    }

    /// As the hardware has it: the fraction bits above the factors.
    pub fn bits(&self) -> u64 {
        let of = |bits: u64, &factor: &i32| (bits << FACTOR_BITS) | u64::from(factor.unsigned_abs());
        self.factors.iter().fold(self.fraction.into(), of)
    }

    /// Removes the crosstalk of a frame.
    pub fn remove(&self, stress: &mut [i64], format: Format) {
        let term = |factor: i32, sum: i64, shift: u32| round_shift(i64::from(factor) * (sum >> shift), self.fraction);
        let [of_row, of_column, of_frame] = self.factors;
        let [shift, frame_shift] = self.shifts;
        let frame = term(of_frame, stress.iter().sum(), frame_shift);
        let columns: Vec<i64> = (0..self.columns)
            .map(|column| stress.iter().skip(column).step_by(self.columns).sum())
            .map(|sum| term(of_column, sum, shift) - frame)
            .collect();
        for row in stress.chunks_mut(self.columns) {
            let of_row = term(of_row, row.iter().sum(), shift);
            for (stress, column) in row.iter_mut().zip(&columns) {
                *stress = (*stress - of_row - column).clamp(-format.bound, format.bound);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use golden::crosstalk::Crosstalk;
    use golden::design::Design;

    use super::*;

    /// The integers remove what `golden` adds, within a few steps of 2^20.
    #[test]
    fn what_golden_adds_is_removed() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../golden/tests/designs/small.toml");
        for (columns, rows, share) in [(4, 3, 0.02), (10, 10, 0.0001), (2, 64, 0.1), (64, 5, 0.05)] {
            let mut design = Design::load(std::path::Path::new(file)).unwrap();
            (design.sensor.columns, design.sensor.rows, design.input.crosstalk) = (columns, rows, share);
            let plan = CrosstalkPlan::new(&design).unwrap();
            let format = Format::covering(f64::from(1 << 20), 27);
            let stress: Vec<f64> = (0..columns * rows).map(|taxel| f64::from(taxel as i32 * 7919 % 65_537)).collect();
            let mut read = stress.clone();
            Crosstalk::new(&design.sensor, share).add(&mut read);
            let mut steps: Vec<i64> = read.iter().map(|&stress| (stress * pow2(-format.lsb)).round() as i64).collect();
            plan.remove(&mut steps, format);
            let most = stress.iter().zip(&steps).map(|(stress, &found)| (stress - found as f64 * format.step()).abs());
            let largest = read.iter().fold(0.0_f64, |most, read| most.max(read.abs()));
            let worst = most.fold(0.0, f64::max);
            assert!(worst < 1e-4 * largest, "{columns} x {rows}, {share}: {worst} of {largest}");
        }
    }
}
