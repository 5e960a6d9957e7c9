//! Block memories of an UltraScale+ device: what a memory of a given shape costs.

use serde::Serialize;

/// What a RAMB18 is worth when a memory could be LUTs instead, in the units of Yosys' `synth_xilinx`, by which a small
/// memory goes where it is cheaper. Vivado's own weights are not published.
const HALF_COST: usize = 129;
/// ROM bits in LUTs at a cost of 1.
const ROM_BITS_PER_COST: usize = 64;
/// RAM bits in LUTs at a cost of 1, in steps of [`LUT_DEPTH`] words; a register for each bit of a word comes on top.
const RAM_BITS_PER_COST: usize = 28;
/// Words of a LUT as RAM.
const LUT_DEPTH: usize = 32;
/// Shapes of half a RAMB36 as `(depth, width)`.
const HALF_SHAPES: [(usize, usize); 6] = [(512, 36), (1024, 18), (2048, 9), (4096, 4), (8192, 2), (16384, 1)];
/// Words of a bank of `sptfra_rom`: the deepest shape of a RAMB36 that has its parity bits for data.
pub const BANK: usize = 4096;
/// Banks of a ROM, at most; one that would have more is in one piece, and in no device.
const MOST_BANKS: usize = 64;

/// One kind of memory in the design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Memory {
    /// What it holds.
    pub name: &'static str,
    /// The block that it is in: see [`super::BlockCost`].
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

impl Memory {
    /// RAMB36 of all of them.
    pub fn all_bram36(&self) -> f64 {
        self.count as f64 * self.bram36
    }

    /// LUTs of all of them, if they are no block memory: of 64 bits of a ROM, or 8 for 14 bits of 32 words.
    pub fn luts(&self) -> f64 {
        if self.bram36 > 0.0 {
            return 0.0;
        }
        let (depth, width, count) = (self.depth, f64::from(self.width), self.count as f64);
        let of_bit = if self.read_only { depth as f64 / 64.0 } else { depth.div_ceil(LUT_DEPTH) as f64 * 8.0 / 14.0 };
        count * width * of_bit
    }
}

/// A memory with its predicted RAMB36, in no block yet.
pub fn memory(name: &'static str, count: usize, depth: usize, width: u32, read_only: bool) -> Memory {
    Memory { name, block: "", count, depth, width, bram36: ramb36(depth, width as usize, read_only), read_only }
}

/// Banks that `sptfra_rom` makes of so many words.
pub fn banks(depth: usize) -> usize {
    if depth > MOST_BANKS * BANK { 1 } else { depth.div_ceil(BANK).max(1) }
}

/// RAMB36 that a memory takes, a RAMB18 counting one half, of a ROM bank by bank.
fn ramb36(depth: usize, width: usize, read_only: bool) -> f64 {
    let others = if read_only { banks(depth) - 1 } else { 0 };
    others as f64 * ramb36_of_one(BANK, width, read_only) + ramb36_of_one(depth - others * BANK, width, read_only)
}

/// The same of one piece: the cheapest of the shapes, tiled, or none if LUTs are cheaper.
fn ramb36_of_one(depth: usize, width: usize, read_only: bool) -> f64 {
    let halves = halves(depth, width);
    let luts = if read_only {
        depth * width / ROM_BITS_PER_COST
    } else {
        depth.next_multiple_of(LUT_DEPTH) * width / RAM_BITS_PER_COST + width
    };
    if luts < HALF_COST * halves { 0.0 } else { halves as f64 / 2.0 }
}

/// RAMB18 of a piece in the cheapest of the shapes, tiled.
fn halves(depth: usize, width: usize) -> usize {
    let tiles = |&(tile_depth, tile_width): &(usize, usize)| depth.div_ceil(tile_depth) * width.div_ceil(tile_width);
    HALF_SHAPES.iter().map(tiles).min().unwrap_or(0)
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
            (12015, 72, true, 24.0),
            (12015, 11, true, 4.5),
            (4935, 18, true, 2.5),
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
