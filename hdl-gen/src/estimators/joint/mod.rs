//! The joint estimator in integers: formats and constants of its grid, its friction and its network.
//!
//! The steps are those of `docs/explanation/estimators.md`. Stresses `u_q` come as the taxels have them; the values on the grid are
//! 8 times finer, so that a step of the grid adds `u_1` or `u_2` as they are.

mod model;
mod network;
pub mod points;
mod report;
pub mod timing;

use golden::design::{Design, Optimise};
use golden::estimators::joint::{DEAD_ZONE, Grid, LARGEST, LEVEL, TIE};
use golden::parity::{CLASSES, Quads};
use golden::sensor::Sensor;
use serde::Serialize;
use serde_json::{Value, json};

use super::{Cells, Found, Given, Metadata, Seen, Slot, Stage, WEIGHT_BITS};
use crate::blocks::FEWEST_ELEMENTS;
use crate::blocks::parameters::Parameters;
use crate::cores::{LONG_BITS, SHORT_BITS};
use crate::plan::format::{FRICTION_FRACTION, Factors, MOST_CELLS, address_bits, pow2};
use crate::plan::memory::{block_memory, memory};
use crate::plan::resources::BlockCost;
pub use network::{
    DoubtPlan, INPUT_BITS, INPUT_FRACTION, NORMAL_DROP, NetworkPlan, RECIPROCAL_BITS, STRESS_BITS, UNIT_BITS,
};
pub use points::PointsPlan;

/// A step of the grid is `2^-STEP_SHIFT`.
pub const STEP_SHIFT: u32 = 3;
/// Points of the grid along one axis.
pub const SIDE: usize = Grid::FINE.side();
/// Points of the grid.
pub const POINTS: usize = SIDE * SIDE;
/// Both the dead zone and the level are `2^-SHARE_SHIFT`, of the largest and of the sum of |b|.
const SHARE_SHIFT: i32 = 8;
/// Width of a taxel's stress on the grid, `8 (u0 - dead zone) + i u1 + j u2`: the last two up to 10 times 27 bits.
pub const POINT_BITS: u32 = 32;
/// Leading bits of the level that a weight is the square of.
pub const DEPTH_BITS: u32 = 17;
/// Bits dropped from the square, of a cell a point as of a walk over the grid.
pub const WEIGHT_DROP: u32 = 8;
/// Fraction bits of c3.
pub const CUBIC_FRACTION: u32 = 15;
/// Fraction bits of c1 and of `|mu|^2`.
pub const LINEAR_FRACTION: u32 = 22;
/// Fraction bits of `c1 + c3 |mu|^2`.
pub const FACTOR_FRACTION: u32 = 21;
/// The largest correction, as a friction component.
pub const CORRECTION_LIMIT: i64 = (LARGEST * ONE) as i64;
/// Left of a pitch from where a contact's centre belongs to the second of two taxels, in the steps of the friction.
pub const CENTRE_HALF: i64 = (ONE / 2.0 + TIE * ONE) as i64;
/// Width of `u_q` where it waits for the look.
const U_BITS: u32 = LONG_BITS;
/// One, in the steps of the friction.
const ONE: f64 = (1_u32 << FRICTION_FRACTION) as f64;
/// Taxels of a cell are visited anew after this many cycles at the earliest: the depth of its pipeline.
const LEAST_ELEMENTS: usize = 4;
/// A cell of so many taxels has its `u` in block memories, which answer a cycle later.
pub const BLOCK_ELEMENTS: usize = 32;

// The shifts above are those of the solver.
const _: () = assert!(Grid::FINE.shift == STEP_SHIFT && Grid::FINE.numerator == 1);
const _: () = assert!((1.0 / LEVEL) as u32 == 1 << SHARE_SHIFT && (1.0 / DEAD_ZONE) as u32 == 1 << SHARE_SHIFT);

/// Formats and constants of the joint estimator of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointPlan {
    /// A cell for each point of the grid, where these are few; else they are walked over.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<PointsPlan>,
    /// Cells of the grid's values: a point each, which all taxels pass, or a few taxels each. They have adders only, and so
    /// their number does not follow the lanes'.
    #[serde(skip)]
    pub cells: Cells,
    /// Bits dropped from `max |b|` for the dead zone, and from `sum |b|` for the level above the least value, both in
    /// steps of the grid's values.
    pub share_shift: u32,
    /// Width of a value on the grid, unsigned: a sum over the taxels.
    pub value_bits: u32,
    /// `c1` of the friction, [`LINEAR_FRACTION`] fraction bits.
    pub linear: i64,
    /// `c3` of the friction, [`CUBIC_FRACTION`] fraction bits.
    pub cubic: i64,
    /// The correction, if the design has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub network: Option<NetworkPlan>,
}

