//! The typed steps of a plan: sparse products, each with what happens to its result.

use serde::Serialize;

use super::format::round_shift;
use super::quantise::QuantisedMatrix;

/// A vector of m numbers that products read or write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Vector {
    /// Measured normal stress `b_z`, in Pa.
    Stress,
    /// Magnitude of the weight vector `|w_z|`, in N (Eq. 9).
    Weight,
    /// `A_p b_z` alone, waiting for its `D_p0 w` (Eqs. 11 to 13); p is 1, 2 or 3.
    Partial(u8),
    /// Coefficient vector `g_pq`, in N (Eqs. 11 to 13).
    G(u8, u8),
    /// `u_q = C33 g_3q`, in Pa: the base stress that the normal forces alone would cause.
    U(u8),
}

impl Vector {
    /// Name used in reports and generated comments.
    pub fn name(self) -> String {
        match self {
            Self::Stress => "b".to_owned(),
            Self::Weight => "|w|".to_owned(),
            Self::Partial(p) => format!("A{p} b"),
            Self::G(p, q) => format!("g{p}{q}"),
            Self::U(q) => format!("u{q}"),
        }
    }
}

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

/// What becomes of a product's rounded result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Epilogue {
    /// `max(-y, 0)`: the magnitude of the clipped weights (Eq. 9).
    ClipNegate,
    /// Kept as it is.
    Keep,
    /// Added to the vector that an earlier product left.
    Add(Vector),
}

/// One sparse matrix-vector product and its epilogue.
#[derive(Clone, Debug, Serialize)]
pub struct Product {
    /// Index of the stored matrix in [`super::Plan::matrices`].
    pub matrix: usize,
    /// The vector it multiplies.
    pub operand: Vector,
    /// The block it belongs to.
    pub block: Block,
    /// What happens to each result.
    pub epilogue: Epilogue,
    /// Where the results go.
    pub result: Vector,
    /// Bits dropped, with rounding, between accumulator and result.
    pub shift: u32,
}

impl Product {
    /// Largest magnitude of a rounded result before the epilogue, for operands up to `operand_bound`.
    pub fn result_bound(matrix: &QuantisedMatrix, operand_bound: i64, shift: u32) -> i64 {
        // An accumulator has 48 bits: beyond that, and well within the 64 of this word, nothing is left.
        round_shift(matrix.row_sum * operand_bound, shift.min(62))
    }
}
