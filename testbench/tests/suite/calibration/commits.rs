//! Commits while frames run: each frame is computed with the bank that acted at its first beat, all of it.

use golden::design::Outputs;
use hdl_gen::model::Model;
use hdl_gen::plan::calibration::Bank;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::stream::{Mode, Pattern, Traffic};
use testbench::verilate::Built;

use super::{BUSY, Subject, core, counts, design, errors, judged, judged_in, load, subject, version};
use crate::support::banks::random_bank;
use crate::support::effort::some_of;
use crate::support::faults::{broken, some_faults};
use crate::support::{built, in_parallel, planned};

/// A direction whatever presses and pulls.
const ALWAYS_KNOWN: &str = "assign no_push = &{1'b0, compression_seen, tension_seen};";

/// Cycles in which a bank of so many words is written, before the first commit.
fn loaded(words: usize) -> u64 {
    600 * words as u64 / 26
}

/// A bank of other gains and offsets, one with another threshold: no frame of it has contact, and one with another noise
/// floor: nothing of it presses or pulls.
fn others(subject: &Subject) -> [Bank; 3] {
    let calibration = subject.calibration();
    let random = random_bank(calibration, &mut ChaCha8Rng::seed_from_u64(1));
    let power_up = || calibration.power_up.clone();
    [random, Bank { contact: u32::MAX, ..power_up() }, Bank { noise: (1 << 26) - 1, ..power_up() }]
}

/// Commits a bank, so that it acts so many cycles later each time, over a frame and more; what went wrong.
pub(super) fn commits_at_every_moment(subject: &Subject, built: &Built, bank: &Bank, step: usize) -> Vec<String> {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let calibration = subject.calibration();
    let interval = subject.plan.timeline.interval_cycles;
    // Frames before it, while it walks through the bank, and after it.
    let before = 2 + (loaded(calibration.words()) + 7 * calibration.words() as u64) / interval;
    // Frames are taken in some way ahead of the answers.
    let packets = counts(&subject.plan, before as usize + 12, &mut random);
    let accesses = load(bank, bank.crc());
    let banks = [calibration.power_up.clone(), bank.clone()];
    // Of every eighth of them the last is still an interval after the first.
    let cycles = some_of((0..interval + 2 + 8 * step as u64).step_by(step));
    let told = in_parallel(&cycles, |&cycle| {
        let mut core = core(built, 1);
        let (commit, writes) = accesses.split_last().expect("a commit");
        for &write in writes {
            core.plan(10, write);
        }
        core.plan(loaded(calibration.words()) + cycle, *commit);
        let versions = judged(&subject.plan, &mut core, &packets, &banks)?;
        match (versions.first(), versions.last(), errors(&mut core), version(&mut core)) {
            (Some(0), Some(1), 0, 1) => Ok(versions.iter().sum()),
            other => Err(format!("{other:?}, first and last version, errors, version")),
        }
    });
    let changes: std::collections::BTreeSet<usize> = told.iter().flatten().copied().collect();
    let wrong = told.into_iter().zip(cycles).filter_map(|(told, cycle)| Some(format!("{cycle}: {}", told.err()?)));
    let wrong: Vec<String> = wrong.collect();
    assert!(!wrong.is_empty() || changes.len() > 1, "the change moves from a frame to the next: {changes:?}");
    wrong
}

#[test]
fn a_commit_at_every_moment_of_a_frame() {
    let subject = subject();
    for (bank, step) in others(subject).iter().zip([1, 4, 3]) {
        assert_eq!(commits_at_every_moment(subject, &subject.built, bank, step), Vec::<String>::new());
    }
}

/// Averages over frames go on over a commit, also of gains, which make them start again where readings step.
#[test]
fn averages_go_on_over_a_commit() {
    let mut design = design(Outputs::Resultants);
    design.name += "_averaged";
    (design.input.smoothing, design.input.noise) = (3, 0.01);
    let plan = planned(&design);
    let subject = Subject { built: built(&plan), plan };
    let interval = subject.plan.timeline.interval_cycles;
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let still = counts(&subject.plan, 1, &mut random).remove(0);
    let mut noisy = |word: &u32| (f32::from_bits(*word) + random.random_range(-3.0..3.0)).round().to_bits();
    let words = subject.calibration().words();
    let frames = 14 + (loaded(words) + 7 * words as u64) / interval;
    let packets: Vec<Vec<u32>> = (0..frames).map(|_| still.iter().map(&mut noisy).collect()).collect();
    let [gains, ..] = others(&subject);
    let same = subject.calibration().power_up.clone();
    let cases: Vec<(&Bank, u64)> = [&gains, &same]
        .into_iter()
        .flat_map(|bank| (0..interval).step_by(16).map(move |cycle| (bank, cycle)))
        .collect();
    let last = in_parallel(&some_of(cases), |&(bank, cycle)| {
        let mut core = core(&subject.built, 1);
        let accesses = load(bank, bank.crc());
        let (commit, writes) = accesses.split_last().expect("a commit");
        for &write in writes {
            core.plan(10, write);
        }
        // When there is an average.
        core.plan(loaded(words) + 8 * interval + cycle, *commit);
        let banks = [subject.calibration().power_up.clone(), bank.clone()];
        judged(&subject.plan, &mut core, &packets, &banks).map(|versions| versions.last().copied())
    });
    assert!(last.iter().all(|last| *last == Ok(Some(1))), "{last:?}");
    // Frames that restart the average are as without one.
    let mut without = design;
    without.input.smoothing = 0;
    let [averaged, plain] = [&subject.plan, &planned(&without)].map(|plan| {
        let mut model = Model::new(plan);
        packets.iter().map(|packet| model.process(packet)).collect::<Vec<_>>()
    });
    let differ = averaged.iter().zip(&plain).filter(|(averaged, plain)| averaged != plain).count();
    assert!(2 * differ > packets.len(), "{differ} of {}", packets.len());
}

