//! The grid search's plan: formats that no frame can leave, ROMs that hold what the plan says.

use golden::design::{Correction, Design, Estimator, StandardError};
use hdl_gen::emit::emit;
use hdl_gen::estimators::joint::search::{FRACTION, GRID, MARGIN_BITS, U_BITS, VALUE_BITS, WEIGHT_DROP};
use hdl_gen::estimators::joint::{CORRECTION_LIMIT, INPUT_BITS, NetworkPlan, STRESS_BITS, UNIT_BITS};
use hdl_gen::model::{Model, SATURATED};
use hdl_gen::plan::Plan;

use super::support::{design_text, plan};

const FRICTION_STEP: f32 = 1.0 / 65_536.0;

/// A design with a correction of one weight all over, of either sign in turn if it alternates.
fn with_weights(half_window: [usize; 2], units: usize, hidden: i32, output: i32, alternating: bool) -> Plan {
    let text = design_text("pad", [10, 10], [4.0, 2.0], 3.0, "");
    let mut design = Design::from_toml(&text, "test.toml").unwrap();
    design.algorithm.estimator = Estimator::Joint;
    let inputs = Correction::inputs(half_window);
    let sign = |index: usize| if alternating && index % 2 == 1 { -1 } else { 1 };
    let row = |shift: usize| (0..inputs).map(|index| sign(index + shift) * hidden).collect();
    let readout = |shift: usize| (0..units).map(|index| sign(index + shift) * output).collect();
    design.algorithm.joint.correction =
        Some(Correction { half_window, hidden: (0..units).map(row).collect(), output: [readout(0), readout(1)] });
    Plan::new(&design).unwrap()
}

fn network(plan: &Plan) -> &NetworkPlan {
    plan.estimator.joint().and_then(|joint| joint.network.as_ref()).unwrap()
}

#[test]
fn no_sum_of_the_network_can_overflow() {
    for (half_window, units, hidden, output) in [
        ([0, 0], 1, 1, 1),
        ([1, 0], 5, -131_072, 131_071),
        ([4, 7], 128, 4096, -300),
        ([9, 9], 256, 131_071, -131_072),
        ([9, 9], 3, 0, 0),
    ] {
        for alternating in [false, true] {
            let plan = with_weights(half_window, units, hidden, output, alternating);
            let network = network(&plan);
            assert_eq!(
                (network.passes, network.weights.len()),
                (units.div_ceil(network.at_once), network.passes * network.length)
            );
            for pass in network.weights.chunks(network.length) {
                for unit in 0..network.at_once {
                    let component = |component: usize| -> i64 {
                        pass.iter().map(|word| i64::from(word[unit][component].abs())).sum()
                    };
                    let sums = [0, 1, 2, 3].map(component);
                    let most = 1_i64 << (INPUT_BITS - 1);
                    assert!(sums.iter().all(|&sum| sum * most < 1 << 47), "a component fits the accumulator");
                    let narrow = pass.iter().all(|word| word[unit].iter().all(|weight| weight.abs() < 1 << 17));
                    assert!(narrow, "18 bits");
                }
            }
            let total: i64 = network.readout.iter().map(|weights| i64::from(weights[0].abs())).sum();
            assert!(total << (UNIT_BITS) < 1 << 47, "the output fits the accumulator");
            // The worst look: every value of the window at its limit, with the signs of the weights.
            let inputs = Correction::inputs(half_window) as i64;
            let unit = i128::from(inputs * i64::from(hidden.abs())) << (STRESS_BITS - 1);
            let left = -12 - network.weight_lsb - network.unit_shift as i32;
            let unit = if left >= 0 { unit << left } else { unit >> -left };
            assert!(unit + 4 < 1 << (UNIT_BITS - 1), "{half_window:?}, {hidden}: a unit fits its width");
        }
    }
}

/// A normalised `u` at its limits, at the corners of the grid: terms fit `FRACTION + 4` bits with their sign, and tensions
/// as many bits as a value has.
#[test]
fn terms_of_the_grid_search_have_room_for_every_taxel() {
    let largest = (1_i64 << (U_BITS - 1)) - 1;
    let limits = [-largest - 1, largest];
    let corners = [-i64::from(GRID.reach), i64::from(GRID.reach)];
    let mut sums = Vec::new();
    for (u0, u1, u2) in
        limits.iter().flat_map(|u0| limits.map(|u1| (u0, u1))).flat_map(|(u0, u1)| limits.map(|u2| (u0, u1, u2)))
    {
        for (x, y) in corners.iter().flat_map(|x| corners.map(|y| (x, y))) {
            // The dead zone is from nothing to a share of all.
            for dead_zone in [0, 1 << (FRACTION - 8)] {
                sums.push(u0 - dead_zone + ((x * u1) >> GRID.shift) + ((y * u2) >> GRID.shift));
            }
        }
    }
    let most = 1 << (FRACTION + 3);
    assert!(sums.iter().all(|sum| (-most..most).contains(sum)));
    assert!(sums.iter().all(|sum| *sum < 1 << VALUE_BITS));
    // Depths of the level, squared, are weights of which a row of points fits 26 bits.
    let depth = (1_i64 << (FRACTION - 8)) + 1;
    assert!(depth < 1 << MARGIN_BITS);
    assert!(GRID.side() as i64 * ((depth * depth) >> WEIGHT_DROP) < 1 << 26);
}

