//! Formats: that the worst case fits, in accumulators and results, and that nothing is coarser than need be.

use golden::design::Design;
use golden::matrices::MatrixName;
use golden::solver::Solver;
use hdl_gen::cores::ACCUMULATOR_BITS;
use hdl_gen::format::{Format, MOST_SHIFT, largest, pow2, round_shift};
use hdl_gen::plan::product::{Epilogue, Vector};
use hdl_gen::plan::{Plan, PlanError};
use proptest::prelude::*;

use crate::support::{any_paper_design, design_text, plan, small_plan};

/// For every row of every product the operand that makes its sum largest, through the product's arithmetic: the
/// accumulator with its rounding fits 48 bits, the result its format's bound.
fn check_worst_cases(plan: &Plan) {
    let mut partial = vec![[0_i64; 3]; plan.taxels()];
    for product in &plan.products {
        let matrix = &plan.matrices[product.matrix];
        let operand_format = plan.formats.of(product.operand());
        let result_format = plan.formats.of(product.result);
        let half = if product.shift == 0 { 0 } else { 1_i64 << (product.shift - 1) };
        assert!(product.shift <= MOST_SHIFT + 1, "{}: {} bits dropped", matrix.name, product.shift);
        assert_eq!(matrix.accumulator_lsb(operand_format) + product.shift as i32, result_format.lsb);
        for (row, entries) in matrix.rows.iter().enumerate() {
            let mut operand = vec![0; plan.taxels()];
            for &(column, channels) in entries {
                operand[column as usize] = operand_format.bound * i64::from(channels[0].signum());
            }
            let accumulator = matrix.row_product(row, 0, &operand);
            assert!(accumulator + half <= largest(ACCUMULATOR_BITS), "{} row {row}: {accumulator}", matrix.name);
            let result = round_shift(accumulator, product.shift);
            let mirrored = round_shift(-accumulator, product.shift);
            assert!(mirrored.abs() <= result.abs() && mirrored >= -result);
            let total = match (product.epilogue, product.result) {
                (Epilogue::Add(Vector::Partial(p)), _) => result + partial[row][usize::from(p) - 1],
                _ => result,
            };
            if let Vector::Partial(p) = product.result {
                partial[row][usize::from(p) - 1] = result;
            }
            assert!(total <= result_format.bound, "{} row {row}: {total} of {}", matrix.name, result_format.bound);
        }
    }
}

/// Widths of vectors and coefficients; each row in order, in as many channels as the plan has.
pub fn check_widths(plan: &Plan) {
    let hardware = &plan.design.hardware;
    let mut formats = vec![plan.formats.stress, plan.formats.weight, plan.formats.g, plan.formats.u];
    if let Some(folded) = plan.formats.folded {
        formats.extend([folded.stress, folded.y, folded.weight, folded.u, folded.residual, folded.explained]);
        formats.extend([folded.force, folded.taxel_force]);
    }
    for format in formats {
        let stress = format == plan.formats.stress;
        assert_eq!(format.bits, if stress { hardware.data_bits.min(27) } else { hardware.data_bits });
        assert!(format.bound > 0 && format.bound <= largest(format.bits), "{format:?} of {:?}", plan.formats);
    }
    for matrix in &plan.matrices {
        let limit = largest(hardware.coefficient_bits);
        for row in &matrix.rows {
            assert!(!row.is_empty(), "{} has an empty row", matrix.name);
            assert!(row.is_sorted_by_key(|&(column, _)| column));
            let (used, unused) = (0..plan.channels(), plan.channels()..4);
            assert!(row.iter().all(|(_, channels)| channels.iter().all(|&value| i64::from(value).abs() <= limit)));
            assert!(row.iter().all(|(_, channels)| channels[unused.clone()].iter().all(|&value| value == 0)));
            for channel in used {
                let sum: i64 = row.iter().map(|(_, channels)| i64::from(channels[channel]).abs()).sum();
                assert!(sum <= matrix.row_sum, "{}", matrix.name);
            }
        }
    }
}

