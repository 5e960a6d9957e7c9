//! Co, the sums over the frame and what the lanes multiply again: `sptfra_co`.

use golden::parity::COMPONENTS;

use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::product::Vector;
use crate::plan::vector_formats::ARM_BITS;
use crate::resources::BlockCost;
use crate::resources::memory::memory;

use super::place;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let folded = [Vector::Residual(0), Vector::Residual(1), Vector::Residual(2), Vector::Explained];
    let taxels = [Vector::G(3, 0), Vector::G(3, 1), Vector::G(3, 2)];
    let stored = if plan.channels() > 1 { &folded[..] } else { &taxels };
    let mut bases: Vec<(u64, String)> =
        stored.iter().map(|&vector| (place(plan, vector).0 as u64, vector.name())).collect();
    let mut in_bank: Vec<bool> = stored.iter().map(|&vector| place(plan, vector).1).collect();
    bases.resize(folded.len(), (0, String::new()));
    in_bank.resize(folded.len(), false);
    Parameters::new()
        .count("CHANNELS", plan.channels())
        .count("ELEMENTS", plan.elements())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .count("OPERAND_DEPTH", plan.operands.words())
        .table("STORE_BASES", 16, &bases)
        .mask("STORE_IN_BANK", &in_bank)
        .signed("RESIDUAL_BANK", 16, plan.operands.residual_bank() as i64)
        .when(!plan.arms.is_empty(), |all| all.outer("ROM_DIR").text("ROM_NAME", &plan.design.name))
}

/// Where sums of torques are made of taxels' forces, a multiplier for each of a taxel's arms.
pub fn cost(plan: &Plan) -> BlockCost {
    let (data, taxels) = (plan.design.hardware.data_bits, plan.taxels());
    let narrow = plan.factors().element_is_narrow();
    let block = |multipliers| {
        BlockCost::new("Co", &["sptfra_co", "sptfra_unfold"], multipliers).narrow(if narrow { multipliers } else { 0 })
    };
    if plan.channels() > 1 {
        let folded = 2 * plan.elements().next_power_of_two();
        return block(0).with([memory("folded b", 1, folded, COMPONENTS as u32 * data, false)]);
    }
    block(2).with([memory("A_p b", 1, 3 * taxels, data, false), memory("arms", 1, taxels, 2 * ARM_BITS, true)])
}
