//! Dead taxels in the banks: maps of any content, at any moment, what is refused, and a tare with them.

use std::sync::OnceLock;

use golden::design::{Calibration, Design, Outputs, Samples};
use hdl_gen::model::{REPLACED, TOO_MANY_REPLACED};
use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::{Bank, DeadMap};
use hdl_gen::plan::dead::{DeadPlan, MOST_WEIGHT};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::model_answers;
use testbench::registers::address;

use super::commits::commits_at_every_moment;
use super::{
    CONTRADICTION, COUNTERS, OUT_OF_RANGE, Subject, WRONG_CRC, counts, design, errors, judged, load, perform,
    read_back, version, wait,
};
use crate::support::banks::{random_bank, random_map, takes, takes_map, tared};
use crate::support::faults::{broken, some_faults};
use crate::support::{built, planned, shipped, simulate_exactly};

/// The small design, with room for two dead taxels, one of which is so at power-up.
pub fn design_with_map() -> Design {
    let mut design = design(Outputs::Resultants);
    design.name += "_map";
    design.input.room = 2;
    design.input.dead = vec![5];
    design
}

fn subject() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(|| {
        let plan = planned(&design_with_map());
        let built = built(&plan);
        Subject { plan, built }
    })
}

/// A bank that replaces these taxels, by the weights that the generator gives them.
fn with_dead(plan: &Plan, bank: &Bank, dead: &[usize]) -> Bank {
    let map = DeadMap { room: bank.dead.room, dead: DeadPlan::of(&plan.design, dead) };
    assert!(takes_map(&map, plan.taxels()), "{dead:?}");
    Bank { dead: map, ..bank.clone() }
}

/// Counts in frames of which some taxels are no numbers or at the end of the range.
fn with_bad_readings(mut packets: Vec<Vec<u32>>, taxels: &[usize]) -> Vec<Vec<u32>> {
    for (index, packet) in packets.iter_mut().enumerate() {
        for &taxel in taxels {
            packet[taxel] = [f32::NAN, f32::INFINITY, 1e30, -7.0, 0.0][index % 5].to_bits();
        }
    }
    packets
}

/// Words and cycles, in every mode of the streams, are the predicted ones; also of frames of a wrong length.
#[test]
fn at_power_up_the_designs_dead_taxels_are_replaced() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut packets = with_bad_readings(counts(&subject.plan, 14, &mut random), &[5]);
    let whole = packets[1].clone();
    packets.extend([1, 2, 11, 13, 30].map(|length| whole.iter().copied().cycle().take(length).collect()));
    packets.extend(counts(&subject.plan, 3, &mut random));
    packets[16][2] = f32::NAN.to_bits();
    simulate_exactly(&subject.plan, &subject.built, &packets, 3).unwrap_or_else(|error| panic!("{error}"));
    let answers = model_answers(&subject.plan, &packets);
    let with = |bit: u32| answers.iter().filter(|words| words[0] & bit != 0).count();
    assert!(with(REPLACED) > with(TOO_MANY_REPLACED) && with(TOO_MANY_REPLACED) > 0);
    assert!(answers.iter().all(|words| words[COUNTERS] >> 16 == (words[0] & REPLACED) >> 8));
    let mut core = subject.core(1);
    let words = subject.calibration().power_up.words();
    assert_eq!(words.len(), subject.calibration().words());
    assert_eq!(read_back(&mut core, true), words);
    assert_eq!(read_back(&mut core, false), words);
}

/// To the last bit what a map in ROM makes of the same stress.
#[test]
fn replaced_from_ram_as_from_rom() {
    let subject = subject();
    let mut rom = subject.plan.design.clone();
    rom.input.room = 0;
    let packets = counts(&subject.plan, 20, &mut ChaCha8Rng::seed_from_u64(2));
    for (rom, ram) in model_answers(&planned(&rom), &packets).into_iter().zip(model_answers(&subject.plan, &packets)) {
        assert_eq!(rom, ram);
    }
}

/// Every pair of taxels, and each alone: corners, edges, neighbours; then anything that a bank takes.
#[test]
fn a_map_of_any_content_acts_once_it_is_committed() {
    let subject = subject();
    let of = subject.calibration();
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut banks = vec![of.power_up.clone()];
    for dead in [&[][..], &[0], &[11], &[0, 1], &[3, 11], &[5, 6], &[2, 6], &[0, 11], &[10, 11]] {
        banks.push(with_dead(&subject.plan, &of.power_up, dead));
    }
    banks.extend((0..16).map(|_| Bank { dead: random_map(of, &mut random), ..random_bank(of, &mut random) }));
    let mut core = subject.core(2);
    for (expected, bank) in banks.iter().enumerate().skip(1) {
        perform(&mut core, &load(bank, bank.crc()));
        assert_eq!((errors(&mut core), version(&mut core)), (0, expected as u32), "{:?}", bank.dead);
        assert_eq!(read_back(&mut core, true), bank.words());
        let packets = with_bad_readings(counts(&subject.plan, 5, &mut random), &bank.dead.dead.taxels);
        let acting = vec![bank.clone(); expected + 1];
        let seen = judged(&subject.plan, &mut core, &packets, &acting).unwrap_or_else(|error| panic!("{error}"));
        assert!(seen.iter().all(|&seen| seen == expected));
    }
}

