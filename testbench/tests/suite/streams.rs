//! Streams of several samples and words a beat: every width, every sample format, in all stream modes, and frames
//! that a source should not send.

use std::sync::OnceLock;

use crate::support::effort::half_of;
use crate::support::{built, by_plan, frames, in_parallel, planned, shipped, simulate_exactly, with_joint, with_lanes};
use golden::design::{Calibration, Curve, Design, Outputs, PlanKind, Samples};
use hdl_gen::model::{BAD_LENGTH, NOT_FINITE};
use hdl_gen::plan::Plan;
use hdl_gen::plan::streams::Intake;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::{model_answers, timeout};
use testbench::compare::Comparison;
use testbench::stream::{Mode, Traffic, exchange};
use testbench::verilate::Built;

/// A design, planned and compiled.
struct Subject {
    plan: Plan,
    built: Built,
}

/// Both widths, field and resultants, frames that fill their last beat and frames that do not, samples taken at once and
/// one by one, in pascals and in counts; `make test` plays every second.
fn subjects() -> &'static [Subject] {
    static SUBJECTS: OnceLock<Vec<Subject>> = OnceLock::new();
    SUBJECTS.get_or_init(|| {
        let [paper, reduced] = [PlanKind::Paper, PlanKind::Reduced];
        let small = |name: &str, bits: u32, kind: PlanKind, outputs: Outputs| {
            let mut design = by_plan(shipped("small"), kind, outputs);
            design.name = format!("{name}_{bits}");
            design.hardware.stream_bits = bits;
            design
        };
        let mut narrow = small("narrow", 64, reduced, Outputs::Field);
        (narrow.sensor.columns, narrow.sensor.rows) = (3, 3);
        (narrow.hardware.data_bits, narrow.hardware.lanes) = (22, 8);
        let mut odd = with_joint(with_lanes(shipped("odd"), 12));
        odd.hardware.stream_bits = 128;
        let mut long = small("long", 128, reduced, Outputs::Field);
        (long.hardware.coefficient_bits, long.hardware.data_bits) = (27, 35);
        let mut tiny = small("tiny", 128, reduced, Outputs::Field);
        (tiny.sensor.columns, tiny.sensor.rows) = (2, 2);
        let mut counts = small("counts", 64, reduced, Outputs::Resultants);
        counts.sensor.rows = 5;
        counts.sensor.columns = 3;
        calibrate(&mut counts);
        let mut curved = small("curved", 128, reduced, Outputs::Resultants);
        curved.input.curve = Some(Curve { points: vec![[0.0, 0.0], [50.0, -100.0], [4095.0, -1e5]], law: None });
        let mut integers = small("integers", 128, reduced, Outputs::Resultants);
        calibrate(&mut integers);
        integers.hardware.samples = Samples::Int16;
        let mut unsigned = small("unsigned", 32, paper, Outputs::Field);
        (unsigned.sensor.columns, unsigned.sensor.rows) = (3, 3);
        calibrate(&mut unsigned);
        unsigned.hardware.samples = Samples::Uint16;
        let mut narrow_counts = small("narrow_counts", 32, reduced, Outputs::Field);
        calibrate(&mut narrow_counts);
        narrow_counts.hardware.samples = Samples::Uint16;
        let mut dead = small("dead", 128, reduced, Outputs::Field);
        dead.sensor.rows = 5;
        dead.sensor.columns = 3;
        dead.input.dead = vec![3, 4];
        dead.input.crosstalk = 0.1;
        let designs = [
            small("paper", 64, paper, Outputs::Field),
            small("whole", 128, reduced, Outputs::Field),
            narrow,
            long,
            odd,
            tiny,
            integers,
            counts,
            curved,
            dead,
            unsigned,
            narrow_counts,
        ];
        in_parallel(&half_of(designs), |design| {
            let plan = planned(design);
            let built = built(&plan);
            Subject { plan, built }
        })
    })
}

/// Counts, with a gain and an offset for each taxel.
fn calibrate(design: &mut Design) {
    let taxels = design.sensor.taxels();
    let gain = (0..taxels).map(|taxel| 0.5 + taxel as f64 / 7.0).collect();
    let offset = (0..taxels).map(|taxel| taxel as f64 - 5.0).collect();
    design.input.pa_per_count = Some(-12.5);
    design.input.calibration = Some(Calibration { gain, offset });
}

