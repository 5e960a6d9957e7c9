//! A calibration in RAM behind a scanner that cannot be held: commits and a tare among frames of which some are dropped.

use golden::design::CalibrationIn;
use hdl_gen::model::{DROPPED, Model};
use hdl_gen::plan::calibration::Bank;
use hdl_gen::plan::words::COUNTERS;
use testbench::co_simulation::timeout;
use testbench::registers::{Access, Controlled, address};
use testbench::stream::{Outcome, Pacing, Traffic, exchange};

use super::{Subject, packets, subjects};
use crate::support::banks::tared;

fn subject() -> &'static Subject {
    let in_ram = |subject: &&Subject| subject.plan.design.hardware.calibration == CalibrationIn::Ram;
    subjects().iter().find(in_ram).expect("one of them")
}

/// What comes of a scanner twice as fast as the core, while accesses go on from a cycle on.
fn scan(packets: &[Vec<u32>], cycle: u64, accesses: &[Access]) -> Outcome {
    let Subject { plan, built } = subject();
    let mut core = Controlled::new(built.load(1).expect("loads"), 1).expect("has a port");
    for &access in accesses {
        core.plan(cycle, access);
    }
    let pacing = Pacing::Spaced { cycles: plan.timeline.interval_cycles / 2, inside: usize::MAX };
    let traffic = Traffic::new(packets, timeout(plan)).with_pacing(pacing).with_drops();
    let outcome = exchange(&mut core, &traffic, |_| ()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(core.read(address::CALIBRATION_ERRORS).expect("a reply"), 0);
    assert_eq!(core.read(address::FRAMES_DROPPED).expect("a reply") as usize, outcome.dropped.len());
    outcome
}

/// Every answer is that of the bank whose version it states, and both act.
fn judge(packets: &[Vec<u32>], outcome: &Outcome, next: &Bank) {
    let mut model = Model::new(&subject().plan);
    let mut stated = 0;
    for exchange in &outcome.exchanges {
        let version = exchange.words[COUNTERS] >> 8 & 0xFF;
        assert!(version >= stated && version < 2, "version {version} after {stated}");
        if version > stated {
            model.commit(next.clone());
            stated = version;
        }
        let expected = model.process(&packets[exchange.packet]);
        let words: Vec<u32> =
            std::iter::once(exchange.words[0] & !DROPPED).chain(exchange.words[1..].to_vec()).collect();
        assert_eq!(words, expected, "packet {}, version {version}", exchange.packet);
    }
    assert_eq!(stated, 1, "the change is among the frames");
    assert!(!outcome.dropped.is_empty());
}

fn write(address: u32, data: u32) -> Access {
    Access::Write { address, data, strobes: 0xF }
}

#[test]
fn frames_are_computed_with_a_whole_bank() {
    let plan = &subject().plan;
    let power_up = &plan.calibration.as_ref().expect("in RAM").power_up;
    let gains = power_up.gains.iter().map(|&(mantissa, exponent)| (mantissa, exponent - 1)).collect();
    let bank = Bank { gains, ..power_up.clone() };
    let words = bank.words().into_iter().map(|word| write(address::CALIBRATION_DATA, word));
    let accesses: Vec<Access> = words.chain([write(address::CALIBRATION_COMMIT, bank.crc())]).collect();
    let packets = packets(plan, 60);
    for cycle in (10..1500).step_by(211) {
        judge(&packets, &scan(&packets, cycle, &accesses), &bank);
    }
}

#[test]
fn a_tare_takes_frames_that_have_room() {
    let plan = &subject().plan;
    let calibration = plan.calibration.as_ref().expect("in RAM");
    let counts: Vec<f64> = (0..plan.taxels()).map(|taxel| 40.0 + taxel as f64).collect();
    let packet = plan.streams().packet(&counts);
    let samples: Vec<u32> = plan.streams().samples_of(packet.iter().copied()).take(plan.taxels()).collect();
    let tared = tared(&calibration.power_up, calibration, &vec![samples; 4]).expect("rest");
    let packets = vec![packet; 60];
    for cycle in [10, 700, 1501] {
        judge(&packets, &scan(&packets, cycle, &[write(address::TARE, 2)]), &tared);
    }
}
