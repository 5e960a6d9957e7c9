//! The geometry of a sensor.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Largest number of columns or rows of a sensor.
pub const MAX_SIDE: usize = 64;
/// Layers of fewer pitches are better served by the kernel "cell" (`docs/explanation/accuracy.md`, "Thin layers").
const CELL_BELOW: f64 = 0.5;
/// What a quotient of two lengths in millimetres may be off by.
const ROUNDING: f64 = 1e-9;

/// Geometry of a rectangular grid of taxels under an elastic layer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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

    /// The grid's sides, from the first taxel to the last, in metres.
    pub fn extent_m(&self) -> [f64; 2] {
        self.position_m(self.taxels() - 1)
    }

    /// The taxel whose cell, a pitch along each axis, holds a position in metres from the first taxel.
    pub fn taxel_at(&self, position_m: [f64; 2]) -> Option<usize> {
        let [x, y] = [0, 1].map(|axis| (position_m[axis] / (self.pitch_mm[axis] * 1e-3) + 0.5).floor());
        let within = |place: f64, count: usize| (0.0..count as f64).contains(&place);
        (within(x, self.columns) && within(y, self.rows)).then(|| y as usize * self.columns + x as usize)
    }

    /// Position of taxel `index` in metres about the middle of the grid: the arm of its force's torque.
    pub fn arm_m(&self, index: usize) -> [f64; 2] {
        let (ix, iy) = (index % self.columns, index / self.columns);
        [
            (ix as f64 - 0.5 * (self.columns - 1) as f64) * self.pitch_mm[0] * 1e-3,
            (iy as f64 - 0.5 * (self.rows - 1) as f64) * self.pitch_mm[1] * 1e-3,
        ]
    }

    /// The torque `[T_x, T_y, T_z]` in N m about the middle of the grid of a force in newtons at the surface, at a
    /// position in metres from the first taxel.
    pub fn torque_of(&self, [x, y]: [f64; 2], [fx, fy, fz]: [f64; 3]) -> [f64; 3] {
        let [corner_x, corner_y] = self.arm_m(0);
        let (x, y) = (x + corner_x, y + corner_y);
        [y * fz, -x * fz, x * fy - y * fx]
    }

    /// Thickness of the layer over the coarser pitch.
    pub fn depth_by_pitch(&self) -> f64 {
        let [x, y] = self.pitch_mm;
        self.depth_mm / x.max(y)
    }

    /// Whether the layer has less than so many pitches; a depth that was meant to be so many has not.
    pub fn is_thinner_than(&self, pitches: f64) -> bool {
        self.depth_by_pitch() < pitches - ROUNDING
    }

    /// Whether the kernel "cell" finds friction better than "point": where a point force beside a taxel hardly reaches it.
    pub fn wants_cells(&self) -> bool {
        self.is_thinner_than(CELL_BELOW)
    }

    /// Depth of the taxels below the surface in metres.
    pub fn depth_m(&self) -> f64 {
        self.depth_mm * 1e-3
    }
}
