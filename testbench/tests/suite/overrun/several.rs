//! Frames of one body and of several, mixed: those take many times as long, and what has no room meanwhile is dropped.

use golden::design::{Overrun, Slip};
use hdl_gen::plan::words;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::stream::Mode;

use super::{Subject, judge, scan, scan_in};
use crate::support::effort::half_of;
use crate::support::{built, in_parallel, planned, shipped};
use crate::told_apart;

/// With registers, which count what is dropped, and by itself; a wide stream and one of a word; bodies that slip by the frame
/// before, be it that the one in between was dropped.
fn subjects() -> Vec<Subject> {
    let mut designs = [shipped("small-bodies"), shipped("small-bodies")];
    for (design, control) in designs.iter_mut().zip([true, false]) {
        design.name = format!("several_dropped{}", if control { "_controlled" } else { "" });
        design.hardware.overrun = Overrun::Drop;
        design.hardware.control = control;
        design.hardware.stream_bits = if control { 64 } else { 32 };
        design.algorithm.slip = Some(Slip { limit: 0.3, hysteresis: 0.2 });
    }
    in_parallel(&designs, |design| {
        let plan = planned(design);
        let built = built(&plan);
        Subject { plan, built }
    })
}

#[test]
fn frames_of_several_bodies_find_room_or_are_dropped_whole() {
    let subjects = subjects();
    let cases: Vec<(&Subject, u64)> = subjects
        .iter()
        .flat_map(|subject| half_of([0, 1, 3, 2]).into_iter().map(move |seed| (subject, seed)))
        .collect();
    in_parallel(&cases, |&(subject, seed)| {
        let plan = &subject.plan;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let packets: Vec<Vec<u32>> = (0..12).flat_map(|_| told_apart::packets(plan, &mut random)).collect();
        let interval = plan.timeline.interval_cycles;
        let mode = Mode::all(seed)[seed as usize % Mode::COUNT];
        let mut answered = [0, 0];
        for cycles in [interval / 2, 2 * interval, 4 * interval] {
            let outcome = scan_in(subject, &packets, cycles, &mode);
            judge(plan, &packets, &outcome);
            assert!(!outcome.dropped.is_empty(), "every {cycles} cycles");
            for exchange in &outcome.exchanges {
                match exchange.words[words::CENSUS] & 0xFF {
                    0 => {}
                    bodies => answered[usize::from(bodies > 1)] += 1,
                }
            }
        }
        assert!(answered.iter().all(|&answered| answered > 10), "{answered:?}");
    });
}

/// Of one body none is dropped from the interval on that is stated, as without the records.
#[test]
fn frames_of_one_body_are_dropped_below_the_interval_alone() {
    in_parallel(&subjects(), |subject| {
        let plan = &subject.plan;
        let packets = vec![told_apart::blocks(plan, 1, 1).concat(); 60];
        let interval = plan.timeline.interval_cycles;
        for (cycles, drops) in [(interval, false), (interval - interval / 5, true)] {
            let outcome = scan(subject, &packets, cycles);
            judge(plan, &packets, &outcome);
            assert_eq!(!outcome.dropped.is_empty(), drops, "every {cycles} of {interval} cycles");
        }
    });
}
