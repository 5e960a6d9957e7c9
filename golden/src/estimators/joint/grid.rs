//! The grid over the plane of both friction components.

/// A square grid of points around `mu = 0`, the same distance apart along both axes.
///
/// The distance is a fraction whose denominator is a power of two, so that hardware steps by additions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Steps from the middle to the border.
    pub reach: i32,
    /// A step is this many times `2^-shift`.
    pub numerator: i32,
    /// See `numerator`.
    pub shift: u32,
}

impl Grid {
    /// 21 by 21 points, 1/8 apart.
    pub const FINE: Self = Self { reach: 10, numerator: 1, shift: 3 };
    /// 15 by 15 points, 3/16 apart: few enough for a cell of hardware each.
    pub const COARSE: Self = Self { reach: 7, numerator: 3, shift: 4 };
    /// All that there are.
    pub const ALL: [Self; 2] = [Self::COARSE, Self::FINE];

    /// The grid with so many points along an axis, if there is one.
    pub fn of_side(side: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|grid| grid.side() == side)
    }

    /// Points along one axis.
    pub const fn side(&self) -> usize {
        2 * self.reach as usize + 1
    }

    /// Points of the grid.
    pub const fn points(&self) -> usize {
        self.side() * self.side()
    }

    /// Distance of neighbouring points.
    pub fn step(&self) -> f64 {
        f64::from(self.numerator) / f64::from(1_u32 << self.shift)
    }
}
