//! Scanners that cannot be held, and cores that drop what they have no room for: every answer is the model's to a frame
//! that was sent, in order, and every frame without one was dropped for want of room and counted.

mod calibrated;
mod others;
mod resets;

use std::sync::OnceLock;

use golden::design::{Design, Outputs, Overrun, PlanKind, Samples};
use hdl_gen::model::{DROPPED, Model};
use hdl_gen::plan::Plan;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::registers::{Controlled, address};
use testbench::stream::{Mode, Outcome, Pacing, Traffic, exchange};
use testbench::verilate::Built;

use crate::support::effort::{half_of, some_of};
use crate::support::{built, by_plan, frames, in_parallel, planned, shipped, simulate_exactly};

/// A design, planned and compiled.
struct Subject {
    plan: Plan,
    built: Built,
}

/// Every sample format and every width, samples taken at once, one by one, and through a calibration in RAM; frames of
/// many beats and of one.
fn subjects() -> &'static [Subject] {
    static SUBJECTS: OnceLock<Vec<Subject>> = OnceLock::new();
    SUBJECTS.get_or_init(|| {
        let small = |name: &str, bits: u32, samples: Samples, kind: PlanKind, outputs: Outputs| {
            let mut design = by_plan(shipped("small"), kind, outputs);
            design.name = format!("{name}_{bits}_drops");
            design.hardware.stream_bits = bits;
            design.hardware.overrun = Overrun::Drop;
            design.hardware.samples = samples;
            if samples != Samples::Float32 {
                design.input.pa_per_count = Some(-12.5);
            }
            design
        };
        let [paper, reduced] = [PlanKind::Paper, PlanKind::Reduced];
        let mut controlled = small("controlled", 64, Samples::Float32, reduced, Outputs::Field);
        controlled.hardware.control = true;
        // A whole frame is one beat.
        let mut beat = small("beat", 128, Samples::Int16, reduced, Outputs::Field);
        beat.sensor.rows = 2;
        let designs = [
            shipped("small-scanner"),
            small("single", 32, Samples::Float32, reduced, Outputs::Field),
            small("paper", 64, Samples::Uint16, paper, Outputs::Field),
            small("whole", 128, Samples::Int16, reduced, Outputs::Resultants),
            controlled,
            beat,
        ];
        in_parallel(&designs, |design: &Design| {
            let plan = planned(design);
            let built = built(&plan);
            Subject { plan, built }
        })
    })
}

/// So many frames, all different, every seventh a beat too long and every ninth too short.
fn packets(plan: &Plan, count: usize) -> Vec<Vec<u32>> {
    let streams = plan.streams();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut packet = |index: usize| {
        let pascals: Vec<f64> =
            frames::contact(plan, &mut random).iter().map(|&word| f64::from(f32::from_bits(word))).collect();
        let value = |(taxel, &pascal)| plan.design.input.from_pa(taxel, pascal);
        let mut packet = if plan.design.input.counts() {
            streams.packet(&pascals.iter().enumerate().map(value).collect::<Vec<_>>())
        } else {
            pascals.iter().map(|&pascal| (pascal as f32).to_bits()).collect()
        };
        if index % 7 == 6 {
            packet.resize(streams.whole_beats(packet.len()) + (index % 3 + 1) * streams.words(), 0x3f80_0000);
        } else if index % 9 == 8 && streams.beats_in() > 1 {
            packet.truncate(streams.words());
        }
        packet
    };
    (0..count).map(&mut packet).collect()
}

/// What came of a scanner that begins a frame every so many cycles, or as soon as the last one has gone.
fn scan(subject: &Subject, packets: &[Vec<u32>], cycles: u64) -> Outcome {
    let [free, ..] = Mode::all(0);
    scan_in(subject, packets, cycles, &free)
}

/// The same with pauses.
fn scan_in(subject: &Subject, packets: &[Vec<u32>], cycles: u64, mode: &Mode) -> Outcome {
    let Subject { plan, built } = subject;
    let pacing = Pacing::Spaced { cycles, inside: usize::MAX };
    let traffic = Traffic::new(packets, timeout(plan)).with_mode(mode).with_pacing(pacing).with_drops();
    let name = &plan.design.name;
    let fail = |error| panic!("{name}, every {cycles} cycles: {error}");
    let core = built.load(3).expect("loads");
    if !plan.design.hardware.control {
        let mut core = core;
        return exchange(&mut core, &traffic, |_| ()).unwrap_or_else(fail);
    }
    let mut core = Controlled::new(core, 3).expect("has a port");
    let outcome = exchange(&mut core, &traffic, |_| ()).unwrap_or_else(fail);
    let counted = [address::FRAMES_IN, address::FRAMES_OUT, address::FRAMES_DROPPED]
        .map(|address| core.read(address).expect("a reply") as usize);
    assert_eq!(counted, [outcome.exchanges.len(), outcome.exchanges.len(), outcome.dropped.len()], "{name}");
    outcome
}

/// Each answer is the model's to a frame that was sent, in order, with the mark of dropped ones where there are some
/// before it; and what was sent was answered or dropped.
fn judge(plan: &Plan, packets: &[Vec<u32>], outcome: &Outcome) {
    let mut model = Model::new(plan);
    let mut next = 0;
    for exchange in &outcome.exchanges {
        let mut expected = model.process(&packets[exchange.packet]);
        expected[0] |= if exchange.packet > next { DROPPED } else { 0 };
        assert_eq!(exchange.words, expected, "{}, packet {}", plan.design.name, exchange.packet);
        next = exchange.packet + 1;
    }
    let mut all: Vec<usize> = outcome.exchanges.iter().map(|exchange| exchange.packet).collect();
    all.extend(outcome.dropped.iter().map(|&(packet, _)| packet));
    all.sort_unstable();
    assert_eq!(all, (0..packets.len()).collect::<Vec<_>>(), "{}", plan.design.name);
}

