//! Whose turn the lanes are: `sptfra_turns`.

use golden::design::Optimise;

use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::timing::places::places;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    Parameters::new()
        .count("PROGRAMS", plan.schedule.programs.len())
        .count("RESIDUALS", plan.operands.residuals())
        .count("PLACES", places(plan.has_field(), plan.ways() > 1).unwrap_or(0))
        .flag("INTERVAL", plan.design.hardware.optimise != Optimise::Latency)
}
