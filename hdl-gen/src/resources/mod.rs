//! Predicted resources: multipliers and block memories of a device of AMD's, as the blocks state them.

pub mod memory;

use serde::Serialize;

use crate::cores::DspBlock;
use memory::Memory;

/// What a block of the hardware takes.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct BlockCost {
    /// What the block is called.
    pub name: &'static str,
    /// Its modules in `rtl/`; all that they instantiate counts too.
    pub modules: &'static [&'static str],
    /// Multipliers of 27 by 18 bits: one for each product that it forms in a cycle.
    pub multipliers: usize,
    /// Of these, the ones whose operands never have more than 25 bits: [`crate::cores::OLDER_LONG_BITS`].
    pub narrow: usize,
    /// Its memories.
    pub memories: Vec<Memory>,
}

impl BlockCost {
    /// A block with multipliers only.
    pub fn new(name: &'static str, modules: &'static [&'static str], multipliers: usize) -> Self {
        Self { name, modules, multipliers, narrow: 0, memories: Vec::new() }
    }

    /// The same where so many of its multipliers have short operands.
    pub fn narrow(self, narrow: usize) -> Self {
        Self { narrow, ..self }
    }

    /// The same with memories.
    pub fn with(mut self, memories: impl IntoIterator<Item = Memory>) -> Self {
        self.memories.extend(memories.into_iter().map(|memory| Memory { block: self.name, ..memory }));
        self
    }
}

/// One block's share.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlockResources {
    /// What the block is called.
    pub name: &'static str,
    /// Its modules in `rtl/`; all that they instantiate counts too.
    pub modules: &'static [&'static str],
    /// DSP blocks of the part: one a multiplier, or two where its operands are too long for one.
    pub dsp: usize,
    /// RAMB36; a RAMB18 counts one half.
    pub bram36: f64,
    /// Its multipliers, whatever the part makes of them.
    #[serde(skip)]
    pub multipliers: usize,
}

/// Predicted resources of a design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Resources {
    /// DSP blocks of the part.
    pub dsp: usize,
    /// Which those are.
    pub dsp_block: DspBlock,
    /// Multipliers, whatever the part makes of them.
    pub multipliers: usize,
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
    /// The sum over the blocks, on a part with such multipliers.
    pub fn of(costs: Vec<BlockCost>, dsp_block: DspBlock) -> Self {
        let mut resources = Self { dsp_block, ..Self::default() };
        for BlockCost { name, modules, multipliers, narrow, memories } in costs {
            // From a positive zero, which the sum of nothing is not.
            let bram36 = memories.iter().fold(0.0, |sum, memory| sum + memory.all_bram36());
            let rom_bits = |memory: &Memory| (memory.count * memory.depth) as u64 * u64::from(memory.width);
            let dsp = dsp_block.count(multipliers, narrow);
            resources.dsp += dsp;
            resources.multipliers += multipliers;
            resources.bram36 += bram36;
            resources.rom_bits += memories.iter().filter(|memory| memory.read_only).map(rom_bits).sum::<u64>();
            resources.memories.extend(memories);
            if dsp > 0 || bram36 > 0.0 {
                resources.blocks.push(BlockResources { name, modules, dsp, bram36, multipliers });
            }
        }
        resources
    }
}
