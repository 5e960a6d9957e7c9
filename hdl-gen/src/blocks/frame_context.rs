//! Frame-context FIFO, `sptfra_frame_context`: what a frame carries beside its numbers.

use crate::parameters::Parameters;
use crate::plan::Plan;

/// The instance's parameters: which fields contexts hold beside the timestamp.
pub fn parameters(plan: &Plan) -> Parameters {
    let fields = [
        ("DROPS", plan.streams().drops),
        ("CALIBRATED", plan.calibration.is_some()),
        ("SCALED", plan.scales_frames()),
        ("AVERAGED", plan.thresholds.error.is_some_and(|error| error.averaged)),
    ];
    fields.into_iter().fold(Parameters::new(), |all, (name, there)| all.when(there, |all| all.flag(name, true)))
}