impl JointPlan {
    /// As many cells as are worth their adders, or one for each way.
    pub fn new(given: &Given) -> Self {
        let groups = if given.design.hardware.optimise == Optimise::Area { 1 } else { MOST_CELLS / given.ways };
        let per_cell = given.elements.div_ceil(groups).next_power_of_two().max(LEAST_ELEMENTS);
        let constants = &given.design.algorithm.joint;
        let [c1, c3] = constants.tangential;
        let finer = given.stress.lsb - given.u.lsb;
        let fixed = |value: f64, fraction: u32| (value * pow2(fraction as i32)).round() as i64;
        let points = PointsPlan::new(constants.grid, finer, given.design);
        let cells = match &points {
            Some(of) => Cells { cells: of.side * of.side, elements: given.design.sensor.taxels() },
            None => Cells::new(given.elements, given.ways, per_cell),
        };
        Self {
            points,
            cells,
            // `u` holds the stress itself and more: its steps are hardly ever finer, and never by a factor of 8.
            share_shift: (SHARE_SHIFT - STEP_SHIFT as i32 - finer).max(0) as u32,
            value_bits: POINT_BITS - 1 + address_bits(given.design.sensor.taxels()),
            linear: fixed(c1, LINEAR_FRACTION),
            cubic: fixed(c3, CUBIC_FRACTION),
            network: constants
                .correction
                .as_ref()
                .map(|correction| NetworkPlan::new(correction, -finer, given.design.hardware.lanes)),
        }
    }

    /// Whether the cells of the walk have block memories.
    fn block_cells(&self) -> bool {
        self.points.is_none() && self.cells.elements >= BLOCK_ELEMENTS
    }

    /// `value * 2^-share_shift`, rounded down.
    pub fn share(&self, value: i64) -> i64 {
        value >> self.share_shift
    }
}

/// Sums of the hidden units: both components, and the error that is left.
fn readouts(network: &NetworkPlan) -> usize {
    2 + usize::from(network.doubt.is_some())
}

impl Slot for JointPlan {
    fn cells(&self) -> Cells {
        self.cells
    }

    fn contact_latency(&self) -> u64 {
        timing::CONTACT_LATENCY
    }

    fn line_latency(&self) -> Option<u64> {
        None
    }

    fn stages(&self, sensor: &Sensor) -> Vec<Stage> {
        timing::stages(sensor, self)
    }

    fn releases(&self) -> usize {
        timing::releases(self)
    }

    fn contact_block(&self) -> BlockCost {
        BlockCost::new("CeAn", &["sptfra_cean"], 0)
    }

    fn search_blocks(&self, sensor: &Sensor) -> Vec<BlockCost> {
        let quads = Quads::new(sensor.columns, sensor.rows).count();
        let classes = CLASSES as u32;
        let rows = quads.max(FEWEST_ELEMENTS);
        // Of two frames, or one of them handed on.
        let taxels = || memory("u", 3, 2 * rows.next_power_of_two(), classes * U_BITS, false);
        let handed_on = || memory("u", 3, rows, classes * U_BITS, false);
        let Cells { cells, elements } = self.cells;
        let cells = self.block_cells().then(|| block_memory("u of cells", 3 * cells, 2 * elements, U_BITS));
        // The squares of five depths, or of one, which are of 17 bits; and both moments.
        let plane =
            |squares, multipliers| BlockCost::new("plane", &["sptfra_plane_search"], multipliers).narrow(squares);
        let mut blocks = vec![match &self.points {
            Some(of) => plane(of.weighed(), of.multipliers()).with([taxels()]),
            None => {
                plane(1, 3).with([memory("grid values", 1, POINTS, self.value_bits, false)].into_iter().chain(cells))
            }
        }];
        if let Some(network) = &self.network {
            // The stresses of a quad, and two of their shares of all.
            let look = BlockCost::new("look", &["sptfra_look"], CLASSES + 2);
            // Each member of a place in the window may be in any quarter of the grid.
            let seen = if self.points.is_some() { handed_on() } else { taxels() };
            blocks.push(look.with([seen, memory("look", CLASSES * CLASSES, rows, STRESS_BITS, false)]));
            // The hidden units' four classes, both components, and the error that is left.
            let units = BlockCost::new("network", &["sptfra_network"], CLASSES * network.at_once + readouts(network));
            let width = WEIGHT_BITS * classes * network.at_once as u32;
            blocks.push(units.with([
                memory("look, folded", 1, network.length, classes * INPUT_BITS, false),
                memory("hinge weights", 1, network.weights.len(), width, true),
                memory("readout", 1, network.units(), readouts(network) as u32 * WEIGHT_BITS, true),
            ]));
        }
        // One after the other.
        blocks.push(BlockCost::new("friction", &["sptfra_friction"], 1));
        blocks
    }

