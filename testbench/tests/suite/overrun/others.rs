//! Scanners that cannot be held before cores that replace dead taxels behind a curve: a frame is kept before it goes on.

use std::sync::OnceLock;

use golden::design::{Curve, Outputs, Overrun, PlanKind, Samples};
use testbench::stream::Mode;

use super::{Subject, judge, packets, scan, scan_in};
use crate::support::{built, by_plan, in_parallel, planned, shipped, simulate_exactly};

fn subjects() -> &'static [Subject] {
    static SUBJECTS: OnceLock<Vec<Subject>> = OnceLock::new();
    SUBJECTS.get_or_init(|| {
        let mut dead = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants);
        "dead_curved_drops".clone_into(&mut dead.name);
        dead.hardware.overrun = Overrun::Drop;
        dead.input.dead = vec![0, 5, 6];
        dead.input.curve = Some(Curve { points: vec![[0.0, 0.0], [900.0, -2e4], [4095.0, -1e5]], law: None });
        dead.hardware.samples = Samples::Int16;
        dead.hardware.stream_bits = 64;
        let plan = planned(&dead);
        let built = built(&plan);
        vec![Subject { plan, built }]
    })
}

#[test]
fn every_word_is_right_and_no_cycle_more_than_predicted() {
    for Subject { plan, built } in subjects() {
        simulate_exactly(plan, built, &packets(plan, 20), 3)
            .unwrap_or_else(|fault| panic!("{}: {fault}", plan.design.name));
    }
}

/// At the stated interval, that of the worst frame, none is dropped; faster ones are, and cost no other one.
#[test]
fn none_is_dropped_from_the_interval_on() {
    in_parallel(subjects(), |subject| {
        let Subject { plan, .. } = subject;
        let interval = plan.timeline.interval_cycles;
        let mut packets = packets(plan, 90);
        packets.retain(|packet| plan.streams().is_frame(packet.len()));
        for cycles in [interval, interval + interval / 7] {
            let outcome = scan(subject, &packets, cycles);
            judge(plan, &packets, &outcome);
            assert_eq!(outcome.dropped, [], "{}, every {cycles} cycles", plan.design.name);
        }
        for cycles in [0, interval / 3] {
            let outcome = scan(subject, &packets, cycles);
            judge(plan, &packets, &outcome);
            assert_ne!(outcome.dropped, [], "{}, every {cycles} cycles", plan.design.name);
        }
    });
}

#[test]
fn pauses_and_bad_frames_change_nothing_there() {
    let cases: Vec<(&Subject, u64)> =
        subjects().iter().flat_map(|subject| (0..4).map(move |seed| (subject, seed))).collect();
    in_parallel(&cases, |&(subject, seed)| {
        let packets = packets(&subject.plan, 120);
        let mode = Mode::all(seed)[seed as usize % Mode::COUNT];
        let outcome = scan_in(subject, &packets, (seed % 2) * subject.plan.timeline.interval_cycles / 3, &mode);
        judge(&subject.plan, &packets, &outcome);
        assert_ne!(outcome.dropped, [], "{}, {seed}", subject.plan.design.name);
    });
}