/// The gain is in the matrices, so forces have it and friction does not.
#[test]
fn the_gain_scales_forces_and_nothing_else() {
    let text = |gain: f64| {
        let more = format!("[algorithm]\nestimator = \"joint\"\ngain = {gain:?}\nfriction_correction = [1, 0]");
        plan(&design_text("pad", [10, 10], [4.0, 4.0], 3.0, &more))
    };
    let frame: Vec<u32> = (0..100)
        .map(|taxel| {
            let [x, y] = [taxel % 10, taxel / 10].map(|at| (at as f32 - 4.3) / 2.0);
            (-2e4 * (1.0 + 0.5 * x) * (-x * x - y * y).exp()).to_bits()
        })
        .collect();
    let answer = |plan: &Plan| Model::new(plan).process(&frame).into_iter().map(f32::from_bits).collect::<Vec<f32>>();
    let (one, more) = (answer(&text(1.0)), answer(&text(1.3)));
    assert!(one[4] < -0.1 && one[10] > 0.05, "{:?}", &one[..16]);
    let near = |found: f32, wanted: f32, scale: f32| (found - wanted).abs() < 2e-3 * scale;
    assert!((2..5).all(|word| near(more[word], 1.3 * one[word], one[4].abs())), "{:?} {:?}", &one[..16], &more[..16]);
    let arm = 0.02 * one[4].abs();
    assert!((5..8).all(|word| near(more[word], 1.3 * one[word], arm)), "{:?} {:?}", &one[..16], &more[..16]);
    assert!(
        (10..12).all(|word| (more[word] - one[word]).abs() < 20.0 * FRICTION_STEP),
        "{:?} {:?}",
        &one[..16],
        &more[..16]
    );
    let largest = one[16..].iter().fold(0.0_f32, |most, force| most.max(force.abs()));
    assert!(one.iter().zip(&more).skip(16).all(|(one, more)| near(*more, 1.3 * one, largest)));
}

#[test]
fn the_correction_is_bounded_and_says_when_it_saw_too_much() {
    // A large constant unit that pushes along x: only its odd part is left, which a look to the side has.
    let plan = with_weights([2, 2], 4, 131_071, 131_071, true);
    let uncorrected = with_weights([2, 2], 4, 0, 0, false);
    let frame: Vec<u32> = (0..100).map(|taxel| if taxel % 10 < 4 { -3e4_f32 } else { 1e2 }.to_bits()).collect();
    let [with, without] = [&plan, &uncorrected].map(|plan| Model::new(plan).process(&frame));
    let limit = CORRECTION_LIMIT as f32 * FRICTION_STEP;
    let change = [10, 11].map(|word| (f32::from_bits(with[word]) - f32::from_bits(without[word])).abs());
    assert!(change.iter().all(|&change| change <= limit + FRICTION_STEP), "{change:?}");
    assert!(change.iter().any(|&change| change > 0.9 * limit), "{change:?}");
    // Stresses that all but cancel in their sum of magnitudes do not exist: nothing is clipped here.
    assert_eq!(with[0] & SATURATED, 0);
}

