//! The estimator of the paper: the direction of push allows a line in the (`mu_x`, `mu_y`) plane, and on it the optimum
//! is searched (Eqs. 20 to 24).

mod direction;
mod report;
mod search;
pub mod timing;

use golden::design::Design;
use golden::sensor::Sensor;
use serde_json::json;

use super::{Cells, Config, Estimate, EstimatorBlock, Inputs, Metadata};
use crate::format::{FRICTION_FRACTION, Factors, MOST_CELLS};
use crate::parameters::Parameters;
use crate::resources::BlockCost;
use crate::timing::durations::Stage;

/// Fraction bits of a centroid, in units of the taxel index.
pub const CENTROID_FRACTION: u32 = 20;
/// Bits of a centroid, six of them for the whole index.
pub const CENTROID_BITS: u32 = 6 + CENTROID_FRACTION;
/// Fraction bits of the pitch ratios that turn index differences into lengths.
pub const PITCH_FRACTION: u32 = 16;
/// Fraction bits of the line's offset c0 and slope c1; two integer bits and a sign go with them.
pub const LINE_FRACTION: u32 = 15;
/// Significant bits of the sums `G_pq` in the line equation.
pub const LINE_SUM_BITS: u32 = 17;
/// Bits dropped from `alpha + t beta` before summing, where `B(t)` is wanted.
pub const RECTIFIER_DROP: u32 = 8;
/// The level set lies below `B_min + 2^-LEVEL_SHIFT sum |b|`.
pub const LEVEL_SHIFT: i32 = 9;
/// Bisections of the search variable, for the minimum and for each end of the level set.
pub const SEARCH_STEPS: u32 = 17;
/// Lanes beyond which a round of the search evaluates three points and finds two bits: from 10 × 10 taxels on fewer lanes
/// take longer than the search.
pub const ONE_POINT_LANES: usize = 32;
/// Taxels of a cell beyond which it does not: they, not the way to a decision, take most of a bisection's time.
pub const THREE_POINTS_ELEMENTS: usize = 8;

/// Constants of the direction of push and of the search on its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinePlan {
    /// Evaluation cells, one multiplier each.
    pub cells: Cells,
    /// Points of a round of the search: 1, or 3 for two bisections at a time.
    pub points: usize,
    /// Left shift (negative: right) that turns `sum |b|` into the level above `B_min`.
    pub level_shift: i32,
    /// Pitch in x and y over the larger of the two, with [`PITCH_FRACTION`] fraction bits.
    pub pitch: [i64; 2],
}

impl LinePlan {
    /// As many cells as lanes, at most [`MOST_CELLS`], with a power of two of taxels each.
    pub fn new(config: &Config) -> Self {
        let groups = (config.design.hardware.lanes.min(MOST_CELLS) / config.channels).max(1);
        let per_cell = config.elements.div_ceil(groups).next_power_of_two();
        let rectifier_lsb = config.u.lsb - FRICTION_FRACTION as i32 + RECTIFIER_DROP as i32;
        let pitch_mm = config.design.sensor.pitch_mm;
        let larger = pitch_mm[0].max(pitch_mm[1]);
        let one = f64::from(1_u32 << PITCH_FRACTION);
        Self {
            cells: Cells::new(config.elements, config.channels, per_cell),
            points: if config.design.hardware.lanes > ONE_POINT_LANES && per_cell <= THREE_POINTS_ELEMENTS {
                3
            } else {
                1
            },
            level_shift: config.stress.lsb - LEVEL_SHIFT - rectifier_lsb,
            pitch: pitch_mm.map(|pitch| (pitch / larger * one).round() as i64),
        }
    }
}

impl EstimatorBlock for LinePlan {
    fn cells(&self, _sensor: &Sensor) -> Cells {
        self.cells
    }

    fn contact_latency(&self) -> u64 {
        timing::DIRECTION_LATENCY
    }

    fn line_latency(&self) -> Option<u64> {
        Some(timing::LINE_LATENCY)
    }

    fn stages(&self, _sensor: &Sensor) -> Vec<Stage> {
        vec![Stage { cycles: timing::search(self), shows: 0 }]
    }

    fn contact_block(&self) -> BlockCost {
        BlockCost::new("CeAn", &["sptfra_cean"], 1)
    }

    fn search_blocks(&self, _sensor: &Sensor) -> Vec<BlockCost> {
        vec![BlockCost::new("line", &["sptfra_line"], 1), BlockCost::new("cells", &["sptfra_search"], self.cells.cells)]
    }

    fn module(&self) -> &'static str {
        "sptfra_estimator_line"
    }

    fn parameters(&self, design: &Design, channels: usize) -> Parameters {
        Parameters::new()
            .count("COLUMNS", design.sensor.columns)
            .count("ROWS", design.sensor.rows)
            .count("CHANNELS", channels)
            .number("DATA_BITS", Factors::of(design).outside_bits().into())
            .count("CELLS", self.cells.cells)
            .count("CELL_ELEMENTS", self.cells.elements)
            .count("POINTS", self.points)
            .number("LEVEL_SHIFT", self.level_shift.into())
            .cycles("EXPECTED_LINE_LATENCY", timing::LINE_LATENCY)
            .cycles("EXPECTED_SEARCH_LATENCY", timing::search(self))
    }

    fn pitch(&self) -> Option<[i64; 2]> {
        Some(self.pitch)
    }

    fn metadata(&self) -> Metadata {
        let Cells { cells, elements } = self.cells;
        Metadata {
            search: json!({
                "cells": cells, "elements": elements, "points": self.points,
                "level_shift": self.level_shift,
            }),
            direction: json!({ "pitch": self.pitch }),
            own: None,
        }
    }

    fn report(&self, design: &Design) -> String {
        report::report(self, design)
    }

    fn kernel_advice(&self, design: &Design, indent: &str) -> String {
        report::kernel_advice(design, indent)
    }

    fn find(&self, inputs: &Inputs) -> Estimate {
        search::friction(self, inputs)
    }
}
