//! Sensors of thousands of taxels, by the reduced plan.

use golden::design::{Design, Filter, Kernel, MatrixFilter};
use golden::filter::nnz_of;
use golden::matrices::{Matrices, MatrixName};
use golden::reduced::{ReducedMatrices, ReducedName};
use golden::solver::{Solver, Status};
use nalgebra::DVector;

fn check(columns: usize, rows: usize) {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"mat\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"reduced\"\n"
    );
    let design = Design::from_toml(&text, "mat.toml").unwrap();
    let matrices = Matrices::new(&design.sensor, Kernel::Point).unwrap();
    let reduced = ReducedMatrices::new(&matrices, matrices.orbits(), &Filter::None).unwrap();
    let n = matrices.orbits().count();
    assert!(ReducedName::ALL.into_iter().all(|name| reduced.nnz(name) == 4 * n * n));
    let counts = MatrixName::ALL.map(|name| nnz_of(&matrices, name, MatrixFilter::F2 { p: 30.0 }));
    let m = columns * rows;
    assert!(counts.iter().all(|&count| count > m && count <= m * m), "{counts:?}");
    drop(reduced);

    // A pushed contact on a part of the mat; without a filter its stress is explained exactly.
    let press = DVector::from_fn(m, |i, _| {
        let [x, y] = [i % columns, i / columns].map(|place| place as f64);
        let square = ((x - 0.4 * columns as f64) / 6.0).powi(2) + ((y - 0.6 * rows as f64) / 5.0).powi(2);
        0.1 * (1.0 - square).max(0.0).sqrt()
    });
    let stress = &(&matrices.c31 * &press) * 0.4 + &(&matrices.c32 * &press) * 0.3 - &matrices.c33 * &press;
    let solver = Solver::new(&design).unwrap();
    let solution = solver.solve(stress.as_slice()).unwrap();
    assert_eq!(solution.status, Status::default());
    // The line search's friction falls short of the true 0.5, here as everywhere.
    let direction = 0.3_f64.atan2(0.4);
    assert!(
        solution.mu > 0.3 && solution.mu < 0.6 && (solution.phi - direction).abs() < 0.2,
        "{} {}",
        solution.mu,
        solution.phi
    );
    let [fx, fy, fz] = solution.field.map(DVector::from_vec);
    let residual = (&matrices.c31 * &fx + &matrices.c32 * &fy + &matrices.c33 * &fz - &stress).amax();
    assert!(residual < 1e-9 * stress.amax(), "{residual:e}");
}

#[test]
fn a_mat_of_1728_taxels() {
    check(27, 64);
}

#[test]
#[ignore = "a minute: part of `make test-long`"]
fn a_mat_of_4096_taxels() {
    check(64, 64);
}
