//! Frames that a source should not send, and resets at any moment: each costs its own frame and no other.

mod support;

use std::sync::OnceLock;

use hdl_gen::model::{
    AT_BOUND, BAD_LENGTH, DIRECTION_UNKNOWN, Model, NO_CONTACT, NOT_FINITE, SATURATED, SUMMARY_WORDS,
};
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use support::{built, frames, in_parallel, planned, shipped};
use testbench::compare::Comparison;
use testbench::run::timeout;
use testbench::stream::{INITIAL_RESET, Mode, Outcome, Pacing, Pattern, Reset, Traffic, exchange};
use testbench::verilate::Built;
use testbench::words::{Answer, decode, encode};

const LONG: usize = 2000;

/// The small design, planned and compiled once.
fn small() -> &'static (Plan, Built) {
    static SMALL: OnceLock<(Plan, Built)> = OnceLock::new();
    SMALL.get_or_init(|| {
        let plan = planned(&shipped("small"));
        let built = built(&plan);
        (plan, built)
    })
}

fn run(traffic: &Traffic<'_>) -> Result<Outcome, String> {
    let mut core = small().1.load(7).map_err(|error| error.to_string())?;
    exchange(&mut core, traffic, |_| ()).map_err(|error| error.to_string())
}

fn traffic(packets: &[Vec<u32>]) -> Traffic<'_> {
    Traffic::new(packets, timeout(&small().0))
}

/// The answers in order, if each packet has one.
fn answers(packets: &[Vec<u32>], mode: &Mode) -> Vec<Vec<u32>> {
    let outcome = run(&traffic(packets).with_mode(mode)).expect(mode.name);
    assert_eq!(outcome.exchanges.len(), packets.len(), "{}", mode.name);
    outcome.exchanges.into_iter().map(|exchange| exchange.words).collect()
}

/// One answer to a packet sent to a core just out of reset.
fn answer(packet: &[u32]) -> Vec<u32> {
    answers(&[packet.to_vec()], &Mode::all(1)[0]).remove(0)
}

fn read(words: &[u32]) -> Answer {
    decode(words).expect("a whole frame")
}

/// A contact that is dragged, with an answer to every question.
fn good(random: &mut ChaCha8Rng) -> Vec<u32> {
    let plan = &small().0;
    loop {
        let packet = frames::contact(plan, random);
        if Model::new(plan).process(&packet)[0] == 0 {
            return packet;
        }
    }
}

/// The ways a packet can be bad, from a good one; with the status that must come of each.
fn bad(good: &[u32]) -> Vec<(&'static str, Vec<u32>, u32)> {
    let with = |taxel: usize, value: f32| {
        let mut packet = good.to_vec();
        packet[taxel] = value.to_bits();
        packet
    };
    let of_length = |length: usize| good.iter().copied().cycle().take(length).collect::<Vec<u32>>();
    let taxels = good.len();
    let mut late_nan = of_length(taxels + 1);
    late_nan[taxels] = f32::NAN.to_bits();
    let mut early_nan = of_length(taxels - 1);
    early_nan[0] = f32::NAN.to_bits();
    vec![
        ("NaN in the first word", with(0, f32::NAN), NOT_FINITE),
        ("NaN in the last word", with(taxels - 1, -f32::NAN), NOT_FINITE),
        ("+infinity", with(taxels / 2, f32::INFINITY), NOT_FINITE),
        ("-infinity", with(1, f32::NEG_INFINITY), NOT_FINITE),
        ("signalling NaN", with(2, f32::from_bits(0x7F80_0001)), NOT_FINITE),
        ("NaN everywhere", vec![f32::NAN.to_bits(); taxels], NOT_FINITE),
        ("TLAST on the first beat", of_length(1), BAD_LENGTH),
        ("TLAST on the second beat", of_length(2), BAD_LENGTH),
        ("TLAST one beat early", of_length(taxels - 1), BAD_LENGTH),
        ("TLAST one beat late", of_length(taxels + 1), BAD_LENGTH),
        ("TLAST two beats late", of_length(taxels + 2), BAD_LENGTH),
        ("three frames in one", of_length(3 * taxels), BAD_LENGTH),
        ("a NaN beyond the frame", late_nan, BAD_LENGTH),
        ("a NaN in a short frame", early_nan, BAD_LENGTH | NOT_FINITE),
    ]
}

