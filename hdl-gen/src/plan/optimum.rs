//! Constants and formats of the two scalar blocks: `CeAn` (direction of the push) and Op (optimum on the line).

use serde::Serialize;

use super::Formats;
use super::format::address_bits;

/// Fraction bits of a centroid, in units of the taxel index.
pub const CENTROID_FRACTION: u32 = 20;
/// Fraction bits of the pitch ratios that turn index differences into lengths.
pub const PITCH_FRACTION: u32 = 16;
/// Fraction bits of the friction components and of the search variable t; one integer bit and a sign go with them.
pub const FRICTION_FRACTION: u32 = 16;
/// Fraction bits of the line's offset c0 and slope c1; two integer bits and a sign go with them.
pub const LINE_FRACTION: u32 = 15;
/// Significant bits of the sums `G_pq` in the line equation.
pub const LINE_SUM_BITS: u32 = 17;
/// Width of the frame sums `G_pq` and `sum |b|`.
pub const SUM_BITS: u32 = 40;
/// Bits dropped from `alpha + t beta` before summing, where `B(t)` is wanted.
pub const HINGE_DROP: u32 = 8;
/// The level set lies below `B_min + 2^-LEVEL_SHIFT sum |b|`.
pub const LEVEL_SHIFT: i32 = 9;
/// Bisections of an interval of the search variable.
pub const SEARCH_STEPS: u32 = 17;
/// Most evaluation cells worth their multiplier.
const MOST_CELLS: usize = 32;

/// Constants of the direction block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DirectionPlan {
    /// Pitch in x and y over the larger of the two, with [`PITCH_FRACTION`] fraction bits.
    pub pitch: [i64; 2],
}

impl DirectionPlan {
    /// From the pitch in millimetres.
    pub fn new(pitch_mm: [f64; 2]) -> Self {
        let larger = pitch_mm[0].max(pitch_mm[1]);
        let one = f64::from(1_u32 << PITCH_FRACTION);
        Self { pitch: pitch_mm.map(|pitch| (pitch / larger * one).round() as i64) }
    }
}

/// Layout of the optimum search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct OptimumPlan {
    /// Evaluation cells, one multiplier each.
    pub cells: usize,
    /// Taxels per cell, a power of two; the last cells may have fewer.
    pub elements: usize,
    /// Left shift (negative: right) that turns `sum |b|` into the level above `B_min`.
    pub level_shift: i32,
}

impl OptimumPlan {
    /// As many cells as lanes, at most 32, with a power of two of taxels each. Where `ways` taxels arrive at a time
    /// (the members of a quad, of which there are `elements`), they go to as many cells.
    ///
    /// The joint estimator's cells have adders only, and so their number does not follow the lanes'.
    pub fn new(elements: usize, ways: usize, lanes: usize, joint: bool, formats: &Formats) -> Self {
        let per_cell = elements.div_ceil((lanes.min(MOST_CELLS) / ways).max(1)).next_power_of_two();
        let hinge_lsb = formats.u.lsb - FRICTION_FRACTION as i32 + HINGE_DROP as i32;
        let (cells, each) =
            if joint { super::joint::cells(elements, ways) } else { (ways * elements.div_ceil(per_cell), per_cell) };
        Self { cells, elements: each, level_shift: formats.stress.lsb - LEVEL_SHIFT - hinge_lsb }
    }

    /// Cycles from the last taxel's address in an evaluation to the decision.
    pub fn decision_cycles(&self) -> u32 {
        5 + self.tree_levels()
    }

    /// Levels of the adder tree over the cells.
    pub fn tree_levels(&self) -> u32 {
        if self.cells == 1 { 0 } else { address_bits(self.cells) }
    }
}
