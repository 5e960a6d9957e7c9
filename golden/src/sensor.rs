//! The geometry of a sensor.

use std::fmt;

/// Largest number of columns or rows of a sensor.
pub const MAX_SIDE: usize = 64;

/// Geometry of a rectangular grid of taxels under an elastic layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    /// Taxels along x, 2 to [`MAX_SIDE`].
    pub columns: usize,
    /// Taxels along y, 2 to [`MAX_SIDE`].
    pub rows: usize,
    /// Distance between neighbours along x and y, in millimetres.
    pub pitch_mm: [f64; 2],
    /// Thickness of the layer above the taxels, in millimetres.
    pub depth_mm: f64,
}

impl fmt::Display for Sensor {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { columns, rows, pitch_mm: [x, y], depth_mm } = self;
        write!(formatter, "{columns} x {rows} taxels of {x} x {y} mm, {depth_mm} mm deep")
    }
}

impl Sensor {
    /// Number of taxels, `columns * rows`.
    pub fn taxels(&self) -> usize {
        self.columns * self.rows
    }

    /// Position of taxel `index = iy * columns + ix` in metres; the first taxel is the origin.
    pub fn position_m(&self, index: usize) -> [f64; 2] {
        let (ix, iy) = (index % self.columns, index / self.columns);
        [ix as f64 * self.pitch_mm[0] * 1e-3, iy as f64 * self.pitch_mm[1] * 1e-3]
    }

    /// Depth of the taxels below the surface in metres.
    pub fn depth_m(&self) -> f64 {
        self.depth_mm * 1e-3
    }
}
