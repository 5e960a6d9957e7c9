//! Tare: the mean of frames at rest becomes the offsets; what is no rest changes nothing.

use hdl_gen::plan::calibration::Bank;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::registers::{Access, address};
use testbench::stream::{Mode, Pattern, Traffic, exchange};

use super::{
    BAD_FRAME, BUSY, NOT_AT_REST, OUT_OF_RANGE, Subject, core, counts, errors, judge, load, perform, read_back, send,
    subject, version,
};
use crate::support::banks::{random_bank, tared};
use crate::support::in_parallel;

/// Cycles in which the bank is written, before the first tare.
const LOADED: u64 = 900;

/// What makes frames at rest into others.
type Change<'a> = &'a dyn Fn(&mut Vec<Vec<u32>>);

/// Taring is bit 10 of the status.
const TARING: u32 = 1 << 10;

/// Frames of a sensor at rest that reads something in each taxel, and noise of so many counts on that.
pub(super) fn rest(subject: &Subject, frames: usize, noise: f64, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let level: Vec<f64> = (0..subject.plan.taxels()).map(|_| random.random_range(-200.0..200.0)).collect();
    (0..frames)
        .map(|_| {
            let reads = |&level: &f64| ((level + random.random_range(-1.0..1.0) * noise) as f32).to_bits();
            level.iter().map(reads).collect()
        })
        .collect()
}

/// A bank with a noise floor of about so many counts.
pub(super) fn quiet_bank(subject: &Subject, counts: f64) -> Bank {
    let calibration = subject.calibration();
    Bank { noise: (counts * calibration.count_steps.abs()) as u32, ..calibration.power_up.clone() }
}

#[test]
fn at_rest_the_mean_becomes_the_offsets() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for log2 in [0, 1, 3, 5] {
        let mut core = subject.core(u64::from(log2));
        let bank = quiet_bank(subject, 3.0);
        perform(&mut core, &load(&bank, bank.crc()));
        let frames = rest(subject, 1 << log2, 1.0, &mut random);
        let tared = tared(&bank, subject.calibration(), &frames).expect("at rest");
        core.write(address::TARE, log2).expect("a reply");
        assert_eq!(core.read(address::CALIBRATION_STATUS).expect("a reply") & TARING, TARING);
        core.write(address::CALIBRATION_DATA, 5).expect("a reply");
        assert_eq!(errors(&mut core), BUSY);
        let packets = [frames, rest(subject, 3, 40.0, &mut random), counts(&subject.plan, 6, &mut random)].concat();
        let answers = send(&mut core, &packets);
        let banks = [subject.calibration().power_up.clone(), bank, tared.clone()];
        let versions = judge(&subject.plan, &packets, &answers, &banks).unwrap_or_else(|error| panic!("{error}"));
        // The frames of the tare are answered as before it; the last ones are tared.
        assert!(versions[..1 << log2].iter().all(|&version| version == 1), "{versions:?}");
        assert_eq!(versions.last(), Some(&2), "2^{log2}: {versions:?}");
        super::wait(&mut core);
        assert_eq!((errors(&mut core), version(&mut core)), (0, 2));
        assert_eq!(read_back(&mut core, true), tared.words());
        assert_eq!(core.read(address::CALIBRATION_CRC).expect("a reply"), tared.crc());
    }
}

#[test]
fn what_is_no_rest_changes_nothing() {
    let subject = subject();
    let calibration = subject.calibration();
    let bank = quiet_bank(subject, 3.0);
    let restless = |frames: &mut Vec<Vec<u32>>| frames[5][7] = (f32::from_bits(frames[5][7]) + 9.0).to_bits();
    let last = |frames: &mut Vec<Vec<u32>>| frames[7][11] = (f32::from_bits(frames[7][11]) - 9.0).to_bits();
    let number = |frames: &mut Vec<Vec<u32>>| frames[3][0] = f32::NAN.to_bits();
    let infinite = |frames: &mut Vec<Vec<u32>>| frames[7][11] = f32::INFINITY.to_bits();
    let clipped = |frames: &mut Vec<Vec<u32>>| frames[0][2] = 1e6_f32.to_bits();
    let short = |frames: &mut Vec<Vec<u32>>| frames[2].truncate(11);
    let long = |frames: &mut Vec<Vec<u32>>| frames[7].push(0);
    let cases: [(&str, Change<'_>, u32); 7] = [
        ("a taxel moves", &restless, NOT_AT_REST),
        ("the last one of the last frame moves", &last, NOT_AT_REST),
        ("a NaN", &number, BAD_FRAME),
        ("an infinity at the end", &infinite, BAD_FRAME),
        ("beyond the full scale", &clipped, BAD_FRAME),
        ("a frame too short", &short, BAD_FRAME),
        ("a frame too long", &long, BAD_FRAME),
    ];
    for (seed, (what, change, error)) in (1..).zip(cases) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut core = subject.core(seed);
        perform(&mut core, &load(&bank, bank.crc()));
        let mut packets = rest(subject, 8, 1.0, &mut random);
        assert!(tared(&bank, calibration, &packets).is_some());
        change(&mut packets);
        packets.extend(counts(&subject.plan, 4, &mut random));
        core.write(address::TARE, 3).expect("a reply");
        let answers = send(&mut core, &packets);
        let banks = [calibration.power_up.clone(), bank.clone()];
        let versions =
            judge(&subject.plan, &packets, &answers, &banks).unwrap_or_else(|error| panic!("{what}: {error}"));
        assert!(versions.iter().all(|&version| version == 1), "{what}");
        // A NaN counts as 0, and so spreads too.
        let seen = errors(&mut core);
        assert!(seen & error != 0 && seen & !(BAD_FRAME | NOT_AT_REST) == 0, "{what}: {seen:#x}");
        assert!(error == BAD_FRAME || seen == NOT_AT_REST, "{what}: {seen:#x}");
        assert_eq!((version(&mut core), read_back(&mut core, true)), (1, bank.words()), "{what}");
    }
}

