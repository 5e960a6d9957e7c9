//! Predicted resources: multipliers and block memories of an UltraScale+ device.

use golden::design::{Design, Outputs, PlanKind};
use golden::estimators::joint::WEIGHT_BITS;
use golden::parity::CLASSES;
use serde::Serialize;

use super::counts::{CountsPlan, GAIN_BITS};
use super::format::address_bits;
use super::joint::{INPUT_BITS, JointPlan, POINTS, STRESS_BITS, UNITS};
use super::layout::OperandLayout;
use super::optimum::OptimumPlan;
use super::product::Product;
use super::reduced::SUM_ROWS;
use super::schedule::Schedule;

/// What a RAMB18 is worth when a memory could be LUTs instead, in the units of Yosys' `synth_xilinx`, by which a small
/// memory goes where it is cheaper. Vivado's own weights are not published.
const HALF_COST: usize = 129;
/// ROM bits in LUTs at a cost of 1.
const ROM_BITS_PER_COST: usize = 64;
/// RAM bits in LUTs at a cost of 1, in steps of [`LUT_DEPTH`] words; a register for each bit of a word comes on top.
const RAM_BITS_PER_COST: usize = 28;
/// Words of a LUT as RAM.
const LUT_DEPTH: usize = 32;
/// Frames whose weights are kept for the output, reduced plan.
pub const WEIGHT_BANKS: usize = 4;
/// The blocks with multipliers or memories and their modules.
const BLOCKS: [(&str, &[&str]); 14] = [
    (BZ, &["bz", "fold"]),
    (CEAN, &["cean"]),
    (LANES, &["spmv_array"]),
    (WE, &["we", "nonzeros"]),
    (CO, &["co", "unfold"]),
    (FIELD, &["field"]),
    (LINE, &["op_line"]),
    (CELLS, &["op_search"]),
    (PLANE, &["op_plane", "op_level"]),
    (LOOK, &["op_look"]),
    (NETWORK, &["op_network"]),
    (FRICTION, &["op_friction"]),
    (SUMMARY, &["op_summary"]),
    (OUTPUT, &["op_output"]),
];
const BZ: &str = "Bz";
const CEAN: &str = "CeAn";
const LANES: &str = "lanes";
const WE: &str = "We";
const CO: &str = "Co";
const FIELD: &str = "field";
const LINE: &str = "line";
const CELLS: &str = "cells";
const PLANE: &str = "plane";
const LOOK: &str = "look";
const NETWORK: &str = "network";
const FRICTION: &str = "friction";
const SUMMARY: &str = "summary";
const OUTPUT: &str = "output";
/// Shapes of half a RAMB36 as `(depth, width)`.
const HALF_SHAPES: [(usize, usize); 6] = [(512, 36), (1024, 18), (2048, 9), (4096, 4), (8192, 2), (16384, 1)];

/// One kind of memory in the design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Memory {
    /// What it holds.
    pub name: &'static str,
    /// The block that it is in, one of [`Resources::blocks`].
    pub block: &'static str,
    /// How many of them.
    pub count: usize,
    /// Words.
    pub depth: usize,
    /// Bits of a word.
    pub width: u32,
    /// RAMB36 of one of them, in halves.
    pub bram36: f64,
    /// Whether its contents are fixed.
    pub read_only: bool,
}

/// One block's share.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlockResources {
    /// What the block is called.
    pub name: &'static str,
    /// Its modules: the emitted module is `NAME_` and this, and all that it instantiates counts too.
    pub modules: &'static [&'static str],
    /// DSP48E2.
    pub dsp: usize,
    /// RAMB36; a RAMB18 counts one half.
    pub bram36: f64,
}

/// Predicted resources of a design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Resources {
    /// DSP48E2.
    pub dsp: usize,
    /// RAMB36; a RAMB18 counts one half.
    pub bram36: f64,
    /// Bits in ROM files.
    pub rom_bits: u64,
    /// The memories.
    pub memories: Vec<Memory>,
    /// The same multipliers and block memories by block; every block with one of them, in the data's order.
    pub blocks: Vec<BlockResources>,
}

