//! A curve in the banks: what acts at power-up, any other one that a bank takes, commits at every moment of a frame, what
//! is refused, and tare.

use std::sync::OnceLock;

use golden::design::{Outputs, Samples};
use golden::progress::Progress;
use hdl_gen::plan::calibration::Bank;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::frame_set::FrameSet;
use testbench::registers::address;
use testbench::run::{Options, run};
use testbench::stream::{Mode, Traffic};

use super::commits::commits_at_every_moment;
use super::{Subject, core, errors, judged, judged_in, load, perform, read_back, version};
use crate::support::banks::{random_bank, random_curve, takes};
pub use crate::support::calibrated::design_with_curve;
use crate::support::effort::half_of;
use crate::support::faults::{broken, some_faults};
use crate::support::{built, frames, in_parallel, planned, simulate_exactly};

mod refused;
mod tares;

fn subject() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(|| {
        let plan = planned(&design_with_curve());
        let built = built(&plan);
        Subject { plan, built }
    })
}

/// Frames of counts along the design's curve.
fn counts(subject: &Subject, count: usize, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let of_pascals = |packet: Vec<u32>| -> Vec<u32> {
        let count = |(taxel, word): (usize, u32)| {
            (subject.plan.design.input.from_pa(taxel, f64::from(f32::from_bits(word))).round() as f32).to_bits()
        };
        packet.into_iter().enumerate().map(count).collect()
    };
    (0..count)
        .map(|index| match index % 5 {
            4 => (0..12).map(|_| random.random_range(-12e3_f32..12e3).to_bits()).collect(),
            3 => of_pascals(frames::noise(&subject.plan, 1.3, random)),
            _ => of_pascals(frames::contact(&subject.plan, random)),
        })
        .collect()
}

fn random_bank_and_curve(subject: &Subject, random: &mut ChaCha8Rng) -> Bank {
    let usual = subject.calibration().power_up.curve.as_ref().expect("a curve");
    let curve = random_curve(&subject.plan, usual, random);
    let bank = Bank { curve: Some(curve), ..random_bank(subject.calibration(), random) };
    assert!(takes(subject.calibration(), &bank));
    bank
}

#[test]
fn at_power_up_the_designs_curve_acts() {
    let subject = subject();
    let packets = counts(subject, 14, &mut ChaCha8Rng::seed_from_u64(1));
    simulate_exactly(&subject.plan, &subject.built, &packets, 3).unwrap_or_else(|error| panic!("{error}"));
    let mut core = subject.core(1);
    let words = subject.calibration().power_up.words();
    assert_eq!(words.len(), 26 + 4 * 16 + 3);
    assert_eq!(read_back(&mut core, true), words);
    assert_eq!(read_back(&mut core, false), words);
    let room = core.read(address::CALIBRATION_CURVE).expect("a reply") & 0xFF;
    assert_eq!(room, 16);
    assert_eq!(core.read(address::FEATURES).expect("a reply") >> 6 & 1, 1);
}

/// `sptfra run`, which reads every register, knows what they say of a curve in the banks.
#[test]
fn a_run_finds_all_registers_right() {
    let frames = FrameSet::standing(&subject().plan.design.sensor).expect("frames");
    let report = run(&design_with_curve(), &frames, &Options::default(), &Progress::hidden()).expect("runs");
    assert!(report.faults.is_empty(), "{report:#?}");
}

/// Integers of either kind, several in a beat, dead taxels in the banks and in ROM, a field, a scanner that is not held.
#[test]
fn other_designs_from_end_to_end() {
    for (samples, bits, room) in
        half_of([(Samples::Uint16, 64, 2), (Samples::Int16, 32, 0), (Samples::Float32, 128, 1)])
    {
        let mut design = design_with_curve();
        design.name = format!("{}_{samples}_{bits}", design.name);
        design.algorithm.outputs = Outputs::Field;
        design.input.dead = vec![3];
        design.input.room = room;
        design.hardware.samples = samples;
        design.hardware.stream_bits = bits;
        let plan = planned(&design);
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let packets: Vec<Vec<u32>> = (0..8)
            .map(|index| {
                let most = [9500.0, 700.0][index % 2];
                let values: Vec<f64> = (0..12).map(|_| random.random_range(-100.0..most)).collect();
                plan.streams().packet(&values)
            })
            .collect();
        let subject = Subject { built: built(&plan), plan };
        simulate_exactly(&subject.plan, &subject.built, &packets, 3).unwrap_or_else(|error| panic!("{error}"));
        let mut core = subject.core(1);
        let bank = random_bank_and_curve(&subject, &mut random);
        perform(&mut core, &load(&bank, bank.crc()));
        assert_eq!((errors(&mut core), read_back(&mut core, true)), (0, bank.words()));
        let banks = [bank.clone(), bank];
        judged(&subject.plan, &mut core, &packets, &banks).unwrap_or_else(|error| panic!("{samples}: {error}"));
    }
}

