//! An estimate of a frame's energy, from counted operations. **Nothing of it was measured.**
//!
//! Products of the lanes are counted (all of them, where zeros may be skipped); of all else one thing a cycle is taken, at
//! the full rate of frames: much for a multiplier, which rests between frames, little for a memory that is read and
//! written at once. What an operation takes on a chip of 45 nm at 0.9 V is from
//! Horowitz, "Computing's energy problem", ISSCC 2014. An FPGA takes some 14 times the dynamic energy of a chip of the
//! same generation, less with hard blocks: Kuon and Rose, "Measuring the gap between FPGAs and ASICs", IEEE TCAD 26(2),
//! 2007. Adders in LUTs, registers, clock and wires have no count of their own; static power is not in it.

use serde::Serialize;

use super::Plan;

/// Product of 32 x 32 bits, pJ.
const PRODUCT_PJ: f64 = 3.1;
/// Sum of 32 bits, pJ.
const SUM_PJ: f64 = 0.1;
/// Access of 64 bits to a memory of 8 KB, pJ.
const ACCESS_PJ: f64 = 10.0;
/// Bits of those.
const OPERATION_BITS: f64 = 32.0;
const ACCESS_BITS: f64 = 64.0;
/// An FPGA's dynamic energy over that of a chip.
const FABRIC: f64 = 14.0;
/// The module of the lanes.
const LANES: &str = "sptfra_spmv_array";

/// What a frame takes, estimated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Energy {
    /// Products that the lanes form in a frame.
    pub lane_products: u64,
    /// Those of all other blocks, one a multiplier and cycle.
    pub other_products: u64,
    /// Bits that memories read or take, one access a cycle.
    pub memory_bits: u64,
    /// Of these operations on a chip of 45 nm, in nJ.
    pub chip_nj: f64,
    /// The same on an FPGA, in nJ.
    pub fabric_nj: f64,
}

impl Energy {
    /// Of a design's frames at its full rate.
    pub fn of(plan: &Plan) -> Self {
        let (resources, cycles) = (&plan.resources, plan.timeline.interval_cycles);
        let lanes =
            resources.blocks.iter().find(|block| block.modules.contains(&LANES)).map_or(0, |block| block.multipliers);
        let width: u64 = resources.memories.iter().map(|memory| memory.count as u64 * u64::from(memory.width)).sum();
        let lane_products = plan.macs();
        let other_products = (resources.multipliers - lanes) as u64 * cycles;
        let memory_bits = width * cycles;
        let hardware = &plan.design.hardware;
        let area = f64::from(hardware.coefficient_bits) * f64::from(hardware.data_bits) / OPERATION_BITS.powi(2);
        let product = PRODUCT_PJ * area + SUM_PJ * f64::from(crate::cores::ACCUMULATOR_BITS) / OPERATION_BITS;
        let picojoules =
            product * (lane_products + other_products) as f64 + ACCESS_PJ / ACCESS_BITS * memory_bits as f64;
        let chip_nj = rounded(picojoules / 1e3);
        Self { lane_products, other_products, memory_bits, chip_nj, fabric_nj: rounded(FABRIC * picojoules / 1e3) }
    }

    /// Dynamic power at so many frames a second, in W.
    pub fn watts(&self, frames_per_second: f64) -> f64 {
        self.fabric_nj * frames_per_second / 1e9
    }
}

/// To a tenth: an estimate has no more.
fn rounded(nanojoules: f64) -> f64 {
    (nanojoules * 10.0).round() / 10.0
}