impl Resources {
    /// Counts what the emitted modules will infer.
    pub fn new(
        design: &Design,
        products: &[Product],
        operands: &OperandLayout,
        schedule: &Schedule,
        (optimum, joint): (&OptimumPlan, Option<&JointPlan>),
        counts: Option<&CountsPlan>,
    ) -> Self {
        let mut memories = lane_memories(design, products, operands, schedule);
        memories.extend(frame_memories(design, operands.elements()));
        if let Some(counts) = counts.filter(|counts| counts.per_taxel()) {
            let taxels = design.sensor.taxels();
            memories.push(memory(BZ, "gains", 1, taxels, GAIN_BITS, true));
            memories.push(memory(BZ, "offsets", 1, taxels, counts.offset_bits(), true));
        }
        memories.extend(joint.iter().flat_map(|joint| joint_memories(design, joint)));
        let blocks: Vec<BlockResources> = BLOCKS
            .iter()
            .map(|&(name, modules)| BlockResources {
                name,
                modules,
                dsp: multipliers(name, design, optimum, joint, counts),
                // From a positive zero, which the sum of nothing is not.
                bram36: memories
                    .iter()
                    .filter(|memory| memory.block == name)
                    .fold(0.0, |sum, of| sum + of.all_bram36()),
            })
            .collect();
        let bits = |memory: &Memory| (memory.count * memory.depth) as u64 * u64::from(memory.width);
        Self {
            dsp: blocks.iter().map(|block| block.dsp).sum(),
            bram36: blocks.iter().map(|block| block.bram36).sum(),
            rom_bits: memories.iter().filter(|memory| memory.read_only).map(bits).sum(),
            memories,
            blocks: blocks.into_iter().filter(|block| block.dsp > 0 || block.bram36 > 0.0).collect(),
        }
    }
}

impl Memory {
    /// RAMB36 of all of them.
    pub fn all_bram36(&self) -> f64 {
        self.count as f64 * self.bram36
    }
}

/// DSP48E2 of a block: one for each product that it forms in a cycle.
fn multipliers(
    block: &str,
    design: &Design,
    optimum: &OptimumPlan,
    joint: Option<&JointPlan>,
    counts: Option<&CountsPlan>,
) -> usize {
    let network = joint.is_some_and(|joint| joint.network.is_some());
    match block {
        // The square of a depth, both moments.
        PLANE if joint.is_some() => 3,
        FRICTION if joint.is_some() => 1,
        // The stress of a taxel, its share of all.
        LOOK if network => 2,
        // The hidden units' four classes, both components.
        NETWORK if network => CLASSES * UNITS + 2,
        CEAN | LINE | CELLS if joint.is_some() => 0,
        BZ => usize::from(counts.is_some()),
        LANES => design.hardware.lanes,
        CELLS => optimum.cells,
        CEAN | LINE | SUMMARY => 1,
        OUTPUT => match (design.algorithm.outputs, design.algorithm.plan) {
            (Outputs::Resultants, _) => 0,
            (Outputs::Field, PlanKind::Reduced) => 1,
            (Outputs::Field, PlanKind::Paper) => 2,
        },
        _ => 0,
    }
}

/// The lanes' programs and operands.
fn lane_memories(design: &Design, products: &[Product], operands: &OperandLayout, schedule: &Schedule) -> Vec<Memory> {
    let walkers = schedule.lanes.len();
    let ways = design.hardware.lanes / walkers;
    let elements = operands.elements();
    let words = schedule.word_depth();
    let vectors = products.iter().map(|product| product.operands.len()).max().unwrap_or(1);
    let codes = products.len() + usize::from(ways > 1);
    let visit = 1 + address_bits(walkers) + address_bits(codes) + address_bits(elements.max(SUM_ROWS));
    let values = ways as u32 * design.hardware.coefficient_bits;
    vec![
        memory(LANES, "values", walkers, schedule.value_depth(), values, true),
        memory(LANES, "columns", walkers, words, address_bits(vectors * elements), true),
        memory(LANES, "MACs per row", walkers, schedule.segment_depth(), 16, true),
        memory(LANES, "visits", 1, schedule.visits.len(), visit, true),
        memory(LANES, "operands", walkers, operands.words(), ways as u32 * design.hardware.data_bits, false),
    ]
}

