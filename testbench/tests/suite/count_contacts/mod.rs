//! Contacts counted in hardware: the module by itself, whole designs against the model, the model against the solver.

#[allow(dead_code, reason = "shared with the tests of the solver, which use all of it")]
#[path = "../../../../golden/tests/suite/separate/kinds.rs"]
pub mod kinds;
mod module;

use std::collections::BTreeMap;

use golden::contacts::{Labels, SHARE};
use golden::design::{Design, Estimator, Outputs, PlanKind, Sensor};
use golden::matrices::{Matrices, MatrixName};
use golden::solver::Solver;
use hdl_gen::model::{BAD_LENGTH, NO_CONTACT, NOT_FINITE, SEVERAL_CONTACTS};
use hdl_gen::plan::{Plan, words};
use hdl_gen::timing::latency;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::{model_answers, timeout};
use testbench::stream::{Mode, Pattern, Traffic, exchange};

use crate::support::effort::half_of;
use crate::support::{built, by_plan, frames, in_parallel, planned, shipped, simulate_exactly, with_joint};
use kinds::{Kind, frame};

fn counting(mut design: Design) -> Design {
    design.name += "_counting";
    design.algorithm.count_contacts = true;
    design
}

fn wide(mut design: Design, bits: usize) -> Design {
    design.name += "_wide";
    design.hardware.stream_bits = bits as u32;
    design
}

/// Both plans, both estimators, narrow and wide streams, odd sides; and what has the shortest search of all. `make test` plays
/// every second.
fn designs() -> Vec<Design> {
    vec![
        shipped("odd"),
        counting(wide(by_plan(shipped("odd"), PlanKind::Reduced, Outputs::Field), 64)),
        counting(wide(by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants), 128)),
        counting(shipped("sensor1-fast-64")),
        counting(with_joint(shipped("small"))),
    ]
}

/// Stress whose seeds are where a drawing has no dot, with as many contacts as components, or fewer.
fn drawn(plan: &Plan, c33: &impl Fn(usize, usize) -> f64, touched: impl Fn(usize, usize) -> bool) -> Vec<u32> {
    let columns = plan.design.sensor.columns;
    let weight: Vec<f64> = (0..plan.taxels())
        .map(|taxel| if touched(taxel % columns, taxel / columns) { 1.0 + 0.3 * (taxel % 5) as f64 } else { 0.0 })
        .collect();
    let row = |taxel: usize| weight.iter().enumerate().map(|(of, weight)| c33(taxel, of) * weight).sum();
    let stress: Vec<f64> = (0..plan.taxels()).map(row).collect();
    let largest = stress.iter().fold(0.0_f64, |largest, stress| largest.max(stress.abs()));
    let to = -0.4 * plan.design.hardware.full_scale_pa / largest.max(f64::MIN_POSITIVE);
    plan.streams().packet(&stress.iter().map(|stress| to * stress).collect::<Vec<_>>())
}

/// Components that join late, boards, one to four contacts; between them frames without an answer.
fn packets(plan: &Plan, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let matrices = Matrices::of(&plan.design).expect("matrices");
    let c33 = matrices.dense(MatrixName::C33inv).try_inverse().expect("an inverse");
    let c33 = |row: usize, column: usize| c33[(row, column)];
    let shapes: [fn(usize, usize) -> bool; 10] = [
        |x, y| x < 2 && y < 2,
        |x, y| !(2..=3).contains(&x) && y < 2,
        |x, y| x != 2 && y != 2 && y < 4,
        |x, y| x % 4 < 2 && y % 4 < 2,
        // U, comb, rings that do not touch, a board, stripes, all.
        |x, y| x == 0 || y == 3 || x == 3,
        |x, y| x % 2 == 0 || y == 4,
        |x, y| x.max(y) % 3 == 0,
        |x, y| (x + y) % 2 == 0,
        |x, _| x % 3 == 0,
        |_, _| true,
    ];
    let mut packets: Vec<Vec<u32>> = Vec::new();
    for (index, shape) in shapes.into_iter().enumerate() {
        packets.push(drawn(plan, &c33, shape));
        let whole = packets[packets.len() - 1].clone();
        match index % 4 {
            0 => packets.push(vec![0; whole.len()]),
            1 => packets.push(whole[..whole.len() / 2].to_vec()),
            2 => packets.push([&[f32::NAN.to_bits()], &whole[1..]].concat()),
            _ => packets.push([whole.clone(), whole].concat()),
        }
    }
    packets.push(frames::contact(plan, random));
    packets.push(frames::noise(plan, 0.5, random));
    for packet in &mut packets {
        packet.resize(plan.streams().whole_beats(packet.len()), 0);
    }
    packets
}

