//! The grid search in integers: formats and constants of its grid, its friction and its network.
//!
//! The steps are those of `docs/explanation/estimators.md`.

mod model;
mod network;
mod report;
pub mod search;
pub mod timing;

use golden::design::Design;
use golden::estimators::joint::{LARGEST, TIE};
use golden::parity::{COMPONENTS, Orbits};
use golden::sensor::Sensor;
use serde::Serialize;
use serde_json::{Value, json};

use super::{Cells, Config, Estimate, EstimatorBlock, Inputs, Metadata, WEIGHT_BITS};
use crate::cores::{LONG_BITS, SHORT_BITS};
use crate::format::FEWEST_ELEMENTS;
use crate::format::{FRICTION_FRACTION, Factors, pow2};
use crate::parameters::Parameters;
use crate::resources::BlockCost;
use crate::resources::memory::memory;
use crate::timing::durations::Stage;
pub use network::{INPUT_BITS, INPUT_FRACTION, NORMAL_DROP, NetworkPlan, RECIPROCAL_BITS, STRESS_BITS, UNIT_BITS};
pub use search::SearchPlan;

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
/// Width of `u_q` where it waits for the features.
const U_BITS: u32 = LONG_BITS;
/// One, in the steps of the friction.
const ONE: f64 = (1_u32 << FRICTION_FRACTION) as f64;
/// Formats and constants of the grid search of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointPlan {
    /// The grid search.
    pub search: SearchPlan,
    /// `c1` of the friction, [`LINEAR_FRACTION`] fraction bits.
    pub linear: i64,
    /// `c3` of the friction, [`CUBIC_FRACTION`] fraction bits.
    pub cubic: i64,
    /// The correction, if the design has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub network: Option<NetworkPlan>,
}

impl JointPlan {
    /// The formats of a design.
    pub fn new(config: &Config) -> Self {
        let constants = &config.design.algorithm.joint;
        let [c1, c3] = constants.friction_correction;
        let finer = config.stress.lsb - config.u.lsb;
        let fixed = |value: f64, fraction: u32| (value * pow2(fraction as i32)).round() as i64;
        Self {
            search: SearchPlan::new(finer, config.design),
            linear: fixed(c1, LINEAR_FRACTION),
            cubic: fixed(c3, CUBIC_FRACTION),
            network: constants
                .correction
                .as_ref()
                .map(|correction| NetworkPlan::new(correction, -finer, config.design.hardware.lanes)),
        }
    }
}

/// Sums of the hidden units: both components.
const READOUTS: usize = 2;

impl EstimatorBlock for JointPlan {
    fn cells(&self, sensor: &Sensor) -> Cells {
        Cells { cells: self.search.parallel, elements: sensor.taxels() }
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

    fn contact_block(&self) -> BlockCost {
        BlockCost::new("CeAn", &["sptfra_cean"], 0)
    }

    fn search_blocks(&self, sensor: &Sensor) -> Vec<BlockCost> {
        let orbits = Orbits::new(sensor.columns, sensor.rows).count();
        let components = COMPONENTS as u32;
        let rows = orbits.max(FEWEST_ELEMENTS);
        // Of two frames, or one of them handed on.
        let taxels = || memory("u", 3, 2 * rows.next_power_of_two(), components * U_BITS, false);
        let handed_on = || memory("u", 3, rows, components * U_BITS, false);
        // The squares of depths, which are short, and both moments.
        let search = BlockCost::new("search", &["sptfra_grid_search"], self.search.multipliers());
        let mut blocks = vec![search.narrow(self.search.weighed()).with([taxels()])];
        if let Some(network) = &self.network {
            // The stresses of an orbit, and two of their shares of all.
            let features = BlockCost::new("features", &["sptfra_features"], COMPONENTS + 2);
            // Each image of a place in the window may be in any quarter of the grid.
            blocks.push(
                features.with([handed_on(), memory("features", COMPONENTS * COMPONENTS, rows, STRESS_BITS, false)]),
            );
            // The hidden units' four parity components, and both friction components.
            let units = BlockCost::new("network", &["sptfra_network"], COMPONENTS * network.at_once + READOUTS);
            let width = WEIGHT_BITS * components * network.at_once as u32;
            blocks.push(units.with([
                memory("features, folded", 1, network.length, components * INPUT_BITS, false),
                memory("network weights", 1, network.weights.len(), width, true),
                memory("readout", 1, network.units(), READOUTS as u32 * WEIGHT_BITS, true),
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
        readout.resize(network.units(), vec![0; READOUTS]);
        vec![("weights", weights.collect()), ("readout", readout)]
    }

    fn module(&self) -> &'static str {
        "sptfra_estimator_joint"
    }

    fn parameters(&self, design: &Design, channels: usize) -> Parameters {
        let parameters = Parameters::new()
            .count("COLUMNS", design.sensor.columns)
            .count("ROWS", design.sensor.rows)
            .count("CHANNELS", channels)
            .number("DATA_BITS", Factors::of(design).outside_bits().into())
            .count("PARALLEL", self.search.parallel)
            .count("TAXELS", self.search.taxels)
            .number("FRACTION", search::FRACTION.into())
            .number("U_LEFT", self.search.u_left.into())
            .signed("LINEAR", LONG_BITS, self.linear)
            .signed("CUBIC", SHORT_BITS, self.cubic)
            .flag("NETWORK", self.network.is_some())
            .cycles("EXPECTED_VALUES_LATENCY", self.search.first_row(&design.sensor))
            .cycles("EXPECTED_SEARCH_LATENCY", self.search.cycles(&design.sensor))
            .cycles(
                "EXPECTED_FRICTION_LATENCY",
                if self.network.is_some() { timing::CORRECTED } else { timing::FRICTION },
            );
        let Some(network) = &self.network else { return parameters };
        let [half_x, half_y] = network.half_window;
        parameters
            .count("HALF_X", half_x)
            .count("HALF_Y", half_y)
            .count("LENGTH", network.length)
            .count("PASSES", network.passes)
            .count("AT_ONCE", network.at_once)
            .number("STRESS_LEFT", network.stress_left.into())
            .number("UNIT_SHIFT", network.unit_shift.into())
            .number("CORRECTION_SHIFT", network.correction_shift.into())
            .outer("ROM_DIR")
            .text("ROM_NAME", &design.name)
            .cycles("EXPECTED_FEATURES_LATENCY", timing::features(&design.sensor))
            .cycles("EXPECTED_NETWORK_LATENCY", timing::network(network))
    }

    fn without(&self) -> Vec<&'static str> {
        if self.network.is_none() { vec!["sptfra_features", "sptfra_network"] } else { Vec::new() }
    }

    fn pitch(&self) -> Option<[i64; 2]> {
        None
    }

    fn metadata(&self) -> Metadata {
        Metadata {
            search: json!({ "side": self.search.side, "parallel": self.search.parallel }),
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

    fn find(&self, inputs: &Inputs) -> Estimate {
        model::friction(self, inputs)
    }
}
