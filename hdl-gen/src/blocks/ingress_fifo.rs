//! Ingress FIFO of a core whose source has no back-pressure, `sptfra_ingress_fifo`. Other cores have a skid buffer there.

use crate::parameters::Parameters;
use crate::plan::Plan;
use crate::plan::streams::WORD_BITS;
use crate::resources::BlockCost;
use crate::resources::memory::memory;
use crate::timing::buffers::INGRESS_FRAMES;

/// The instance's parameters.
pub fn parameters(plan: &Plan) -> Parameters {
    let streams = plan.streams();
    Parameters::new().count("BEATS", streams.beats_in()).count("WORDS", streams.words())
}

/// The frames that wait, each with room for a beat too many, and for each beat whether it is the last; nothing where the
/// source is held.
pub fn cost(plan: &Plan) -> Option<BlockCost> {
    let streams = plan.streams();
    let depth = INGRESS_FRAMES * (streams.beats_in() + 1);
    let ring = memory("waiting frames", 1, depth, (streams.words() * WORD_BITS + 1) as u32, false);
    streams.drops.then(|| BlockCost::new("Intake", &["sptfra_ingress_fifo"], 0).with([ring]))
}
