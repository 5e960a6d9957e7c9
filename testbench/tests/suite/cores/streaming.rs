//! Runs of the cores that work every cycle: multiply-accumulate lane, skid buffer, row sequencer.

use std::collections::VecDeque;

use hdl_gen::cores::{ACCUMULATOR_BITS, DROPPED_BITS};
use hdl_gen::plan::matrix::product;
use hdl_gen::plan::schedule::{MACS_BITS, MAX_SEGMENT};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::bench::{Played, Port, Run};

/// Cycles from a lane's operands to the accumulator that holds their product.
const LANE_LATENCY: usize = 3;

/// Words that the skid buffer holds at most. It takes one only while it holds fewer, and offers them in their order.
const CAPACITY: usize = 2;

fn bits(flag: bool) -> u64 {
    u64::from(flag)
}

/// Both forms of the lane: they have the same reference and the same cycles.
pub fn mac(module: &'static str) -> Run {
    const INPUTS: &[Port] = &[("reset", 1), ("valid", 1), ("first", 1), ("coefficient", 18), ("data", 27)];
    lane(module, INPUTS, |[coefficient, data]| coefficient * data)
}

/// The lane of two multipliers.
pub fn mac_wide(module: &'static str) -> Run {
    const INPUTS: &[Port] = &[("reset", 1), ("valid", 1), ("first", 1), ("coefficient", 27), ("data", 35)];
    lane(module, INPUTS, |[coefficient, data]| product(coefficient as i32, data, DROPPED_BITS))
}

/// A lane, and what it adds of both operands: to the sum so far, or to 0 where it starts anew. Sums wrap.
fn lane(module: &'static str, inputs: &'static [Port], product: impl Fn([i64; 2]) -> i64) -> Run {
    let mut run = Run::new(module, inputs, &[("accumulator", ACCUMULATOR_BITS)]);
    let widths = [inputs[3].1, inputs[4].1];
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    // Products on their way; the accumulator shows one after LANE_LATENCY cycles.
    let mut pipeline: VecDeque<Option<(bool, [i64; 2])>> = vec![None; LANE_LATENCY - 1].into();
    let mut accumulator: Option<i64> = None;
    for cycle in 0..40_000 {
        let reset = cycle < 3 || rng.random_ratio(1, 2_000);
        let phase = cycle / 1_000;
        let valid = rng.random_bool([1.0, 0.6, 0.1][phase % 3]);
        // In some phases no sum ever starts anew, so that the accumulator wraps.
        let first = phase % 4 != 3 && rng.random_bool([0.1, 0.5, 1.0, 0.0][phase % 4]);
        let kind = rng.random_range(0..4);
        let operands = widths.map(|bits| {
            let least = -1_i64 << (bits - 1);
            // The ends, and those of what two multipliers halve.
            let corners = [0, 1, -1, least, -least - 1, 1 << 16, (1 << 16) - 1, (1 << 17) - 1, -1 << 17];
            match kind {
                0 => least,
                1 => corners[rng.random_range(0..corners.len())],
                _ => rng.random::<i64>() >> (64 - bits),
            }
        });
        let inputs = [bits(reset), bits(valid), bits(first), operands[0] as u64, operands[1] as u64];
        run.push(&inputs, &[accumulator.map(|value| value as u64)]);
        pipeline.push_back((valid && !reset).then_some((first, operands)));
        if let Some((first, operands)) = pipeline.pop_front().flatten()
            && (first || accumulator.is_some())
        {
            let sum = product(operands) + accumulator.filter(|_| !first).unwrap_or(0);
            let unused = 64 - ACCUMULATOR_BITS;
            accumulator = Some(sum << unused >> unused);
            run.results += 1;
        }
        if reset {
            // The product that was one stage from the accumulator has arrived; the ones behind it are discarded.
            pipeline.make_contiguous().fill(None);
        }
    }
    run
}

/// Both forms of the multiplier.
pub fn multiply(module: &'static str) -> Run {
    factors(Run::new(module, &[("enable", 1), ("coefficient", 18), ("data", 27)], &[("product", 45)]))
}

