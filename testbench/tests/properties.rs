//! RTL against model on random designs and frames: every word in every stream mode, and the predicted cycles.
//!
//! A failure names the seed of the random designs and shows the design file.

mod support;

use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::compare::Comparison;
use testbench::run::{model_answers, timeout};
use testbench::stream::{Mode, Pacing, Traffic, exchange};

use support::random::{self, Shape, seed};
use support::{built, frames, in_parallel, planned, simulate_exactly};

const RANDOM_DESIGNS: u64 = 14;
/// Cycles to simulate in each stream mode of one design, roughly.
const MOST_CYCLES: u64 = 150_000;
fn packets(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let mut packets = frames::extremes(plan, random);
    packets.extend((0..6).map(|_| frames::contact(plan, random)));
    packets.extend([1e-4, 1e-3, 0.03, 1.0, 1.2].map(|share| frames::noise(plan, share, random)));
    // An input that settles for a frame hides what it takes over from the frame before.
    for index in (1..packets.len()).rev() {
        packets.swap(index, random.random_range(0..=index));
    }
    packets.truncate((MOST_CYCLES / plan.timeline.interval_cycles) as usize);
    packets
}

fn check(plan: &Plan, random: &mut ChaCha8Rng) -> Result<(), String> {
    let packets = packets(plan, random);
    simulate_exactly(plan, &built(plan), &packets, random.random())
        .map(drop)
        .map_err(|error| format!("{error}\nin the design\n{}", plan.design.to_toml()))
}

#[test]
fn random_designs_agree_with_the_model() {
    let numbers: Vec<u64> = (0..RANDOM_DESIGNS).collect();
    let results = in_parallel(&numbers, |&number| {
        let (plan, mut random) = random::plan(number)?;
        check(&plan, &mut random)
    });
    let failures: Vec<String> = results.into_iter().filter_map(Result::err).collect();
    assert!(failures.is_empty(), "SPTFRA_TEST_SEED={}: {}", seed(), failures.join("\n\n"));
}

/// Sizes that a random draw hardly ever hits, each at an end of some range.
#[test]
fn corner_designs_agree_with_the_model() {
    let base = |columns, rows, lanes| Shape {
        columns,
        rows,
        pitch_mm: [3.0, 4.0],
        depth_mm: 2.5,
        filter: "{ kind = \"none\" }".to_owned(),
        lanes,
        coefficient_bits: 18,
        data_bits: 27,
        full_scale_pa: 1e5,
    };
    let narrow = Shape { coefficient_bits: 8, data_bits: 16, ..base(6, 4, 3) };
    let diagonal = Shape { filter: "{ kind = \"f1\", l = 22 }".to_owned(), ..base(4, 6, 2) };
    let shapes = [
        ("more_lanes_than_taxels", base(2, 2, 64)),
        ("lanes_not_used_evenly", base(9, 2, 33)),
        ("one_lane", base(2, 5, 1)),
        ("tall", base(3, 32, 16)),
        ("wide", base(32, 2, 7)),
        ("narrow_words", narrow),
        ("three_diagonals", diagonal),
    ];
    let results = in_parallel(&shapes, |(name, shape)| {
        let plan = planned(&shape.design(name));
        check(&plan, &mut ChaCha8Rng::seed_from_u64(seed()))
    });
    let failures: Vec<String> = results.into_iter().filter_map(Result::err).collect();
    assert!(failures.is_empty(), "SPTFRA_TEST_SEED={}: {}", seed(), failures.join("\n\n"));
}

/// The largest sensor on the most lanes, its matrices filtered to seven diagonals. Two frames are long enough to
/// simulate: each of its memories is used to the end.
#[test]
fn the_largest_sensor_agrees_with_the_model() {
    let shape = Shape {
        columns: 32,
        rows: 32,
        pitch_mm: [4.0, 2.0],
        depth_mm: 3.0,
        filter: "{ kind = \"f1\", l = 1020 }".to_owned(),
        lanes: 64,
        coefficient_bits: 18,
        data_bits: 27,
        full_scale_pa: 1e5,
    };
    let plan = planned(&shape.design("largest"));
    let mut random = ChaCha8Rng::seed_from_u64(seed());
    let packets = [frames::contact(&plan, &mut random), frames::noise(&plan, 1.0, &mut random)];
    let expected = model_answers(&plan, &packets);
    let built = built(&plan);
    let [free, .., both] = Mode::all(1);
    for (mode, pacing) in [(free, Pacing::OneAtATime), (both, Pacing::BackToBack)] {
        let traffic = Traffic::new(&packets, timeout(&plan)).with_mode(&mode).with_pacing(pacing);
        let outcome = exchange(&mut built.load(1).expect("loads"), &traffic, |_| ()).expect(mode.name);
        let answers = outcome.exchanges.iter().map(|exchange| exchange.words.as_slice());
        let comparison = Comparison::new(&expected, answers, 32);
        assert!(comparison.is_exact(), "{}: {:?}", mode.name, comparison.first);
        if mode.is_free() {
            assert_eq!(outcome.latency(), Some(plan.timeline.latency_cycles));
        }
    }
}
