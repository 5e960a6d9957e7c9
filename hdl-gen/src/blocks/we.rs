//! We, the weights: `sptfra_we`.

use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::product::Vector;
use crate::resources::BlockCost;

use super::place;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let weight = plan.formats.weight;
    Parameters::new()
        .count("CHANNELS", plan.channels())
        .count("ELEMENTS", plan.elements())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .number("FOLD_SHIFT", plan.formats.folded.map_or(0, |folded| folded.weight.lsb - weight.lsb).into())
        .count("OPERAND_DEPTH", plan.operands.words())
        .count("WEIGHT_BASE", place(plan, Vector::Weight).0)
}

/// No multiplier, no memory.
pub fn cost() -> BlockCost {
    BlockCost::new("We", &["sptfra_we"], 0)
}