/// Under a load that moves it is no rest.
#[test]
fn under_load_nothing_is_tared() {
    let subject = subject();
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let mut core = subject.core(9);
    let bank = quiet_bank(subject, 3.0);
    perform(&mut core, &load(&bank, bank.crc()));
    let packets = counts(&subject.plan, 8, &mut random);
    core.write(address::TARE, 2).expect("a reply");
    let answers = send(&mut core, &packets);
    let banks = [subject.calibration().power_up.clone(), bank.clone()];
    judge(&subject.plan, &packets, &answers, &banks).unwrap_or_else(|error| panic!("{error}"));
    assert!(errors(&mut core) & (NOT_AT_REST | BAD_FRAME) != 0);
    assert_eq!((version(&mut core), read_back(&mut core, true)), (1, bank.words()));
}

/// An offset near its bound, and a reading on the other side that would take it beyond.
#[test]
fn a_tare_to_an_offset_out_of_bounds_changes_nothing() {
    let subject = subject();
    let calibration = subject.calibration();
    let mut core = subject.core(10);
    let mut bank = quiet_bank(subject, 3.0);
    bank.offsets[5] = calibration.offset_limit as i32 - 1;
    perform(&mut core, &load(&bank, bank.crc()));
    let at = |taxel: usize, share: f64| {
        let steps = share * calibration.stress.bound as f64 - f64::from(bank.offsets[taxel]);
        let (mantissa, exponent) = bank.gains[taxel];
        let count = steps / f64::from(mantissa) * f64::from(calibration.shift as i32 - exponent).exp2();
        (count as f32).to_bits()
    };
    let frame: Vec<u32> = (0..calibration.taxels).map(|taxel| at(taxel, if taxel == 5 { -0.5 } else { 0.0 })).collect();
    assert!(tared(&bank, calibration, std::slice::from_ref(&frame)).is_none());
    core.write(address::TARE, 0).expect("a reply");
    send(&mut core, &[frame.clone(), frame]);
    assert_eq!(errors(&mut core), OUT_OF_RANGE);
    assert_eq!((version(&mut core), read_back(&mut core, true)), (1, bank.words()));
}

/// A tare that begins within a frame, where another one has just failed, takes whole frames that begin after it.
#[test]
fn a_tare_again_within_a_frame_leaves_the_rest_of_it_alone() {
    let subject = subject();
    let calibration = subject.calibration();
    let interval = subject.plan.timeline.interval_cycles;
    let bank = quiet_bank(subject, 3.0);
    let mut random = ChaCha8Rng::seed_from_u64(12);
    let mut packets = rest(subject, 16, 1.0, &mut random);
    // The first tare ends here, in the middle of a frame. The taxel reads next to nothing else, as a NaN does: what the
    // first tare had of it would not look restless to the second one.
    for packet in &mut packets {
        packet[5] = random.random_range(-0.5_f32..0.5).to_bits();
    }
    packets[5][5] = f32::NAN.to_bits();
    let pairs: Vec<Vec<u32>> =
        packets.windows(2).filter_map(|pair| Some(tared(&bank, calibration, pair)?.words())).collect();
    let cycles: Vec<u64> = (0..4 * interval).step_by(5).collect();
    let told = in_parallel(&cycles, |&cycle| {
        let mut core = core(&subject.built, 12);
        for access in load(&bank, bank.crc()) {
            core.plan(10, access);
        }
        let tare = |data| Access::Write { address: address::TARE, data, strobes: 0xF };
        core.plan(LOADED, tare(3));
        core.plan(LOADED + interval + cycle, tare(1));
        // A source that takes its time, so that there is a rest of the frame.
        let pattern = Pattern::Random { seed: 3, willing: 12.0 / interval as f64 };
        let slow = Mode { name: "slow source", source: pattern, sink: Pattern::Free };
        let traffic = Traffic::new(&packets, timeout(&subject.plan)).with_mode(&slow);
        exchange(&mut core, &traffic, |_| ()).expect("answers");
        let errors = errors(&mut core);
        let tared = read_back(&mut core, true);
        match version(&mut core) {
            // Refused while the first one ran, or not at an end yet.
            1 => Ok(false),
            2 if pairs.contains(&tared) => Ok(errors & BAD_FRAME != 0),
            other => Err(format!("cycle {cycle}: version {other}, errors {errors:#x}, offsets of no two frames")),
        }
    });
    let wrong: Vec<&String> = told.iter().filter_map(|told| told.as_ref().err()).collect();
    assert!(wrong.is_empty(), "{} of {}: {}", wrong.len(), told.len(), wrong[0]);
    assert!(told.iter().filter(|told| **told == Ok(true)).count() > 40, "{told:?}");
}

/// A soft reset ends a tare.
#[test]
fn a_soft_reset_ends_a_tare() {
    let subject = subject();
    let mut core = subject.core(11);
    let bank = random_bank(subject.calibration(), &mut ChaCha8Rng::seed_from_u64(2));
    perform(&mut core, &load(&bank, bank.crc()));
    core.write(address::TARE, 4).expect("a reply");
    core.write(address::CONTROL, 1).expect("a reply");
    super::wait(&mut core);
    assert_eq!((errors(&mut core), version(&mut core)), (BAD_FRAME, 1));
}
