//! The banks themselves: what is in them at power-up, what they take and what they refuse.

use golden::design::{CalibrationIn, Curve, Outputs, Samples};
use hdl_gen::plan::calibration::Bank;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::model_answers;
use testbench::dut::{Core, Inputs};
use testbench::registers::{Access, address};

use super::{
    ACTIVE, BUSY, COUNTERS, OUT_OF_RANGE, WRONG_CRC, counts, design, errors, judged, load, perform, read_back, subject,
    version, wait,
};
use crate::support::banks::random_bank;
use crate::support::{built, planned, shipped, simulate_exactly};

/// Words and cycles, in every mode of the streams, are the predicted ones.
#[test]
fn at_power_up_the_designs_calibration_acts() {
    let subject = subject();
    let packets = counts(&subject.plan, 14, &mut ChaCha8Rng::seed_from_u64(1));
    simulate_exactly(&subject.plan, &subject.built, &packets, 3).unwrap_or_else(|error| panic!("{error}"));
    let mut core = subject.core(1);
    let words = subject.calibration().power_up.words();
    assert_eq!(read_back(&mut core, true), words);
    assert_eq!(read_back(&mut core, false), words);
}

/// To the last bit, for samples of every format, along a curve or not, with a calibration or without, and dead taxels.
#[test]
fn ram_and_rom_say_the_same() {
    let curve = Curve { points: vec![[-90.0, 700.0], [0.0, 0.0], [60.0, -700.0], [4000.0, -2.2e5]], law: None };
    for (samples, curve) in [Samples::Float32, Samples::Int16, Samples::Uint16]
        .into_iter()
        .flat_map(|samples| [None, Some(&curve)].map(|curve| (samples, curve)))
    {
        for (calibrated, dead) in [(true, vec![]), (false, vec![]), (true, vec![3, 6])] {
            let mut ram = design(Outputs::Field);
            ram.hardware.samples = samples;
            ram.input.dead = dead;
            if let Some(curve) = curve {
                (ram.input.pa_per_count, ram.input.curve) = (None, Some(curve.clone()));
            }
            if !calibrated {
                ram.input.calibration = None;
            }
            let mut rom = ram.clone();
            rom.hardware.calibration = CalibrationIn::Rom;
            let [ram, rom] = [ram, rom].map(|design| planned(&design));
            let mut random = ChaCha8Rng::seed_from_u64(2);
            let mut packet = |_| -> Vec<u32> {
                let reach: f64 = random.random_range(10.0..5000.0);
                let mut count = |_| random.random_range(-reach..reach);
                let counts: Vec<f64> = (0..ram.taxels()).map(&mut count).collect();
                ram.streams().packet(&counts)
            };
            let packets: Vec<Vec<u32>> = (0..40).map(&mut packet).collect();
            let [answers, of_ram] = [&rom, &ram].map(|plan| {
                let mut answers = model_answers(plan, &packets);
                // The version of a bank, which ROM has not.
                for words in &mut answers {
                    words[COUNTERS] &= !0xff00;
                }
                answers
            });
            assert_eq!(answers, of_ram, "{samples}, {curve:?}, {calibrated}");
            assert!(answers.iter().any(|words| words[2] != 0), "{samples}, {curve:?}: forces");
        }
    }
}

/// Integers, several in a beat, one by one, dead taxels, a field, wide answers.
#[test]
fn another_design_from_end_to_end() {
    let mut design = design(Outputs::Field);
    design.name += "_wide";
    design.sensor = shipped("odd").sensor;
    design.input.calibration = None;
    design.input.dead = vec![3];
    design.hardware.samples = Samples::Uint16;
    design.hardware.stream_bits = 64;
    let plan = planned(&design);
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let packets: Vec<Vec<u32>> =
        (0..8).map(|_| (0..plan.streams().words_in()).map(|_| random.random()).collect()).collect();
    let built = built(&plan);
    simulate_exactly(&plan, &built, &packets, 3).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_bank_of_any_content_acts_once_it_is_committed() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut core = subject.core(2);
    for expected in 1..12 {
        let bank = random_bank(subject.calibration(), &mut random);
        perform(&mut core, &load(&bank, bank.crc()));
        assert_eq!(errors(&mut core), 0);
        assert_eq!(version(&mut core), expected);
        assert_eq!(core.read(address::CALIBRATION_CRC).expect("a reply"), bank.crc());
        assert_eq!(read_back(&mut core, true), bank.words());
        let packets = counts(&subject.plan, 5, &mut random);
        // The versions before are of no frame here.
        let banks = vec![bank; expected as usize + 1];
        let seen = judged(&subject.plan, &mut core, &packets, &banks).unwrap_or_else(|error| panic!("{error}"));
        assert!(seen.iter().all(|&seen| seen == expected as usize));
    }
}

