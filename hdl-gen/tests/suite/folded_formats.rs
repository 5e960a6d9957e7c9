//! Formats of the reduced plan: that the worst case fits, folded and unfolded.

use golden::parity::{COMPONENTS, Orbits, sign};
use golden::products::RESULTANTS;
use golden::reduced::ReducedName;
use golden::solver::Solver;
use hdl_gen::cores::ACCUMULATOR_BITS;
use hdl_gen::format::FRICTION_FRACTION;
use hdl_gen::format::{MOST_SHIFT, largest, pow2, round_shift};
use hdl_gen::plan::Plan;
use hdl_gen::plan::matrix::{QuantisedMatrix, product as product_of};
use hdl_gen::plan::product::{Coefficients, Epilogue, Product, Vector};
use hdl_gen::plan::product::{SHARE_ROW, SUM_ROWS, sum_channel, sum_row};
use hdl_gen::plan::vector_formats::FoldedFormats;
use proptest::prelude::*;

use crate::formats::check_widths;
use crate::support::{any_reduced_design, design_text, plan};

/// A friction component at its end, -2.
const STEEPEST: i64 = 2 << FRICTION_FRACTION;

fn half(shift: u32) -> i64 {
    if shift == 0 { 0 } else { 1 << (shift - 1) }
}

/// The largest sum of a row in one channel, rounded, for operands up to `bound`; the accumulator fits 48 bits.
fn largest_result(matrix: &QuantisedMatrix, row: usize, channel: usize, bound: i64, shift: u32) -> i64 {
    let magnitudes = matrix.rows[row].iter().map(|(_, channels)| i64::from(channels[channel]).abs());
    let accumulator = magnitudes.map(|value| product_of(value as i32, bound, matrix.dropped)).sum::<i64>();
    assert!(accumulator + half(shift) <= largest(ACCUMULATOR_BITS), "{} row {row}: {accumulator}", matrix.name);
    round_shift(accumulator, shift)
}

/// The format in which the lanes leave a product's results.
fn result_lsb_and_bound(product: &Product, folded: &FoldedFormats) -> (i32, i64) {
    let format = if product.epilogue == Epilogue::Part { folded.y } else { folded.of(product.result) };
    (format.lsb, format.bound)
}

/// The largest of the q-th of the parts that friction combines.
fn largest_part(plan: &Plan, folded: &FoldedFormats, q: u8) -> i64 {
    let product = plan.products.iter().find(|product| product.result == Vector::Residual(q)).expect("a part");
    let (matrix, bound) = (&plan.matrices[product.matrix], folded.of(product.operand()).bound);
    let places = (0..matrix.rows.len()).flat_map(|row| (0..COMPONENTS).map(move |channel| (row, channel)));
    places.map(|(row, channel)| largest_result(matrix, row, channel, bound, product.shift)).max().expect("rows")
}

/// For every row and way of every product the folded operand that makes its sum largest.
fn check_folded(plan: &Plan, folded: &FoldedFormats) {
    for product in &plan.products {
        let matrix = &plan.matrices[product.matrix];
        let operand = folded.of(product.operand());
        assert!(product.operands.iter().all(|&vector| folded.of(vector) == operand), "read at one step");
        let (lsb, bound) = result_lsb_and_bound(product, folded);
        assert!(product.shift <= MOST_SHIFT + 3, "{}: {} bits dropped", matrix.name, product.shift);
        assert_eq!(matrix.accumulator_lsb(operand) + product.shift as i32, lsb, "{}", matrix.name);
        // With the stress added at the step of u, and its rounding.
        let more = match product.epilogue {
            Epilogue::AddStress => (folded.stress.bound as f64 * pow2(folded.stress.lsb - lsb)) as i64 + 1,
            _ => 0,
        };
        for row in 0..matrix.rows.len() {
            if product.coefficients == Coefficients::Friction {
                let factor = |friction: i64| (friction << plan.factors().friction_shift()) as i32;
                let steepest = factor((1 << FRICTION_FRACTION) + 2 * STEEPEST);
                let accumulator = product_of(steepest, operand.bound, matrix.dropped) + 1;
                assert!(accumulator + half(product.shift) <= largest(ACCUMULATOR_BITS));
                let part =
                    |friction: i64, q: u8| product_of(factor(friction), largest_part(plan, folded, q), matrix.dropped);
                let accumulator = part(1 << FRICTION_FRACTION, 0) + part(STEEPEST, 1) + part(STEEPEST, 2);
                assert!(round_shift(accumulator, product.shift) <= bound);
                continue;
            }
            for channel in 0..COMPONENTS {
                let result = largest_result(matrix, row, channel, operand.bound, product.shift) + more;
                // Forces may have a tighter bound than the worst r allows: the frames of the model's tests do that.
                let force = matches!(product.result, Vector::Force(_));
                assert!(force || result <= bound, "{} row {row} channel {channel}: {result} of {bound}", matrix.name);
            }
        }
    }
}

