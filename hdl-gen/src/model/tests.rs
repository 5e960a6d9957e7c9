//! Frames made to be as bad as can be: every vector of the paper's plan stays within the bound of its format.

mod folded;

use golden::design::Design;
use proptest::prelude::*;

use super::{Integers, frame, integer, run};
use crate::plan::Plan;
use crate::plan::matrix::QuantisedMatrix;
use crate::plan::product::Vector;

fn plan(columns: usize, rows: usize, algorithm: &str, hardware: &str) -> Plan {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"bad\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 2.5]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"paper\"\n{algorithm}\n[hardware]\n{hardware}"
    );
    Plan::new(&Design::from_toml(&text, "bad.toml").unwrap()).unwrap()
}

/// The rows of `matrix`, or of `matrix * before`, as dense signs: full scale of that sign makes the row's sum largest.
fn sign_patterns(matrix: &QuantisedMatrix, before: Option<&QuantisedMatrix>) -> Vec<Vec<i64>> {
    let size = matrix.rows.len();
    let mut patterns = Vec::with_capacity(size);
    for row in &matrix.rows {
        let mut sums = vec![0.0; size];
        for &(middle, [value, ..]) in row {
            match before {
                None => sums[middle as usize] += f64::from(value),
                Some(before) => {
                    for &(column, [inner, ..]) in &before.rows[middle as usize] {
                        sums[column as usize] -= f64::from(value) * f64::from(inner);
                    }
                }
            }
        }
        patterns.push(sums.into_iter().map(|sum| if sum < 0.0 { -1 } else { 1 }).collect());
    }
    patterns
}

/// All products of a frame at full scale, of these signs.
fn products<'plan>(plan: &'plan Plan, signs: &[i64]) -> Integers<'plan, 1> {
    let stress: Vec<i64> = signs.iter().map(|sign| sign * plan.formats.stress.bound).collect();
    let integers = integer::by_taxel(plan);
    let mut frame = frame(plan, &integers, &stress);
    run(plan, &integers, 0..plan.products.len(), [0, 0], &mut frame);
    frame
}

fn check(plan: &Plan, signs: &[i64]) {
    let vectors = products(plan, signs);
    for product in &plan.products {
        for vector in [product.operand(), product.result] {
            let format = plan.formats.of(vector);
            let top = vectors.get(vector).as_flattened().iter().map(|value| value.abs()).max().unwrap();
            assert!(top <= format.bound, "{} reaches {top} of {}", vector.name(), format.bound);
        }
    }
    assert!(vectors.get(Vector::Weight).as_flattened().iter().all(|&weight| weight >= 0));
}

fn check_worst_frames(plan: &Plan) {
    for product in &plan.products {
        let matrix = &plan.matrices[product.matrix];
        // Before a product of the weights comes the inverse of C33.
        let before = (product.operand() != Vector::Stress).then(|| &plan.matrices[0]);
        for pattern in sign_patterns(matrix, before) {
            let opposite: Vec<i64> = pattern.iter().map(|sign| -sign).collect();
            check(plan, &pattern);
            check(plan, &opposite);
        }
    }
}

#[test]
fn the_worst_frames_stay_within_the_bounds() {
    check_worst_frames(&plan(4, 4, "", ""));
    check_worst_frames(&plan(5, 3, "filter = { kind = \"f1\", l = 7 }", ""));
    check_worst_frames(&plan(4, 5, "filter = { kind = \"f2\", p = 20 }", "data_bits = 20"));
    check_worst_frames(&plan(2, 6, "", "coefficient_bits = 8\ndata_bits = 16"));
    check_worst_frames(&plan(4, 4, "", "coefficient_bits = 27"));
    check_worst_frames(&plan(5, 3, "filter = { kind = \"f1\", l = 7 }", "coefficient_bits = 27\ndata_bits = 20"));
}

#[test]
fn the_bound_of_the_weights_is_reached_and_not_just_respected() {
    let plan = plan(4, 4, "", "");
    let reach =
        |signs: &[i64]| products(&plan, signs).get(Vector::Weight).as_flattened().iter().copied().max().unwrap();
    let patterns = sign_patterns(&plan.matrices[0], None);
    let negative = patterns.iter().map(|pattern| pattern.iter().map(|sign| -sign).collect::<Vec<_>>());
    assert_eq!(negative.map(|signs| reach(&signs)).max(), Some(plan.formats.weight.bound));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn full_scale_of_any_signs_stays_within_the_bounds(
        columns in 2_usize..7, rows in 2_usize..7, signs in proptest::collection::vec(-1_i64..=1, 36),
    ) {
        let plan = plan(columns, rows, "", "");
        check(&plan, &signs[..plan.taxels()]);
    }
}
