//! The grid of the search over both friction components.

/// A square grid of points around `mu = 0`, the same distance apart along both axes.
///
/// The distance is a power of two, so that hardware steps by shifts and additions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Steps from the middle to the border.
    pub reach: i32,
    /// A step is `2^-shift`.
    pub shift: u32,
}

impl Grid {
    /// The grid of the search: 13 by 13 points, 1/4 apart.
    pub const SEARCH: Self = Self { reach: 6, shift: 2 };

    /// Points along one axis.
    pub const fn side(&self) -> usize {
        2 * self.reach as usize + 1
    }

    /// Distance of neighbouring points.
    pub fn step(&self) -> f64 {
        1.0 / f64::from(1_u32 << self.shift)
    }
}