#[test]
fn a_map_at_every_moment_of_a_frame() {
    let subject = subject();
    let of = subject.calibration();
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let bank = with_dead(&subject.plan, &random_bank(of, &mut random), &[2, 6]);
    let wrong = commits_at_every_moment(subject, &subject.built, &bank, 3);
    assert_eq!(wrong, Vec::<String>::new());
}

/// Copies in which a frame takes its map from another bank than its gains, or counts other taxels, are found.
#[test]
fn a_map_of_another_bank_is_noticed() {
    let subject = subject();
    let of = subject.calibration();
    let bank = with_dead(&subject.plan, &of.power_up, &[6, 7]);
    let faults = [
        ("sptfra_bz", ".bank           (bank_held)", ".bank           (active)"),
        ("sptfra_bz", "active_calibration[66:59], replaced}", "active_calibration[66:59], 4'd1}"),
    ];
    for (module, from, to) in some_faults(faults, |&(module, from, ..)| (module, from)) {
        let built = broken(&subject.plan, module, from, to);
        let wrong = commits_at_every_moment(subject, &built, &bank, 5);
        assert_ne!(wrong, Vec::<String>::new(), "{to}");
    }
}

/// Eight of twenty taxels, integers, several in a beat, a field, wide answers; each frame with another map.
#[test]
fn another_design_with_a_map_from_end_to_end() {
    let mut design = design_with_map();
    design.name += "_wide";
    design.algorithm.outputs = Outputs::Field;
    design.sensor = shipped("odd").sensor;
    design.input.calibration = None;
    design.input.dead = vec![0, 1, 6, 7, 8, 12, 13, 18];
    design.input.room = 8;
    design.hardware.samples = Samples::Uint16;
    design.hardware.stream_bits = 64;
    let plan = planned(&design);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let packets: Vec<Vec<u32>> =
        (0..8).map(|_| (0..plan.streams().words_in()).map(|_| random.random()).collect()).collect();
    let built = built(&plan);
    simulate_exactly(&plan, &built, &packets, 3).unwrap_or_else(|error| panic!("{error}"));
    // Weights that add up to the most that an accumulator takes, and to one more, in the first and the last sum.
    let subject = Subject { plan, built };
    let power_up = &subject.calibration().power_up;
    let taxels = subject.plan.taxels();
    let mut core = subject.core(5);
    for (version_before, place) in [0, 1].into_iter().zip([0, 7]) {
        let with_sum = |sum: i64| {
            let mut bank = with_dead(&subject.plan, power_up, &[0, 1, 2]);
            let mut left = sum;
            let mut weights = vec![0; taxels];
            for weight in &mut weights[3..] {
                *weight = -left.min(131_071) as i32;
                left += i64::from(*weight);
            }
            assert_eq!(left, 0);
            // Whether or not the place is taken.
            bank.dead.dead.weights.resize(8, vec![0; taxels]);
            bank.dead.dead.weights[place] = weights;
            bank
        };
        let (most, beyond) = (with_sum(MOST_WEIGHT), with_sum(MOST_WEIGHT + 1));
        perform(&mut core, &load(&beyond, beyond.crc()));
        assert_eq!((errors(&mut core), version(&mut core)), (CONTRADICTION, version_before), "place {place}");
        perform(&mut core, &load(&most, most.crc()));
        assert_eq!((errors(&mut core), version(&mut core)), (0, version_before + 1), "place {place}");
    }
}

/// Dead taxels are at rest, whatever they read, and a tare takes the map along.
#[test]
fn a_tare_keeps_the_map() {
    let subject = subject();
    let of = subject.calibration();
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut gain = vec![1.0; 12];
    (gain[2], gain[6]) = (0.0, 0.0);
    let thresholds = super::tare::quiet_bank(subject, 3.0);
    let bank = of.bank(&Calibration { gain, offset: vec![4.0; 12] }, &thresholds).expect("within bounds");
    let bank = with_dead(&subject.plan, &bank, &[2, 6]);
    let mut core = subject.core(8);
    perform(&mut core, &load(&bank, bank.crc()));
    let mut packets = super::tare::rest(subject, 8, 1.0, &mut random);
    for packet in &mut packets {
        (packet[2], packet[6]) = (random.random_range(-1e5_f32..1e5).to_bits(), 1e30_f32.to_bits());
    }
    let tared = tared(&bank, of, &packets).expect("at rest");
    assert!(tared.offsets[2] == 0 && tared.offsets[3] != bank.offsets[3]);
    core.write(address::TARE, 3).expect("a reply");
    packets.extend(counts(&subject.plan, 4, &mut random));
    let answers = super::send(&mut core, &packets);
    let banks = [of.power_up.clone(), bank, tared.clone()];
    let versions = super::judge(&subject.plan, &packets, &answers, &banks).unwrap_or_else(|e| panic!("{e}"));
    assert!(versions[..8].iter().all(|&version| version == 1) && versions.last() == Some(&2));
    wait(&mut core);
    assert_eq!((errors(&mut core), version(&mut core)), (0, 2));
    assert_eq!(read_back(&mut core, true), tared.words());
}

