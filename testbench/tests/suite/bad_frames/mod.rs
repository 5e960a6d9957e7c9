//! Frames that a source should not send, and resets at any moment: each costs its own frame and no other.

mod resets;

use std::sync::OnceLock;

use golden::design::{Design, Optimise, Outputs, PlanKind};
use golden::solver::Solution;
use hdl_gen::model::{
    AT_BOUND, BAD_LENGTH, DIRECTION_UNKNOWN, LOW_CONFIDENCE, Model, NO_CONTACT, NO_TENSION, NOT_FINITE, SATURATED,
};
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::compare::Comparison;
use testbench::stream::{Mode, Outcome, Pattern, Traffic, exchange};
use testbench::stream_words::decode;
use testbench::verilate::Built;

use crate::support::effort::share_of;
use crate::support::frames::encode;
use crate::support::{built, by_plan, frames, in_parallel, planned, shipped, with_joint};

/// Frames of a long row.
fn long() -> usize {
    share_of(1200)
}

/// Frames among as many that must have each status, so that a mode shows it more than once.
fn fewest_of_a_status() -> usize {
    share_of(5)
}

/// Cycles of a frame from which not every one is tried: the serial grid search is long.
const LONG_FRAME: u64 = 2000;

/// A design, planned and compiled.
struct Subject {
    plan: Plan,
    built: Built,
}

/// The small design in every plan: the paper's, the reduced one for either aim, by the grid search, and
/// without a field.
fn subjects() -> &'static [Subject] {
    static SUBJECTS: OnceLock<Vec<Subject>> = OnceLock::new();
    SUBJECTS.get_or_init(|| {
        let small = |name: &str, change: &dyn Fn(&mut Design)| {
            let mut design = shipped("small");
            name.clone_into(&mut design.name);
            change(&mut design);
            design
        };
        let designs = [
            by_plan(shipped("small"), PlanKind::Paper, Outputs::Field),
            by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field),
            small("small_latency", &|design| {
                design.algorithm.plan = PlanKind::Reduced;
                design.hardware.optimise = Optimise::Latency;
                (design.sensor.columns, design.sensor.rows) = (3, 3);
            }),
            small("small_joint", &|design| *design = with_joint(design.clone())),
            small("small_area", &|design| {
                *design = with_joint(design.clone());
                design.hardware.optimise = Optimise::Area;
            }),
            by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants),
        ];
        in_parallel(&designs, |design| {
            let plan = planned(design);
            let built = built(&plan);
            Subject { plan, built }
        })
    })
}

impl Subject {
    fn run(&self, traffic: &Traffic<'_>) -> Result<Outcome, String> {
        let mut core = self.built.load(7).map_err(|error| error.to_string())?;
        exchange(&mut core, traffic, |_| ()).map_err(|error| format!("{}: {error}", self.plan.design.name))
    }

    fn traffic<'a>(&self, packets: &'a [Vec<u32>]) -> Traffic<'a> {
        Traffic::new(packets, timeout(&self.plan))
    }

    /// The answers in order, if each packet has one.
    fn answers(&self, packets: &[Vec<u32>], mode: &Mode) -> Vec<Vec<u32>> {
        let outcome = self.run(&self.traffic(packets).with_mode(mode)).expect(mode.name);
        assert_eq!(outcome.exchanges.len(), packets.len(), "{}", mode.name);
        outcome.exchanges.into_iter().map(|exchange| exchange.words).collect()
    }

    /// One answer to a packet sent to a core just out of reset.
    fn answer(&self, packet: &[u32]) -> Vec<u32> {
        self.answers(&[packet.to_vec()], &Mode::all(1)[0]).remove(0)
    }

    fn has_field(&self) -> bool {
        self.plan.field_words() > 0
    }
}

fn read(words: &[u32]) -> Solution {
    decode(words).expect("a whole frame")
}