#[test]
fn a_bad_frame_costs_that_frame_only() {
    let plan = &small().0;
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for mode in Mode::all(5) {
        let mut packets = Vec::new();
        let mut names = Vec::new();
        for (name, packet, status) in bad(&good(&mut random)) {
            packets.extend([packet, good(&mut random)]);
            names.extend([(name, status), (name, 0)]);
        }
        let answers = answers(&packets, &mode);
        for (counter, (words, (name, status))) in (0..).zip(answers.iter().zip(names)) {
            let case = format!("{}, {name}, frame {counter}", mode.name);
            assert_eq!(words[0], counter << 16 | status, "{case}");
            if status != 0 {
                assert_eq!(words[1..], vec![0; SUMMARY_WORDS - 1 + 3 * plan.taxels()], "{case}");
                continue;
            }
            // Alone after a reset, the good frame has the same answer.
            let mut alone = Model::new(plan).process(&packets[counter as usize]);
            alone[0] |= counter << 16;
            assert_eq!(*words, alone, "{case}");
        }
    }
}

#[test]
fn nothing_pressed_is_no_contact() {
    let taxels = small().0.taxels();
    let quiet = [0.0, -0.0, 0.9, -0.9].map(|pascal| encode(&vec![pascal; taxels]));
    for packet in quiet {
        let words = answer(&packet);
        assert_eq!(words[0], NO_CONTACT);
        assert!(words[1..].iter().all(|&word| word == 0));
    }
    assert_eq!(answer(&encode(&vec![-2.0; taxels]))[0] & NO_CONTACT, 0, "twice the noise floor is a contact");
}

#[test]
fn pressing_straight_down_has_no_direction() {
    let taxels = small().0.taxels();
    let stress: Vec<f64> = (0..taxels).map(|taxel| -1000.0 - 100.0 * (taxel % 5) as f64).collect();
    for sign in [1.0, -1.0] {
        let words = answer(&encode(&stress.iter().map(|value| sign * value).collect::<Vec<_>>()));
        assert_eq!(words[0], DIRECTION_UNKNOWN, "one sign everywhere");
        let answer = read(&words);
        assert_eq!(answer.mu_xy.map(f64::to_bits), [0, 0]);
        assert!(answer.field.iter().flatten().any(|&force| force != 0.0), "the forces of pressing are there");
    }
    assert!(read(&answer(&encode(&stress))).resultant[2] < 0.0, "compression presses");
}

#[test]
fn beyond_the_full_scale_is_the_full_scale_and_is_said() {
    let full_scale = small().0.design.hardware.full_scale_pa;
    let mut clamped = vec![-0.3 * full_scale; small().0.taxels()];
    clamped[2] = full_scale;
    clamped[5] = -full_scale;
    let mut beyond = clamped.clone();
    beyond[2] = 1.5 * full_scale;
    beyond[5] = -f64::from(f32::MAX);
    let (clamped, beyond) = (answer(&encode(&clamped)), answer(&encode(&beyond)));
    assert_eq!(clamped[0] & SATURATED, 0);
    assert_eq!(beyond[0], clamped[0] | SATURATED);
    assert_eq!(beyond[1..], clamped[1..]);
}

/// Frames of every kind, at random.
fn mixed(count: usize, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let plan = &small().0;
    let extremes = frames::extremes(plan, random);
    (0..count)
        .map(|_| match random.random_range(0..8) {
            0..3 => frames::contact(plan, random),
            3 => frames::noise(plan, 1.1, random),
            4 => extremes[random.random_range(0..extremes.len())].clone(),
            5 => {
                let length = random.random_range(1..3 * plan.taxels());
                frames::contact(plan, random).into_iter().cycle().take(length).collect()
            }
            _ => {
                let mut faults = bad(&frames::contact(plan, random));
                faults.swap_remove(random.random_range(0..faults.len())).1
            }
        })
        .collect()
}

