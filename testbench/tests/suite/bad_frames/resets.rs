//! Resets at any moment.

use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::stream::{Mode, Pacing, Pattern, Reset, Traffic};
use testbench::trial::timeout;

use crate::support::in_parallel;

use super::{LONG, LONG_FRAME, Subject, good, judge, mixed, subjects};

/// Every so many cycles of a frame are tried.
fn step(plan: &Plan) -> usize {
    1 + 2 * (plan.timeline.latency_cycles / LONG_FRAME) as usize
}

/// Every pair of a design and one of so many cycles.
fn with_each_cycle(cycles: impl Fn(&Plan) -> std::ops::Range<u64>, every: usize) -> Vec<(&'static Subject, u64)> {
    subjects()
        .iter()
        .flat_map(|subject| {
            cycles(&subject.plan).step_by(every * step(&subject.plan)).map(move |cycle| (subject, cycle))
        })
        .collect()
}

#[test]
fn a_reset_in_any_cycle_of_a_frame_leaves_no_trace() {
    // From before the first beat of the first frame to the first beats of the second.
    let cases = with_each_cycle(|plan| 0..plan.timeline.latency_cycles + 10, 1);
    in_parallel(&cases, |&(subject, cycle)| {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let packets = [0; 3].map(|_| good(&subject.plan, &mut random));
        let resets = [Reset { cycle, length: 1 + cycle % 3 }];
        let alone = subject.traffic(&packets).with_resets(&resets).with_pacing(Pacing::OneAtATime);
        let outcome = subject.run(&alone).unwrap_or_else(|error| panic!("{resets:?}: {error}"));
        judge(&subject.plan, &packets, &outcome);
    });
}

#[test]
fn a_reset_while_frames_overlap_leaves_no_trace() {
    // One interval in which a frame comes in, others are worked on and one goes out, every second cycle.
    let interval = |plan: &Plan| {
        let begin = plan.timeline.latency_cycles + plan.timeline.interval_cycles;
        begin..begin + plan.timeline.interval_cycles + 2
    };
    let cases = with_each_cycle(interval, 2);
    in_parallel(&cases, |&(subject, cycle)| {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let packets: Vec<Vec<u32>> = (0..10).map(|_| good(&subject.plan, &mut random)).collect();
        let resets = [Reset { cycle, length: 1 }];
        let traffic = subject.traffic(&packets).with_resets(&resets);
        let outcome = subject.run(&traffic).unwrap_or_else(|error| panic!("{resets:?}: {error}"));
        judge(&subject.plan, &packets, &outcome);
    });
}

/// Intervals of traffic in front of each reset: frames come out after the reset before, and pile up again.
const PILING_UP: u64 = 24;

/// Packets for each reset: about as many as that time takes.
const PACKETS_A_RESET: usize = 12;

/// Resets of one simulation.
const CHAIN: usize = 24;

/// The sink stands still for so long that every place inside is taken, then a reset. After a reset the core is a new
/// one, so that the next trial begins where the one before has ended.
#[test]
fn a_reset_while_frames_pile_up_leaves_no_trace() {
    let offsets = |subject: &Subject| (0..2 * subject.plan.timeline.interval_cycles).step_by(11 * step(&subject.plan));
    let chains: Vec<(&Subject, Vec<u64>)> = subjects()
        .iter()
        .flat_map(|subject| {
            let offsets: Vec<u64> = offsets(subject).collect();
            offsets.chunks(CHAIN).map(|chain| (subject, chain.to_vec())).collect::<Vec<_>>()
        })
        .collect();
    let counts = in_parallel(&chains, |(subject, offsets)| {
        let plan = &subject.plan;
        let mut random = ChaCha8Rng::seed_from_u64(6);
        let some: Vec<Vec<u32>> = (0..20).map(|_| good(plan, &mut random)).collect();
        let packets: Vec<Vec<u32>> = some.into_iter().cycle().take(PACKETS_A_RESET * (offsets.len() + 1)).collect();
        let interval = plan.timeline.interval_cycles;
        let mut cycle = 0;
        let resets: Vec<Reset> = offsets
            .iter()
            .map(|offset| {
                cycle += PILING_UP * interval + offset;
                Reset { cycle, length: 1 }
            })
            .collect();
        let sink = Pattern::Bursts {
            seed: 5,
            longest_run: 3 * plan.streams().beats_out() as u32,
            longest_pause: 12 * interval as u32,
        };
        let mode = Mode { name: "sink that stands still", source: Pattern::Free, sink };
        let traffic = Traffic::new(&packets, 8 * timeout(plan)).with_resets(&resets).with_mode(&mode);
        let outcome = subject.run(&traffic).unwrap_or_else(|error| panic!("{resets:?}: {error}"));
        assert!(outcome.cycles > cycle, "every reset took place");
        let counts = judge(plan, &packets, &outcome);
        counts[..resets.len()].to_vec()
    });
    // For how long the sink stands still is drawn anew each time: this is true of most resets, not of each chain.
    let counts = counts.concat();
    let share = |wanted: &dyn Fn(&(usize, usize)) -> bool| {
        counts.iter().filter(|&count| wanted(count)).count() as f64 / counts.len() as f64
    };
    assert!(share(&|&(answered, _)| answered > 0) >= 0.9, "resets are judged by what comes between them: {counts:?}");
    assert!(share(&|&(_, lost)| lost >= 4) >= 0.8, "resets come while frames have piled up: {counts:?}");
}

#[test]
fn resets_among_mixed_frames_cost_the_frames_inside() {
    in_parallel(subjects(), |subject| {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let packets = mixed(&subject.plan, LONG, &mut random);
        let interval = subject.plan.timeline.interval_cycles;
        // Late enough after one another that some frames are answered, and not in the last packets.
        let mut cycle = 0;
        let resets: Vec<Reset> = (0..LONG / 24)
            .map(|_| {
                cycle += random.random_range(interval..12 * interval);
                Reset { cycle, length: random.random_range(1..20) }
            })
            .collect();
        let mode = Mode::all(12)[3];
        let outcome = subject.run(&subject.traffic(&packets).with_resets(&resets).with_mode(&mode));
        let outcome = outcome.expect("no rule is broken");
        assert!(outcome.cycles > cycle, "every reset took place");
        judge(&subject.plan, &packets, &outcome);
    });
}
