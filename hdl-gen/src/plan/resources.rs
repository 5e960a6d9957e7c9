//! Predicted resources: multipliers and block memories of an UltraScale+ device.

use golden::design::{Design, Outputs, PlanKind};
use golden::parity::CLASSES;
use serde::Serialize;

use super::counts::{CountsPlan, EXPONENT_BITS, GAIN_BITS};
use super::curve::SEGMENT_BITS;
use super::dead::WEIGHT_BITS;
use super::format::address_bits;
use super::formats::ARM_BITS;
use super::layout::OperandLayout;
use super::memory::{Memory, memory};
use super::places::WEIGHT_PLACES;
use super::product::{Product, SUM_ROWS, destination_bits};
use super::schedule::Schedule;
use super::streams::{Intake, Streams};
use crate::estimators::{BlockCost, Slot};

/// Bits of a stress between Bz and the fold.
const STRESS_BITS: u32 = 27;
const BZ: &str = "Bz";
const LANES: &str = "lanes";
const WE: &str = "We";
const CO: &str = "Co";
const FIELD: &str = "field";

/// One block's share.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlockResources {
    /// What the block is called.
    pub name: &'static str,
    /// Its modules in `rtl/`; all that they instantiate counts too.
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
        estimator: &dyn Slot,
        counts: Option<&CountsPlan>,
    ) -> Self {
        let mut memories = lane_memories(design, products, operands, schedule);
        memories.extend(frame_memories(design, operands.elements()));
        let conversions = Streams::of(design).conversions();
        if let Some(counts) = counts.filter(|counts| counts.per_taxel()) {
            let taxels = design.sensor.taxels().div_ceil(conversions);
            if counts.curve.is_none() {
                memories.push(memory(BZ, "exponents", conversions, taxels, EXPONENT_BITS, true));
            }
            memories.push(memory(BZ, "gains", conversions, taxels, GAIN_BITS, true));
            memories.push(memory(BZ, "offsets", conversions, taxels, counts.offset_bits(), true));
        }
        if let Some(curve) = counts.and_then(|counts| counts.curve.as_ref()) {
            memories.push(memory(BZ, "curve", conversions, 1 << curve.levels(), SEGMENT_BITS, true));
        }
        let dead = design.input.dead.len();
        if dead > 0 {
            let taxels = design.sensor.taxels();
            memories.push(memory(BZ, "whole frame", 1, taxels, STRESS_BITS + 2, false));
            memories.push(memory(BZ, "neighbours", 1, taxels, WEIGHT_BITS * dead as u32, true));
            memories.push(memory(BZ, "dead taxels", 1, taxels, 1, true));
        }
        memories.extend(estimator.memories(&design.sensor));
        let blocks: Vec<BlockResources> = blocks(design, estimator, counts)
            .into_iter()
            .map(|BlockCost { name, modules, dsp }| BlockResources {
                name,
                modules,
                dsp,
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

/// The blocks with multipliers or memories, in the data's order.
fn blocks(design: &Design, estimator: &dyn Slot, counts: Option<&CountsPlan>) -> Vec<BlockCost> {
    let block = |name, modules, dsp| BlockCost { name, modules, dsp };
    let streams = Streams::of(design);
    let field = match (design.algorithm.outputs, design.algorithm.plan) {
        (Outputs::Resultants, _) => 0,
        (Outputs::Field, PlanKind::Reduced) => streams.words(),
        (Outputs::Field, PlanKind::Paper) => 2 * streams.words(),
    };
    let mut blocks = vec![
        block(
            BZ,
            &["sptfra_bz", "sptfra_bz_wide"],
            streams.conversions() * multipliers(counts) + design.input.dead.len(),
        ),
        estimator.contact_block(),
        block(LANES, &["sptfra_spmv_array"], design.hardware.lanes),
        block(WE, &["sptfra_we"], 0),
        // Both arms of a taxel, where sums of torques are made of taxels' forces.
        block(CO, &["sptfra_co", "sptfra_unfold"], if design.algorithm.plan == PlanKind::Paper { 2 } else { 0 }),
        block(FIELD, &["sptfra_field", "sptfra_field_wide", "sptfra_coefficient_field"], field),
    ];
    blocks.extend(estimator.search_blocks());
    blocks.push(block("summary", &["sptfra_summary"], 1));
    blocks
}

/// Multipliers between a count and its stress.
fn multipliers(counts: Option<&CountsPlan>) -> usize {
    counts.map_or(0, |counts| 1 + usize::from(counts.curve.is_some()))
}

/// The lanes' programs and operands.
fn lane_memories(design: &Design, products: &[Product], operands: &OperandLayout, schedule: &Schedule) -> Vec<Memory> {
    let walkers = schedule.lanes.len();
    let ways = design.hardware.lanes / walkers;
    let elements = operands.elements();
    let words = schedule.word_depth();
    let vectors = products.iter().map(|product| product.operands.len()).max().unwrap_or(1);
    let destination = destination_bits(design.algorithm.outputs == Outputs::Field);
    let visit = 1 + address_bits(walkers) + destination + address_bits(elements.max(SUM_ROWS));
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
    let streams = Streams::of(design);
    let words = streams.words();
    if design.algorithm.plan == PlanKind::Paper {
        return vec![
            memory(CO, "A_p b", 1, 3 * taxels, data, false),
            memory(CO, "arms", 1, taxels, 2 * ARM_BITS, true),
            memory(FIELD, "field", 3 * words, 2 * (3 * taxels).div_ceil(words), data, false),
        ];
    }
    let mut memories = Vec::new();
    if design.hardware.skip_zeros {
        memories.push(memory(WE, "nonzeros", 2, elements, address_bits(elements), false));
    }
    let folded = 2 * elements.next_power_of_two();
    if streams.intake == Intake::Whole {
        // One for each taxel of a quad, and one for CeAn.
        let samples = streams.samples();
        memories.push(memory(BZ, "frame by quads", CLASSES * samples, streams.beats_in(), data, false));
        memories.push(memory(BZ, "frame by taxels", samples, streams.beats_in(), STRESS_BITS, false));
    } else {
        memories.push(memory(BZ, "half-folded b", 1, elements, 2 * data + 2, false));
    }
    memories.push(memory(CO, "folded b", 1, folded, CLASSES as u32 * data, false));
    if design.algorithm.outputs == Outputs::Field {
        let weights = WEIGHT_PLACES * elements.next_power_of_two();
        if words > 1 {
            // A copy for a taxel, and one for the next.
            let forces = 2 * elements.next_power_of_two();
            memories.push(memory(FIELD, "weights", 2 * CLASSES, weights, data, false));
            memories.push(memory(FIELD, "field", 2 * 3 * CLASSES, forces, data, false));
        } else {
            memories.push(memory(FIELD, "weights", CLASSES, weights, data, false));
            memories.push(memory(FIELD, "field", CLASSES, 6 * elements, data, false));
        }
    }
    memories
}
