//! The 13 matrices and their filters, against the paper's table and the algebra that defines them.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::design::{Filter, Kernel, Sensor};
use golden::filter::{FilteredMatrices, nnz_of};
use golden::kernel;
use golden::matrices::{Matrices, MatrixName};
use golden::parity::{FoldedMatrix, Orbits};
use nalgebra::DMatrix;
use proptest::prelude::*;

fn sensor(pitch_mm: [f64; 2]) -> Sensor {
    Sensor { columns: 10, rows: 10, pitch_mm, depth_mm: 3.0 }
}

const SENSOR_1: [f64; 2] = [4.0, 2.0];
const SENSOR_2: [f64; 2] = [4.0, 4.0];

fn counts(pitch_mm: [f64; 2], filter: &Filter) -> [usize; 13] {
    let matrices = Matrices::new(&sensor(pitch_mm), Kernel::Point).unwrap();
    let filtered = FilteredMatrices::new(&matrices, filter).unwrap();
    MatrixName::ALL.map(|name| filtered.nnz(name))
}

#[test]
fn row_thresholds_count_as_in_table_1() {
    let table = [
        (SENSOR_1, 30.0, [4512, 9462, 7966, 6876, 9548, 10000, 9400, 8938, 9400, 9412, 10000, 9550, 8934]),
        (SENSOR_1, 50.0, [5180, 9522, 8552, 7684, 9568, 10000, 9502, 9320, 9490, 9676, 10000, 9568, 9326]),
        (SENSOR_2, 20.0, [4036, 9294, 9294, 5388, 9360, 9932, 9146, 9360, 9146, 9932, 10000, 9362, 9362]),
        (SENSOR_2, 50.0, [5348, 9430, 9430, 7588, 9440, 9968, 9196, 9440, 9196, 9968, 10000, 9442, 9442]),
    ];
    for (pitch, p, expected) in table {
        assert_eq!(counts(pitch, &Filter::F2 { p }), expected, "pitch {pitch:?}, p = {p}");
    }
    // An entry of the paper's F3 column for sensor 2.
    assert_eq!(counts(SENSOR_2, &Filter::F2 { p: 70.0 })[0], 5732);
}

#[test]
fn bands_count_as_in_table_1() {
    for (l, expected) in [(40, 8360), (50, 7450)] {
        assert_eq!(counts(SENSOR_1, &Filter::F1 { l }), [expected; 13]);
    }
    assert_eq!(counts(SENSOR_1, &Filter::None), [10_000; 13]);
}

#[test]
fn counts_need_no_whole_matrix() {
    // Sides of every parity: rows on a centre line are there once.
    for (columns, rows) in [(10, 10), (7, 4), (4, 7), (5, 5), (2, 3)] {
        let sensor = Sensor { columns, rows, pitch_mm: SENSOR_1, depth_mm: 3.0 };
        let matrices = Matrices::new(&sensor, Kernel::Point).unwrap();
        for filter in [Filter::None, Filter::F1 { l: 3 }, Filter::F2 { p: 0.3 }, Filter::F2 { p: 30.0 }] {
            let filtered = FilteredMatrices::new(&matrices, &filter).unwrap();
            for name in MatrixName::ALL {
                let counted = nnz_of(&matrices, name, filter.of(name).unwrap());
                assert_eq!(counted, filtered.nnz(name), "{name} of {columns} x {rows}, {filter:?}");
            }
        }
    }
}

/// The blocks of a matrix of m by m entries.
pub fn fold(matrix: &DMatrix<f64>, parity: usize, orbits: &Orbits) -> FoldedMatrix {
    FoldedMatrix::from_fn(parity, orbits, |row, column| matrix[(row, column)])
}

#[test]
fn the_kernels_matrices_survive_folding() {
    for (columns, rows) in [(10, 10), (7, 4), (4, 7), (5, 5)] {
        let sensor = Sensor { columns, rows, pitch_mm: SENSOR_1, depth_mm: 3.0 };
        for kind in [Kernel::Point, Kernel::Cell] {
            let folded = kernel::folded(&sensor, kind);
            for (folded, whole) in folded.iter().zip(kernel::matrices(&sensor, kind)) {
                assert_close(&folded.dense(), &whole, 1e-15 * whole.amax(), "folded and unfolded");
                assert_eq!(*folded, fold(&whole, folded.parity, &folded.orbits));
            }
        }
    }
}

