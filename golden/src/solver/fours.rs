//! Folded vectors with the four classes of a quad side by side, which is what one coefficient of each class multiplies.

use crate::parity::{CLASSES, Quads, butterfly};
use crate::reduced::FoldedRows;

/// The values of a folded vector by quad and class, or of a plain one by quad and member.
pub(super) type Fours = Vec<[f64; CLASSES]>;

/// The quads of a sensor, looked up.
#[derive(Clone, Debug)]
pub(super) struct Members {
    taxels: Vec<[usize; 4]>,
}

impl Members {
    pub(super) fn new(quads: &Quads) -> Self {
        Self { taxels: (0..quads.count()).map(|q| quads.members(q)).collect() }
    }

    /// Number of quads.
    pub(super) fn quads(&self) -> usize {
        self.taxels.len()
    }

    /// Folds one quad of a vector of m values.
    pub(super) fn fold(&self, x: &[f64], q: usize) -> [f64; CLASSES] {
        butterfly(self.taxels[q].map(|taxel| x[taxel]))
    }

    /// Unfolds a vector: calls `put(quad, member, taxel, value)`, for taxels on a centre line more than once.
    pub(super) fn unfold(
        &self,
        folded: impl Fn(usize) -> [f64; CLASSES],
        mut put: impl FnMut(usize, usize, usize, f64),
    ) {
        for (quad, taxels) in self.taxels.iter().enumerate() {
            let values = butterfly(folded(quad));
            for (member, (&taxel, value)) in taxels.iter().zip(values).enumerate() {
                put(quad, member, taxel, 0.25 * value);
            }
        }
    }
}

/// The product of a folded matrix with a folded vector.
pub(super) fn times(matrix: &FoldedRows, x: &Fours, result: &mut Fours) {
    for (row, result) in matrix.rows.iter().zip(result) {
        let mut sums = [0.0; CLASSES];
        for (column, [a, b, c, d]) in row {
            let x = &x[*column as usize];
            sums[0] += a * x[0];
            sums[1] += b * x[1];
            sums[2] += c * x[2];
            sums[3] += d * x[3];
        }
        *result = [0, 1, 2, 3].map(|class| sums[class ^ matrix.parity]);
    }
}
