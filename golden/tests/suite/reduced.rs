//! The reduced plan: folding, its matrices and its filter, and that its results are those of the paper's plan.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::design::{Design, Filter, Kernel, Outputs, PlanKind, Sensor};
use golden::kernel;
use golden::matrices::{Matrices, MatrixName};
use golden::parity::{COMPONENTS, Orbits, sign};
use golden::reduced::{ReducedMatrices, ReducedName, SumRow};
use golden::solver::{Solution, Solver, Status};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use crate::matrices::fold;

fn design(size: [usize; 2], pitch_mm: [f64; 2], depth_mm: f64, more: &str) -> Design {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"pad\"\n[sensor]\ncolumns = {}\nrows = {}\npitch_mm = {pitch_mm:?}\ndepth_mm = {depth_mm:?}\n{more}",
        size[0], size[1]
    );
    Design::from_toml(&text, "pad.toml").unwrap()
}

/// The matrices of a small sensor of any parity of sides, and the dense ones of the reduced plan.
fn small(columns: usize, rows: usize) -> (Orbits, Matrices, [DMatrix<f64>; 10]) {
    let sensor = Sensor { columns, rows, pitch_mm: [4.0, 3.0], depth_mm: 3.0 };
    let matrices = Matrices::new(&sensor, Kernel::Point).unwrap();
    let [a1, a2, a3] = [MatrixName::A1, MatrixName::A2, MatrixName::A3].map(|name| matrices.dense(name));
    let [c31, c32, c33] = kernel::matrices(&sensor, Kernel::Point);
    let e = &c33 * &a3;
    let dense = [matrices.dense(MatrixName::C33inv), &c33 - &e * &c33, &e * &c31, &e * &c32, c33, c31, c32, a1, a2, a3];
    (Orbits::new(columns, rows), matrices, dense)
}

/// Numbers without any symmetry.
fn uneven(count: usize) -> Vec<f64> {
    (0..count).map(|i| (1.7 * i as f64 + 0.3).sin() - 0.2).collect()
}

const SIDES: [[usize; 2]; 5] = [[2, 2], [6, 4], [5, 4], [4, 7], [5, 3]];

#[test]
fn every_taxel_is_in_one_orbit() {
    for [columns, rows] in SIDES {
        let orbits = Orbits::new(columns, rows);
        assert_eq!((orbits.columns(), orbits.rows()), (columns.div_ceil(2), rows.div_ceil(2)));
        let mut seen = vec![0; columns * rows];
        for q in 0..orbits.count() {
            let images = orbits.images(q);
            for (s, taxel) in orbits.distinct(q) {
                assert_eq!(images[s], taxel);
                seen[taxel] += 1;
            }
            assert_eq!(orbits.distinct(q).count(), orbits.size(q));
            // Mirrored in both directions: the same distance from the other corner.
            assert_eq!(images[0] + images[3], columns * rows - 1);
        }
        assert_eq!(seen, vec![1; columns * rows], "{columns} x {rows}");
    }
    assert_eq!(Orbits::new(5, 3).distinct(5).collect::<Vec<_>>(), [(0, 7)], "the centre");
}

#[test]
fn signs_are_those_of_the_components() {
    let table = [[1, 1, 1, 1], [1, -1, 1, -1], [1, 1, -1, -1], [1, -1, -1, 1]];
    for (component, row) in table.into_iter().enumerate() {
        assert_eq!([0, 1, 2, 3].map(|image| sign(component, image)), row.map(f64::from));
    }
}