/// Contacts, noise and the ends of the ranges.
fn packets(plan: &Plan) -> Vec<Vec<u32>> {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut packets = frames::extremes(plan, &mut random);
    packets.extend((0..6).map(|_| frames::contact(plan, &mut random)));
    packets.push(frames::noise(plan, 1.0, &mut random));
    if plan.design.hardware.samples != Samples::Float32 {
        // Made as float32: as words they are counts of all sizes and signs.
        for packet in &mut packets {
            packet.truncate(plan.streams().words_in());
        }
        for share in [1e-3, 0.1, 1.0] {
            let pascals = random.random_range(0.1..1.0) * share * plan.design.hardware.full_scale_pa;
            let value = |taxel: usize| {
                plan.design.input.from_pa(taxel, if taxel.is_multiple_of(4) { pascals } else { -pascals })
            };
            packets.push(plan.streams().packet(&(0..plan.taxels()).map(value).collect::<Vec<_>>()));
        }
    }
    packets
}

#[test]
fn every_word_and_every_cycle_is_right() {
    let wrong = in_parallel(subjects(), |Subject { plan, built }| {
        simulate_exactly(plan, built, &packets(plan), 3)
            .map(drop)
            .map_err(|fault| format!("{}: {fault}", plan.design.name))
    });
    assert_eq!(wrong.into_iter().filter_map(Result::err).collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn both_ways_in_are_among_the_designs() {
    for intake in [Intake::Unpacked, Intake::Whole] {
        assert!(subjects().iter().any(|subject| subject.plan.streams().intake == intake), "{intake:?}");
    }
}

/// A NaN in every place of a beat, every number of beats that is not a frame's, and anything behind the last sample.
#[test]
fn bad_frames_cost_themselves_only() {
    in_parallel(subjects(), |Subject { plan, built }| {
        let streams = plan.streams();
        // Words of a frame, of a beat, and of all beats.
        let (taxels, width) = (streams.words_in(), streams.words());
        let whole = streams.whole_beats(taxels);
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let good = frames::contact(plan, &mut random)[..taxels].to_vec();
        let mut packets = vec![good.clone()];
        let mut known = vec![0];
        let mut add = |packet: Vec<u32>, status: u32| {
            packets.extend([packet, good.clone()]);
            known.extend([status, 0]);
        };
        for place in (0..width.min(taxels)).flat_map(|place| [place, taxels - 1 - place]) {
            let mut packet = good.clone();
            packet[place] = if place % 2 == 0 { f32::NAN } else { f32::NEG_INFINITY }.to_bits();
            // Integers are numbers, and what a dead taxel reads is none's business.
            let ignored = streams.sample != Samples::Float32 || plan.design.input.dead.contains(&place);
            add(packet, if ignored { 0 } else { NOT_FINITE });
        }
        let of_length = |length: usize| good.iter().copied().cycle().take(length).collect::<Vec<u32>>();
        for beats in (1..streams.beats_in()).chain([1, 2, 7].map(|more| streams.beats_in() + more)) {
            add(of_length(beats * width), BAD_LENGTH);
            add(of_length((beats - 1) * width + 1), BAD_LENGTH);
        }
        // What fills the last beat means nothing, whatever it is.
        let mut filled = of_length(whole);
        filled[taxels..].fill_with(|| f32::NAN.to_bits() | random.random_range(0..9));
        add(filled, 0);
        let expected = model_answers(plan, &packets);
        for (words, status) in expected.iter().zip(known) {
            assert_eq!(words[0] & (BAD_LENGTH | NOT_FINITE), status, "{}", plan.design.name);
        }
        for mode in Mode::all(5) {
            let mut core = built.load(5).expect("loads");
            let traffic = Traffic::new(&packets, timeout(plan)).with_mode(&mode);
            let outcome = exchange(&mut core, &traffic, |_| ()).unwrap_or_else(|error| panic!("{error}"));
            let answers = outcome.exchanges.iter().map(|exchange| exchange.words.as_slice());
            let comparison = Comparison::new(&expected, answers, plan.design.sensor.columns);
            assert!(comparison.is_exact(), "{}, {}: {:?}", plan.design.name, mode.name, comparison.first.first());
        }
    });
}