/// Each coefficient is its matrix entry rounded to the nearest step.
fn check_rounding(plan: &Plan) {
    let solver = Solver::new(&plan.design).unwrap();
    let c33 = solver.matrices().c33.dense();
    for matrix in &plan.matrices {
        let plain = matrix.name.trim_matches(|c: char| !c.is_ascii_alphanumeric()).trim_start_matches("I + ");
        let sign = if matrix.name.starts_with('-') { -1.0 } else { 1.0 };
        let identity = if matrix.name.contains("I + ") { 1.0 } else { 0.0 };
        let filtered = plain.parse::<MatrixName>().ok().map(|name| solver.filtered().unwrap().get(name));
        let mut entries = 0;
        for (row, stored) in matrix.rows.iter().enumerate() {
            for &(column, [value, ..]) in stored {
                let column = column as usize;
                let kept = match filtered {
                    Some(sparse) => sparse.get_entry(row, column).map_or(0.0, nalgebra_sparse::SparseEntry::into_value),
                    None => c33[(row, column)],
                };
                let exact = sign * (kept + if row == column { identity } else { 0.0 });
                let error = (f64::from(value) * pow2(matrix.lsb) - exact).abs();
                assert!(error <= 0.501 * pow2(matrix.lsb), "{} [{row}, {column}]: off by {error:e}", matrix.name);
                entries += usize::from(row != column || identity == 0.0);
            }
        }
        let expected = match filtered {
            Some(sparse) => sparse.triplet_iter().filter(|&(row, column, _)| row != column || identity == 0.0).count(),
            None => plan.taxels() * plan.taxels(),
        };
        assert_eq!(entries, expected, "{}", matrix.name);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_worst_case_fits(text in any_paper_design()) {
        let plan = plan(&text);
        check_widths(&plan);
        check_worst_cases(&plan);
        check_rounding(&plan);
    }

    #[test]
    fn depth_may_be_a_small_or_a_large_share_of_the_pitch(ratio in -2.0..0.4_f64, pitch in 1.0..9.0_f64) {
        // Where the layer is thin, A1 and D12 are smaller than A3 and D30 by many powers of ten.
        let paper = "[algorithm]\nplan = \"paper\"";
        let plan = plan(&design_text("thin", [4, 4], [pitch, pitch], pitch * 10_f64.powf(ratio), paper));
        check_widths(&plan);
        check_worst_cases(&plan);
    }
}

#[test]
fn a_band_that_leaves_only_zeros_of_a_matrix_has_a_plan() {
    // Of A2 and C32 the narrowest band keeps only entries between neighbours in x, which are zero by symmetry.
    let plan = plan(&design_text(
        "band",
        [4, 3],
        [4.0, 2.0],
        3.0,
        "[algorithm]\nplan = \"paper\"\nfilter = { kind = \"f1\", l = 10 }",
    ));
    check_widths(&plan);
    check_worst_cases(&plan);
    let a2 = plan.matrices.iter().find(|matrix| matrix.name == "A2").unwrap();
    assert!(a2.nnz() == 12 + 2 * 11);
}

#[test]
fn the_stress_uses_its_whole_width() {
    for (full_scale, bits, lsb) in [(100_000.0, 27, -9), (100_000.0, 16, 2), (67_108_860.0, 27, 0), (0.5, 20, -19)] {
        let plan = small_plan(&format!("full_scale_pa = {full_scale:?}\ndata_bits = {bits}"));
        assert_eq!(plan.formats.stress, Format::covering(full_scale, bits));
        assert_eq!(plan.formats.stress.lsb, lsb, "{full_scale} Pa in {bits} bits");
        assert_eq!(plan.formats.stress.bound, (full_scale * pow2(-lsb)).round() as i64);
    }
    // No float32 lies between these two: a frame cannot bring the second one.
    let odd = small_plan("full_scale_pa = 67108863.0").formats.stress;
    assert_eq!((odd.lsb, odd.bound), (0, 67_108_860));
}

#[test]
fn thresholds_follow_the_noise_floor() {
    let text = |floor: &str| design_text("t", [4, 3], [4.0, 2.0], 3.0, &format!("[algorithm]\n{floor}"));
    let with = |floor: &str| plan(&text(floor)).thresholds;
    let default = with("");
    assert_eq!((default.taxel, default.contact), (781, 9375), "100 kPa / 65536 in steps of 2^-9 Pa, times 12");
    let stated = with("noise_floor_pa = 10.0");
    assert_eq!((stated.taxel, stated.contact), (5120, 61440));
    // A floor finer than a step still needs one step.
    assert_eq!(with("noise_floor_pa = 0.0002").taxel, 1);
    let design = Design::from_toml(&text("noise_floor_pa = 0.0001"), "t.toml").unwrap();
    let error = Plan::new(&design).unwrap_err();
    assert!(matches!(error, PlanError::Resolution { bits: 27, .. }), "{error}");
}
