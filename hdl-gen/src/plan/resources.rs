//! Predicted resources: multipliers and block memories of an UltraScale+ device.

use golden::design::Design;
use serde::Serialize;

use super::format::address_bits;
use super::layout::OperandLayout;
use super::optimum::OptimumPlan;
use super::schedule::Schedule;

/// Memories of fewer bits than this go into LUTs rather than block RAM.
const DISTRIBUTED_BITS: usize = 4096;
/// Multipliers outside the lanes and the cells: `CeAn` 1, line 1, summary 1, output 2.
const SCALAR_MULTIPLIERS: usize = 5;
/// Shapes of half a RAMB36 as `(depth, width)`.
const HALF_SHAPES: [(usize, usize); 6] = [(512, 36), (1024, 18), (2048, 9), (4096, 4), (8192, 2), (16384, 1)];

/// One kind of memory in the design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Memory {
    /// What it holds.
    pub name: &'static str,
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
}

impl Resources {
    /// Counts what the emitted modules will infer.
    pub fn new(design: &Design, operands: &OperandLayout, schedule: &Schedule, optimum: &OptimumPlan) -> Self {
        let taxels = design.sensor.taxels();
        let lanes = design.hardware.lanes;
        let data = design.hardware.data_bits;
        let words = schedule.word_depth();
        let products = address_bits(schedule.windows.len());
        let memories = vec![
            memory("values", lanes, words, design.hardware.coefficient_bits, true),
            memory("columns", lanes, words, address_bits(taxels), true),
            memory("MACs per row", lanes, schedule.segment_depth(), 16, true),
            memory("visits", 1, schedule.visits.len(), address_bits(lanes) + products + address_bits(taxels), true),
            memory("operands", lanes, operands.words(), data, false),
            memory("A_p b", 1, 3 * taxels, data, false),
            memory("field", 3, 6 * taxels, data, false),
        ];
        let bits = |memory: &Memory| (memory.count * memory.depth) as u64 * u64::from(memory.width);
        Self {
            dsp: lanes + optimum.cells + SCALAR_MULTIPLIERS,
            bram36: memories.iter().map(|memory| memory.count as f64 * memory.bram36).sum(),
            rom_bits: memories.iter().filter(|memory| memory.read_only).map(bits).sum(),
            memories,
        }
    }
}

fn memory(name: &'static str, count: usize, depth: usize, width: u32, read_only: bool) -> Memory {
    Memory { name, count, depth, width, bram36: ramb36(depth, width as usize), read_only }
}

/// RAMB36 that a memory takes, a RAMB18 counting one half: the cheapest of the shapes, tiled.
fn ramb36(depth: usize, width: usize) -> f64 {
    if depth * width < DISTRIBUTED_BITS {
        return 0.0;
    }
    let halves = |&(tile_depth, tile_width): &(usize, usize)| depth.div_ceil(tile_depth) * width.div_ceil(tile_width);
    HALF_SHAPES.iter().map(halves).min().unwrap_or(0) as f64 / 2.0
}

#[cfg(test)]
mod tests {
    use super::ramb36;

    #[test]
    fn block_ram_shapes() {
        assert!((ramb36(500, 27) - 0.5).abs() < 1e-9 && (ramb36(512, 36) - 0.5).abs() < 1e-9);
        assert!((ramb36(600, 27) - 1.0).abs() < 1e-9);
        assert!((ramb36(7418, 18) - 4.0).abs() < 1e-9);
        assert!(ramb36(100, 16) < 1e-9);
    }
}