#[test]
fn nothing_is_lost_of_what_has_room_and_every_cycle_is_right() {
    let wrong = in_parallel(subjects(), |Subject { plan, built }| {
        simulate_exactly(plan, built, &packets(plan, 20), 3)
            .map(drop)
            .map_err(|fault| format!("{}: {fault}", plan.design.name))
    });
    assert_eq!(wrong.into_iter().filter_map(Result::err).collect::<Vec<_>>(), Vec::<String>::new());
}

/// From the interval on none is dropped, however the frames lie; below it some are, and not more than must be.
#[test]
fn frames_are_dropped_from_the_interval_on_and_no_sooner() {
    const FRAMES: usize = 120;
    in_parallel(subjects(), |subject| {
        let plan = &subject.plan;
        let interval = plan.timeline.interval_cycles;
        let mut packets = packets(plan, FRAMES);
        // Bad ones take other times.
        packets.retain(|packet| plan.streams().is_frame(packet.len()));
        let outcome = scan(subject, &packets, interval);
        judge(plan, &packets, &outcome);
        assert_eq!(outcome.dropped, [], "{}", plan.design.name);
        for cycles in [0, interval / 3, interval / 2 + 1, interval - interval / 4] {
            // About forty answers.
            let count = 40 * interval / cycles.max(plan.streams().beats_in() as u64);
            let packets: Vec<Vec<u32>> = packets.iter().cycle().take(count as usize).cloned().collect();
            let outcome = scan(subject, &packets, cycles);
            judge(plan, &packets, &outcome);
            assert_ne!(outcome.dropped, [], "{}, every {cycles} cycles", plan.design.name);
            explained(plan, cycles, &outcome);
        }
    });
}

/// A cycle closer than the interval one is.
#[test]
fn a_frame_is_dropped_a_cycle_below_the_interval() {
    in_parallel(&some_of(subjects()), |subject| {
        let plan = &subject.plan;
        let interval = plan.timeline.interval_cycles;
        // They pile up by a cycle a frame, in the core and before it, until two wait.
        let mut packets = packets(plan, 60);
        packets.retain(|packet| plan.streams().is_frame(packet.len()));
        let packets: Vec<Vec<u32>> = packets.into_iter().cycle().take(8 * interval as usize).collect();
        let outcome = scan(subject, &packets, interval - 1);
        judge(plan, &packets, &outcome);
        assert_ne!(outcome.dropped, [], "{}, a cycle closer than {interval}", plan.design.name);
    });
}

/// The ingress FIFO's decisions against a model of when there is room. While the core is never without work, a frame
/// leaves the FIFO the same number of cycles before its answer ends. With that one number, whatever it is, every decision
/// is the one that two frames in the FIFO give.
fn explained(plan: &Plan, cycles: u64, outcome: &Outcome) {
    // Until every buffer is full frames go faster.
    const FULL: usize = 8;
    let kept = &outcome.exchanges;
    let from = kept[FULL].first_in;
    let begun = kept.iter().map(|kept| (kept.first_in, true)).chain(outcome.dropped.iter().map(|&(_, at)| (at, false)));
    let decisions: Vec<(u64, bool)> = begun.filter(|&(at, _)| at > from).collect();
    // Frames come and leave in one order: those that wait are the ones that have come and not left.
    assert!(kept.is_sorted_by_key(|kept| kept.first_in) && kept.is_sorted_by_key(|kept| kept.last_out));
    let holds = |leaves_before: u64| {
        let wrong = |&&(at, had_room): &&(u64, bool)| {
            let come = kept.partition_point(|kept| kept.first_in < at);
            let left = kept.partition_point(|kept| kept.last_out < at + leaves_before);
            (come.saturating_sub(left) < 2) != had_room
        };
        decisions.iter().filter(wrong).count()
    };
    let longest = kept.iter().map(|kept| kept.last_out - kept.first_in).max().unwrap_or(0);
    let wrong = (0..longest).map(holds).min();
    assert_eq!(wrong, Some(0), "{}, every {cycles} cycles: of {} decisions", plan.design.name, decisions.len());
}

/// Good and bad frames, of a scanner that pauses anywhere, to a sink that does.
#[test]
fn pauses_and_bad_frames_change_nothing() {
    // Either half has a source that pauses and a sink that does.
    let seeds = half_of([1, 0, 3, 2, 5, 4]);
    let cases: Vec<(&Subject, u64)> =
        subjects().iter().flat_map(|subject| seeds.iter().map(move |&seed| (subject, seed))).collect();
    in_parallel(&cases, |&(subject, seed)| {
        let interval = subject.plan.timeline.interval_cycles;
        let packets = packets(&subject.plan, 150);
        let mode = Mode::all(seed)[seed as usize % Mode::COUNT];
        let outcome = scan_in(subject, &packets, (seed % 3) * interval / 3, &mode);
        judge(&subject.plan, &packets, &outcome);
        assert_ne!(outcome.dropped, [], "{}, {seed}", subject.plan.design.name);
    });
}
