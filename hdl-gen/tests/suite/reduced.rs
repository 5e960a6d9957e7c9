//! The reduced plan: that its products are those of the matrices they stand for, and that its model agrees with the f64
//! solver and with the paper's plan.

use std::f64::consts::TAU;

use golden::design::{Design, PlanKind};
use golden::parity::{COMPONENTS, FoldedMatrix, Orbits, sign};
use hdl_gen::model::{AT_BOUND, Model, SUMMARY_WORDS};
use hdl_gen::plan::Plan;
use hdl_gen::plan::matrix::{Entry, QuantisedMatrix};
use hdl_gen::plan::product::{Block, Coefficients, Epilogue, Product, Step, Vector, mirror};
use hdl_gen::plan::schedule::Schedule;
use nalgebra::DMatrix;
use proptest::prelude::*;

use crate::model::{Contact, answer, any_contact, frame, full_width, line_ratio, prepare_as, reference, top};
use crate::pes::execute;
use crate::support::{any_reduced_design, design_text, plan};

/// Largest difference of two plans' forces, of the largest normal force of the frame.
const BETWEEN_PLANS: f64 = 2e-3;

pub fn swapped(component: usize) -> usize {
    [0, 2, 1, 3][component]
}

pub fn signed(component: usize, image: usize, value: i64) -> i64 {
    if sign(component, image) < 0.0 { -value } else { value }
}

/// A matrix of whole numbers with the mirror symmetry `parity`, from numbers for its rows at image 0 of each orbit.
pub fn symmetric(orbits: &Orbits, parity: usize, numbers: &[i32]) -> DMatrix<f64> {
    let m = orbits.taxels();
    let mut dense = DMatrix::zeros(m, m);
    for orbit in 0..orbits.count() {
        let rows = orbits.images(orbit);
        for column in 0..orbits.count() {
            let columns = orbits.images(column);
            for s in 0..4 {
                // All that must be the same or the opposite by symmetry adds up: so it is, also on the centre lines.
                let value = f64::from(numbers[(orbit * m + columns[s]) % numbers.len()]);
                for t in 0..4 {
                    dense[(rows[t], columns[s ^ t])] += sign(parity, t) * value;
                }
            }
        }
    }
    dense
}

/// A product of the lanes with four times the matrix: on centre lines its blocks have quarters.
pub fn stored(orbits: &Orbits, parity: usize, dense: &DMatrix<f64>) -> QuantisedMatrix {
    let folded = FoldedMatrix::from_fn(parity, orbits, |row, column| 4.0 * dense[(row, column)]);
    let entry = |row: usize, column: usize| -> Entry {
        let channels = folded.blocks.each_ref().map(|block| block[(row, column)]);
        assert!(channels.iter().all(|value| value.fract() == 0.0));
        (column as u32, channels.map(|value| value as i32))
    };
    let n = orbits.count();
    let rows = (0..n).map(|row| (0..n).map(|column| entry(row, column)).collect()).collect();
    QuantisedMatrix::from_rows("M", rows, 0)
}

/// A component of one orbit of a vector of one value a taxel.
pub fn folded(orbits: &Orbits, component: usize, orbit: usize, x: &[i64]) -> i64 {
    let images = orbits.images(orbit);
    (0..4).map(|s| signed(component, s, x[images[s]])).sum()
}

/// What the lanes make of a vector of one value a taxel: folded, through the schedule, unfolded. Sixteen times the
/// product with the matrix.
fn through_the_lanes(orbits: &Orbits, product: &Product, matrix: QuantisedMatrix, lanes: usize, x: &[i64]) -> Vec<i64> {
    let n = orbits.count();
    let folded = |component: usize, orbit: usize| folded(orbits, component, orbit, x);
    let (products, matrices) = (std::slice::from_ref(product), [matrix]);
    let schedule = Schedule::new(products, &matrices, lanes, false);
    let sums = execute(&schedule, products, &matrices, n, &|product, _, orbit| {
        std::array::from_fn(|channel| match product.mirrored {
            None => folded(channel, orbit),
            Some(side) => folded(swapped(channel), mirror(orbit, side)),
        })
    });
    // For each component of the result, the channel that computes it.
    let channel =
        |component: usize| if product.mirrored.is_some() { swapped(component) } else { component } ^ product.parity;
    unfolded(orbits, |orbit| std::array::from_fn(|component| sums[&(0, orbit as u32)][channel(component)]))
}

