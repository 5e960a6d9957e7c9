//! Results to taxels: `sptfra_unfold`.

use crate::parameters::Parameters;
use crate::plan::Plan;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    Parameters::new()
        .count("CHANNELS", plan.channels())
        .count("ELEMENTS", plan.elements())
        .number("DATA_BITS", plan.design.hardware.data_bits.into())
        .number("U_SHIFT", plan.formats.folded.map_or(0, |folded| folded.u.lsb - folded.stress.lsb).into())
}
