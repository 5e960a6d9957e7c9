//! RTL against model on random designs and frames: every word in every stream mode, and the predicted cycles.
//!
//! A failure names the seed of the random designs and shows the design file.

use golden::design::{Optimise, Scaling};
use hdl_gen::plan::Plan;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::{model_answers, timeout};
use testbench::compare::Comparison;
use testbench::stream::{Mode, Outcome, Pacing, Pattern, Traffic, exchange};
use testbench::verilate::Built;

use crate::support::effort::{all, share_of, some_of};
use crate::support::random::{self, Kind, Shape, seed};
use crate::support::{built, frames, in_parallel, planned, simulate_exactly};

const RANDOM_DESIGNS: u64 = 18;
/// With every key drawn.
const DESIGNS_OF_EVERY_KEY: u64 = 400;
/// Of these, what `make test` tries; the last one drops frames, and shows its interval after more than `INTERVAL_FRAMES`.
const FEW_OF_EVERY_KEY: [u64; 6] = [0, 1, 2, 3, 4, 117];
/// Cycles to simulate in each stream mode of one design, roughly.
const MOST_CYCLES: usize = 150_000;
/// Frames to send to a sink that is slower than the core: more than there are places inside.
const PILED_UP: usize = 14;

fn packets(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let mut packets = frames::extremes(plan, random);
    packets.extend((0..6).map(|_| frames::contact(plan, random)));
    packets.extend([1e-4, 1e-3, 0.03, 1.0, 1.2].map(|share| frames::noise(plan, share, random)));
    if plan.smoothing.is_some() {
        packets = frames::held(&packets, random);
    }
    if plan.design.input.counts() {
        packets = packets.iter().map(|packet| in_counts(plan, packet)).collect();
    }
    // An input that settles for a frame hides what it takes over from the frame before.
    // An average takes in what is alike.
    for index in (1..packets.len()).rev().filter(|_| plan.smoothing.is_none()) {
        packets.swap(index, random.random_range(0..=index));
    }
    packets.truncate((share_of(MOST_CYCLES) as u64 / plan.timeline.interval_cycles) as usize);
    packets
}

/// A packet of pascals as the counts that a sensor of this design delivers.
fn in_counts(plan: &Plan, packet: &[u32]) -> Vec<u32> {
    let (input, samples) = (&plan.design.input, plan.design.hardware.samples);
    let count =
        |(taxel, &bits): (usize, &u32)| samples.clip(input.from_pa(taxel, f64::from(f32::from_bits(bits))).round());
    plan.streams().packet(&packet.iter().enumerate().map(count).collect::<Vec<_>>())
}

/// Frames in a row through the RTL, judged by the model.
fn agrees(plan: &Plan, built: &Built, packets: &[Vec<u32>], mode: &Mode, pacing: Pacing) -> Result<Outcome, String> {
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", mode.name);
    // A core that drops frames gets one at a time: of those that come while the sink stands still it would lose some.
    let pacing = if plan.streams().drops { Pacing::OneAtATime } else { pacing };
    let traffic = Traffic::new(packets, 8 * timeout(plan)).with_mode(mode).with_pacing(pacing);
    let mut core = built.load(1).map_err(|error| failed(&error))?;
    let outcome = exchange(&mut core, &traffic, |_| ()).map_err(|error| failed(&error))?;
    let expected = model_answers(plan, packets);
    let answers = outcome.exchanges.iter().map(|exchange| exchange.words.as_slice());
    let comparison = Comparison::new(&expected, answers, plan.design.sensor.columns);
    match comparison.first.first() {
        Some(first) => Err(failed(first)),
        None => Ok(outcome),
    }
}

/// A sink that takes a frame in twice the time in which the core makes one: they pile up to the last place.
fn slow_sink(plan: &Plan) -> Mode {
    let willing = plan.streams().beats_out() as f64 / (2 * plan.timeline.interval_cycles) as f64;
    Mode { name: "slow sink", source: Pattern::Free, sink: Pattern::Random { seed: 1, willing } }
}

/// A sink that stands still until every place inside is taken, then takes several frames at full speed.
fn stuck_sink(plan: &Plan) -> Mode {
    let longest_run = 3 * plan.streams().beats_out() as u32;
    let longest_pause = (12 * plan.timeline.interval_cycles) as u32;
    let sink = Pattern::Bursts { seed: 2, longest_run, longest_pause };
    Mode { name: "sink that stands still for long", source: Pattern::Free, sink }
}