/// The frame sums; G30, and those of `T_x` and `T_y` for q = 0, are one less another.
fn check_sums(plan: &Plan, folded: &FoldedFormats) {
    let product = plan.products.iter().find(|product| product.preload.is_some()).unwrap();
    let preload = product.preload.unwrap();
    let matrix = &plan.matrices[preload.matrix];
    assert_eq!((matrix.rows.len(), product.result), (SUM_ROWS, Vector::U(0)));
    assert_eq!(matrix.accumulator_lsb(folded.weight) + preload.shift as i32, plan.formats.g.lsb);
    let sum = |row: usize, channel: usize| largest_result(matrix, row, channel, folded.weight.bound, preload.shift);
    for (p, q) in (0..RESULTANTS).flat_map(|p| (0..3).map(move |q| (p, q))) {
        let less = if q == 0 && (2..5).contains(&p) { sum(SHARE_ROW, sum_channel(p, 0)) } else { 0 };
        let result = sum(sum_row(p, q), sum_channel(p, q));
        assert!(result <= largest(plan.formats.g.bits) && result + less <= plan.formats.g.bound, "G{}{q}", p + 1);
    }
}

/// What stands in the four components of each orbit, from the values of the taxels.
fn fold(orbits: &Orbits, values: &[i64], shift: u32) -> Vec<[i64; COMPONENTS]> {
    let signed = |component: usize, image: usize, value: i64| if sign(component, image) < 0.0 { -value } else { value };
    (0..orbits.count())
        .map(|orbit| {
            let images = orbits.images(orbit);
            std::array::from_fn(|component| {
                round_shift((0..4).map(|s| signed(component, s, values[images[s]])).sum(), shift)
            })
        })
        .collect()
}

/// For every taxel and every product that is unfolded the taxels' operand that makes the taxel's value largest: it has
/// as many bits as any word.
fn check_unfolded(plan: &Plan, folded: &FoldedFormats) {
    let orbits = plan.orbits();
    for product in &plan.products {
        let matrix = &plan.matrices[product.matrix];
        // Range of a taxel's operand, bits by which its fold is coarser, and the bound of a taxel's result.
        let weight_shift = (folded.weight.lsb - plan.formats.weight.lsb) as u32;
        let stress = plan.formats.stress.bound;
        let (low, high, shift) = match product.operand() {
            Vector::Stress => (-stress, stress, (folded.stress.lsb - plan.formats.stress.lsb) as u32),
            Vector::Weight | Vector::Pull => (0, plan.formats.weight.bound, weight_shift),
            _ => continue, // what r can be has no bound of its own for a taxel: the frames of the model's tests do that
        };
        let bound = match product.epilogue {
            Epilogue::Part => plan.formats.weight.bound,
            Epilogue::Unfold | Epilogue::AddStress => plan.formats.u.bound,
            _ => continue,
        };
        for (row, image) in (0..matrix.rows.len()).flat_map(|row| (0..4).map(move |image| (row, image))) {
            let mut values = vec![0.0; plan.taxels()];
            for &(column, channels) in &matrix.rows[row] {
                for (s, taxel) in orbits.images(column as usize).into_iter().enumerate() {
                    let weight = |channel: usize| {
                        let result = sign(channel ^ product.parity, image);
                        f64::from(channels[channel]) * result * sign(channel, s)
                    };
                    values[taxel] += (0..COMPONENTS).map(weight).sum::<f64>();
                }
            }
            for direction in [1.0, -1.0] {
                let chosen = |&value: &f64| if direction * value > 0.0 { high } else { low };
                let operand = fold(&orbits, &values.iter().map(chosen).collect::<Vec<_>>(), shift);
                let result = |channel: usize| {
                    let entries = matrix.rows[row].iter();
                    let of_entry = |&(column, channels): &(u32, [i32; COMPONENTS])| {
                        product_of(channels[channel], operand[column as usize][channel], matrix.dropped)
                    };
                    let sum = entries.map(of_entry).sum();
                    let result = round_shift(sum, product.shift);
                    if sign(channel ^ product.parity, image) < 0.0 { -result } else { result }
                };
                let value = (0..COMPONENTS).map(result).sum::<i64>();
                let more = match product.epilogue {
                    // A taxel's value has a quarter of the step.
                    Epilogue::AddStress => (stress as f64 * pow2(plan.formats.stress.lsb - plan.formats.u.lsb)) as i64,
                    _ => 0,
                };
                let value = value.abs() + more;
                assert!(value <= bound, "{} orbit {row} image {image}: {value} of {bound}", matrix.name);
            }
        }
    }
}