#[test]
fn the_hardware_counts_as_the_model_does() {
    let failures: Vec<String> = in_parallel(&half_of(designs()), |design| {
        let plan = planned(design);
        let packets = packets(&plan, &mut ChaCha8Rng::seed_from_u64(11));
        let mut seen = BTreeMap::new();
        for answer in model_answers(&plan, &packets) {
            let (status, contacts) = (answer[words::STATUS] & 0xFFFF, answer[words::COUNTERS] & 0xFF);
            let blank = status & (NO_CONTACT | NOT_FINITE | BAD_LENGTH) != 0;
            assert_eq!((status & SEVERAL_CONTACTS != 0, blank), (contacts > 1, contacts == 0), "{}", design.name);
            *seen.entry(contacts).or_insert(0) += 1;
        }
        let most = if plan.taxels() < 20 { 2 } else { 4 };
        assert!((0..=most).all(|contacts| seen.contains_key(&contacts)), "{}: {seen:?}", design.name);
        simulate_exactly(&plan, &built(&plan), &packets, 3).err().map(|error| format!("{}: {error}", design.name))
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Counting takes no time: the stage of the search that a count must be over before is longer, on every grid.
#[test]
fn counting_is_over_before_the_search() {
    for design in designs() {
        let mut plain = design.clone();
        plain.algorithm.count_contacts = false;
        let [plain, counted] = [&plain, &design].map(planned);
        assert_eq!(plain.timeline, counted.timeline, "{}", design.name);
        // Of the grid search on any other sensor, too; the line search has as many cells as the sensor at hand needs.
        let block = counted.estimator.block();
        let own = &counted.design.sensor;
        let mut sensors = vec![own.clone()];
        if design.algorithm.estimator == Estimator::Joint {
            let grids = (2..=64).flat_map(|columns| (2..=64).map(move |rows| (columns, rows)));
            sensors.extend(grids.map(|(columns, rows)| Sensor { columns, rows, ..own.clone() }));
        }
        for sensor in sensors {
            let (count, search) = (latency::count_contacts(&sensor), block.stages(&sensor)[0].cycles);
            assert!(count < search, "{}, {sensor}: {count} cycles to count, {search} to search", design.name);
        }
    }
}

/// A sink that stands still until every place inside is taken: counts wait for frames that wait at every stage.
#[test]
fn counts_wait_for_their_frames() {
    let mut design = counting(with_joint(shipped("small")));
    design.algorithm.outputs = Outputs::Resultants;
    design.name += "_resultants";
    let plan = planned(&design);
    let matrices = Matrices::of(&plan.design).expect("matrices");
    let c33 = matrices.dense(MatrixName::C33inv).try_inverse().expect("an inverse");
    let c33 = |row: usize, column: usize| c33[(row, column)];
    let of = |several: bool| drawn(&plan, &c33, |x, _| x == 0 || (several && x == 3));
    let packets: Vec<Vec<u32>> = (0..24).map(|frame| of(frame % 3 == 0 || frame % 7 == 1)).collect();
    let sink = Pattern::Bursts {
        seed: 2,
        longest_run: 3 * plan.streams().beats_out() as u32,
        longest_pause: (16 * plan.timeline.interval_cycles) as u32,
    };
    let mode = Mode { name: "sink that stands still for long", source: Pattern::Free, sink };
    let traffic = Traffic::new(&packets, 40 * timeout(&plan)).with_mode(&mode);
    let mut core = built(&plan).load(1).expect("loaded");
    let outcome = exchange(&mut core, &traffic, |_| ()).expect("all frames come out");
    let expected = model_answers(&plan, &packets);
    let counts = |answer: &[u32]| (answer[words::STATUS] & SEVERAL_CONTACTS, answer[words::COUNTERS] & 0xFF);
    let found: Vec<_> = outcome.exchanges.iter().map(|exchange| counts(&exchange.words)).collect();
    assert_eq!(found, expected.iter().map(|answer| counts(answer)).collect::<Vec<_>>());
    assert!([1, 2].iter().all(|&contacts| found.iter().any(|found| found.1 == contacts)), "{found:?}");
}

fn pair(name: &str) -> (Plan, Solver) {
    let design = counting(shipped(name));
    (planned(&design), Solver::new(&design).expect("matrices"))
}

/// Rounding may move a taxel or a component across its threshold that is so near to it, in shares of the largest `|w|` or of
/// all.
const MARGIN: f64 = 1e-4;

/// How near weights come to a threshold: those of taxels over the largest, those of components over all.
fn distance(weight: &[f64], columns: usize) -> f64 {
    let (largest, all) = (weight.iter().copied().fold(0.0, f64::max), weight.iter().sum::<f64>());
    let touched: Vec<bool> = weight.iter().map(|&weight| weight > SHARE * largest).collect();
    let mut labels = Labels::default();
    labels.find(&touched, columns);
    let mut sums = vec![0.0; labels.count];
    for (component, weight) in labels.components.iter().zip(weight) {
        if let Some(component) = component {
            sums[*component] += weight;
        }
    }
    let of_taxels = weight.iter().map(|weight| (weight / largest - SHARE).abs());
    of_taxels.chain(sums.iter().map(|sum| (sum / all - SHARE).abs())).fold(f64::INFINITY, f64::min)
}

/// Shares from 2 to 40 % at which a count changes.
fn changes(count: impl Fn(f64) -> usize) -> Vec<f64> {
    let shares: Vec<f64> = (0..40).map(|step| 0.02 * 1.08_f64.powi(step)).collect();
    let bisected = |pair: &[f64]| {
        let (mut low, mut high) = (pair[0], pair[1]);
        for _ in 0..30 {
            let middle = f64::midpoint(low, high);
            *if count(middle) == count(pair[0]) { &mut low } else { &mut high } = middle;
        }
        high
    };
    shares.windows(2).filter(|pair| count(pair[0]) != count(pair[1])).map(bisected).collect()
}

/// One contact that grows beside another until it counts: beyond the margin of rounding, hardware and solver count alike.
#[test]
fn counts_differ_within_the_margin_of_rounding_alone() {
    for name in ["sensor1-fast", "sensor2-none", "sensor1-reduced"] {
        let (plan, solver) = pair(name);
        let sensor = &plan.design.sensor;
        let inverse = Matrices::of(&plan.design).expect("matrices").dense(MatrixName::C33inv);
        let mut frames = [0; 2];
        for seed in 0..10 {
            let [first, second] = [seed, 100 + seed].map(|seed| frame(sensor, Kind::One, seed).stress);
            let stress = |share: f64| -> Vec<f64> { first.iter().zip(&second).map(|(a, b)| a + share * b).collect() };
            let count = |share: f64| solver.solve(&stress(share)).expect("a whole frame").contacts;
            let beside = |change: f64| {
                (4..24).flat_map(move |bits| [-1.0, 1.0].map(|of| change + of * change * 0.5_f64.powi(bits)))
            };
            for share in changes(count).into_iter().flat_map(beside) {
                let stress = stress(share);
                let answer = &model_answers(&plan, &[plan.streams().packet(&stress)])[0];
                let force = |row: usize| (0..stress.len()).map(|of| inverse[(row, of)] * stress[of]).sum::<f64>();
                let weight: Vec<f64> = (0..stress.len()).map(|taxel| (-force(taxel)).max(0.0)).collect();
                let distance = distance(&weight, sensor.columns);
                let [counted, expected] = [(answer[words::COUNTERS] & 0xFF) as usize, count(share)];
                assert!(counted == expected || distance < MARGIN, "{name}: {counted}, not {expected}, at {distance}");
                frames[usize::from(distance < MARGIN)] += 1;
            }
        }
        assert!(frames.iter().all(|&frames| frames >= 25), "{name}: {frames:?} frames beyond and within the margin");
    }
}