/// What contradicts itself has the right CRC and changes nothing; nor does a map that was written by half.
#[test]
fn maps_that_contradict_themselves_are_refused() {
    let subject = subject();
    let of = subject.calibration();
    let good = with_dead(&subject.plan, &of.power_up, &[3, 7]);
    let changed = |change: &dyn Fn(&mut DeadPlan)| {
        let mut bank = good.clone();
        change(&mut bank.dead.dead);
        assert!(!takes(of, &bank));
        bank
    };
    let cases = [
        ("equal", changed(&|dead| dead.taxels = vec![7, 7])),
        ("descending", changed(&|dead| dead.taxels = vec![7, 3])),
        ("a weight of a dead taxel", changed(&|dead| dead.weights[1][3] = 1)),
        ("of itself", changed(&|dead| dead.weights[0][3] = -1)),
    ];
    let mut core = subject.core(4);
    let packets = counts(&subject.plan, 2, &mut ChaCha8Rng::seed_from_u64(6));
    for (what, bank) in &cases {
        perform(&mut core, &load(bank, bank.crc()));
        assert_eq!((errors(&mut core), version(&mut core)), (CONTRADICTION, 0), "{what}");
        assert_eq!(core.read(address::CALIBRATION_CRC).expect("a reply"), of.power_up.crc());
        assert_eq!(read_back(&mut core, true), of.power_up.words(), "{what}");
        judged(&subject.plan, &mut core, &packets, std::slice::from_ref(&of.power_up))
            .unwrap_or_else(|e| panic!("{e}"));
        // The same words with another CRC are told as such.
        perform(&mut core, &load(bank, !bank.crc()));
        assert_eq!(errors(&mut core), WRONG_CRC, "{what}");
    }
    let whole = load(&good, good.crc());
    let commit = *whole.last().expect("a commit");
    // From behind the noise floor on.
    for written in [27, 28, 30, 50, whole.len() - 2] {
        perform(&mut core, &load(&of.power_up, of.power_up.crc() ^ 1)[..]);
        errors(&mut core);
        perform(&mut core, &whole[..written]);
        perform(&mut core, &[commit]);
        assert_eq!((errors(&mut core), version(&mut core)), (WRONG_CRC, 0), "{written} words");
    }
    perform(&mut core, &whole);
    assert_eq!((errors(&mut core), version(&mut core)), (0, 1));
}

/// Words of the map that are out of bounds are not written.
#[test]
fn words_of_a_map_out_of_bounds_are_refused() {
    let subject = subject();
    let mut core = subject.core(5);
    let power_up = subject.calibration().power_up.words();
    let first = 26_u32;
    let mut attempt = |index: u32, word: u32, fits: bool| {
        core.write(address::CALIBRATION_INDEX, index).expect("a reply");
        core.write(address::CALIBRATION_DATA, word).expect("a reply");
        let at = format!("word {index}: {word:#010x}");
        assert_eq!(errors(&mut core), if fits { 0 } else { OUT_OF_RANGE }, "{at}");
        core.write(address::CALIBRATION_INDEX, index).expect("a reply");
        let before = power_up.get(index as usize).copied().unwrap_or(0);
        let expected = if fits { word } else { before };
        assert_eq!(core.read(address::CALIBRATION_DATA).expect("a reply"), expected, "{at}");
        if fits {
            core.write(address::CALIBRATION_DATA, before).expect("a reply");
        }
    };
    for (word, fits) in [(0, true), (0x1102, true), (0x1002, true), (0x1202, false), (3, false), (8, false)] {
        attempt(first, word, fits);
    }
    for bit in (4..8).chain(13..32) {
        attempt(first, 1 << bit, false);
    }
    for place in [1, 2] {
        for (word, fits) in [(0, true), (11, true), (12, false), (0x1_0000, false), (u32::MAX, false)] {
            attempt(first + place, word, fits);
        }
    }
    for index in [first + 3, first + 4, first + 3 + 11, first + 26] {
        for (weight, fits) in
            [(131_071, true), (-131_071, true), (131_072, false), (-131_072, false), (i32::MIN, false)]
        {
            attempt(index, weight.cast_unsigned(), fits);
        }
    }
    for index in [first + 27, first + 100, 0xFFFE] {
        attempt(index, 1, false);
    }
}