/// Each coefficient is its matrix entry rounded to the nearest step.
fn check_rounding(plan: &Plan) {
    let solver = Solver::new(&plan.design).unwrap();
    let reduced = solver.reduced().unwrap();
    let mut seen = 0;
    for matrix in &plan.matrices {
        let (sign, plain) = matrix.name.strip_prefix('-').map_or((1.0, matrix.name.as_str()), |plain| (-1.0, plain));
        let Some(name) = ReducedName::ALL.into_iter().find(|name| name.to_string() == plain) else { continue };
        seen += 1;
        assert_eq!(matrix.rows.len(), reduced.get(name).rows.len());
        for (row, (stored, exact)) in matrix.rows.iter().zip(&reduced.get(name).rows).enumerate() {
            assert_eq!(stored.len(), exact.len(), "{name} row {row}");
            for (&(column, channels), &(exact_column, values)) in stored.iter().zip(exact) {
                assert_eq!(column, exact_column);
                for (value, exact) in channels.into_iter().zip(values) {
                    let error = (f64::from(value) * pow2(matrix.lsb) - sign * exact).abs();
                    assert!(error <= 0.501 * pow2(matrix.lsb), "{name} [{row}, {column}]: off by {error:e}");
                }
            }
        }
    }
    // Those that the mirror image of another stands in for are not stored.
    let mirrored = plan.products.iter().filter(|product| product.mirrored.is_some()).count();
    assert_eq!(seen + mirrored, if plan.field_words() > 0 { 10 } else { 4 });
}

fn check(plan: &Plan) {
    let folded = plan.formats.folded.unwrap();
    check_widths(plan);
    check_folded(plan, &folded);
    check_sums(plan, &folded);
    check_unfolded(plan, &folded);
    check_rounding(plan);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_worst_case_fits(text in any_reduced_design()) {
        check(&plan(&text));
    }

    #[test]
    fn depth_may_be_a_small_or_a_large_share_of_the_pitch(
        // Beyond two pitches the worst case of A+ r leaves a force too few steps, and the plan is refused.
        ratio in -2.0..0.3_f64, pitch in 1.0..9.0_f64, square in any::<bool>(),
    ) {
        let other = if square { pitch } else { 1.25 * pitch };
        let reduced = "[algorithm]\nplan = \"reduced\"";
        check(&plan(&design_text("thin", [4, 4], [pitch, other], pitch * 10_f64.powf(ratio), reduced)));
    }
}

#[test]
fn the_folded_stress_is_the_mean_of_four() {
    let plan = plan(&design_text("pad", [4, 3], [4.0, 2.0], 3.0, "[algorithm]\nplan = \"reduced\""));
    let folded = plan.formats.folded.unwrap();
    assert_eq!(folded.stress.bound, plan.formats.stress.bound, "four at full scale, at four times the step");
    assert_eq!(folded.stress.lsb, plan.formats.stress.lsb + 2);
    // Weights give up as few bits as four of them need.
    let shift = (folded.weight.lsb - plan.formats.weight.lsb) as u32;
    assert!(shift <= 2 && round_shift(4 * plan.formats.weight.bound, shift) <= folded.weight.bound);
    assert!(shift == 0 || round_shift(4 * plan.formats.weight.bound, shift - 1) > largest(27));
}