/// The values at the taxels, from the components of each orbit.
pub fn unfolded(orbits: &Orbits, components: impl Fn(usize) -> [i64; COMPONENTS]) -> Vec<i64> {
    let mut result = vec![0; orbits.taxels()];
    for orbit in 0..orbits.count() {
        let components = components(orbit);
        for (s, taxel) in orbits.images(orbit).into_iter().enumerate() {
            result[taxel] = (0..COMPONENTS).map(|component| signed(component, s, components[component])).sum();
        }
    }
    result
}

pub fn product(parity: usize, mirrored: Option<usize>) -> Product {
    Product {
        step: Step {
            matrix: 0,
            operands: vec![Vector::Weight],
            coefficients: Coefficients::Rom,
            sums: false,
            parity,
            mirrored,
            epilogue: Epilogue::Unfold,
            result: Vector::U(0),
        },
        preload: None,
        block: Block::Co,
        program: 0,
        shift: 0,
    }
}

/// Sixteen times the product, in whole numbers.
pub fn exactly(dense: &DMatrix<f64>, x: &[i64]) -> Vec<i64> {
    dense.row_iter().map(|row| row.iter().zip(x).map(|(&value, &x)| 16 * value as i64 * x).sum()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Fold, blocks, unfold: the product with the whole matrix, to the last digit, of any mirror symmetry.
    #[test]
    fn folded_products_are_the_products(
        columns in 1_usize..8, rows in 1_usize..8, parity in 0_usize..4, lanes in 1_usize..=16,
        numbers in proptest::collection::vec(-2_000..2_000_i32, 256),
        x in proptest::collection::vec(-1_000_000..1_000_000_i64, 49),
    ) {
        let orbits = Orbits::new(columns, rows);
        let dense = symmetric(&orbits, parity, &numbers);
        let x = &x[..orbits.taxels()];
        let matrix = stored(&orbits, parity, &dense);
        let found = through_the_lanes(&orbits, &product(parity, None), matrix, lanes, x);
        prop_assert_eq!(found, exactly(&dense, x));
    }

    /// On a square grid the diagonal mirror of what is odd in x is what is odd in y: one matrix serves both.
    #[test]
    fn mirrored_products_are_those_of_the_mirrored_matrix(
        side in 1_usize..8, lanes in 1_usize..=16,
        numbers in proptest::collection::vec(-2_000..2_000_i32, 256),
        x in proptest::collection::vec(-1_000_000..1_000_000_i64, 49),
    ) {
        let orbits = Orbits::new(side, side);
        let dense = symmetric(&orbits, 1, &numbers);
        let other = |taxel: usize| mirror(taxel, side);
        let mirrored = DMatrix::from_fn(side * side, side * side, |row, column| dense[(other(row), other(column))]);
        let x = &x[..orbits.taxels()];
        let along_y = through_the_lanes(
            &orbits, &product(1, Some(orbits.columns())), stored(&orbits, 1, &dense), lanes, x,
        );
        prop_assert_eq!(&along_y, &exactly(&mirrored, x));
        let not_mirrored = through_the_lanes(&orbits, &product(2, None), stored(&orbits, 2, &mirrored), lanes, x);
        prop_assert_eq!(along_y, not_mirrored);
    }

    #[test]
    fn friction_and_status_agree_with_the_solver(
        text in any_reduced_design(), contacts in proptest::collection::vec(any_contact(), 4),
    ) {
        let (design, solver, plan) = prepare_as(&full_width(&text), PlanKind::Reduced);
        // The same line in every plan, but for the filter.
        let (_, unfiltered, _) = prepare_as(&unfiltered(&text), PlanKind::Paper);
        for contact in contacts {
            let frame = frame(&contact, &design, &solver);
            let near = |value: f64, limit: f64| (value / limit - 1.0).abs() < 0.02;
            let floor = design.algorithm.noise_floor_pa;
            if frame.iter().any(|&stress| near(f64::from(stress.abs()), floor))
                || (3.0..5.0).contains(&line_ratio(&frame, &design, &unfiltered))
            {
                continue; // either answer is right
            }
            let found = answer(&plan, &frame);
            let expected = reference(&solver, &frame);
            prop_assert_eq!(found.status & !AT_BOUND, expected.status.0 & !AT_BOUND);
            let error = (found.summary[5] - expected.mu_x).abs().max((found.summary[6] - expected.mu_y).abs());
            prop_assert!(error <= 0.02, "friction off by {error}");
            let scale = expected.resultant[2].abs();
            for p in 0..3 {
                let error = (found.summary[p] - expected.resultant[p]).abs();
                prop_assert!(error <= 0.03 * scale, "F[{p}] off by {error} N of {scale} N");
                let scale = top(&expected.field[2]);
                prop_assert_eq!(found.field[p].len(), expected.field[p].len());
                let pairs = found.field[p].iter().zip(&expected.field[p]);
                let error = pairs.map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
                prop_assert!(error <= 0.03 * scale, "component {p} off by {error} N of {scale} N");
            }
        }
    }
}

/// The design by the paper's plan without a filter, full widths and a field.
fn unfiltered(text: &str) -> String {
    let dropped = ["filter", "outputs", "optimise", "plan"];
    let kept = text.lines().filter(|line| !dropped.iter().any(|key| line.starts_with(key)));
    full_width(&kept.map(|line| line.to_owned() + "\n").collect::<String>())
}

/// Both sensors of the paper, and one with odd sides: the reduced plan is the paper's mathematics, so that both models
/// and the solver agree in every direction of a push.
#[test]
fn the_plans_agree() {
    for (size, pitch) in [([10, 10], [4.0, 2.0]), ([10, 10], [4.0, 4.0]), ([9, 7], [3.0, 4.0])] {
        let text = design_text("sensor", size, pitch, 3.0, "");
        let (design, solver, paper) = prepare_as(&text, PlanKind::Paper);
        let (_, reduced_solver, reduced) = prepare_as(&text, PlanKind::Reduced);
        for step in 0..36 {
            let direction = f64::from(step * 10).to_radians();
            let contact = Contact { centre: [0.48, 0.5], radius: 0.3, friction: 0.5, direction, strength: 0.3 };
            let frame = frame(&contact, &design, &solver);
            let expected = reference(&solver, &frame);
            let in_f64 = reference(&reduced_solver, &frame);
            let (first, second) = (answer(&paper, &frame), answer(&reduced, &frame));
            assert_eq!((first.status, second.status), (expected.status.0, expected.status.0), "{size:?} at {step}0");
            let scale = top(&expected.field[2]);
            for p in 0..3 {
                for (taxel, &expected) in expected.field[p].iter().enumerate() {
                    let worst = (first.field[p][taxel] - second.field[p][taxel])
                        .abs()
                        .max((second.field[p][taxel] - expected).abs())
                        .max((in_f64.field[p][taxel] - expected).abs());
                    assert!(worst <= BETWEEN_PLANS * scale, "{size:?} {pitch:?} at {step}0 degrees: {worst}");
                }
                let error = (second.summary[p] - expected.resultant[p]).abs();
                assert!(error <= BETWEEN_PLANS * expected.resultant[2].abs(), "F[{p}] off by {error} N");
                // An arm is a hundredth of a metre.
                let (first, second, in_f64) = (first.torque[p], second.torque[p], in_f64.torque[p]);
                let worst = [first, second, in_f64].map(|torque| (torque - expected.torque[p]).abs());
                let limit = 0.01 * BETWEEN_PLANS * expected.resultant[2].abs();
                assert!(worst.iter().all(|&error| error <= limit), "{size:?} T[{p}] off by {worst:?} N m");
            }
            assert!((second.summary[3] - expected.mu).abs() <= 2e-3);
            let turn = (second.summary[4] - expected.phi).abs();
            assert!(turn.min(TAU - turn) <= 4e-3, "phi off by {turn}");
        }
    }
}

fn words(plan: &Plan, frame: &[f32]) -> Vec<u32> {
    Model::new(plan).process(&frame.iter().map(|stress| stress.to_bits()).collect::<Vec<_>>())
}

/// Without a field the eight words are the same, bit for bit.
#[test]
fn resultants_alone_are_those_of_the_field() {
    for (size, pitch) in [([10, 10], [4.0, 2.0]), ([5, 5], [3.0, 3.0]), ([2, 7], [3.0, 2.0])] {
        let of = |outputs: &str| {
            let more = format!("[algorithm]\nplan = \"reduced\"\noutputs = \"{outputs}\"");
            prepare_as(&design_text("pad", size, pitch, 2.0, &more), PlanKind::Reduced)
        };
        let ((design, solver, field), (_, _, alone)) = (of("field"), of("resultants"));
        for step in 0..24 {
            let direction = f64::from(step * 15).to_radians();
            let contact = Contact { centre: [0.45, 0.55], radius: 0.4, friction: 0.4, direction, strength: 0.5 };
            let frame = frame(&contact, &design, &solver);
            assert_eq!(words(&alone, &frame), words(&field, &frame)[..SUMMARY_WORDS], "{size:?} at {direction}");
        }
    }
}

/// A pitch that differs in its last digit has all ten matrices, where a square one makes three from mirror images.
#[test]
fn mirrored_matrices_change_nothing() {
    for side in [2, 3, 6, 7] {
        let design = |y: f64| {
            let text = design_text("pad", [side, side], [3.0, y], 2.0, "[algorithm]\nplan = \"reduced\"");
            Design::from_toml(&text, "pad.toml").unwrap()
        };
        let square = Plan::new(&design(3.0)).unwrap();
        let nearly = Plan::new(&design(3.0_f64.next_up())).unwrap();
        let mirrored = |plan: &Plan| plan.products.iter().filter(|product| product.mirrored.is_some()).count();
        assert_eq!((mirrored(&square), mirrored(&nearly)), (3, 0));
        assert_eq!((square.matrices.len() + 3, square.formats), (nearly.matrices.len(), nearly.formats));
        for step in 0..24 {
            let stress = |taxel: usize| -4e4 * (1.0 + (0.7 * (taxel * (step + 1)) as f32).sin() * 1.2);
            let frame: Vec<f32> = (0..side * side).map(stress).collect();
            let (one, other) = (words(&square, &frame), words(&nearly, &frame));
            let values = |words: &[u32]| words[1..].iter().map(|&word| f32::from_bits(word)).collect::<Vec<f32>>();
            let (ones, others) = (values(&one), values(&other));
            assert_eq!(one[0], other[0]);
            let scale = ones.iter().fold(0.0_f32, |top, value| top.max(value.abs()));
            for (one, other) in ones.iter().zip(&others) {
                assert!((one - other).abs() <= 1e-5 * scale, "{side} x {side}: {one} {other}");
            }
        }
    }
}

/// Push a square sensor along the other axis: the mirrored frame has the mirrored answer.
#[test]
fn a_mirrored_frame_has_the_mirrored_answer() {
    let plan = plan(&design_text("pad", [6, 6], [3.0, 3.0], 2.0, "[algorithm]\nplan = \"reduced\""));
    let (design, solver, _) = prepare_as(&design_text("pad", [6, 6], [3.0, 3.0], 2.0, ""), PlanKind::Paper);
    let mut judged = 0;
    for step in 0..24 {
        let direction = f64::from(step).mul_add(15.0, 7.0).to_radians();
        let contact = Contact { centre: [0.4, 0.5], radius: 0.4, friction: 0.4, direction, strength: 0.5 };
        let stress = frame(&contact, &design, &solver);
        let turned: Vec<f32> = (0..36).map(|taxel| stress[mirror(taxel, 6)]).collect();
        let (one, other) = (answer(&plan, &stress), answer(&plan, &turned));
        assert_eq!(one.status, other.status);
        let scale = top(&one.field[2]);
        for (p, of_mirror) in [1, 0, 2].into_iter().enumerate() {
            for taxel in 0..36 {
                let error = (one.field[p][taxel] - other.field[of_mirror][mirror(taxel, 6)]).abs();
                assert!(error <= 1e-3 * scale, "at {direction}: off by {error} N of {scale} N");
            }
        }
        judged += 1;
    }
    assert_eq!(judged, 24);
}

/// Where a filter cuts what a mirror image would need, nothing is mirrored.
#[test]
fn filtered_matrices_are_not_mirrored() {
    for (filter, mirrored) in [("{ kind = \"none\" }", 3), ("{ kind = \"f1\", l = 9 }", 0)] {
        let more = format!("[algorithm]\nplan = \"reduced\"\nfilter = {filter}");
        let plan = plan(&design_text("pad", [4, 4], [3.0, 3.0], 2.0, &more));
        assert_eq!(plan.products.iter().filter(|product| product.mirrored.is_some()).count(), mirrored);
    }
}