/// Two multipliers.
pub fn multiply_wide(module: &'static str) -> Run {
    factors(Run::new(module, &[("enable", 1), ("coefficient", 18), ("data", 35)], &[("product", 53)]))
}

fn factors(mut run: Run) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let widths = [run.inputs[1].1, run.inputs[2].1];
    let mut expected: Option<i64> = None;
    for _ in 0..20_000 {
        let [coefficient, data] = widths.map(|bits| {
            let least = -1_i64 << (bits - 1);
            let corners = [0, 1, -1, least, -least - 1, -1 << 17, (1 << 17) - 1];
            let corner = rng.random_bool(0.3).then(|| corners[rng.random_range(0..corners.len())]);
            corner.unwrap_or_else(|| rng.random::<i64>() >> (64 - bits))
        });
        let enable = rng.random_bool(0.8);
        run.push(&[bits(enable), coefficient as u64, data as u64], &[expected.map(|product| product as u64)]);
        run.results += usize::from(expected.is_some());
        if enable {
            expected = Some(coefficient * data);
        }
    }
    run
}

pub fn axis_skid() -> Run {
    let mut run = Run::new(
        "sptfra_axis_skid",
        &[("reset", 1), ("s_tdata", 32), ("s_tlast", 1), ("s_tvalid", 1), ("m_tready", 1)],
        &[("s_tready", 1), ("m_tdata", 32), ("m_tlast", 1), ("m_tvalid", 1)],
    );
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut stored: VecDeque<(u32, bool)> = VecDeque::new();
    let mut offered: Option<(u32, bool)> = None;
    let mut ready = false;
    for cycle in 0..80_000 {
        let reset = cycle < 3;
        let phase = cycle / 500;
        let (source, sink) = ([1.0, 0.5, 0.1][phase % 3], [1.0, 0.5, 0.1][phase / 3 % 3]);
        if !reset && offered.is_none() && rng.random_bool(source) {
            offered = Some((rng.random(), rng.random()));
        }
        let given = !reset && rng.random_bool(sink);
        // Nothing is promised of the wires before the first edge, nor of data that is not offered.
        let known = cycle > 0;
        let (data, last) = offered.unwrap_or((rng.random(), rng.random()));
        let front = stored.front();
        run.push(
            &[bits(reset), u64::from(data), bits(last), bits(offered.is_some()), bits(given)],
            &[
                known.then_some(bits(ready)),
                front.map(|word| u64::from(word.0)),
                front.map(|word| bits(word.1)),
                known.then_some(bits(front.is_some())),
            ],
        );
        if given && stored.pop_front().is_some() {
            run.results += 1;
        }
        if ready && let Some(word) = offered.take() {
            stored.push_back(word);
        }
        ready = !reset && stored.len() < CAPACITY;
    }
    run
}

/// The stream's rules, from what the simulation did and without the cycle model.
pub fn check_stream(played: &Played) {
    let [s_data, s_last, s_valid, m_ready] = ["s_tdata", "s_tlast", "s_tvalid", "m_tready"].map(|n| played.input(n));
    let [m_data, m_last, m_valid, s_ready] = ["m_tdata", "m_tlast", "m_tvalid", "s_tready"].map(|n| played.output(n));
    let transfers = |valid: &[u64], ready: &[u64], data: &[u64], last: &[u64]| -> Vec<(u64, u64)> {
        (1..valid.len()).filter(|&i| valid[i] & ready[i] == 1).map(|i| (data[i], last[i])).collect()
    };
    let taken = transfers(&s_valid, &s_ready, &s_data, &s_last);
    let given = transfers(&m_valid, &m_ready, &m_data, &m_last);
    assert!(given.len() > 20_000 && taken.len() - given.len() <= CAPACITY, "{} of {}", given.len(), taken.len());
    assert!(taken.starts_with(&given), "words lost, doubled or out of order");
    for i in 1..m_valid.len() - 1 {
        if m_valid[i] == 1 && m_ready[i] == 0 {
            let waiting = (m_valid[i + 1], m_data[i + 1], m_last[i + 1]);
            assert_eq!(waiting, (1, m_data[i], m_last[i]), "the offer of cycle {i} changed before it was taken");
        }
    }
    let full_speed = 10..490;
    assert!(full_speed.clone().all(|i| s_valid[i] & m_ready[i] == 1), "the first phase runs at full speed");
    assert!(full_speed.clone().all(|i| s_ready[i] & m_valid[i] == 1), "the buffer takes and gives a word every cycle");
}

