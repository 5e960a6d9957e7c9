//! All modes and the timing of the stub in one go, and a wrong core is found out.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::stub::{DELAY, PLAIN_TRACE, answer, packet_sum, packets};
use testbench::simulate::{Job, SimulationError, frames_to_simulate, simulate};
use testbench::stream::Pacing;
use testbench::verilate::{Built, Verilate};

fn built(fault: u32) -> Built {
    Verilate::default().build(&packet_sum(fault)).expect("builds")
}

fn expected(packets: &[Vec<u32>]) -> Vec<Vec<u32>> {
    (0..).zip(packets).map(|(counter, packet)| answer(counter, packet)).collect()
}

fn job<'a>(built: &'a Built, packets: &'a [Vec<u32>], expected: &'a [Vec<u32>]) -> Job<'a> {
    let pacing = Pacing::BackToBack;
    Job {
        built,
        packets,
        timed: packets,
        expected,
        columns: 4,
        pacing,
        spacing: None,
        timeout: 500,
        seed: 1,
        trace: None,
        half_period: 4000,
    }
}

#[test]
fn a_right_core_is_exact_in_all_modes() {
    let packets = vec![vec![9, 8, 7]; 10];
    let expected = expected(&packets);
    let built = built(0);
    let job = job(&built, &packets, &expected);
    let answered = AtomicU64::new(0);
    let count = || {
        answered.fetch_add(1, Ordering::Relaxed);
    };
    let simulation = simulate(&job, &count).expect("runs");
    assert!(simulation.is_exact());
    assert_eq!(simulation.modes.len(), 4);
    assert!(simulation.modes.iter().all(|result| result.words == 40));
    assert_eq!(simulation.answers, expected);
    let cycles = 3 + DELAY + 1 + 4;
    assert_eq!((simulation.cycles.latency, simulation.cycles.interval), (cycles, cycles));
    assert_eq!(answered.into_inner(), frames_to_simulate(packets.len()));
    let [free, idle, stalled, both] = [0, 1, 2, 3].map(|mode| simulation.modes[mode].cycles);
    assert!(free < idle && free < stalled && free < both, "{free} {idle} {stalled} {both}");
}

#[test]
fn a_wrong_word_is_counted_in_every_mode_and_named() {
    let packets = packets(10);
    let mut expected = expected(&packets);
    expected[4][2] ^= 1;
    let built = built(0);
    let job = job(&built, &packets, &expected);
    let simulation = simulate(&job, &|| ()).expect("runs");
    assert_eq!((simulation.is_exact(), simulation.mismatches()), (false, 4));
    let mismatch = &simulation.modes[3].first_mismatches[0];
    assert_eq!((mismatch.frame, mismatch.beat, mismatch.name.as_str()), (4, 2, "F_x"));
}

#[test]
fn a_core_that_breaks_under_stalls_is_refused_by_mode() {
    let packets = packets(10);
    let expected = expected(&packets);
    let built = built(1);
    let job = job(&built, &packets, &expected);
    let error = simulate(&job, &|| ()).expect_err("must fail");
    assert!(matches!(error, SimulationError::Stream { mode: "stalled sink", .. }), "{error}");
    let nothing = Job { packets: &[], timed: &[], expected: &[], ..job };
    assert!(matches!(simulate(&nothing, &|| ()), Err(SimulationError::NoFrames)));
}

#[test]
fn the_free_running_mode_is_traced() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("wave.vcd");
    let packets = packets(2);
    let expected = expected(&packets);
    let built = Verilate::default().with_trace(PLAIN_TRACE).build(&packet_sum(0)).expect("builds");
    let trace = Some(file.as_path());
    let job = Job { trace, ..job(&built, &packets, &expected) };
    assert!(simulate(&job, &|| ()).expect("runs").is_exact());
    assert!(std::fs::read_to_string(&file).expect("written").contains("s_axis_tvalid"));
}