/// A square with hidden units in pairs, each of which sees what the other would see of the transposed frame, answers to
/// a transposed frame with the transposed forces, to the last bit.
#[test]
fn a_square_is_symmetric_about_its_diagonal() {
    const HALF: usize = 3;
    const WIDTH: usize = 2 * HALF + 1;
    let text = design_text("pad", [10, 10], [4.0, 4.0], 3.0, "");
    let mut design = Design::from_toml(&text, "test.toml").unwrap();
    design.algorithm.estimator = Estimator::Joint;
    let inputs = Correction::inputs([HALF; 2]);
    let unit = |seed: usize| -> Vec<i32> {
        (0..inputs).map(|index| ((index * index * 31 + index * seed * 17) % 2003) as i32 - 1001).collect()
    };
    let transposed = |row: &[i32]| -> Vec<i32> {
        let window = (0..WIDTH * WIDTH).map(|place| row[place % WIDTH * WIDTH + place / WIDTH]);
        window.chain([1, 0, 3, 2, 4].map(|extra| row[WIDTH * WIDTH + extra])).collect()
    };
    let hidden: Vec<Vec<i32>> = (1..4).flat_map(|seed| [unit(seed), transposed(&unit(seed))]).collect();
    let output = [vec![300, -500, 90, 20, -700, 40], vec![-500, 300, 20, 90, 40, -700]];
    design.algorithm.standard_error = Some(StandardError { model: 0.03, noise: 100.0, border: 1.0 });
    design.algorithm.joint.correction = Some(Correction { half_window: [HALF; 2], hidden, output });
    let plan = Plan::new(&design).unwrap();
    for shift in 0..5 {
        let frame: Vec<f32> = (0..100)
            .map(|taxel| {
                let [x, y] = [taxel % 10, taxel / 10].map(|at| (at as f32 - 3.1 - 0.3 * shift as f32) / 2.0);
                -2e4 * (1.0 + 0.5 * x - 0.2 * y) * (-x * x - 1.5 * y * y).exp() + 40.0 * (taxel as f32).sin()
            })
            .collect();
        let other: Vec<f32> = (0..100).map(|taxel| frame[taxel % 10 * 10 + taxel / 10]).collect();
        let [one, other] = [frame, other]
            .map(|frame| Model::new(&plan).process(&frame.iter().map(|stress| stress.to_bits()).collect::<Vec<u32>>()));
        for (word, of_other) in [(0, 0), (2, 3), (3, 2), (4, 4), (8, 8), (10, 11), (11, 10), (12, 12)] {
            assert_eq!(one[word], other[of_other], "word {word}");
        }
        assert!(f32::from_bits(one[12]) > 0.0);
    }
}

#[test]
fn the_roms_hold_the_weights() {
    let plan = with_weights([1, 2], 6, 1234, -77, true);
    let network = network(&plan);
    let files = emit(&plan).unwrap();
    let lines = |name: &str| -> Vec<String> {
        String::from_utf8(files[&format!("rom/pad_{name}.mem")].clone()).unwrap().lines().map(str::to_owned).collect()
    };
    // Weight `index` from the right, of 18 bits.
    let weight = |line: &str, index: usize| -> i32 {
        let bits: Vec<bool> = line
            .chars()
            .rev()
            .flat_map(|digit| (0..4).map(move |bit| digit.to_digit(16).unwrap() >> bit & 1 == 1))
            .collect();
        let value = (0..18).fold(0, |value, bit| value | i32::from(bits[18 * index + bit]) << bit);
        value << 14 >> 14
    };
    let weights = lines("weights");
    assert_eq!(weights.len(), network.weights.len());
    for (line, units) in weights.iter().zip(&network.weights) {
        assert_eq!(line.len(), 72);
        for (index, wanted) in units.iter().flatten().enumerate() {
            assert_eq!(weight(line, index), *wanted);
        }
    }
    let readout = lines("readout");
    assert_eq!(readout.len(), 8, "filled up to whole passes");
    for (index, line) in readout.iter().enumerate() {
        let wanted = network.readout.get(index).copied().unwrap_or_default();
        assert_eq!([weight(line, 0), weight(line, 1)], wanted);
    }
    assert!(files.contains_key("rtl/sptfra_grid_search.v") && !files.contains_key("rtl/sptfra_line.v"));
    let metadata: serde_json::Value = serde_json::from_slice(&files["metadata.json"]).unwrap();
    assert_eq!(metadata["joint"]["network"]["length"], network.length);
}

/// How many points of the grid are evaluated at a time.
#[test]
fn inspect_says_how_many_points_are_evaluated_at_a_time() {
    let said = |keys: &str| {
        let more = format!("[algorithm]\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]\n{keys}");
        let plan = plan(&design_text("pad", [10, 10], [4.0, 4.0], 3.0, &more));
        let report = plan.estimator.block().report(&plan.design);
        assert!(report.lines().all(|line| line.chars().count() <= 110), "{report}");
        report
            .lines()
            .find_map(|line| line.strip_prefix("  search       13 x 13 points, "))
            .expect("a search")
            .to_owned()
    };
    assert_eq!(said(""), "all at a time, a taxel a cycle");
    assert_eq!(said("[hardware]\nlanes = 100"), "all at a time, 2 taxels a cycle with more than 64 lanes");
    assert_eq!(said("[hardware]\noptimise = \"area\""), "13 at a time, as optimise is \"area\"");
}
