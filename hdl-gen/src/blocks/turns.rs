//! Whose turn the lanes are: `sptfra_turns`.

use golden::design::Optimise;

use crate::plan::Plan;

use super::Parameters;

/// Frames whose weights are kept for the output where the lanes put the field together.
pub const WEIGHT_PLACES: usize = 4;
/// Frames whose field has a place.
pub const FIELD_PLACES: usize = 2;

/// Frames that have a place from their start until they have left; none is needed where nothing of a frame stays.
pub fn places(field: bool, folded: bool) -> Option<usize> {
    field.then_some(if folded { WEIGHT_PLACES } else { FIELD_PLACES })
}

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    Parameters::new()
        .count("PROGRAMS", plan.schedule.programs.len())
        .count("PLACES", places(plan.field_words() > 0, plan.ways() > 1).unwrap_or(0))
        .flag("INTERVAL", plan.design.hardware.optimise == Optimise::Interval)
}