    fn roms(&self) -> Vec<(&'static str, Vec<Vec<i32>>)> {
        let Some(network) = &self.network else { return Vec::new() };
        let weights = network.weights.iter().map(|units| units.iter().flatten().copied().collect());
        let mut readout: Vec<Vec<i32>> = network.readout.iter().map(|weights| weights.to_vec()).collect();
        if let Some(doubt) = &network.doubt {
            readout.iter_mut().zip(&doubt.readout).for_each(|(weights, weight)| weights.push(*weight));
        }
        readout.resize(network.units(), vec![0; readouts(network)]);
        vec![("weights", weights.collect()), ("readout", readout)]
    }

    fn module(&self) -> &'static str {
        "sptfra_estimator_joint"
    }

    fn parameters(&self, design: &Design, ways: usize) -> Parameters {
        let parameters = Parameters::new()
            .count("COLUMNS", design.sensor.columns)
            .count("ROWS", design.sensor.rows)
            .count("WAYS", ways)
            .number("DATA_BITS", Factors::of(design).outside_bits().into())
            .count("POINTS_SIDE", self.points.as_ref().map_or(0, |points| points.side));
        let parameters = match &self.points {
            Some(points) => {
                let parameters = parameters.number("U_LEFT", points.u_left.into());
                if points.taxels > 1 { parameters.count("TAXELS", points.taxels) } else { parameters }
            }
            None => parameters
                .count("CELLS", self.cells.cells)
                .count("CELL_ELEMENTS", self.cells.elements)
                .number("SHARE_SHIFT", self.share_shift.into()),
        };
        let parameters = parameters
            .wide("LINEAR", LONG_BITS, self.linear)
            .wide("CUBIC", SHORT_BITS, self.cubic)
            .flag("NETWORK", self.network.is_some())
            .cycles("EXPECTED_PLANE_LATENCY", timing::first_value(&design.sensor, self))
            .cycles("EXPECTED_LEVEL_LATENCY", timing::level(self))
            .cycles(
                "EXPECTED_FRICTION_LATENCY",
                if self.network.is_some() { timing::CORRECTED } else { timing::FRICTION },
            );
        let Some(network) = &self.network else { return parameters };
        let [half_x, half_y] = network.half_window;
        let parameters = parameters
            .count("HALF_X", half_x)
            .count("HALF_Y", half_y)
            .count("LENGTH", network.length)
            .count("PASSES", network.passes)
            .count("AT_ONCE", network.at_once)
            .number("STRESS_LEFT", network.stress_left.into())
            .number("UNIT_SHIFT", network.unit_shift.into())
            .number("CORRECTION_SHIFT", network.correction_shift.into());
        let parameters = match &network.doubt {
            Some(DoubtPlan { shift, base, .. }) => {
                parameters.flag("DOUBT", true).number("DOUBT_SHIFT", (*shift).into()).wide("DOUBT_BASE", 18, *base)
            }
            None => parameters,
        };
        parameters
            .expression("ROM_DIR", "ROM_DIR")
            .expression("ROM_NAME", format!("\"{}\"", design.name))
            .cycles("EXPECTED_LOOK_LATENCY", timing::look(&design.sensor))
            .cycles("EXPECTED_NETWORK_LATENCY", timing::network(network))
    }

    fn without(&self) -> Vec<&'static str> {
        let mut without = match self.points {
            Some(_) => vec!["sptfra_plane", "sptfra_level_set"],
            None => vec!["sptfra_points", "sptfra_points_level"],
        };
        if self.network.is_none() {
            without.push("sptfra_correction");
        }
        if self.network.as_ref().is_none_or(|network| network.doubt.is_none()) {
            without.push("sptfra_doubt");
        }
        without
    }

    fn pitch(&self) -> Option<[i64; 2]> {
        None
    }

    fn answers_with_a_line(&self) -> bool {
        false
    }

    fn metadata(&self) -> Metadata {
        let Cells { cells, elements } = self.cells;
        Metadata {
            search: json!({ "cells": cells, "elements": elements }),
            direction: Value::Null,
            own: Some(("joint", json!(self))),
        }
    }

    fn report(&self, design: &Design) -> String {
        report::report(self, design)
    }

    fn kernel_advice(&self, design: &Design, indent: &str) -> String {
        report::kernel_advice(design, indent)
    }

    fn find(&self, seen: &Seen) -> Found {
        model::friction(self, seen)
    }
}