/// A contact that is dragged, with every value found, of any confidence.
fn good(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<u32> {
    loop {
        let packet = frames::contact(plan, random);
        if Model::new(plan).process(&packet)[0] & !LOW_CONFIDENCE == 0 {
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
    let cases: Vec<_> = subjects().iter().flat_map(|subject| Mode::all(5).map(|mode| (subject, mode))).collect();
    in_parallel(&cases, |&(subject, mode)| {
        let plan = &subject.plan;
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut packets = Vec::new();
        let mut names = Vec::new();
        for (name, packet, status) in bad(&good(plan, &mut random)) {
            packets.extend([packet, good(plan, &mut random)]);
            names.extend([(name, status), (name, 0)]);
        }
        let answers = subject.answers(&packets, &mode);
        for (counter, (words, (name, status))) in (0..).zip(answers.iter().zip(names)) {
            let case = format!("{}, {}, {name}, frame {counter}", plan.design.name, mode.name);
            if status != 0 {
                assert_eq!(words[0], counter << 16 | status, "{case}");
                assert_eq!(words[1..], vec![0; plan.words_out() - 1], "{case}");
                continue;
            }
            // Alone after a reset, the good frame has the same answer.
            let mut alone = Model::new(plan).process(&packets[counter as usize]);
            alone[0] |= counter << 16;
            assert_eq!(*words, alone, "{case}");
        }
    });
}

/// Frames of wrong lengths one right after the other: what each leaves behind is gone before the next.
#[test]
fn wrong_lengths_back_to_back() {
    let cases: Vec<_> = subjects().iter().flat_map(|subject| Mode::all(8).map(|mode| (subject, mode))).collect();
    in_parallel(&cases, |&(subject, mode)| {
        let plan = &subject.plan;
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let taxels = plan.taxels();
        let lengths = [1, 1, 1, 3 * taxels, taxels - 1, taxels + 1, 1, 2 * taxels, taxels + 2, 2, taxels - 1, taxels];
        let mut packets: Vec<Vec<u32>> = Vec::new();
        for length in lengths.into_iter().chain([taxels]) {
            packets.push(good(plan, &mut random).into_iter().cycle().take(length).collect());
        }
        let mut model = Model::new(plan);
        let expected: Vec<Vec<u32>> = packets.iter().map(|packet| model.process(packet)).collect();
        assert_eq!(subject.answers(&packets, &mode), expected, "{}, {}", plan.design.name, mode.name);
    });
}

#[test]
fn nothing_pressed_is_no_contact() {
    for subject in subjects() {
        let taxels = subject.plan.taxels();
        let quiet = [0.0, -0.0, 0.9, -0.9].map(|pascal| encode(&vec![pascal; taxels]));
        for packet in quiet {
            let words = subject.answer(&packet);
            assert_eq!(words[0], NO_CONTACT);
            assert!(words[1..].iter().all(|&word| word == 0));
        }
        let twice = subject.answer(&encode(&vec![-2.0; taxels]));
        assert_eq!(twice[0] & NO_CONTACT, 0, "twice the noise floor is a contact");
    }
}

#[test]
fn pressing_straight_down_has_no_direction() {
    for subject in subjects() {
        let taxels = subject.plan.taxels();
        let stress: Vec<f64> = (0..taxels).map(|taxel| -1000.0 - 100.0 * (taxel % 5) as f64).collect();
        // The grid search does without the direction, unless nothing presses.
        let signs = if subject.plan.estimator.joint().is_some() { &[-1.0][..] } else { &[1.0, -1.0] };
        for sign in signs {
            let words = subject.answer(&encode(&stress.iter().map(|value| sign * value).collect::<Vec<_>>()));
            let pulls = if *sign < 0.0 { 0 } else { NO_TENSION };
            // Whoever tells an error says that it may be all of the force.
            let low = if subject.plan.thresholds.error.is_some() { LOW_CONFIDENCE } else { 0 };
            assert_eq!(words[0], DIRECTION_UNKNOWN | pulls | low, "one sign everywhere");
            let answer = read(&words);
            assert_eq!([answer.mu_x, answer.mu_y].map(f64::to_bits), [0, 0]);
            let forces = answer.field.iter().flatten().any(|&force| force != 0.0);
            assert_eq!(forces, subject.has_field(), "the forces of pressing are there");
        }
        assert!(read(&subject.answer(&encode(&stress))).resultant[2] < 0.0, "compression presses");
    }
}

#[test]
fn the_full_scale_and_beyond_are_the_full_scale_and_are_said() {
    for subject in subjects() {
        let full_scale = subject.plan.design.hardware.full_scale_pa;
        let mut clamped = vec![-0.3 * full_scale; subject.plan.taxels()];
        clamped[2] = full_scale;
        clamped[5] = -full_scale;
        let mut beyond = clamped.clone();
        beyond[2] = 1.5 * full_scale;
        beyond[5] = -f64::from(f32::MAX);
        let mut within = clamped.clone();
        within[2] = 0.9999 * full_scale;
        within[5] = -0.9999 * full_scale;
        let [within, clamped, beyond] = [within, clamped, beyond].map(|frame| subject.answer(&encode(&frame)));
        assert_eq!(within[0] & SATURATED, 0);
        assert_eq!(clamped[0], within[0] | SATURATED);
        assert_eq!(beyond, clamped);
    }
}

/// Frames of every kind, at random.
fn mixed(plan: &Plan, count: usize, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let extremes = frames::extremes(plan, random);
    (0..count)
        .map(|_| match random.random_range(0..9) {
            0..3 => frames::contact(plan, random),
            3 => frames::noise(plan, 1.1, random),
            4..6 => extremes[random.random_range(0..extremes.len())].clone(),
            6 => {
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
    in_parallel(subjects(), mixed_in_every_mode);
}

fn mixed_in_every_mode(subject: &Subject) {
    let plan = &subject.plan;
    let packets = mixed(plan, long(), &mut ChaCha8Rng::seed_from_u64(2));
    let mut model = Model::new(plan);
    let expected: Vec<Vec<u32>> = packets.iter().map(|packet| model.process(packet)).collect();
    for status in [0, NO_CONTACT, DIRECTION_UNKNOWN, AT_BOUND, SATURATED, NOT_FINITE, BAD_LENGTH] {
        // A frame in which nothing pulls says that beside what else it says.
        let seen = expected.iter().filter(|words| words[0] & 0xFFFF & !(NO_TENSION | LOW_CONFIDENCE) == status).count();
        assert!(seen >= fewest_of_a_status(), "only {seen} frames with the status {status:#x} alone");
    }
    let seen = expected.iter().filter(|words| words[0] & NO_TENSION != 0).count();
    // The grid search asks for tension only where it finds that something is pushed.
    let least = if plan.estimator.joint().is_some() { 0 } else { fewest_of_a_status() };
    assert!(seen >= least, "only {seen} frames without tension");
    let [free, _, _, both] = Mode::all(11);
    // The sink takes a beat now and then: frames pile up inside.
    let slow = Mode { name: "slow sink", source: Pattern::Free, sink: Pattern::Random { seed: 3, willing: 0.03 } };
    let bursts = Pattern::Bursts { seed: 4, longest_run: 40, longest_pause: 3000 };
    let rare = Mode { name: "rare source, sink with long pauses", source: bursts, sink: bursts };
    for mode in [free, both, slow, rare] {
        let answers = subject.answers(&packets, &mode);
        let comparison = Comparison::new(&expected, answers.iter().map(Vec::as_slice), plan.design.sensor.columns);
        assert!(comparison.is_exact(), "{}, {}: {:?}", plan.design.name, mode.name, comparison.first);
    }
}

/// Judges traffic with resets: between two of them the core is a new one, and only packets that were on the way when
/// one came have no answer. How many packets were answered between resets, and how many the one that followed has cost.
fn judge(plan: &Plan, packets: &[Vec<u32>], outcome: &Outcome) -> Vec<(usize, usize)> {
    let spans = outcome.between_resets(packets.len()).map(|(sent, exchanges)| {
        let mut model = Model::new(plan);
        for (packet, exchange) in sent.clone().zip(exchanges) {
            assert_eq!(exchange.packet, packet, "{:?}", outcome.resumed);
            assert_eq!(exchange.words, model.process(&packets[packet]), "packet {packet}, {:?}", outcome.resumed);
        }
        (exchanges.len(), sent.len() - exchanges.len())
    });
    let counts: Vec<(usize, usize)> = spans.collect();
    assert_eq!(counts[counts.len() - 1].1, 0, "the last packets are sent after the last reset, {:?}", outcome.resumed);
    counts
}