#[test]
fn folding_is_undone() {
    for [columns, rows] in SIDES {
        let orbits = Orbits::new(columns, rows);
        let x = uneven(columns * rows);
        let folded = orbits.fold(&x);
        for (component, folded) in folded.iter().enumerate() {
            for (q, value) in folded.iter().enumerate() {
                let images = orbits.images(q);
                let sum: f64 = (0..4).map(|s| sign(component, s) * x[images[s]]).sum();
                assert!((value - sum).abs() < 1e-14);
                assert!(orbits.exists(component, q) || *value == 0.0);
            }
        }
        for (found, expected) in orbits.unfold(&folded).iter().zip(&x) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}

#[test]
fn blocks_do_what_the_matrix_does() {
    for [columns, rows] in SIDES {
        let (orbits, matrices, dense) = small(columns, rows);
        let reduced = ReducedMatrices::new(&matrices, &orbits, &Filter::None).unwrap();
        let x = uneven(columns * rows);
        let whole = DVector::from_vec(x.clone());
        let folded = orbits.fold(&x);
        let elements: Vec<[f64; 4]> =
            (0..orbits.count()).map(|q| folded.each_ref().map(|component| component[q])).collect();
        for (name, dense) in ReducedName::ALL.into_iter().zip(&dense) {
            let product = dense * &whole;
            let tolerance = 1e-12 * product.amax();
            let blocks = fold(dense, name.parity(), &orbits);
            let sparse = reduced.get(name);
            assert_eq!(sparse.parity, name.parity());
            let mut by_rows = vec![[0.0; 4]; orbits.count()];
            sparse.times(&elements, &mut by_rows);
            let by_rows = [0, 1, 2, 3].map(|component| by_rows.iter().map(|row| row[component]).collect());
            for found in [blocks.apply(&folded), by_rows] {
                let found = orbits.unfold(&found);
                let error = (DVector::from_vec(found) - &product).amax();
                assert!(error < tolerance, "{name} of {columns} x {rows}: off by {error:e}");
            }
            // Without a filter everything is kept, and what cannot be is exactly zero.
            let n = orbits.count();
            assert_eq!(reduced.nnz(name), 4 * n * n);
            for (q, row) in sparse.rows.iter().enumerate() {
                for &(column, values) in row {
                    for (component, value) in values.into_iter().enumerate() {
                        let exists =
                            orbits.exists(component, column as usize) && orbits.exists(component ^ name.parity(), q);
                        assert!(exists || value == 0.0);
                    }
                }
            }
        }
    }
}

#[test]
fn sums_are_those_of_the_coefficients() {
    for [columns, rows] in SIDES {
        let (orbits, matrices, dense) = small(columns, rows);
        let reduced = ReducedMatrices::new(&matrices, &orbits, &Filter::None).unwrap();
        let x = DVector::from_vec(uneven(columns * rows));
        let folded = orbits.fold(x.as_slice());
        let total = x.sum();
        let arms = (0..x.len()).map(|taxel| matrices.sensor().arm_m(taxel));
        let shares =
            arms.zip(x.iter()).fold([0.0; 3], |[one, y, x], (arm, w)| [one + w, y + arm[1] * w, x - arm[0] * w]);
        let sum = |row: &SumRow| -> f64 { row.weights.iter().zip(&folded[row.component]).map(|(w, x)| w * x).sum() };
        for (row, share) in reduced.weight_shares().iter().zip(shares) {
            assert!((sum(row) - share).abs() < 1e-12);
        }
        for p in 0..3 {
            for (q, c) in [&dense[4], &dense[5], &dense[6]].into_iter().enumerate() {
                let product = (&dense[7 + p] * (c * &x)).sum();
                let own = if q == p + 1 { total } else { 0.0 };
                let expected = if q == 0 { product } else { own - product };
                let found = sum(reduced.sums(p, q));
                assert!((found - expected).abs() < 1e-11 * (1.0 + total.abs()), "G{}{q}: {found} {expected}", p + 1);
            }
        }
    }
}

#[test]
fn a_row_threshold_is_by_magnitude_and_the_same_for_all_components() {
    for [columns, rows] in SIDES {
        let (orbits, matrices, dense) = small(columns, rows);
        let p = 0.02;
        let reduced = ReducedMatrices::new(&matrices, &orbits, &Filter::F2 { p }).unwrap();
        for (name, dense) in ReducedName::ALL.into_iter().zip(&dense) {
            let blocks = fold(dense, name.parity(), &orbits).blocks;
            for (q, row) in reduced.get(name).rows.iter().enumerate() {
                assert!(!row.is_empty() && row.is_sorted_by_key(|&(column, _)| column));
                for column in 0..orbits.count() {
                    let kept = row.iter().any(|&(kept, _)| kept as usize == column);
                    // Away from the threshold by more than rounding.
                    let ratio = (0..COMPONENTS)
                        .map(|c| (blocks[c][(q, column)] / blocks[c].row(q).amax()).abs())
                        .fold(0.0, f64::max);
                    assert!((ratio - 0.05).abs() < 1e-9 || kept == (ratio > 0.05), "{name} {q} {column}: {ratio}");
                }
            }
        }
    }
}

#[test]
fn a_band_is_scaled_to_the_block() {
    let (orbits, matrices, _) = small(6, 4);
    // 24 taxels, 6 orbits: l = 1, 4, 5, 22 of at most 22 keeps 5 (23 - l) / 23 diagonals on either side.
    for (l, distance) in [(1, 4), (4, 4), (5, 3), (22, 0)] {
        let reduced = ReducedMatrices::new(&matrices, &orbits, &Filter::F1 { l }).unwrap();
        for name in ReducedName::ALL {
            for (q, row) in reduced.get(name).rows.iter().enumerate() {
                let expected: Vec<usize> = (0..6).filter(|&column| q.abs_diff(column) <= distance).collect();
                assert!(row.iter().map(|&(column, _)| column as usize).eq(expected), "{name}, l = {l}");
            }
        }
    }
}

#[test]
fn filters_that_cannot_be_are_refused() {
    let (orbits, matrices, _) = small(5, 4);
    let error = ReducedMatrices::new(&matrices, &orbits, &Filter::F2 { p: 0.0005 }).unwrap_err();
    assert!(error.to_string().contains("the filter f2 p=0.0005 empties row 0 of the folded matrix C33inv"), "{error}");
    let error =
        ReducedMatrices::new(&matrices, &orbits, &Filter::F3 { scenes: Vec::new(), choices: None }).unwrap_err();
    assert!(error.to_string().contains("plan = \"paper\""), "{error}");
}

fn both(design: &Design) -> [Solver; 2] {
    [PlanKind::Paper, PlanKind::Reduced].map(|plan| {
        let mut design = design.clone();
        design.algorithm.plan = plan;
        Solver::new(&design).unwrap()
    })
}

/// Asserts that the solutions are the same but for rounding.
fn assert_same(paper: &Solution, reduced: &Solution) {
    assert_eq!(paper.status, reduced.status);
    let peak = paper.field.iter().flatten().fold(0.0_f64, |peak, force| peak.max(force.abs()));
    for (one, other) in paper.field.iter().flatten().zip(reduced.field.iter().flatten()) {
        assert!((one - other).abs() <= 1e-9 * peak, "{one} {other} of {peak}");
    }
    let taxels = paper.field[0].len() as f64;
    for (one, other) in paper.resultant.iter().zip(reduced.resultant) {
        assert!((one - other).abs() <= 1e-9 * taxels * peak, "{one} {other}");
    }
    assert!((paper.mu_x - reduced.mu_x).abs() < 1e-9 && (paper.mu_y - reduced.mu_y).abs() < 1e-9);
}

#[test]
fn the_papers_sensors_have_the_papers_results() {
    for (pitch, kernel) in [([4.0, 2.0], "point"), ([4.0, 4.0], "cell")] {
        let design = design([10, 10], pitch, 3.0, &format!("[algorithm]\nkernel = \"{kernel}\"\n"));
        assert_eq!(design.algorithm.plan, PlanKind::Reduced);
        let [paper, reduced] = both(&design);
        assert!(paper.filtered().is_some() && paper.reduced().is_none());
        assert!(reduced.filtered().is_none() && reduced.reduced().is_some());
        let [c31, c32, c33] = kernel::matrices(&design.sensor, design.algorithm.kernel);
        for direction in 0..12 {
            // A contact off the centre, pushed in each direction.
            let (sine, cosine) = (f64::from(direction) * 30.0_f64.to_radians()).sin_cos();
            let press = DVector::from_fn(100, |i, _| {
                let square = (((i % 10) as f64 - 4.2) / 3.0).powi(2) + (((i / 10) as f64 - 5.1) / 3.0).powi(2);
                0.1 * (1.0 - square).max(0.0).sqrt()
            });
            let b = (&c31 * cosine + &c32 * sine) * &press * 0.5 - &c33 * &press;
            let [one, other] = [&paper, &reduced].map(|solver| solver.solve(b.as_slice()).unwrap());
            assert_eq!(one.status, Status::default());
            assert_same(&one, &other);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn any_sensor_has_the_papers_results(
        columns in 2_usize..9, rows in 2_usize..9,
        pitch_x in 1.0..10.0_f64, pitch_y in 1.0..10.0_f64, ratio in 0.3..1.2_f64, cell in proptest::bool::ANY,
        values in proptest::collection::vec(-90_000.0..30_000.0_f64, 64),
    ) {
        let kernel = if cell { "cell" } else { "point" };
        let depth = ratio * pitch_x.min(pitch_y);
        let design =
            design([columns, rows], [pitch_x, pitch_y], depth, &format!("[algorithm]\nkernel = \"{kernel}\"\n"));
        let [paper, reduced] = both(&design);
        let frame = &values[..columns * rows];
        let [one, other] = [&paper, &reduced].map(|solver| solver.solve(frame).unwrap());
        assert_same(&one, &other);
    }
}

#[test]
fn frames_without_an_answer_have_the_same_status() {
    let [paper, reduced] = both(&design([4, 3], [4.0, 4.0], 3.0, ""));
    let mut bad = vec![-5000.0; 12];
    bad[7] = f64::NAN;
    for frame in [vec![0.0; 12], vec![-500.0; 12], vec![-4e9; 12], bad] {
        let [one, other] = [&paper, &reduced].map(|solver| solver.solve(&frame).unwrap());
        assert_same(&one, &other);
    }
}

#[test]
fn resultants_come_without_a_field() {
    let full = design([5, 4], [4.0, 3.0], 3.0, "[algorithm]\nplan = \"reduced\"\n");
    let mut short = full.clone();
    short.algorithm.outputs = Outputs::Resultants;
    let [full, short] = [full, short].map(|design| Solver::new(&design).unwrap());
    for frame in [uneven(20).iter().map(|x| 9000.0 * x - 3000.0).collect(), vec![0.0; 20]] {
        let (one, other) = (full.solve(&frame).unwrap(), short.solve(&frame).unwrap());
        assert!(other.field.iter().all(Vec::is_empty));
        assert_eq!((one.status, one.resultant, one.mu, one.phi), (other.status, other.resultant, other.mu, other.phi));
        for (p, component) in one.field.iter().enumerate() {
            assert!((component.iter().sum::<f64>() - one.resultant[p]).abs() <= 1e-9 * one.resultant[2].abs());
        }
    }
}

#[test]
fn a_filter_changes_the_field_a_little_and_the_sums_not() {
    let unfiltered = design([10, 10], [4.0, 2.0], 3.0, "[algorithm]\nplan = \"reduced\"\n");
    let mut filtered = unfiltered.clone();
    filtered.algorithm.filter = Filter::F2 { p: 1.0 };
    let frame: Vec<f64> = (0..100).map(|i| if i % 10 > 2 && i / 10 > 3 { -8000.0 } else { 60.0 }).collect();
    let [plain, sparse] = [unfiltered, filtered].map(|design| Solver::new(&design).unwrap());
    let kept = |solver: &Solver| {
        ReducedName::ALL.map(|name| solver.reduced().map_or(0, |matrices| matrices.nnz(name))).iter().sum::<usize>()
    };
    assert!(kept(&sparse) < kept(&plain) * 9 / 10, "{} of {}", kept(&sparse), kept(&plain));
    let [plain, sparse] = [plain, sparse].map(|solver| solver.solve(&frame).unwrap());
    let error = golden::metrics::field_error(&plain.field, &sparse.field);
    assert!(error > 1e-6 && error < 0.05, "{error}");
}