fn check(plan: &Plan, random: &mut ChaCha8Rng) -> Result<(), String> {
    let packets = packets(plan, random);
    let built = built(plan);
    let few = &packets[..packets.len().min(PILED_UP)];
    simulate_exactly(plan, &built, &packets, random.random())
        .and_then(|_| agrees(plan, &built, few, &slow_sink(plan), Pacing::BackToBack))
        .and_then(|_| agrees(plan, &built, few, &stuck_sink(plan), Pacing::BackToBack))
        .map(drop)
        .map_err(|error| format!("{error}\nin the design\n{}", plan.design.to_toml()))
}

#[test]
fn random_designs_agree_with_the_model() {
    let numbers = some_of(0..RANDOM_DESIGNS);
    let results = in_parallel(&numbers, |&number| {
        let (plan, mut random) = random::plan(number)?;
        check(&plan, &mut random)
    });
    let failures: Vec<String> = results.into_iter().filter_map(Result::err).collect();
    assert!(failures.is_empty(), "SPTFRA_TEST_SEED={}: {}", seed(), failures.join("\n\n"));
}

/// Every key of a design file drawn, among them those of the intake.
#[test]
fn random_designs_of_every_key_agree_with_the_model() {
    let numbers = if all() { (0..DESIGNS_OF_EVERY_KEY).collect() } else { FEW_OF_EVERY_KEY.to_vec() };
    let results = in_parallel(&numbers, |&number| {
        let (plan, mut random) = random::plan_of_every_key(number)?;
        check(&plan, &mut random)
    });
    let failures: Vec<String> = results.into_iter().filter_map(Result::err).collect();
    assert!(failures.is_empty(), "SPTFRA_TEST_SEED={}: {}", seed(), failures.join("\n\n"));
}

fn judge(plans: &[Plan]) {
    let plans = some_of(plans);
    let results = in_parallel(&plans, |plan| check(plan, &mut ChaCha8Rng::seed_from_u64(seed())));
    let failures: Vec<String> = results.into_iter().filter_map(Result::err).collect();
    assert!(failures.is_empty(), "SPTFRA_TEST_SEED={}: {}", seed(), failures.join("\n\n"));
}

/// Sizes that a random draw hardly ever hits, each at an end of some range.
#[test]
fn corner_designs_agree_with_the_model() {
    let base = |columns, rows, lanes| Shape {
        kind: Kind::Paper,
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
        ("more_lanes_than_taxels", base(2, 2, 32)),
        ("lanes_not_used_evenly", base(9, 2, 33)),
        ("one_lane", base(2, 5, 1)),
        ("tall", base(3, 32, 16)),
        ("wide", base(32, 2, 7)),
        ("narrow_words", narrow),
        ("three_diagonals", diagonal),
        ("long_coefficients", Shape { coefficient_bits: 27, ..base(4, 3, 5) }),
    ];
    let plans: Vec<Plan> = shapes.iter().map(|(name, shape)| planned(&shape.design(name))).collect();
    judge(&plans);
}