#[test]
fn filtered_entries_are_the_unfiltered_ones() {
    let matrices = Matrices::new(&sensor(SENSOR_1), Kernel::Point).unwrap();
    let filtered = FilteredMatrices::new(&matrices, &Filter::F1 { l: 40 }).unwrap();
    for name in MatrixName::ALL {
        let dense = matrices.dense(name);
        for (row, column, value) in filtered.get(name).triplet_iter() {
            assert_eq!(*value, dense[(row, column)]);
            assert!(row.abs_diff(column) <= 59);
        }
    }
}

#[test]
fn a_filter_that_leaves_nothing_is_refused() {
    let matrices = Matrices::new(&sensor(SENSOR_1), Kernel::Point).unwrap();
    let error = FilteredMatrices::new(&matrices, &Filter::F2 { p: 1e-6 }).unwrap_err().to_string();
    assert!(error.contains("C33inv") && error.contains("f2 p=0.000001"), "{error}");
    // On a deep sensor some rows of C33inv have their largest magnitude in a negative entry, and stay; others go.
    let deep = Sensor { depth_mm: 12.0, ..sensor(SENSOR_2) };
    let error = FilteredMatrices::new(&Matrices::new(&deep, Kernel::Point).unwrap(), &Filter::F2 { p: 0.000_999 })
        .unwrap_err()
        .to_string();
    assert!(error.contains("row 1 of matrix C33inv"), "{error}");
}

fn blocks(matrices: &Matrices) -> DMatrix<f64> {
    let m = matrices.orbits().taxels();
    let mut a = DMatrix::zeros(m, 3 * m);
    for (block, c) in [&matrices.c31, &matrices.c32, &matrices.c33].into_iter().enumerate() {
        a.columns_mut(block * m, m).copy_from(&c.dense());
    }
    a
}

fn assert_close(found: &DMatrix<f64>, expected: &DMatrix<f64>, tolerance: f64, what: &str) {
    let error = (found - expected).amax();
    assert!(error <= tolerance, "{what}: off by {error:e}");
}

/// The equations that define the matrices, on any sensor; `tolerance` grows with the condition number.
fn check_algebra(sensor: &Sensor, kernel: Kernel) {
    let matrices = Matrices::new(sensor, kernel).unwrap();
    let get = |name| matrices.dense(name);
    let (c32, c33) = (matrices.c32.dense(), matrices.c33.dense());
    let m = sensor.taxels();
    let one = DMatrix::identity(m, m);
    let tolerance = 1e-13 * matrices.condition_c33().max(matrices.condition_aat().sqrt()) * m as f64;

    assert_close(&(c33 * get(MatrixName::C33inv)), &one, tolerance, "C33 C33inv");
    let a = blocks(&matrices);
    let mut a_plus = DMatrix::zeros(3 * m, m);
    for (block, name) in [MatrixName::A1, MatrixName::A2, MatrixName::A3].into_iter().enumerate() {
        a_plus.rows_mut(block * m, m).copy_from(&get(name));
    }
    assert_close(&(&a * &a_plus), &one, tolerance, "A A+");
    let projection = &a_plus * &a;
    assert_close(&projection.transpose(), &projection, tolerance, "A+ A");

    for (name, mirror) in [
        (MatrixName::D12, MatrixName::D21),
        (MatrixName::D10, MatrixName::D31),
        (MatrixName::D20, MatrixName::D32),
        (MatrixName::D11, MatrixName::D11),
        (MatrixName::D22, MatrixName::D22),
        (MatrixName::D30, MatrixName::D30),
    ] {
        assert_close(&get(name).transpose(), &get(mirror), tolerance, &format!("{name} = {mirror}^T"));
    }
    assert_close(&(-(get(MatrixName::A1) * c32)), &get(MatrixName::D12), tolerance, "D12 = -A1 C32");
}

