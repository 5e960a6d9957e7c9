//! The typed steps of a plan: sparse products, each with what happens to its result.

use golden::parity::CLASSES;
use serde::Serialize;

use super::format::round_shift;
use super::quantise::{Entry, QuantisedMatrix};
use crate::blocks::{array, co, unfold, we};

/// A vector of m numbers that products read or write; in the reduced plan folded by mirror parity, unless it says
/// otherwise.
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
    /// Reduced plan: `y+ = max(C33inv b, 0)`, in N, which comes with the weights.
    Pull,
    /// Reduced plan: `C33 y+`, `-C31 |w|`, `-C32 |w|` for 0, 1, 2, in Pa.
    Residual(u8),
    /// Reduced plan: `r = C33 y+ - mu_x C31 |w| - mu_y C32 |w|`, in Pa.
    Explained,
    /// Reduced plan: `A_p r`, in N; p is 1, 2 or 3.
    Force(u8),
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
            Self::Pull => "y+".to_owned(),
            Self::Residual(q) => format!("r{q}"),
            Self::Explained => "r".to_owned(),
            Self::Force(p) => format!("A{p} r"),
        }
    }

    /// What becomes of a result, as the visit ROM and the collector (`sptfra_spmv_collector`) have it.
    pub fn destination(self) -> usize {
        match self {
            Self::Stress | Self::Weight | Self::Pull => 0,
            Self::U(q) => 1 + usize::from(q),
            Self::Residual(q) => 5 + usize::from(q),
            Self::Explained => 8,
            Self::Force(p) => 8 + usize::from(p),
            Self::Partial(p) => 3 + usize::from(p),
            Self::G(p, q) => 7 + 3 * usize::from(p - 1) + usize::from(q),
        }
    }

    /// The destination of sums over the frame.
    pub const SUMS_DESTINATION: usize = 4;

    /// Whether a product with this result makes `vector`: weights and `y+` come together.
    pub fn holds(self, vector: Self) -> bool {
        self == vector || (self == Self::Weight && vector == Self::Pull)
    }
}

/// Numbers that a destination can have.
pub const DESTINATIONS: usize = 16;

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
    /// Kept as it is, outside the operand memories.
    Keep,
    /// Written to the operand memories as it is.
    Store,
    /// Added to the vector that an earlier product left.
    Add(Vector),
    /// Unfolded into taxels, parted into `max(-y, 0)` and `max(y, 0)`, both folded again.
    Part,
    /// Unfolded into taxels.
    Unfold,
    /// Added to the folded stress, then unfolded into taxels.
    AddStress,
}

impl Epilogue {
    /// Fewest cycles from taking one result to taking the next: both halves of a parted one are written.
    pub fn spacing(self) -> u64 {
        if self == Self::Part { 2 } else { 1 }
    }

    /// Cycles from the collector's visit to the first issue that may read the value as an operand.
    pub fn visit_to_operand(self) -> u64 {
        let after_bus = match self {
            Self::Part => unfold::latency(true) + we::latency(true),
            Self::Store | Self::Unfold | Self::AddStress => co::latency(true),
            Self::ClipNegate => unfold::latency(false) + we::latency(false),
            Self::Keep | Self::Add(_) => co::latency(false),
        };
        array::VISIT_TO_BUS + after_bus + array::WRITE_TO_ISSUE
    }
}

/// Rows in front of a product's own, whose results are sums over the frame and go to Co.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Lead {
    /// Index of the stored matrix.
    pub matrix: usize,
    /// Bits dropped, with rounding, between accumulator and result.
    pub shift: u32,
}

/// Where a lane's coefficients come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Coefficients {
    /// The ROM.
    Rom,
    /// The friction components: the ROM says which, see [`super::reduced::SELECT_ONE`].
    Friction,
}

/// One sparse matrix-vector product and its epilogue.
#[derive(Clone, Debug, Serialize)]
pub struct Product {
    /// Index of the stored matrix in [`super::Plan::matrices`].
    pub matrix: usize,
    /// Rows in front of the matrix, of the same operands.
    pub lead: Option<Lead>,
    /// The vectors it multiplies, which stand next to each other in the operand memory: column `k n + i` is element
    /// i of vector k.
    pub operands: Vec<Vector>,
    /// The block it belongs to.
    pub block: Block,
    /// Its program: products of one program follow each other at fixed distances.
    pub program: usize,
    /// Where the coefficients come from.
    pub coefficients: Coefficients,
    /// What the stored matrix does to the class of its operand, see [`golden::parity::FoldedMatrix`].
    pub parity: usize,
    /// The diagonal mirror of the stored matrix is meant: operand and result are mirrored instead. Holds the number of
    /// quads along a side.
    pub mirrored: Option<usize>,
    /// Zeros of the operand cost nothing: the lanes pass over its quads that are zero, see [`super::schedule::Rounds`].
    pub skips: bool,
    /// What happens to each result.
    pub epilogue: Epilogue,
    /// Where the results go.
    pub result: Vector,
    /// Bits dropped, with rounding, between accumulator and result.
    pub shift: u32,
}

impl Product {
    /// The vector it multiplies, the first if there are several.
    pub fn operand(&self) -> Vector {
        self.operands[0]
    }

    /// Largest magnitude of a rounded result before the epilogue, for operands up to `operand_bound`.
    pub fn result_bound(matrix: &QuantisedMatrix, operand_bound: i64, shift: u32) -> i64 {
        // An accumulator has 48 bits: beyond that, and well within the 64 of this word, nothing is left.
        round_shift(matrix.row_sum * operand_bound, shift.min(62))
    }

    /// For each class of the result, the way of the lanes that computes it.
    pub fn ways(&self) -> [usize; CLASSES] {
        let swap = |class: usize| (class & 1) << 1 | class >> 1;
        std::array::from_fn(|class| if self.mirrored.is_some() { swap(class) } else { class } ^ self.parity)
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

/// The quad on the other side of the diagonal, on a square grid of `side` by `side` quads.
pub fn mirror(quad: usize, side: usize) -> usize {
    quad % side * side + quad / side
}
