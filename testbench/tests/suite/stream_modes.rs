//! The stream driver on the stub: answers in every mode, stamps, resets.

use crate::stub::{DELAY, answer, load, packets};
use proptest::prelude::*;
use testbench::stream::{Mode, Pacing, Pattern, Reset, Traffic, exchange};

const TIMEOUT: u64 = 500;

#[test]
fn every_mode_gives_the_right_answers() {
    let packets = packets(40);
    for mode in Mode::all(3) {
        let traffic = Traffic::new(&packets, TIMEOUT).with_mode(&mode);
        let outcome = exchange(&mut load(0), &traffic, |_| ()).expect(mode.name);
        assert_eq!(outcome.exchanges.len(), packets.len(), "{}", mode.name);
        for (k, (got, packet)) in (0..).zip(outcome.exchanges.iter().zip(&packets)) {
            assert_eq!(got.words, answer(k, packet), "{}, packet {k}", mode.name);
            assert_eq!(got.packet, k as usize);
        }
    }
}

#[test]
fn latency_and_interval_are_those_of_the_stand_in() {
    let packets = vec![vec![1, 2, 3, 4, 5, 6]; 5];
    // Six words in, the edge into WAIT, the pause and its end, four words out.
    let cycles = 6 + (DELAY + 1) + 4;
    let alone = Traffic::new(&packets, TIMEOUT).with_pacing(Pacing::OneAtATime);
    let outcome = exchange(&mut load(0), &alone, |_| ()).expect("runs");
    assert_eq!(outcome.latency(), Some(cycles));
    let outcome = exchange(&mut load(0), &Traffic::new(&packets, TIMEOUT), |_| ()).expect("runs");
    assert_eq!(outcome.interval(), Some(cycles));
}

#[test]
fn progress_counts_the_answers() {
    let packets = packets(4);
    let mut seen = Vec::new();
    exchange(&mut load(0), &Traffic::new(&packets, TIMEOUT), |count| {
        seen.push(count);
    })
    .expect("runs");
    assert_eq!(seen, [1, 2, 3, 4]);
}

#[test]
fn a_reset_gives_up_one_packet_and_the_next_is_right() {
    let packets = vec![vec![7; 20]; 3];
    let resets = [Reset { cycle: 10, length: 3 }];
    let traffic = Traffic::new(&packets, TIMEOUT).with_resets(&resets);
    let outcome = exchange(&mut load(0), &traffic, |_| ()).expect("runs");
    let sent: Vec<usize> = outcome.exchanges.iter().map(|exchange| exchange.packet).collect();
    assert_eq!(sent, [1, 2], "packet 0 was under way");
    assert_eq!(outcome.exchanges[0].words, answer(0, &packets[1]), "counter and sum start again");
}

#[test]
fn a_reset_while_the_answer_comes_out_loses_that_answer() {
    let packets = vec![vec![7; 4]; 3];
    // Four words in, DELAY + 1 cycles, then two of the four words out.
    let resets = [Reset { cycle: 4 + DELAY + 1 + 2, length: 1 }];
    let traffic = Traffic::new(&packets, TIMEOUT).with_resets(&resets).with_pacing(Pacing::OneAtATime);
    let outcome = exchange(&mut load(0), &traffic, |_| ()).expect("runs");
    let sent: Vec<usize> = outcome.exchanges.iter().map(|exchange| exchange.packet).collect();
    assert_eq!(sent, [1, 2]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn answers_do_not_depend_on_the_pauses(
        seed in any::<u64>(),
        willing in 0.05f64..1.0,
        longest_run in 1u32..20,
        longest_pause in 1u32..20,
        packets in prop::collection::vec(prop::collection::vec(any::<u32>(), 1..12), 1..12),
    ) {
        let source = Pattern::Bursts { seed, longest_run, longest_pause };
        let sink = Pattern::Random { seed, willing };
        let traffic = Traffic { source, sink, ..Traffic::new(&packets, 2000) };
        let outcome = exchange(&mut load(0), &traffic, |_| ()).expect("runs");
        prop_assert_eq!(outcome.exchanges.len(), packets.len());
        for (k, (got, packet)) in (0..).zip(outcome.exchanges.iter().zip(&packets)) {
            prop_assert_eq!(&got.words, &answer(k, packet));
        }
    }
}