#[test]
fn the_papers_sensors_satisfy_the_algebra() {
    for kernel in [Kernel::Point, Kernel::Cell] {
        check_algebra(&sensor(SENSOR_1), kernel);
        check_algebra(&sensor(SENSOR_2), kernel);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn any_sensor_satisfies_the_algebra(
        columns in 2_usize..8, rows in 2_usize..8,
        pitch_x in 1.0..10.0_f64, pitch_y in 1.0..10.0_f64, ratio in 0.3..2.0_f64, cell in proptest::bool::ANY,
    ) {
        let sensor = Sensor { columns, rows, pitch_mm: [pitch_x, pitch_y], depth_mm: ratio * pitch_x.min(pitch_y) };
        check_algebra(&sensor, if cell { Kernel::Cell } else { Kernel::Point });
    }
}

#[test]
fn tension_trails_the_push() {
    // A force along +x on the middle of the grid: tension behind it, compression ahead.
    let matrices = Matrices::new(&sensor(SENSOR_1), Kernel::Point).unwrap();
    let force = 45;
    let [c31, c32, c33] = [&matrices.c31, &matrices.c32, &matrices.c33].map(FoldedMatrix::dense);
    assert!(c31[(44, force)] > 0.0 && c31[(46, force)] < 0.0);
    assert!(c32[(35, force)] > 0.0 && c32[(55, force)] < 0.0);
    assert!(c33[(45, force)] > 0.0, "f_z < 0 gives compression");
}

#[test]
fn condition_numbers() {
    // h/s, cond C33, cond A A^T, each with half a unit of its last digit.
    let table = [
        (0.5, (1.15, 0.005), (1.33, 0.005)),
        (0.75, (1.83, 0.005), (3.4, 0.05)),
        (1.0, (3.8, 0.05), (15.0, 0.5)),
        (1.5, (22.0, 0.5), (490.0, 5.0)),
        (2.0, (136.0, 0.5), (1.9e4, 0.05e4)),
        (3.0, (5.8e3, 0.05e3), (3e7, 0.5e7)),
        (4.0, (2.4e5, 0.05e5), (3.845e10, 0.001e10)),
    ];
    for (ratio, c33, aat) in table {
        let matrices = Matrices::new(
            &Sensor { columns: 10, rows: 10, pitch_mm: [4.0, 4.0], depth_mm: 4.0 * ratio },
            Kernel::Point,
        )
        .unwrap();
        for ((expected, tolerance), found) in [(c33, matrices.condition_c33()), (aat, matrices.condition_aat())] {
            assert!((found - expected).abs() <= tolerance, "h/s = {ratio}: {found} for {expected}");
        }
    }
    for (pitch, expected) in [(SENSOR_1, (7.2, 52.0)), (SENSOR_2, (1.83, 3.4))] {
        let matrices = Matrices::new(&sensor(pitch), Kernel::Point).unwrap();
        assert!((matrices.condition_c33() / expected.0 - 1.0).abs() < 0.01);
        assert!((matrices.condition_aat() / expected.1 - 1.0).abs() < 0.015);
    }
}

#[test]
fn a_sensor_too_deep_to_invert_is_refused() {
    let error = Matrices::new(&Sensor { columns: 10, rows: 10, pitch_mm: [1.0, 1.0], depth_mm: 12.0 }, Kernel::Point)
        .unwrap_err()
        .to_string();
    for part in ["singular", "condition number", "12 mm", "smaller depth"] {
        assert!(error.contains(part), "no {part:?} in: {error}");
    }
}

#[test]
fn names_are_those_of_the_table() {
    let names = MatrixName::ALL.map(|name| name.to_string()).join(" ");
    assert_eq!(names, "C33inv A1 A2 A3 D10 D11 D12 D20 D21 D22 D30 D31 D32");
    for name in MatrixName::ALL {
        assert_eq!(name.to_string().parse::<MatrixName>().unwrap(), name);
    }
    assert!("D40".parse::<MatrixName>().is_err());
}
