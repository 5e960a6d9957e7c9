//! The steps of a list: products, each with what happens to its result.

use serde::Serialize;

/// A vector that products read or write: a value for each taxel, or in a folded list for each orbit and component.
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
    /// Fewer products: `y+ = max(C33inv b, 0)`, in N, which comes with the weights.
    Pull,
    /// Fewer products: `C33 y+`, `-C31 |w|`, `-C32 |w|` for 0, 1, 2, in Pa.
    Residual(u8),
    /// Fewer products: `r = C33 y+ - mu_x C31 |w| - mu_y C32 |w|`, in Pa.
    Explained,
    /// Fewer products: `A_p r`, in N; p is 1, 2 or 3.
    Force(u8),
}

impl Vector {
    /// Number of vectors.
    pub const COUNT: usize = 25;

    /// A number below [`Vector::COUNT`] of its own.
    pub fn slot(self) -> usize {
        match self {
            Self::Stress => 0,
            Self::Weight => 1,
            Self::Pull => 2,
            Self::Explained => 3,
            Self::Partial(p) => 3 + usize::from(p),
            Self::U(q) => 7 + usize::from(q),
            Self::Residual(q) => 10 + usize::from(q),
            Self::Force(p) => 12 + usize::from(p),
            Self::G(p, q) => 13 + 3 * usize::from(p) + usize::from(q),
        }
    }

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

    /// Whether a product with this result makes `vector`: weights and `y+` come together.
    pub fn holds(self, vector: Self) -> bool {
        self == vector || (self == Self::Weight && vector == Self::Pull)
    }
}

/// What becomes of a product's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Epilogue {
    /// `max(-y, 0)`: the magnitude of the clipped weights (Eq. 9).
    ClipNegate,
    /// Kept as it is, for no other product.
    Keep,
    /// Kept as it is, for other products.
    Store,
    /// Added to the vector that an earlier product left.
    Add(Vector),
    /// Unfolded into taxels, parted into `max(-y, 0)` and `max(y, 0)`, both folded again.
    Part,
    /// Unfolded into taxels.
    Unfold,
    /// Added to the stress, then unfolded into taxels.
    AddStress,
}

/// Where a product's coefficients come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Coefficients {
    /// The stored matrix.
    Rom,
    /// One and the frame's friction components, which multiply the three operands as they are; codes in the stored
    /// matrix say which.
    Friction,
}

/// One product of a list and its epilogue.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Step {
    /// Index of the matrix in the list.
    pub matrix: usize,
    /// The vectors it multiplies, columns one after the other. A matrix in front of which sums stand multiplies the
    /// first, the sums all of them.
    pub operands: Vec<Vector>,
    /// Where the coefficients come from.
    pub coefficients: Coefficients,
    /// Whether the sums `G_pq` of the frame come with it, from rows of their own.
    pub sums: bool,
    /// Mirror symmetry of the stored matrix, see [`crate::parity::FoldedMatrix`]; 0 in a list that is not folded.
    pub parity: usize,
    /// The diagonal mirror of the stored matrix is meant: operand and result are mirrored instead. Holds the number of
    /// orbits along a side.
    pub mirrored: Option<usize>,
    /// What happens to each result.
    pub epilogue: Epilogue,
    /// Where the results go.
    pub result: Vector,
}

impl Step {
    /// The vector it multiplies, the first if there are several.
    pub fn operand(&self) -> Vector {
        self.operands[0]
    }
}