#[test]
fn half_a_bank_never_acts() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let bank = random_bank(subject.calibration(), &mut random);
    let packets = counts(&subject.plan, 3, &mut random);
    let whole = load(&bank, bank.crc());
    let commit = *whole.last().expect("a commit");
    let power_up = subject.calibration().power_up.clone();
    let words = bank.words().len();
    let mut core = subject.core(3);
    for written in [0, 1, words / 2, words - 1] {
        perform(&mut core, &whole[..=written]);
        perform(&mut core, &[commit]);
        assert_eq!(errors(&mut core), WRONG_CRC, "{written} words");
        assert_eq!(version(&mut core), 0);
        judged(&subject.plan, &mut core, &packets, std::slice::from_ref(&power_up)).unwrap_or_else(|e| panic!("{e}"));
        // A reset makes no difference, nor does one of the core.
        core.write(address::CONTROL, 1).expect("a reply");
        assert_eq!(read_back(&mut core, true), power_up.words());
    }
    perform(&mut core, &whole);
    assert_eq!((errors(&mut core), version(&mut core)), (0, 1));
}

#[test]
fn a_reset_leaves_the_calibration() {
    let subject = subject();
    let bank = random_bank(subject.calibration(), &mut ChaCha8Rng::seed_from_u64(7));
    let mut core = subject.core(4);
    perform(&mut core, &load(&bank, bank.crc()));
    // The other one half written.
    perform(&mut core, &load(&subject.calibration().power_up, 0)[..20]);
    for _ in 0..4 {
        core.step(Inputs::default()).expect("runs");
    }
    assert_eq!(version(&mut core), 1);
    assert_eq!(core.read(address::CALIBRATION_CRC).expect("a reply"), bank.crc());
    assert_eq!(read_back(&mut core, true), bank.words());
}

#[test]
fn what_is_out_of_bounds_is_refused() {
    let subject = subject();
    let calibration = subject.calibration();
    let (limit, taxels) = (calibration.offset_limit as i32, calibration.taxels as u32);
    let power_up = calibration.power_up.words();
    let gain = |mantissa: i32, exponent: u32| exponent << 18 | mantissa.cast_unsigned() & 0x3_FFFF;
    let offset = |offset: i32| offset.cast_unsigned();
    let mut core = subject.core(5);
    let mut attempt = |index: u32, word: u32, fits: bool| {
        core.write(address::CALIBRATION_INDEX, index).expect("a reply");
        core.write(address::CALIBRATION_DATA, word).expect("a reply");
        let at = format!("word {index}: {word:#010x}");
        assert_eq!(core.read(address::CALIBRATION_INDEX).expect("a reply"), index + 1, "{at}");
        assert_eq!(errors(&mut core), if fits { 0 } else { OUT_OF_RANGE }, "{at}");
        core.write(address::CALIBRATION_INDEX, index).expect("a reply");
        let expected = if fits { word } else { power_up.get(index as usize).copied().unwrap_or(0) };
        assert_eq!(core.read(address::CALIBRATION_DATA).expect("a reply"), expected, "{at}");
        if fits {
            core.write(address::CALIBRATION_DATA, power_up[index as usize]).expect("a reply");
            assert_eq!(core.read(address::CALIBRATION_ERRORS).expect("a reply"), 0, "{at}");
        }
    };
    for mantissa in [1 << 16, (1 << 17) - 1, 99_999, -(1 << 16), 1 - (1 << 17), -77_777] {
        attempt(0, gain(mantissa, 0x3FF), true);
        attempt(taxels - 1, gain(mantissa, 0), true);
    }
    for mantissa in [0, 1, -1, (1 << 16) - 1, 1 - (1 << 16), 1 << 17, 12_345, -12_345] {
        attempt(3, gain(mantissa, 5), false);
    }
    for bit in 28..32 {
        attempt(5, gain(70_000, 5) | 1 << bit, false);
    }
    for (value, fits) in [(0, true), (limit, true), (-limit, true), (limit + 1, false), (-limit - 1, false)] {
        attempt(taxels, offset(value), fits);
        attempt(2 * taxels - 1, offset(value), fits);
    }
    for value in [i32::MIN, i32::MAX] {
        attempt(taxels + 1, offset(value), false);
    }
    for (word, fits) in [(0, false), (1, true), (u32::MAX, true)] {
        attempt(2 * taxels, word, fits);
    }
    for (word, fits) in [(0, false), (1, true), ((1 << 26) - 1, true), (1 << 26, false), (u32::MAX, false)] {
        attempt(2 * taxels + 1, word, fits);
    }
    for index in [2 * taxels + 2, 2 * taxels + 100, 0xFFFE] {
        attempt(index, gain(70_000, 5), false);
    }
    // Fewer bytes than a word has are none; a tare of too many frames is refused.
    core.write(address::CALIBRATION_INDEX, 0).expect("a reply");
    for strobes in 0..0xF {
        core.access(Access::Write { address: address::CALIBRATION_DATA, data: !0, strobes }).expect("a reply");
        core.access(Access::Write { address: address::CALIBRATION_COMMIT, data: !0, strobes }).expect("a reply");
        core.access(Access::Write { address: address::TARE, data: 0, strobes }).expect("a reply");
    }
    assert_eq!((errors(&mut core), core.read(address::CALIBRATION_INDEX).expect("a reply")), (0, 0));
    for frames in [11, 16, u32::MAX] {
        core.write(address::TARE, frames).expect("a reply");
        assert_eq!(errors(&mut core), OUT_OF_RANGE, "2^{frames} frames");
    }
    assert_eq!((read_back(&mut core, true), read_back(&mut core, false)), (power_up.clone(), power_up));
}