#[test]
fn thousands_of_mixed_frames_in_every_mode() {
    let plan = &small().0;
    let packets = mixed(LONG, &mut ChaCha8Rng::seed_from_u64(2));
    let mut model = Model::new(plan);
    let expected: Vec<Vec<u32>> = packets.iter().map(|packet| model.process(packet)).collect();
    for status in [0, NO_CONTACT, DIRECTION_UNKNOWN, AT_BOUND, SATURATED, NOT_FINITE, BAD_LENGTH] {
        let seen = expected.iter().filter(|words| words[0] & 0xFFFF == status).count();
        assert!(seen >= 10, "only {seen} frames with the status {status:#x} alone");
    }
    let [free, _, _, both] = Mode::all(11);
    // The sink takes a beat now and then: frames pile up inside.
    let slow = Mode { name: "slow sink", source: Pattern::Free, sink: Pattern::Random { seed: 3, willing: 0.03 } };
    let bursts = Pattern::Bursts { seed: 4, longest_run: 40, longest_pause: 3000 };
    let rare = Mode { name: "rare source, sink with long pauses", source: bursts, sink: bursts };
    in_parallel(&[free, both, slow, rare], |mode| {
        let answers = answers(&packets, mode);
        let comparison = Comparison::new(&expected, answers.iter().map(Vec::as_slice), plan.design.sensor.columns);
        assert!(comparison.is_exact(), "{}: {:?}", mode.name, comparison.first);
    });
}

/// Judges traffic with resets: between two of them the core is a new one, and only packets that were on the way when
/// one came have no answer.
fn judge(packets: &[Vec<u32>], resets: &[Reset], outcome: &Outcome) {
    // One in each of two banks, one being put out, one being sent, one between the search and the output.
    const MOST_INSIDE: usize = 5;
    let mut exchanges = outcome.exchanges.iter().peekable();
    let mut next = 0;
    let ends = resets.iter().map(|reset| reset.cycle + INITIAL_RESET).chain([u64::MAX]);
    for end in ends {
        let mut model = Model::new(&small().0);
        let mut first = true;
        while let Some(exchange) = exchanges.next_if(|exchange| exchange.last_out < end) {
            let most = if first { next + MOST_INSIDE } else { next };
            let packet = exchange.packet;
            assert!((next..=most).contains(&packet), "packet {packet} answered, {next} expected, {resets:?}");
            assert_eq!(exchange.words, model.process(&packets[packet]), "packet {packet}, {resets:?}");
            first = false;
            next = packet + 1;
        }
    }
    assert_eq!(next, packets.len(), "the last packet is sent after the last reset, {resets:?}");
}

#[test]
fn a_reset_in_any_cycle_of_a_frame_leaves_no_trace() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let packets = [good(&mut random), good(&mut random), good(&mut random)];
    // From before the first beat of the first frame to the first beats of the second.
    let cycles: Vec<u64> = (0..small().0.timeline.latency_cycles + 10).collect();
    in_parallel(&cycles, |&cycle| {
        let resets = [Reset { cycle, length: 1 + cycle % 3 }];
        let alone = traffic(&packets).with_resets(&resets).with_pacing(Pacing::OneAtATime);
        let outcome = run(&alone).unwrap_or_else(|error| panic!("{resets:?}: {error}"));
        judge(&packets, &resets, &outcome);
    });
}

#[test]
fn a_reset_while_frames_overlap_leaves_no_trace() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let packets: Vec<Vec<u32>> = (0..8).map(|_| good(&mut random)).collect();
    let timeline = &small().0.timeline;
    // One interval in which a frame comes in, another is worked on and a third goes out, every second cycle.
    let begin = timeline.latency_cycles + timeline.interval_cycles;
    let cycles: Vec<u64> = (begin..begin + timeline.interval_cycles + 2).step_by(2).collect();
    in_parallel(&cycles, |&cycle| {
        let resets = [Reset { cycle, length: 1 }];
        let outcome =
            run(&traffic(&packets).with_resets(&resets)).unwrap_or_else(|error| panic!("{resets:?}: {error}"));
        judge(&packets, &resets, &outcome);
    });
}

#[test]
fn resets_among_mixed_frames_cost_the_frames_inside() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let packets = mixed(LONG, &mut random);
    let interval = small().0.timeline.interval_cycles;
    // Late enough after one another that some frames are answered, and not in the last packets.
    let mut cycle = 0;
    let resets: Vec<Reset> = (0..LONG / 16)
        .map(|_| {
            cycle += random.random_range(interval..12 * interval);
            Reset { cycle, length: random.random_range(1..20) }
        })
        .collect();
    let mode = Mode::all(12)[3];
    let outcome = run(&traffic(&packets).with_resets(&resets).with_mode(&mode)).expect("no rule is broken");
    assert!(outcome.cycles > cycle, "every reset took place");
    judge(&packets, &resets, &outcome);
}
