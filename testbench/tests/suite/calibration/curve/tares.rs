//! A tare along a curve.

use hdl_gen::plan::calibration::Bank;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::dut::{Core, Inputs};
use testbench::registers::{Access, address};
use testbench::stream::{Mode, Pattern, Traffic, exchange};

use super::super::{core, errors, judge, load, perform, read_back, send, wait};
use super::{counts, others, random_bank_and_curve, subject};
use crate::support::banks::tared;
use crate::support::in_parallel;

/// The curve goes along; what the other bank held is gone.
#[test]
fn a_tare_takes_the_curve_along() {
    let subject = subject();
    let calibration = subject.calibration();
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for log2 in [0, 2] {
        let mut core = subject.core(u64::from(log2));
        let [other, _] = others(subject);
        let bank = Bank { noise: (300.0 / calibration.stress.step()) as u32, ..other };
        perform(&mut core, &load(&bank, bank.crc()));
        let left = random_bank_and_curve(subject, &mut random);
        let accesses = load(&left, left.crc());
        perform(&mut core, &accesses[..accesses.len() - 1]);
        let level: Vec<f32> = (0..12).map(|_| random.random_range(0.0..400.0)).collect();
        let mut rest = |frames: usize| -> Vec<Vec<u32>> {
            (0..frames)
                .map(|_| level.iter().map(|level| (level + random.random_range(-1.0..1.0_f32)).to_bits()).collect())
                .collect()
        };
        let frames = rest(1 << log2);
        let tared = tared(&bank, calibration, &frames).expect("at rest");
        core.write(address::TARE, log2).expect("a reply");
        let packets = [frames, rest(3), counts(subject, 6, &mut ChaCha8Rng::seed_from_u64(3))].concat();
        let answers = send(&mut core, &packets);
        let banks = [calibration.power_up.clone(), bank, tared.clone()];
        let versions = judge(&subject.plan, &packets, &answers, &banks).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(versions.last(), Some(&2), "{versions:?}");
        wait(&mut core);
        assert_eq!((errors(&mut core), read_back(&mut core, true)), (0, tared.words()));
        assert_eq!(core.read(address::CALIBRATION_CRC).expect("a reply"), tared.crc());
    }
}

/// A frame's first beat waits no longer while the frame before it leaves Bz and `CeAn`.
const BEFORE_BZ: u64 = 200;

/// At every moment of a frame: a tare takes frames that begin after its command, though another is on the curve. The
/// source is so slow that a frame's first beat waits for nothing but the frame before it in Bz.
#[test]
fn a_tare_takes_no_frame_that_began_before() {
    let subject = subject();
    let calibration = subject.calibration();
    let mut random = ChaCha8Rng::seed_from_u64(12);
    let level: Vec<f32> = (0..12).map(|_| random.random_range(0.0..400.0)).collect();
    let packets: Vec<Vec<u32>> = (0..10)
        .map(|_| level.iter().map(|level| (level + random.random_range(-1.0..1.0_f32)).to_bits()).collect())
        .collect();
    let bank = Bank { noise: (300.0 / calibration.stress.step()) as u32, ..calibration.power_up.clone() };
    let tared: Vec<Vec<u32>> = packets
        .iter()
        .filter_map(|frame| Some(tared(&bank, calibration, std::slice::from_ref(frame))?.words()))
        .collect();
    assert_eq!(tared.len(), 10);
    let cycles: Vec<u64> = (3000..4200).step_by(8).collect();
    let told = in_parallel(&cycles, |&cycle| {
        let mut core = core(&subject.built, 12);
        for access in load(&bank, bank.crc()) {
            core.plan(10, access);
        }
        core.plan(cycle, Access::Write { address: address::TARE, data: 0, strobes: 0xF });
        let slow =
            Mode { name: "slow source", source: Pattern::Random { seed: 3, willing: 0.012 }, sink: Pattern::Free };
        let traffic = Traffic::new(&packets, timeout(&subject.plan)).with_mode(&slow);
        let outcome = exchange(&mut core, &traffic, |_| ()).expect("answers");
        for _ in 0..2000 {
            core.step(Inputs { run: true, ..Inputs::default() }).expect("runs");
        }
        let words = read_back(&mut core, true);
        let taken = tared.iter().position(|tared| *tared == words).ok_or("offsets of no frame")?;
        let exchange = &outcome.exchanges[taken];
        // The command's response comes some cycles after it is planned, and the frame is the next one to begin.
        if exchange.first_in + BEFORE_BZ < cycle {
            return Err(format!("cycle {cycle}: frame {taken}, which began in {}", exchange.first_in));
        }
        Ok(taken)
    });
    let wrong: Vec<&String> = told.iter().filter_map(|told: &Result<usize, String>| told.as_ref().err()).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}