/// What a frame leaves on its way outside the lanes.
fn frame_memories(design: &Design, elements: usize) -> Vec<Memory> {
    let taxels = design.sensor.taxels();
    let data = design.hardware.data_bits;
    if design.algorithm.plan == PlanKind::Paper {
        return vec![memory(CO, "A_p b", 1, 3 * taxels, data, false), memory(CO, "field", 3, 6 * taxels, data, false)];
    }
    let mut memories = Vec::new();
    if design.hardware.skip_zeros {
        memories.push(memory(WE, "nonzeros", 2, elements, address_bits(elements), false));
    }
    let folded = 2 * elements.next_power_of_two();
    memories.push(memory(BZ, "half-folded b", 1, elements, 2 * data + 2, false));
    memories.push(memory(CO, "folded b", 1, folded, CLASSES as u32 * data, false));
    if design.algorithm.outputs == Outputs::Field {
        let weights = WEIGHT_BANKS * elements.next_power_of_two();
        memories.push(memory(FIELD, "weights", CLASSES, weights, data, false));
        memories.push(memory(FIELD, "field", CLASSES, 6 * elements, data, false));
    }
    memories
}

/// Those of the joint estimator.
fn joint_memories(design: &Design, joint: &JointPlan) -> Vec<Memory> {
    let mut memories = vec![memory(PLANE, "grid values", 1, POINTS, joint.value_bits, false)];
    if let Some(network) = &joint.network {
        let seen = design.sensor.rows << address_bits(design.sensor.columns);
        let classes = CLASSES as u32;
        memories.push(memory(LOOK, "look", 1, seen, STRESS_BITS, false));
        memories.push(memory(NETWORK, "look, folded", 1, network.length, classes * INPUT_BITS, false));
        let width = WEIGHT_BITS * classes * UNITS as u32;
        memories.push(memory(NETWORK, "hinge weights", 1, network.weights.len(), width, true));
        memories.push(memory(NETWORK, "readout", 1, network.units(), 2 * WEIGHT_BITS, true));
    }
    memories
}

fn memory(block: &'static str, name: &'static str, count: usize, depth: usize, width: u32, read_only: bool) -> Memory {
    Memory { name, block, count, depth, width, bram36: ramb36(depth, width as usize, read_only), read_only }
}

/// RAMB36 that a memory takes, a RAMB18 counting one half: the cheapest of the shapes, tiled, or none if LUTs are
/// cheaper.
fn ramb36(depth: usize, width: usize, read_only: bool) -> f64 {
    let tiles = |&(tile_depth, tile_width): &(usize, usize)| depth.div_ceil(tile_depth) * width.div_ceil(tile_width);
    let halves = HALF_SHAPES.iter().map(tiles).min().unwrap_or(0);
    let luts = if read_only {
        depth * width / ROM_BITS_PER_COST
    } else {
        depth.next_multiple_of(LUT_DEPTH) * width / RAM_BITS_PER_COST + width
    };
    if luts < HALF_COST * halves { 0.0 } else { halves as f64 / 2.0 }
}

#[cfg(test)]
mod tests {
    use super::ramb36;

    /// As Yosys maps them; the cases are memories of the shipped designs.
    #[test]
    fn block_ram_or_luts() {
        let cases = [
            (500, 27, false, 0.5),
            (512, 36, false, 0.5),
            (600, 27, false, 1.0),
            (200, 108, false, 1.5),
            (128, 27, false, 0.5),
            (64, 108, false, 0.0),
            (25, 56, false, 0.0),
            (7418, 18, true, 4.0),
            (1614, 72, true, 4.0),
            (1614, 7, true, 0.5),
            (279, 12, true, 0.0),
            (100, 16, true, 0.0),
        ];
        for (depth, width, read_only, expected) in cases {
            let found = ramb36(depth, width, read_only);
            assert!((found - expected).abs() < 1e-9, "{depth} x {width}: {found}, not {expected}");
        }
    }
}
