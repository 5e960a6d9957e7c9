//! Resets at any moment.

use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::stream::{Mode, Pacing, Pattern, Reset, Traffic};

use crate::support::effort::some_of;
use crate::support::in_parallel;

use super::{LONG_FRAME, Subject, good, judge, long, mixed, subjects};

/// Every so many cycles of a frame are tried.
fn step(plan: &Plan) -> usize {
    1 + 2 * (plan.timeline.latency_cycles / LONG_FRAME) as usize
}

/// Resets of one simulation. After a reset the core is a new one, so that each run begins where the one before has ended.
const CHAIN: usize = 24;

/// Every design with the moments of its trials, so many cycles apart, in chains.
fn chains(cycles: impl Fn(&Plan) -> u64, every: usize) -> Vec<(&'static Subject, Vec<u64>)> {
    let chains = |subject: &'static Subject| {
        let moments = some_of((0..cycles(&subject.plan)).step_by(every * step(&subject.plan)));
        moments.chunks(CHAIN).map(|chain| (subject, chain.to_vec())).collect::<Vec<_>>()
    };
    subjects().iter().flat_map(chains).collect()
}

/// Resets, each so many cycles and a moment of its own after the one before.
fn resets(gap: u64, moments: &[u64], length: impl Fn(u64) -> u64) -> Vec<Reset> {
    let mut cycle = 0;
    let mut reset = |&moment: &u64| {
        let reset = Reset { cycle: cycle + gap + moment, length: length(moment) };
        cycle = reset.cycle + reset.length;
        reset
    };
    moments.iter().map(&mut reset).collect()
}

/// Runs a chain: of each reset, how many packets were answered before it and how many it has cost.
fn judged(subject: &Subject, traffic: &Traffic<'_>) -> Vec<(usize, usize)> {
    let resets = traffic.resets;
    let outcome = subject.run(traffic).unwrap_or_else(|error| panic!("{resets:?}: {error}"));
    assert_eq!(outcome.resumed.len(), resets.len(), "every reset took place");
    let counts = judge(&subject.plan, traffic.packets, &outcome);
    counts[..resets.len()].to_vec()
}

/// So many packets with an answer to every question; one comes again only when no place inside can still have it.
fn some_good(plan: &Plan, seed: u64, count: usize) -> Vec<Vec<u32>> {
    const DIFFERENT: usize = 11;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let some: Vec<Vec<u32>> = (0..DIFFERENT).map(|_| good(plan, &mut random)).collect();
    some.into_iter().cycle().take(count).collect()
}

/// Two frames have their answers, then the reset, from the last beats of the second to those of a third.
#[test]
fn a_reset_in_any_cycle_of_a_frame_leaves_no_trace() {
    let chains = chains(|plan| plan.timeline.latency_cycles + 16, 1);
    let counts = in_parallel(&chains, |(subject, moments)| {
        let plan = &subject.plan;
        // Three for each reset; behind the last moments a fourth has begun.
        let packets = some_good(plan, 3, 3 * moments.len() + 16);
        let resets = resets(2 * plan.timeline.latency_cycles, moments, |moment| 1 + moment % 3);
        let alone = subject.traffic(&packets).with_resets(&resets).with_pacing(Pacing::OneAtATime);
        judged(subject, &alone)
    });
    let counts = counts.concat();
    assert!(counts.iter().all(|&(answered, lost)| answered >= 1 && lost <= 1), "{counts:?}");
    let cut = counts.iter().filter(|&&count| count == (2, 1)).count();
    assert!(10 * cut >= 9 * counts.len(), "resets come while the third frame is inside: {counts:?}");
}

/// One interval in which a frame comes in, others are worked on and one goes out, every second cycle.
#[test]
fn a_reset_while_frames_overlap_leaves_no_trace() {
    let chains = chains(|plan| plan.timeline.interval_cycles + 2, 2);
    in_parallel(&chains, |(subject, moments)| {
        let plan = &subject.plan;
        let interval = plan.timeline.interval_cycles;
        let resets = resets(plan.timeline.latency_cycles + 5 * interval, moments, |_| 1);
        let end = resets.last().expect("a chain has a moment").cycle;
        // What comes out until the last reset, what each one finds inside, and some behind the last.
        let packets = some_good(plan, 4, (end / interval) as usize + 4 * resets.len() + 8);
        let counts = judged(subject, &subject.traffic(&packets).with_resets(&resets));
        assert!(counts.iter().all(|&(answered, lost)| answered >= 4 && lost >= 1), "{counts:?}");
    });
}

/// Intervals of traffic in front of each reset: frames come out after the reset before, and pile up again.
const PILING_UP: u64 = 24;

/// Packets for each reset: about as many as that time takes.
const PACKETS_A_RESET: usize = 12;

/// The sink stands still for so long that every place inside is taken, then a reset.
#[test]
fn a_reset_while_frames_pile_up_leaves_no_trace() {
    let chains = chains(|plan| 2 * plan.timeline.interval_cycles, 11);
    let counts = in_parallel(&chains, |(subject, moments)| {
        let plan = &subject.plan;
        let interval = plan.timeline.interval_cycles;
        let packets = some_good(plan, 6, PACKETS_A_RESET * (moments.len() + 1));
        let resets = resets(PILING_UP * interval, moments, |_| 1);
        let sink = Pattern::Bursts {
            seed: 5,
            longest_run: 3 * plan.streams().beats_out() as u32,
            longest_pause: 12 * interval as u32,
        };
        let mode = Mode { name: "sink that stands still", source: Pattern::Free, sink };
        judged(subject, &Traffic::new(&packets, 8 * timeout(plan)).with_resets(&resets).with_mode(&mode))
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
        let packets = mixed(&subject.plan, long(), &mut random);
        let interval = subject.plan.timeline.interval_cycles;
        // Late enough after one another that some frames are answered, and not in the last packets.
        let mut cycle = 0;
        let resets: Vec<Reset> = (0..long() / 24)
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