#[test]
fn any_curve_acts_once_it_is_committed() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut core = subject.core(2);
    for expected in 1..40 {
        let bank = random_bank_and_curve(subject, &mut random);
        perform(&mut core, &load(&bank, bank.crc()));
        assert_eq!((errors(&mut core), version(&mut core)), (0, expected));
        assert_eq!(read_back(&mut core, true), bank.words());
        let packets = counts(subject, 5, &mut random);
        let banks = vec![bank; expected as usize + 1];
        judged(&subject.plan, &mut core, &packets, &banks).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// A bank with another curve, and one with other gains and another threshold.
fn others(subject: &Subject) -> [Bank; 2] {
    let power_up = &subject.calibration().power_up;
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut steep = power_up.curve.clone().expect("a curve");
    for segment in &mut steep.curve.segments {
        segment.value /= 2;
        segment.shift += 1;
    }
    steep.end /= 2;
    let other = Bank { curve: Some(steep), ..power_up.clone() };
    assert!(takes(subject.calibration(), &other));
    [other, random_bank_and_curve(subject, &mut random)]
}

#[test]
fn a_commit_at_every_moment_of_a_frame() {
    let subject = subject();
    for (bank, step) in others(subject).iter().zip([1, 3]) {
        assert_eq!(commits_at_every_moment(subject, &subject.built, bank, step), Vec::<String>::new());
    }
}

/// Banks come one after the other among good and bad frames, with pauses on both sides.
#[test]
fn commits_on_each_others_heels_among_bad_frames() {
    let subject = subject();
    let told = in_parallel(&[1, 2, 3, 4], |&seed| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut core = core(&subject.built, seed);
        let mut banks = vec![subject.calibration().power_up.clone()];
        let mut cycle = 10;
        for _ in 0..12 {
            let bank = random_bank_and_curve(subject, &mut random);
            for access in load(&bank, bank.crc()) {
                core.plan(cycle, access);
            }
            cycle += 2200 + 4 * subject.plan.timeline.interval_cycles + random.random_range(0..200);
            banks.push(bank);
        }
        let mut packets = counts(subject, 200, &mut random);
        for packet in &mut packets {
            match random.random_range(0..8) {
                0 => packet[random.random_range(0..12)] = f32::NAN.to_bits(),
                1 => packet.truncate(random.random_range(1..12)),
                2 => packet.extend([7; 9]),
                3 => packet.truncate(1),
                _ => {}
            }
        }
        let modes = Mode::all(seed);
        let traffic = Traffic::new(&packets, timeout(&subject.plan)).with_mode(&modes[seed as usize % 4]);
        let versions = judged_in(&subject.plan, &mut core, &traffic, &banks);
        assert_eq!((errors(&mut core), versions.as_ref().err()), (0, None), "seed {seed}");
        versions.ok()?.last().copied()
    });
    assert!(told.iter().all(|&last| last > Some(4)), "{told:?}");
}

/// Copies in which a frame changes its curve within, or takes another bank behind the curve than in front of it.
#[test]
fn half_a_frame_by_another_curve_is_noticed() {
    let subject = subject();
    let [other_curve, other_gains] = others(subject);
    let faults = [
        ("sptfra_bz", "wire bank = in_frame ? bank_held : active;", "wire bank = active;", &other_curve),
        ("sptfra_bz", "((CURVE_LEVELS == 0) ? bank : bank_held)", "(active)", &other_gains),
        (
            "sptfra_banks",
            ".read_bank    (bank),\n            .read_segment",
            ".read_bank    (active),\n            .read_segment",
            &other_curve,
        ),
    ];
    for (module, from, to, bank) in some_faults(faults, |&(module, from, ..)| (module, from)) {
        let built = broken(&subject.plan, module, from, to);
        assert_ne!(commits_at_every_moment(subject, &built, bank, 1), Vec::<String>::new(), "{to}");
    }
}
