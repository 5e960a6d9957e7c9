//! Program scheduler of the lanes: `sptfra_program_scheduler`.

use golden::design::Optimise;

use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::timing::buffers::buffers;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    Parameters::new()
        .count("PROGRAMS", plan.schedule.programs.len())
        .count("RESIDUALS", plan.operands.residuals())
        .count("BUFFERS", buffers(plan.has_field(), plan.channels() > 1).unwrap_or(0))
        .flag("INTERVAL", plan.design.hardware.optimise != Optimise::Latency)
}
