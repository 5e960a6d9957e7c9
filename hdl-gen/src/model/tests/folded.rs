//! Frames made to be as bad as can be: every vector of the reduced plan, folded or not, stays within the bound of its
//! format, for any friction.

use golden::design::Design;
use golden::parity::{COMPONENTS, Orbits, butterfly, sign};
use proptest::prelude::*;

use super::super::{frame, integer, run};
use crate::format::FRICTION_FRACTION;
use crate::plan::Plan;
use crate::plan::product::{Coefficients, Epilogue, Product, Vector};

/// The ends of a friction component's range, which is [-2, 2).
const STEEP: [i64; 2] = [-(2 << FRICTION_FRACTION), (2 << FRICTION_FRACTION) - 1];

fn plan(size: [usize; 2], pitch_mm: [f64; 2], algorithm: &str, hardware: &str) -> Plan {
    let [columns, rows] = size;
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"bad\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = {pitch_mm:?}\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"reduced\"\n{algorithm}\n[hardware]\n{hardware}"
    );
    Plan::new(&Design::from_toml(&text, "bad.toml").unwrap()).unwrap()
}

fn top(values: &[i64]) -> i64 {
    values.iter().map(|value| value.abs()).max().unwrap_or(0)
}

/// Runs a frame with this friction, whatever the search would find, and holds everything against its bound. Returns
/// the largest weight or y+.
fn check(plan: &Plan, stress: &[i64], friction: [i64; 2]) -> i64 {
    let folded = plan.formats.folded.unwrap();
    let integers = integer::by_orbit(plan);
    let mut frame = frame(plan, &integers, stress);
    run(plan, &integers, 0..plan.products.len(), friction, &mut frame);
    let within = |what: &str, found: i64, bound: i64| assert!(found <= bound, "{what} reaches {found} of {bound}");
    for product in &plan.products {
        let pull = (product.epilogue == Epilogue::Part).then_some(Vector::Pull);
        for vector in [Vector::Stress, product.result].into_iter().chain(pull) {
            within(&vector.name(), top(frame.get(vector).as_flattened()), folded.of(vector).bound);
        }
    }
    let largest_weight = top(&frame.weight);
    within("|w| of a taxel", largest_weight, plan.formats.weight.bound);
    assert!(frame.weight.iter().all(|&weight| weight >= 0));
    for (q, u) in frame.u.iter().enumerate() {
        within(&format!("u{q} of a taxel"), top(u), plan.formats.u.bound);
    }
    for (p, force) in frame.force.iter().enumerate() {
        within(&format!("A{} r of a taxel", p + 1), top(force), folded.taxel_force.bound);
    }
    for sums in frame.sums {
        within("G", top(&sums), plan.formats.g.bound);
    }
    largest_weight
}

/// The matrix of one value a taxel that a product's blocks stand for, by rows; in units of its coefficients, times
/// four.
fn unfolded(plan: &Plan, product: &Product) -> Vec<Vec<f64>> {
    let (orbits, matrix) = (plan.orbits(), &plan.matrices[product.matrix]);
    let mut dense = vec![vec![0.0; plan.taxels()]; plan.taxels()];
    for (orbit, row) in matrix.rows.iter().enumerate() {
        for (s, result) in orbits.images(orbit).into_iter().enumerate() {
            let mut line = vec![0.0; plan.taxels()];
            for &(column, channels) in row.iter().filter(|(column, _)| (*column as usize) < orbits.count()) {
                for (t, taxel) in orbits.images(column as usize).into_iter().enumerate() {
                    let of_channel = |channel: usize| {
                        sign(channel ^ product.parity, s) * sign(channel, t) * f64::from(channels[channel])
                    };
                    line[taxel] += (0..COMPONENTS).map(of_channel).sum::<f64>();
                }
            }
            dense[result] = line;
        }
    }
    dense
}

/// A row times a matrix.
fn times(row: &[f64], matrix: &[Vec<f64>]) -> Vec<f64> {
    let sum = |column: usize| row.iter().zip(matrix).map(|(value, inner)| value * inner[column]).sum();
    (0..row.len()).map(sum).collect()
}

