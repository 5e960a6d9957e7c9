//! `regularisation`: its key, and what it does to conditioning, plans and noise.

use golden::design::{Design, Regularisation};
use golden::matrices::Matrices;
use golden::scene::Scene;
use golden::solver::Solver;

fn text(depth_mm: f64, algorithm: &str) -> String {
    format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"pad\"\n[sensor]\ncolumns = 7\nrows = 6\npitch_mm = [4.0, 4.0]\ndepth_mm = {depth_mm:?}\n\
         [algorithm]\n{algorithm}\n"
    )
}

fn design(depth_mm: f64, algorithm: &str) -> Design {
    Design::from_toml(&text(depth_mm, algorithm), "pad.toml").unwrap()
}

#[test]
fn the_key_is_a_share_or_a_noise_and_comes_back() {
    for (key, expected) in [
        ("", Regularisation::None),
        ("regularisation = 0", Regularisation::None),
        ("regularisation = 0.0", Regularisation::None),
        ("regularisation = 0.01", Regularisation::Factor(0.01)),
        ("regularisation = 1", Regularisation::Factor(1.0)),
        ("regularisation = { noise = 0.002 }", Regularisation::Noise { noise: 0.002 }),
    ] {
        let design = design(3.0, key);
        assert_eq!(design.algorithm.regularisation, expected, "{key}");
        assert_eq!(Design::from_toml(&design.to_toml(), "again").unwrap(), design);
    }
    assert!(Regularisation::Noise { noise: 0.002 }.factor() > 0.002);
    assert!(Regularisation::Noise { noise: 0.25 }.factor() <= 1.0);
}

#[test]
fn other_values_are_refused_with_the_key() {
    for key in [
        "regularisation = -0.1",
        "regularisation = 1.5",
        "regularisation = nan",
        "regularisation = \"noise\"",
        "regularisation = { noise = 0 }",
        "regularisation = { noise = 0.5 }",
        "regularisation = { share = 0.5 }",
        "regularisation = { noise = 0.01, share = 0.5 }",
        "regularisation = [0.1]",
    ] {
        let error = Design::from_toml(&text(3.0, key), "pad.toml").unwrap_err().to_string();
        assert!(error.contains("pad.toml") && error.contains("algorithm.regularisation"), "{key}: {error}");
    }
}

#[test]
fn the_condition_is_bounded_by_the_share() {
    for depth_mm in [3.0, 6.0, 12.0, 16.0] {
        for share in [0.001, 0.01, 0.1] {
            let matrices = Matrices::of(&design(depth_mm, &format!("regularisation = {share}"))).unwrap();
            let bound = (1.0 + share) / share;
            assert!(matrices.condition_c33() <= bound * (1.0 + 1e-9), "{depth_mm} {share}");
            // A holds C33, whose smallest singular value it cannot fall below; and C31 and C32, which are no larger.
            assert!(matrices.condition_aat() <= 3.0 * bound * bound, "{depth_mm} {share}");
        }
    }
    // The entries off the diagonal stay, and those on it grow by the share of the largest singular value.
    let [plain, regularised] =
        ["", "regularisation = 0.01"].map(|key| Matrices::of(&design(6.0, key)).unwrap().c33.dense());
    let difference = regularised - &plain;
    let share = difference[(0, 0)];
    assert!((share / (0.01 * plain.singular_values().max()) - 1.0).abs() < 1e-9);
    assert!(share > 0.0);
    for row in 0..difference.nrows() {
        for column in 0..difference.ncols() {
            let expected = if row == column { share } else { 0.0 };
            assert!((difference[(row, column)] - expected).abs() < 1e-9 * share, "{row} {column}");
        }
    }
}

#[test]
fn both_plans_stay_the_same_method() {
    let key = "regularisation = 0.01\nplan = ";
    let [paper, reduced] =
        ["\"paper\"", "\"reduced\""].map(|plan| Solver::new(&design(8.0, &format!("{key}{plan}"))).unwrap());
    for frame in Scene::standing(&design(8.0, "").sensor).frames().unwrap().iter().step_by(7) {
        let [one, other] = [&paper, &reduced].map(|solver| solver.solve(&frame.stress).unwrap());
        for axis in 0..3 {
            assert!((one.resultant[axis] - other.resultant[axis]).abs() < 1e-8, "{one:?} {other:?}");
            for (a, b) in one.field[axis].iter().zip(&other.field[axis]) {
                assert!((a - b).abs() < 1e-8);
            }
        }
    }
}

#[test]
fn a_sensor_that_only_noise_would_move_is_refused_until_it_is_regularised() {
    let deep = |key| {
        Solver::new(
            &Design::from_toml(
                &text(16.0, key).replace("columns = 7", "columns = 10").replace("rows = 6", "rows = 10"),
                "pad.toml",
            )
            .unwrap(),
        )
    };
    let refusal = deep("").unwrap_err().to_string();
    assert!(
        refusal.contains("condition number") && refusal.contains("regularisation = { noise = 0.002 }"),
        "{refusal}"
    );
    assert!(deep("regularisation = { noise = 0.002 }").is_ok());
}
