//! What comes out between resets.

use hdl_gen::model::{DROPPED, Model};
use hdl_gen::plan::Plan;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::stream::{Outcome, Reset, Traffic, exchange};
use testbench::verilate::Built;

use super::frames;

/// Whether each answer is the model's, which begins anew with each reset and knows nothing of what was dropped.
///
/// # Errors
/// The packet with another answer.
pub fn judged(plan: &Plan, packets: &[Vec<u32>], outcome: &Outcome) -> Result<(), String> {
    for (sent, exchanges) in outcome.between_resets(packets.len()) {
        let (mut model, mut next) = (Model::new(plan), sent.start);
        for exchange in exchanges {
            let mut expected = model.process(&packets[exchange.packet]);
            if plan.streams().drops && exchange.packet > next {
                expected[0] |= DROPPED;
            }
            next = exchange.packet + 1;
            if exchange.words != expected {
                return Err(format!("{}: packet {}, {:?}", plan.design.name, exchange.packet, outcome.resumed));
            }
        }
    }
    Ok(())
}

/// Resets of one cycle, in each cycle of an interval once.
///
/// # Errors
/// A rule of the stream that is broken, or a packet with another answer than the model's.
pub fn in_each_cycle(plan: &Plan, built: &Built) -> Result<(), String> {
    let interval = plan.timeline.interval_cycles;
    let mut random = ChaCha8Rng::seed_from_u64(11);
    // A core that has been reset begins anew: moments count from the reset before. Each gap holds a whole answer.
    let gap = plan.timeline.latency_cycles + 2 * interval;
    // Beside what is answered, a reset loses what waits.
    let packets = interval * (gap / interval + 8);
    let sent: Vec<_> = (0..packets).map(|_| frames::contact(plan, &mut random)).collect();
    let moments = (0..interval).scan(0, |cycle, moment| {
        *cycle += gap + moment;
        Some(*cycle)
    });
    let resets: Vec<Reset> = moments.map(|cycle| Reset { cycle, length: 1 }).collect();
    let traffic = Traffic::new(&sent, 8 * timeout(plan)).with_resets(&resets);
    let outcome = exchange(&mut built.load(5).expect("loads"), &traffic, |_| ()).map_err(|error| error.to_string())?;
    assert_eq!(outcome.resumed.len(), resets.len(), "every reset took place");
    let mut between = outcome.between_resets(sent.len());
    assert!(between.all(|(_, exchanges)| !exchanges.is_empty()), "a frame between all resets");
    judged(plan, &sent, &outcome)
}