/// What the sequencer says of one product.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Product {
    /// It is the first of its row.
    first: bool,
    /// It is the last of its row.
    last: bool,
    /// Its row's kind.
    kind: u8,
}

/// One entry of the row ROM: a row of `kind` (two bits) with `macs` products, at least one.
fn row_word(kind: u8, macs: u32) -> u16 {
    u16::from(kind) << MACS_BITS | macs as u16
}

/// What `sptfra_row_sequencer` answers to the successive cycles with `issue` after a restart, for the rows of a ROM.
fn products(rows: &[u16]) -> impl Iterator<Item = Product> {
    rows.iter().flat_map(|word| {
        let (kind, macs) = ((word >> MACS_BITS) as u8, word & ((1 << MACS_BITS) - 1));
        (0..macs).map(move |position| Product { first: position == 0, last: position + 1 == macs, kind })
    })
}

pub fn row_sequencer() -> Run {
    let mut run = Run::new(
        "sptfra_row_sequencer",
        &[("restart", 1), ("start_address", 16), ("issue", 1), ("row_word", 16)],
        &[("row_address", 16), ("row_fetch", 1), ("first", 1), ("last", 1), ("kind", 2)],
    );
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for walk in 0..150 {
        let longest = [1, 2, 6, 40][walk % 4];
        let mut rows: Vec<u16> = (0..rng.random_range(1..300))
            .map(|_| row_word(rng.random_range(0..4), rng.random_range(1..=longest)))
            .collect();
        if walk == 7 {
            rows.push(row_word(2, MAX_SEGMENT));
        }
        let pace = [1.0, 0.5, 0.15][walk % 3];
        let started = walk_rows(&mut run, &mut rng, &rows, pace);
        assert!(started <= rows.len());
    }
    run
}

/// One walk from a restart to the end of the rows or to where it is given up; returns the rows started.
fn walk_rows(run: &mut Run, rng: &mut ChaCha8Rng, rows: &[u16], pace: f64) -> usize {
    let mut expected = products(rows).peekable();
    let gives_up = rng.random_bool(0.3);
    let mut started = 0;
    // Programs begin anywhere; addresses are as many as the port has.
    let begin: u16 = [0, rng.random_range(0..50_000)][usize::from(rng.random::<bool>())];
    let address = |started: usize| Some(u64::from(begin) + started as u64);
    // An issue in the cycle of restart does not count, and neither does the word then at the port.
    let issue = bits(rng.random());
    run.push(&[1, u64::from(begin), issue, rng.random()], &[None, None, None, None, None]);
    run.push(&[0, rng.random(), 0, rng.random()], &[address(0), Some(1), None, None, None]);
    while expected.peek().is_some() && !(gives_up && rng.random_ratio(1, 200)) {
        // Past its end the ROM may hold anything.
        let word = rows.get(started).copied().unwrap_or_else(|| rng.random());
        if !rng.random_bool(pace) {
            run.push(&[0, rng.random(), 0, u64::from(word)], &[address(started + 1), Some(0), None, None, None]);
        } else if let Some(Product { first, last, kind }) = expected.next() {
            let address = address(started + 1);
            started += usize::from(first);
            run.push(
                &[0, rng.random(), 1, u64::from(word)],
                &[address, Some(bits(first)), Some(bits(first)), Some(bits(last)), Some(u64::from(kind))],
            );
            run.results += 1;
        }
    }
    started
}
