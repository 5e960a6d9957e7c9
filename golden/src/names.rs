//! Names of the matrices, of the paper's plan and of the reduced one.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::words::{self, print_as_words};

/// Names of the 13 matrices, in the order of Table 1 of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum MatrixName {
    /// Inverse of C33.
    C33inv,
    /// First block row of the pseudo-inverse A+.
    A1,
    /// Second block row of A+.
    A2,
    /// Third block row of A+.
    A3,
    /// `-A1 C33`.
    D10,
    /// `-A1 C31`.
    D11,
    /// `-A1 C32` (Eq. 14 prints A2 here; it is A1).
    D12,
    /// `-A2 C33`.
    D20,
    /// `-A2 C31`.
    D21,
    /// `-A2 C32`.
    D22,
    /// `-A3 C33`.
    D30,
    /// `-A3 C31`.
    D31,
    /// `-A3 C32`.
    D32,
}

impl MatrixName {
    /// All names, in the order of Table 1.
    pub const ALL: [Self; 13] = [
        Self::C33inv,
        Self::A1,
        Self::A2,
        Self::A3,
        Self::D10,
        Self::D11,
        Self::D12,
        Self::D20,
        Self::D21,
        Self::D22,
        Self::D30,
        Self::D31,
        Self::D32,
    ];

    /// Position in [`MatrixName::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Its mirror symmetry: bit 0 if it changes even into odd in x and back, bit 1 in y.
    pub fn parity(self) -> usize {
        match self {
            Self::C33inv | Self::A3 | Self::D11 | Self::D22 | Self::D30 => 0,
            Self::A1 | Self::D10 | Self::D31 => 1,
            Self::A2 | Self::D20 | Self::D32 => 2,
            Self::D12 | Self::D21 => 3,
        }
    }

    /// `(p, q)` of `D_pq`, p from 1 to 3 and q from 0 to 2, or `None` for C33inv and the `A_p`.
    pub(crate) fn product(self) -> Option<(usize, usize)> {
        let place = self.index().checked_sub(Self::D10.index())?;
        Some((1 + place / 3, place % 3))
    }
}

impl FromStr for MatrixName {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, Self::Err> {
        words::read(word)
            .map_err(|unknown| format!("\"{word}\" is no matrix; the names are {}", unknown.allowed.join(" ")))
    }
}

/// Names of the ten matrices of the reduced plan, in the order in which a frame meets them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub enum ReducedName {
    /// Inverse of C33, in N/Pa.
    C33inv,
    /// `(I - C33 A3) C33`, in Pa/N.
    K0,
    /// `C33 A3 C31`, in Pa/N.
    K1,
    /// `C33 A3 C32`, in Pa/N.
    K2,
    /// Stress for forces along z, in Pa/N.
    C33,
    /// Stress for forces along x, in Pa/N.
    C31,
    /// Stress for forces along y, in Pa/N.
    C32,
    /// First block row of the pseudo-inverse A+, in N/Pa.
    A1,
    /// Second block row of A+.
    A2,
    /// Third block row of A+.
    A3,
}

impl ReducedName {
    /// All names, in order.
    pub const ALL: [Self; 10] =
        [Self::C33inv, Self::K0, Self::K1, Self::K2, Self::C33, Self::C31, Self::C32, Self::A1, Self::A2, Self::A3];

    /// Position in [`ReducedName::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Its mirror symmetry: bit 0 if it changes even into odd in x and back, bit 1 in y.
    pub fn parity(self) -> usize {
        match self {
            Self::C33inv | Self::K0 | Self::C33 | Self::A3 => 0,
            Self::K1 | Self::C31 | Self::A1 => 1,
            Self::K2 | Self::C32 | Self::A2 => 2,
        }
    }
}

print_as_words!(MatrixName, ReducedName);