/// Banks come one after the other, as fast as they can be written, while good and bad frames run with pauses.
#[test]
fn commits_on_each_others_heels_among_bad_frames() {
    let subject = subject();
    let told = in_parallel(&[1, 2, 3, 4], |&seed| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut core = core(&subject.built, seed);
        let mut banks = vec![subject.calibration().power_up.clone()];
        let mut cycle = 10;
        for _ in 0..16 {
            let bank = random_bank(subject.calibration(), &mut random);
            for access in load(&bank, bank.crc()) {
                core.plan(cycle, access);
            }
            // More than its writes and the walk take, and the frame that is coming in: short packets may stand before it,
            // as many as there is room for their ends.
            cycle += 600 + 4 * subject.plan.timeline.interval_cycles + random.random_range(0..200);
            banks.push(bank);
        }
        let mut packets = counts(&subject.plan, 120, &mut random);
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
        let errors = errors(&mut core);
        assert_eq!((errors, versions.as_ref().err()), (0, None), "seed {seed}");
        versions.ok()?.last().copied()
    });
    assert!(told.iter().all(|&last| last > Some(7)), "{told:?}");
}

/// Packets of one beat must not pile up in the pipeline: more would be inside than there is room for.
#[test]
fn packets_of_a_beat_do_not_pile_up() {
    let subject = subject();
    let mut packets = counts(&subject.plan, 60, &mut ChaCha8Rng::seed_from_u64(3));
    for (index, packet) in packets.iter_mut().enumerate() {
        if index % 20 > 2 {
            packet.truncate(1 + index % 3 / 2);
        }
    }
    let mut core = subject.core(3);
    let banks = [subject.calibration().power_up.clone()];
    judged(&subject.plan, &mut core, &packets, &banks).unwrap_or_else(|error| panic!("{error}"));
}

/// A copy in which a frame changes its bank within is found, and some in which it does not keep its thresholds.
#[test]
fn half_a_frame_by_another_bank_is_noticed() {
    let subject = subject();
    let [other_gains, other_threshold, other_floor] = others(subject);
    let faults = [
        ("sptfra_bz", "wire bank = in_frame ? bank_held : active;", "wire bank = active;", other_gains),
        (
            "sptfra_frame_context",
            "thresholds <= of_cean;",
            "thresholds <= {in_contact, of_cean[26:0]};",
            other_threshold,
        ),
        (
            "sptfra_frame_context",
            "thresholds <= of_cean;",
            "thresholds <= {of_cean[58:27], in_noise};",
            other_floor.clone(),
        ),
        ("sptfra_direction", "assign no_push = !(compression_seen && tension_seen);", ALWAYS_KNOWN, other_floor),
    ];
    for (module, from, to, bank) in some_faults(faults, |&(module, from, ..)| (module, from)) {
        let built = broken(&subject.plan, module, from, to);
        assert_ne!(commits_at_every_moment(subject, &built, &bank, 3), Vec::<String>::new(), "{to}");
    }
}

/// A frame that takes longer to come in than two banks to be written keeps the one that it began with, which is not
/// written meanwhile.
#[test]
fn a_frame_that_takes_its_time_keeps_its_bank() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut core = core(&subject.built, 4);
    let [first, second] = [0, 1].map(|_| random_bank(subject.calibration(), &mut random));
    for (cycle, bank) in [(10, &first), (900, &second)] {
        for access in load(bank, bank.crc()) {
            core.plan(cycle, access);
        }
    }
    let packets = counts(&subject.plan, 4, &mut random);
    let slow = Pattern::Bursts { seed: 3, longest_run: 1, longest_pause: 600 };
    let traffic = Traffic { source: slow, ..Traffic::new(&packets, 100_000) };
    let banks = [subject.calibration().power_up.clone(), first];
    let versions = judged_in(&subject.plan, &mut core, &traffic, &banks).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((versions[0], versions[1]), (0, 1));
    assert!(errors(&mut core) & BUSY != 0);
}
