//! We, the weights: `sptfra_we`.

use crate::plan::Plan;
use crate::plan::format::address_bits;
use crate::plan::memory::memory;
use crate::plan::product::Vector;
use crate::plan::resources::BlockCost;

use super::{Parameters, place};

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let weight = plan.formats.weight;
    Parameters::new()
        .count("WAYS", plan.ways())
        .count("ELEMENTS", plan.elements())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .number("FOLD_SHIFT", plan.formats.folded.map_or(0, |folded| folded.weight.lsb - weight.lsb).into())
        .count("OPERAND_DEPTH", plan.operands.words())
        .count("WEIGHT_BASE", place(plan, Vector::Weight).0)
        .flag("SKIPS", plan.design.hardware.skip_zeros)
}

/// No multiplier; the lists of quads that are not zero, where zeros are passed over.
pub fn cost(plan: &Plan) -> BlockCost {
    let elements = plan.elements();
    let skips = plan.ways() > 1 && plan.design.hardware.skip_zeros;
    let nonzeros = skips.then(|| memory("nonzeros", 2, elements, address_bits(elements), false));
    BlockCost::new("We", &["sptfra_we"], 0).with(nonzeros)
}
