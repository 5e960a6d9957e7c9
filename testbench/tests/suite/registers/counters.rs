//! Frames, errors, cycles and interrupts, under frames of every kind.

use hdl_gen::model::{BAD_LENGTH, NOT_FINITE};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::{CoSimulation, timeout};
use testbench::dut::{Core, Inputs};
use testbench::registers::{Access, Controlled, address, check};
use testbench::stream::{Pacing, Traffic, exchange};

use super::{mixed, subjects};
use crate::support::faults::{broken, some_faults};
use crate::support::{frames, in_parallel, simulate_exactly};

#[test]
fn frames_and_errors_are_counted() {
    let cases: Vec<_> = subjects().iter().flat_map(|subject| (1..4).map(move |seed| (subject, seed))).collect();
    in_parallel(&cases, |&(subject, seed)| {
        let plan = &subject.plan;
        let packets = mixed(plan, 150, &mut ChaCha8Rng::seed_from_u64(u64::from(seed)));
        let co_simulation = CoSimulation::new(plan, packets, seed);
        let bad = co_simulation.expected.iter().filter(|words| words[0] & (NOT_FINITE | BAD_LENGTH) != 0).count();
        assert!((20..130).contains(&bad), "{bad} bad frames");
        let report = check(&co_simulation, &subject.built, || ()).expect("no rule broken");
        assert_eq!(report.wrong, Vec::<String>::new(), "{}, seed {seed}", plan.design.name);
        assert!(report.accesses > 100, "{}", report.accesses);
    });
}

/// With the bank around it the core answers the same words in the same cycles as without.
#[test]
fn the_streams_are_those_of_the_core() {
    in_parallel(subjects(), |subject| {
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let packets: Vec<Vec<u32>> = (0..12).map(|_| frames::contact(&subject.plan, &mut random)).collect();
        simulate_exactly(&subject.plan, &subject.built, &packets, 3).unwrap_or_else(|error| panic!("{error}"));
    });
}

#[test]
fn cycles_of_a_frame_alone_are_the_predicted_ones() {
    for subject in subjects() {
        let plan = &subject.plan;
        let mut core = Controlled::new(subject.built.load(5).expect("loads"), 5).expect("has a port");
        let packets = vec![frames::contact(plan, &mut ChaCha8Rng::seed_from_u64(3)); 3];
        let traffic = Traffic::new(&packets, timeout(plan)).with_pacing(Pacing::OneAtATime);
        exchange(&mut core, &traffic, |_| ()).expect("no rule is broken");
        let [latency, predicted] = [address::LAST_LATENCY, address::PREDICTED_LATENCY].map(|at| core.read(at).unwrap());
        assert_eq!(latency, predicted, "{}", plan.design.name);
    }
}

#[test]
fn interrupts_come_when_enabled_and_go_when_cleared() {
    let subject = &subjects()[0];
    let plan = &subject.plan;
    let good = frames::contact(plan, &mut ChaCha8Rng::seed_from_u64(3));
    let mut bad = good.clone();
    bad[1] = f32::NAN.to_bits();
    let [done, error] = [1, 2];
    for (enabled, packet, pending, rises) in [
        (0, &good, done, false),
        (done, &good, done, true),
        (error, &good, done, false),
        (error, &bad, done | error, true),
        (done | error, &bad, done | error, true),
    ] {
        let mut core = Controlled::new(subject.built.load(5).expect("loads"), 5).expect("has a port");
        core.plan(0, Access::Write { address: address::INTERRUPT_ENABLE, data: enabled, strobes: 0xF });
        let packets = [packet.clone()];
        let outcome = exchange(&mut core, &Traffic::new(&packets, timeout(plan)), |_| ()).expect("no rule is broken");
        let case = format!("enabled {enabled}, pending {pending}");
        // Three cycles after the last beat, and no earlier; the exchange ends some cycles later.
        let after = outcome.cycles - (outcome.exchanges[0].last_out + 3);
        assert_eq!(core.interrupts(), if rises { after } else { 0 }, "{case}");
        assert_eq!(core.read(address::INTERRUPT_STATUS).unwrap(), pending, "{case}");
        assert_eq!(core.interrupt(), rises, "{case}");
        // Zeros and strobes that are off clear nothing.
        core.write(address::INTERRUPT_STATUS, 0).unwrap();
        core.access(Access::Write { address: address::INTERRUPT_STATUS, data: 3, strobes: 0xE }).unwrap();
        assert_eq!(core.read(address::INTERRUPT_STATUS).unwrap(), pending, "{case}");
        // Bit by bit.
        core.write(address::INTERRUPT_STATUS, done).unwrap();
        assert_eq!(core.read(address::INTERRUPT_STATUS).unwrap(), pending & error, "{case}");
        assert_eq!(core.interrupt(), pending & error & enabled != 0, "{case}");
        core.write(address::INTERRUPT_STATUS, error).unwrap();
        assert_eq!(core.read(address::INTERRUPT_STATUS).unwrap(), 0, "{case}");
        assert!(!core.interrupt(), "{case}");
        // Enabling later what has happened before raises it too.
        core.step(Inputs { run: true, ..Inputs::default() }).unwrap();
    }
}

#[test]
fn a_wrong_count_is_noticed() {
    let subject = &subjects()[0];
    let plan = &subject.plan;
    let packets = mixed(plan, 40, &mut ChaCha8Rng::seed_from_u64(8));
    let co_simulation = CoSimulation::new(plan, packets, 1);
    let faults = [
        ("(status[5:4] != 2'd0)", "(status[4] != 1'd0)"),
        ("now - beginnings[oldest] + 32'd1", "now - beginnings[oldest]"),
        ("seen_end ? now - last_end : 32'd0", "now - last_end + 32'd1"),
        ("frames_in <= frames_in + 32'd1", "frames_in <= frames_in + 32'd2"),
        ("frame_done <= frame_ends;", "frame_done <= 1'b0;"),
    ];
    for (from, to) in some_faults(faults, |&(from, _)| ("sptfra_registers", from)) {
        let built = broken(plan, "sptfra_registers", from, to);
        let report = check(&co_simulation, &built, || ()).expect("no rule broken");
        assert_ne!(report.wrong, Vec::<String>::new(), "{to}");
    }
}