/// The same for the reduced plan: one orbit, whose programs are shorter than the pipelines; sides of which the middle
/// column or row is its own mirror image; one group of four lanes, and as many as there can be.
#[test]
fn corner_designs_of_the_reduced_plan_agree_with_the_model() {
    let field = Kind::Field { latency: false };
    let base = |kind, columns, rows, lanes| Shape {
        kind,
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
    let square = |shape: Shape| Shape { pitch_mm: [3.0, 3.0], ..shape };
    let latency = Kind::Field { latency: true };
    let joint = |field, correction| Kind::Joint { field, correction };
    let shapes = [
        ("one_orbit", base(field, 2, 2, 4)),
        ("one_square_orbit_for_latency", square(base(latency, 2, 2, 8))),
        ("one_orbit_resultants", base(Kind::Resultants, 2, 2, 64)),
        ("square_and_odd", square(base(field, 3, 3, 4))),
        ("even_and_odd", base(latency, 2, 7, 4)),
        ("odd_and_even", base(field, 7, 2, 12)),
        ("most_lanes", square(base(field, 12, 12, 128))),
        ("tall_resultants", base(Kind::Resultants, 3, 32, 16)),
        ("wide", base(field, 40, 2, 8)),
        ("narrow_words_reduced", Shape { coefficient_bits: 8, data_bits: 16, ..base(latency, 6, 4, 8) }),
        // Two and eight taxels a cell of the search with three points.
        ("two_a_cell", base(field, 7, 7, 64)),
        ("eight_a_cell", base(Kind::Resultants, 12, 12, 64)),
        ("one_orbit_joint", base(joint(true, true), 2, 2, 4)),
        ("uncorrected_joint", base(joint(true, false), 5, 3, 4)),
        ("resultants_joint", base(joint(false, true), 9, 4, 16)),
        ("wide_joint", base(joint(true, true), 40, 2, 8)),
        ("narrow_joint", Shape { coefficient_bits: 8, data_bits: 16, ..base(joint(true, true), 6, 7, 8) }),
        ("wide_words", Shape { coefficient_bits: 27, data_bits: 35, ..base(latency, 6, 4, 8) }),
        ("wide_words_square", square(Shape { coefficient_bits: 27, data_bits: 35, ..base(field, 5, 5, 12) })),
        ("wide_words_joint", Shape { coefficient_bits: 27, data_bits: 35, ..base(joint(true, true), 6, 7, 8) }),
        ("long_coefficients_reduced", Shape { coefficient_bits: 24, data_bits: 18, ..base(field, 3, 4, 4) }),
        ("long_vectors", Shape { coefficient_bits: 9, data_bits: 29, ..base(Kind::Resultants, 7, 4, 12) }),
        ("band_reduced", Shape { filter: "{ kind = \"f1\", l = 22 }".to_owned(), ..base(field, 4, 6, 8) }),
    ];
    let mut plans: Vec<Plan> = shapes.iter().map(|(name, shape)| planned(&shape.design(name))).collect();
    // The points of the grid one row after the other.
    for (name, shape) in [
        ("row_by_row", base(joint(true, true), 9, 5, 4)),
        ("row_by_row_uncorrected", base(joint(true, false), 12, 6, 8)),
    ] {
        let mut design = shape.design(name);
        design.hardware.optimise = Optimise::Area;
        let plan = planned(&design);
        assert!(plan.estimator.joint().is_some_and(|joint| joint.search.is_serial()), "{name}");
        plans.push(plan);
    }
    judge(&plans);
}

/// The same where each frame has a range of its own: by every estimator and plan, the shortest frames, which pass while the
/// one before is scaled, the most lanes, which wait for them, and narrow words.
#[test]
fn corner_designs_with_a_range_for_each_frame_agree_with_the_model() {
    let base = |kind, columns, rows, lanes| Shape {
        kind,
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
    let joint = |field, correction| Kind::Joint { field, correction };
    let shapes = [
        ("paper_of_four_scaled", base(Kind::Paper, 2, 2, 24)),
        ("paper_narrow_scaled", Shape { coefficient_bits: 8, data_bits: 16, ..base(Kind::Paper, 6, 4, 3) }),
        ("one_orbit_scaled", base(Kind::Resultants, 2, 2, 64)),
        ("odd_for_latency_scaled", base(Kind::Field { latency: true }, 3, 5, 4)),
        ("most_lanes_scaled", base(Kind::Field { latency: false }, 10, 10, 100)),
        ("one_orbit_joint_scaled", base(joint(true, true), 2, 2, 4)),
        ("joint_scaled", Shape { full_scale_pa: 1e-3, ..base(joint(true, true), 9, 4, 16) }),
        ("wide_words_scaled", Shape { coefficient_bits: 27, data_bits: 35, ..base(joint(true, true), 6, 5, 8) }),
        ("narrow_joint_scaled", Shape { coefficient_bits: 8, data_bits: 16, ..base(joint(false, true), 6, 7, 8) }),
    ];
    let plan = |(name, shape): &(&str, Shape)| {
        let mut design = shape.design(name);
        design.hardware.scaling = Scaling::PerFrame;
        // Beats of one, two and four words by turns.
        design.hardware.stream_bits = [32, 64, 128][(shape.columns + shape.lanes) % 3];
        planned(&design)
    };
    judge(&shapes.iter().map(plan).collect::<Vec<_>>());
}

/// The largest sensor on the most lanes, its matrices filtered to seven diagonals. Two frames are long enough to
/// simulate: each of its memories is used to the end.
#[test]
#[ignore = "a quarter of a minute: part of `make test-long`"]
fn the_largest_sensor_agrees_with_the_model() {
    let shape = Shape {
        kind: Kind::Paper,
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
    let built = built(&plan);
    let [free, .., both] = Mode::all(1);
    let alone = agrees(&plan, &built, &packets, &free, Pacing::OneAtATime).expect("bit for bit");
    assert_eq!(alone.latency(), Some(plan.timeline.latency_cycles));
    agrees(&plan, &built, &packets, &both, Pacing::BackToBack).expect("bit for bit");
}