/// Also under way nothing is written, begun or read.
#[test]
fn while_busy_writes_are_refused() {
    let subject = subject();
    let bank = random_bank(subject.calibration(), &mut ChaCha8Rng::seed_from_u64(8));
    let mut core = subject.core(6);
    let accesses = load(&bank, bank.crc());
    for &access in &accesses {
        core.access(access).expect("a reply");
    }
    let word = bank.words()[0];
    for (address, data) in [(address::CALIBRATION_DATA, word ^ 1), (address::CALIBRATION_COMMIT, 5), (address::TARE, 0)]
    {
        core.write(address, data).expect("a reply");
        assert_eq!(errors(&mut core), BUSY);
    }
    assert_eq!(core.read(address::CALIBRATION_DATA).expect("a reply"), 0);
    wait(&mut core);
    core.write(address::CALIBRATION_INDEX, ACTIVE).expect("a reply");
    assert_eq!(core.read(address::CALIBRATION_DATA).expect("a reply"), word);
    assert_eq!((version(&mut core), read_back(&mut core, true)), (1, bank.words()));
}

/// The bit that reads what acts writes the other bank all the same: what acts has a CRC, and frames inside.
#[test]
fn what_acts_is_never_written() {
    let subject = subject();
    let power_up = subject.calibration().power_up.words();
    let bank = random_bank(subject.calibration(), &mut ChaCha8Rng::seed_from_u64(10)).words();
    let mut core = subject.core(9);
    for (index, &word) in bank.iter().enumerate() {
        core.write(address::CALIBRATION_INDEX, ACTIVE | index as u32).expect("a reply");
        core.write(address::CALIBRATION_DATA, word).expect("a reply");
    }
    assert_eq!(errors(&mut core), 0);
    assert_eq!((read_back(&mut core, true), read_back(&mut core, false)), (power_up, bank));
}

/// The model's CRC is that of the words' bytes.
#[test]
fn the_crc_covers_every_word() {
    let calibration = subject().calibration();
    let crc = calibration.power_up.crc();
    let changed = |change: &dyn Fn(&mut Bank)| {
        let mut bank = calibration.power_up.clone();
        change(&mut bank);
        bank.crc()
    };
    for taxel in 0..calibration.taxels {
        assert_ne!(changed(&|bank| bank.gains[taxel].0 ^= 1), crc);
        assert_ne!(changed(&|bank| bank.gains[taxel].1 ^= 1), crc);
        assert_ne!(changed(&|bank| bank.offsets[taxel] ^= 1), crc);
    }
    assert_ne!(changed(&|bank| bank.contact ^= 1), crc);
    assert_ne!(changed(&|bank| bank.noise ^= 1), crc);
}

/// A core whose memory has another calibration than the plan says is noticed.
#[test]
fn a_wrong_content_is_noticed() {
    let subject = subject();
    let mut core = subject.core(8);
    let packets = counts(&subject.plan, 4, &mut ChaCha8Rng::seed_from_u64(9));
    let mut other = subject.calibration().power_up.clone();
    other.offsets[4] += 1 << 12;
    perform(&mut core, &load(&other, other.crc()));
    let power_up = subject.calibration().power_up.clone();
    assert!(judged(&subject.plan, &mut core, &packets, &[power_up.clone(), power_up]).is_err());
}
