//! Crosstalk of a row-column array, which adds a share of each row and of each column to its taxels.
//!
//! A taxel of true stress `t` reads `r_ij = t_ij + c R_i + e C_j`. `R_i` is the sum of the true stresses of its row, `C_j` of
//! its column, the taxel among them; a design has one share for both. With n columns, m rows and the row sums `P_i`, column
//! sums `Q_j` and total `S` of what is read, the inverse is exact:
//!
//! `t_ij = r_ij - a P_i - b Q_j + d S`, `a = c / (1 + c n)`, `b = e / (1 + e m)`, `d = (a e + b c) / (1 + c n + e m)`.

use crate::sensor::Sensor;

/// Crosstalk of one sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Crosstalk {
    columns: usize,
    rows: usize,
    /// Of the row and of the column.
    shares: [f64; 2],
}

/// Factors of the inverse: `t_ij = r_ij - row P_i - column Q_j + total S`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// Of the sum of the taxel's row.
    pub row: f64,
    /// Of the sum of its column.
    pub column: f64,
    /// Of the sum of the frame.
    pub total: f64,
}

impl Crosstalk {
    /// The crosstalk that adds `share` of each row and each column of a sensor.
    pub fn new(sensor: &Sensor, share: f64) -> Self {
        Self::of(sensor, [share; 2])
    }

    /// The crosstalk that adds these shares of each row and of each column.
    pub(crate) fn of(sensor: &Sensor, shares: [f64; 2]) -> Self {
        Self { columns: sensor.columns, rows: sensor.rows, shares }
    }

    /// Factors of the inverse.
    pub fn factors(&self) -> Factors {
        let [along, across] = self.of_sums();
        let [of_row, of_column] = self.shares;
        let (row, column) = (of_row / (1.0 + along), of_column / (1.0 + across));
        Factors { row, column, total: (row * of_column + column * of_row) / (1.0 + along + across) }
    }

    /// What a taxel reads of a pressure that is the same everywhere, as a multiple of it.
    pub fn under_uniform_pressure(&self) -> f64 {
        1.0 + self.of_sums().iter().sum::<f64>()
    }

    /// What a taxel reads more of its row, and of its column, under such a pressure.
    fn of_sums(&self) -> [f64; 2] {
        [self.shares[0] * self.columns as f64, self.shares[1] * self.rows as f64]
    }

    /// Adds the crosstalk to a frame of true stresses.
    pub fn add(&self, frame: &mut [f64]) {
        self.combine(frame, Factors { row: -self.shares[0], column: -self.shares[1], total: 0.0 });
    }

    /// Removes the crosstalk from a frame of readings in pascals.
    pub fn remove(&self, frame: &mut [f64]) {
        self.combine(frame, self.factors());
    }

    /// Sums of the rows and of the columns of a frame.
    pub(crate) fn sums(&self, frame: &[f64]) -> [Vec<f64>; 2] {
        let rows = frame.chunks(self.columns).map(|row| row.iter().sum());
        let columns = (0..self.columns).map(|column| frame.iter().skip(column).step_by(self.columns).sum());
        [rows.collect(), columns.collect()]
    }

    fn combine(&self, frame: &mut [f64], factors: Factors) {
        let [rows, columns] = self.sums(frame);
        let total = factors.total * rows.iter().sum::<f64>();
        for (values, row) in frame.chunks_mut(self.columns).zip(rows) {
            for (value, column) in values.iter_mut().zip(&columns) {
                *value += total - factors.row * row - factors.column * column;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_removed_was_added() {
        let sensor = Sensor { columns: 5, rows: 3, pitch_mm: [4.0, 2.0], depth_mm: 2.0 };
        let stress: Vec<f64> = (0..15).map(|taxel| f64::from(taxel * taxel % 11) - 7.0).collect();
        for shares in [[0.0001; 2], [0.02; 2], [0.1, 0.03], [0.0, 0.05]] {
            let crosstalk = Crosstalk::of(&sensor, shares);
            let mut frame = stress.clone();
            crosstalk.add(&mut frame);
            let row: f64 = stress[5..10].iter().sum();
            let column = stress[2] + stress[7] + stress[12];
            assert!((frame[7] - (stress[7] + shares[0] * row + shares[1] * column)).abs() < 1e-12, "{shares:?}");
            crosstalk.remove(&mut frame);
            assert!(frame.iter().zip(&stress).all(|(found, &stress)| (found - stress).abs() < 1e-12), "{shares:?}");
        }
    }
}
