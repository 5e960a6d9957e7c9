//! The interface of an estimator: its configuration, its inputs and outputs, its block.

use golden::design::Design;
use golden::products::ByPq;
use golden::sensor::Sensor;
use serde_json::Value;

use crate::cores::SHORT_BITS;
use crate::format::{Format, address_bits};
use crate::parameters::Parameters;
use crate::resources::BlockCost;
use crate::timing::durations::Stage;

/// Width of a weight in the ROM files of an estimator.
pub const WEIGHT_BITS: u32 = SHORT_BITS;

/// What an estimator's constants are made from.
#[derive(Clone, Copy, Debug)]
pub struct Config<'a> {
    /// The checked design.
    pub design: &'a Design,
    /// Elements of a vector as the lanes see it: taxels, or orbits of the folded grid.
    pub elements: usize,
    /// Values of an element: 1, or the images of an orbit, which arrive at a time.
    pub channels: usize,
    /// Format of a taxel's stress.
    pub stress: Format,
    /// Format of a taxel's `u_q`.
    pub u: Format,
}

/// What an estimator sees of a frame, in steps of the plan's formats.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// The sensor.
    pub sensor: &'a Sensor,
    /// Stress of each taxel.
    pub stress: &'a [i64],
    /// What is known of all of it.
    pub contact: Contact,
    /// A taxel counts as compressed or tensile beyond this magnitude of stress.
    pub noise_floor: i64,
    /// Sums `G_pq`.
    pub sums: &'a ByPq<i64>,
    /// `u_q` of each taxel.
    pub u: &'a [Vec<i64>; 3],
}

/// The stress of a frame in three numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// `sum |b|`.
    pub stress_sum: i64,
    /// `max |b|`.
    pub largest: i64,
    /// `sum |b|` of the taxels at the grid's border.
    pub border: i64,
}

impl Contact {
    /// Of the stress of each taxel, in rows of `columns`.
    pub fn new(stress: &[i64], columns: usize) -> Self {
        let magnitudes = || stress.iter().map(|value| value.abs());
        let ends = |at: usize, side: usize| at == 0 || at + 1 == side;
        let is_border = |taxel: usize| ends(taxel % columns, columns) || ends(taxel / columns, stress.len() / columns);
        let border = magnitudes().enumerate().filter(|&(taxel, _)| is_border(taxel)).map(|(_, value)| value).sum();
        Self { stress_sum: magnitudes().sum(), largest: magnitudes().max().unwrap_or(0), border }
    }
}

/// What an estimator finds of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Friction components, [`crate::format::FRICTION_FRACTION`] fraction bits.
    pub friction: [i64; 2],
    /// Nothing tells the direction.
    pub unknown: bool,
    /// The optimum lies at the end of its range, or a component was clipped.
    pub at_bound: bool,
    /// An intermediate value was clipped.
    pub saturated: bool,
}

/// The cells that hold a frame's `u_q` for the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cells {
    /// How many.
    pub cells: usize,
    /// Taxels per cell, a power of two; the last cells may have fewer.
    pub elements: usize,
}

impl Cells {
    /// Of `per_cell` taxels each. Where `channels` taxels arrive at a time (the images of an orbit, of which there are
    /// `elements`), they go to as many cells.
    pub fn new(elements: usize, channels: usize, per_cell: usize) -> Self {
        Self { cells: channels * elements.div_ceil(per_cell), elements: per_cell }
    }

    /// Levels of the adder tree over the cells.
    pub fn tree_levels(&self) -> u32 {
        if self.cells == 1 { 0 } else { address_bits(self.cells) }
    }
}

/// An estimator's part of `metadata.json`.
#[derive(Clone, Debug, PartialEq)]
pub struct Metadata {
    /// The search.
    pub search: Value,
    /// The direction of push.
    pub direction: Value,
    /// Whatever else there is of it, and the key it stands under.
    pub own: Option<(&'static str, Value)>,
}

/// An estimator as the rest of the generator knows it. Latencies are counts of registers in the emitted modules.
pub trait EstimatorBlock {
    /// The cells of its search.
    fn cells(&self, sensor: &Sensor) -> Cells;

    /// Cycles from the last stress of a frame to what `CeAn` knows of it.
    fn contact_latency(&self) -> u64;

    /// Cycles from the sums and the contact being there to the start of the search, in a stage of its own; `None` where
    /// the search waits for all that it needs at once.
    fn line_latency(&self) -> Option<u64>;

    /// The stages of the search, in the data's order. A stage holds what it found until the next one takes it. When a
    /// frame leaves the first one, the place of its `u_q` is free, of which there are two.
    fn stages(&self, sensor: &Sensor) -> Vec<Stage>;

    /// `CeAn`.
    fn contact_block(&self) -> BlockCost;

    /// The blocks of the search, in the data's order.
    fn search_blocks(&self, sensor: &Sensor) -> Vec<BlockCost>;

    /// `(contents, words)` of its ROM files: words of several weights of [`WEIGHT_BITS`].
    fn roms(&self) -> Vec<(&'static str, Vec<Vec<i32>>)> {
        Vec::new()
    }

    /// Its module in `hdl-gen/rtl`, with the ports that every estimator has.
    fn module(&self) -> &'static str;

    /// The parameters of its instance, for values that arrive `channels` at a time.
    fn parameters(&self, design: &Design, channels: usize) -> Parameters;

    /// Modules of the library that stand only in a conditional block that these parameters do not take.
    fn without(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// Pitch in x and y over the larger of the two with 16 fraction bits, if it needs the direction of the push: then its
    /// answer is one component and the line on which the other lies, rather than both components.
    fn pitch(&self) -> Option<[i64; 2]>;

    /// What `metadata.json` says of it.
    fn metadata(&self) -> Metadata;

    /// What `sptfra inspect` says of it: a paragraph.
    fn report(&self, design: &Design) -> String;

    /// What the load kernel of the design makes of a wide contact, and when the other one is better; further lines
    /// begin with `indent`.
    fn kernel_advice(&self, design: &Design, indent: &str) -> String;

    /// Its steps in integers, bit for bit those of the hardware.
    fn find(&self, inputs: &Inputs) -> Estimate;
}