/// Full scale of the signs that make a taxel's result of each product largest; behind a product of the weights stands
/// the inverse of C33.
fn worst_frames(plan: &Plan) -> Vec<Vec<i64>> {
    let bound = plan.formats.stress.bound;
    let inverse = unfolded(plan, &plan.products[0]);
    let mut frames = Vec::new();
    for product in plan.products.iter().filter(|product| product.coefficients == Coefficients::Rom) {
        let rows = unfolded(plan, product);
        let mut all = match product.operand() {
            Vector::Stress => rows.clone(),
            _ => rows.iter().map(|row| times(row, &inverse)).collect(),
        };
        if matches!(product.result, Vector::Force(_)) {
            for residual in plan.products.iter().filter(|product| matches!(product.result, Vector::Residual(_))) {
                let residual = unfolded(plan, residual);
                all.extend(rows.iter().map(|row| times(&times(row, &residual), &inverse)));
            }
        }
        for through in all {
            for direction in [1.0, -1.0] {
                frames.push(through.iter().map(|&x| if direction * x < 0.0 { -bound } else { bound }).collect());
            }
        }
    }
    frames
}

fn check_worst_frames(plan: &Plan) {
    for (index, frame) in worst_frames(plan).iter().enumerate() {
        check(plan, frame, [STEEP[index % 2], STEEP[index / 2 % 2]]);
        check(plan, frame, [STEEP[index / 2 % 2], 0]);
    }
}

#[test]
fn the_worst_frames_stay_within_the_bounds() {
    check_worst_frames(&plan([4, 4], [4.0, 2.5], "", ""));
    check_worst_frames(&plan([4, 4], [4.0, 2.5], "", "coefficient_bits = 27\ndata_bits = 35"));
    check_worst_frames(&plan([5, 5], [4.0, 4.0], "", "coefficient_bits = 11\ndata_bits = 29"));
    check_worst_frames(&plan([5, 5], [3.0, 3.0], "", ""));
    check_worst_frames(&plan([2, 2], [3.0, 3.0], "", "data_bits = 18"));
    check_worst_frames(&plan([5, 3], [4.0, 2.5], "filter = { kind = \"f1\", l = 7 }", ""));
    check_worst_frames(&plan([4, 5], [4.0, 2.5], "filter = { kind = \"f2\", p = 20 }", "data_bits = 20"));
    // Deep sensors, whose forces have a bound through residual and inverse together.
    check_worst_frames(&plan([4, 4], [1.0, 1.0], "regularisation = 0.01", ""));
    check_worst_frames(&plan([5, 4], [1.0, 1.5], "regularisation = 0.03", "data_bits = 24"));
    check_worst_frames(&plan([2, 6], [4.0, 2.5], "outputs = \"resultants\"", "coefficient_bits = 8\ndata_bits = 16"));
}

/// Rounding apart, one frame in each direction takes y to the end of its format.
#[test]
fn the_bound_of_the_weights_is_reached_and_not_just_respected() {
    for size in [[4, 4], [5, 3]] {
        let plan = plan(size, [4.0, 2.5], "", "");
        let reached = worst_frames(&plan).iter().map(|frame| check(&plan, frame, [0, 0])).max().unwrap();
        let bound = plan.formats.weight.bound;
        assert!(reached as f64 >= 0.999 * bound as f64, "{reached} of {bound}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn full_scale_of_any_signs_stays_within_the_bounds(
        columns in 2_usize..8, rows in 2_usize..8, square in any::<bool>(),
        signs in proptest::collection::vec(-1_i64..=1, 49),
        friction in proptest::array::uniform2(STEEP[0]..=STEEP[1]),
    ) {
        let (rows, pitch_y) = if square { (columns, 3.0) } else { (rows, 2.0) };
        let plan = plan([columns, rows], [3.0, pitch_y], "", "");
        let bound = plan.formats.stress.bound;
        let stress: Vec<i64> = signs[..plan.taxels()].iter().map(|sign| sign * bound).collect();
        check(&plan, &stress, friction);
    }
}

#[test]
fn folding_is_undone_but_for_a_factor_of_four() {
    for [columns, rows] in [[2, 2], [3, 3], [2, 5], [6, 4]] {
        for images in Orbits::new(columns, rows).all() {
            let values = images.map(|taxel| 1000 - 37 * (taxel * taxel) as i64);
            assert_eq!(butterfly(butterfly(values)), values.map(|value| 4 * value));
        }
    }
}
