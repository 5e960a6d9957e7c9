//! Co, the sums over the frame and what the lanes multiply again: `sptfra_co`.

use crate::plan::Plan;
use crate::plan::product::Vector;

use super::{Parameters, place};

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let folded = [Vector::Residual(0), Vector::Residual(1), Vector::Residual(2), Vector::Explained];
    let taxels = [Vector::G(3, 0), Vector::G(3, 1), Vector::G(3, 2)];
    let stored = if plan.ways() > 1 { &folded[..] } else { &taxels };
    let mut bases: Vec<(u64, String)> =
        stored.iter().map(|&vector| (place(plan, vector).0 as u64, vector.name())).collect();
    let mut in_bank: Vec<bool> = stored.iter().map(|&vector| place(plan, vector).1).collect();
    bases.resize(folded.len(), (0, String::new()));
    in_bank.resize(folded.len(), false);
    let parameters = Parameters::new()
        .count("WAYS", plan.ways())
        .count("ELEMENTS", plan.elements())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .count("OPERAND_DEPTH", plan.operands.words())
        .table("STORE_BASES", 16, &bases)
        .mask("STORE_IN_BANK", &in_bank);
    if plan.arms.is_empty() {
        return parameters;
    }
    parameters.expression("ROM_DIR", "ROM_DIR").expression("ROM_NAME", format!("\"{}\"", plan.design.name))
}
