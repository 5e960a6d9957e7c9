//! The line search on ground truth: accuracy, symmetry, and frames without an answer.

use std::path::{Path, PathBuf};

use crate::designs::design;
use crate::stages;
use golden::design::{Design, Kernel};
use golden::estimators::line;
use golden::kernel;
use golden::metrics::{ErrorSummary, Outcome, errors};
use golden::scene::{Scene, SceneFrame};
use golden::solver::{Solution, Solver, Status, cean};
use nalgebra::DVector;
use proptest::prelude::*;

fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn frames(name: &str) -> Vec<SceneFrame> {
    Scene::load(&file(&format!("scenes/{name}.toml"))).unwrap().frames().unwrap()
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() <= tolerance, "{found:.2?} for {expected:.2?}");
    }
}

/// Worst errors of an estimate, forces times `gain`: `e_Fx`, `e_Fy`, `e_Fz` in percent and the angle in degrees.
fn worst(name: &str, scene: &str, gain: f64, every: usize) -> [f64; 4] {
    let solver = Solver::new(&design(name)).unwrap();
    let mut worst = [0.0_f64; 4];
    for frame in frames(scene).iter().step_by(every) {
        let solution = solver.solve(&frame.stress).unwrap();
        // Designs with a standard error rightly doubt the line search.
        assert_eq!(solution.status.0 & !Status::LOW_CONFIDENCE.0, 0, "{}", frame.label);
        let mut found = Outcome::from(&solution);
        found.force = found.force.map(|force| gain * force);
        let [fx, fy, fz, _, phi] = errors(&Outcome::from(frame), &found);
        for (worst, error) in worst.iter_mut().zip([fx, fy, fz, 3.6 * phi]) {
            *worst = worst.max(error);
        }
    }
    worst
}

#[test]
fn accuracy_on_the_layer() {
    // An independent implementation, 12 directions: without gain F_z is off by 10.8 % and 20.6 %; with the gain of the
    // point kernel, 1.096 and 1.248, the tangential forces by 5.1, 4.7 % and 1.7, 1.7 %, the angle by 7.1 and 0.7 deg.
    let one = worst("sensor1-none", "sensor1-hertz", 1.096, 3);
    assert_near(&one, &[5.1, 4.7, 2.2, 7.1], 0.1);
    let two = worst("sensor2-none", "sensor2-disc", 1.248, 3);
    assert_near(&two, &[1.7, 1.7, 1.0, 0.7], 0.12);
    let plain = worst("sensor1-none", "sensor1-hertz", 1.0, 3);
    assert_near(&plain[2..3], &[10.8], 0.05);
    let plain = worst("sensor2-none", "sensor2-disc", 1.0, 3);
    assert_near(&plain[2..3], &[20.6], 0.05);
}

#[test]
fn the_kernel_gain_is_that_of_the_normal_force() {
    for (name, expected) in [("sensor1-none", 1.096), ("sensor2-none", 1.248)] {
        let design = design(name);
        let solver = Solver::new(&design).unwrap();
        let [sx, sy] = design.sensor.pitch_mm;
        let gain = sx * sy * 1e-6 * solver.matrices().c33.dense().row(55).sum();
        assert!((gain - expected).abs() < 5e-4, "{name}: {gain}");
        // An endless grid has a little more.
        let endless = kernel::gain(&design.sensor, Kernel::Point);
        assert!(endless > gain && endless < gain + 0.02, "{name}: {endless}");
        let cell = kernel::gain(&design.sensor, Kernel::Cell);
        assert!((0.998..1.0).contains(&cell), "{name}: {cell}");
    }
}

/// True outcomes and estimates, by the stages and with a level of choice, of every so many directions.
fn pairs_at_level(name: &str, scene: &str, level: f64, every: usize) -> Vec<(Outcome, Outcome)> {
    let design = design(name);
    let solver = Solver::new(&design).unwrap();
    let positions: Vec<[f64; 2]> = (0..100).map(|i| design.sensor.position_m(i)).collect();
    frames(scene)
        .iter()
        .step_by(every)
        .map(|frame| {
            let b = DVector::from_vec(frame.stress.clone());
            let contact = cean::cean(&b, &positions, design.algorithm.noise_floor_pa);
            let filtered = solver.filtered().unwrap();
            let coefficients = stages::co(&b, &stages::we(&b, filtered), filtered);
            let forces = stages::op(&contact, &coefficients, solver.matrices(), level);
            let found = Outcome { force: forces.resultant, friction: forces.mu, direction: forces.phi };
            (Outcome::from(frame), found)
        })
        .collect()
}

/// Errors of sensor 1 in 36 directions.
fn summary_at_level(level: f64) -> ErrorSummary {
    ErrorSummary::new(&pairs_at_level("sensor1-none", "sensor1-hertz", level, 1))
}

#[test]
fn the_second_sensors_tangential_error_hangs_on_the_level() {
    // The independent implementation has 1.7, without saying its level, where the solver has 1.59: a level that is a few
    // percent of this one lower makes that difference.
    let at = |level: f64| {
        let mut pairs = pairs_at_level("sensor2-none", "sensor2-disc", level, 3);
        for (_, found) in &mut pairs {
            found.force = found.force.map(|force| 1.248 * force);
        }
        ErrorSummary::new(&pairs).e_fx.max
    };
    assert_near(&[at(line::LEVEL), at(0.5 * line::LEVEL)], &[1.59, 2.62], 0.01);
    let lower = at(0.93 * line::LEVEL);
    assert!((1.6..1.8).contains(&lower), "{lower}");
}

#[test]
fn accuracy_in_36_directions_without_gain() {
    // An independent implementation gives 4.5, 7.9, 10.8, 3.4, 2.2 % without saying its level. About 3e-4 was found by
    // trying to give the same; the errors along z and of the angle do not depend on the level.
    let lower = summary_at_level(3e-4).spreads().map(|spread| spread.max);
    assert_near(&lower, &[4.5, 7.9, 10.8, 3.4, 2.2], 0.1);
    // At the solver's own level, as measured here: tangential forces a little worse, friction better.
    let ours = summary_at_level(line::LEVEL).spreads().map(|spread| spread.max);
    assert_near(&ours, &[6.1, 8.2, 10.8, 2.2, 2.2], 0.1);
}

/// True and estimated outcome of every frame of a scene.
fn solve_all(design: &Design, scene: &str) -> Vec<(Outcome, Outcome)> {
    let solver = Solver::new(design).unwrap();
    let found = |frame: &SceneFrame| Outcome::from(&solver.solve(&frame.stress).unwrap());
    frames(scene).iter().map(|frame| (Outcome::from(frame), found(frame))).collect()
}

#[test]
fn the_cell_kernel_needs_no_gain() {
    // Measured here, worst of 36 directions. With the cell kernel F_z is right as it is, and the direction is the same.
    // The tangential forces fall short with either kernel; with the point kernel F_z does so as much, so that their
    // quotient, the friction, is the better one.
    for (name, scene, point, cell) in [
        ("sensor1-none", "sensor1-hertz", ([6.1, 8.2, 10.8, 2.2, 2.2], 0.504), ([7.6, 10.2, 0.9, 8.0, 2.2], 0.433)),
        ("sensor2-none", "sensor2-disc", ([9.1, 9.1, 20.6, 2.9, 0.3], 0.519), ([9.3, 9.3, 0.4, 9.1, 0.3], 0.416)),
    ] {
        let mut design = design(name);
        for (kernel, (expected, expected_mean)) in [(Kernel::Point, point), (Kernel::Cell, cell)] {
            design.algorithm.kernel = kernel;
            let pairs = solve_all(&design, scene);
            let mean = pairs.iter().map(|(_, found)| found.friction).sum::<f64>() / pairs.len() as f64;
            let found = ErrorSummary::new(&pairs).spreads().map(|spread| spread.max);
            assert_near(&found, &expected, 0.06);
            assert_near(&[mean], &[expected_mean], 5e-4);
        }
    }
}

#[test]
fn the_stress_is_explained_exactly_without_a_filter() {
    let solver = Solver::new(&design("sensor1-none")).unwrap();
    let matrices = solver.matrices();
    for frame in frames("sensor1-hertz").iter().step_by(5) {
        let solution = solver.solve(&frame.stress).unwrap();
        let [fx, fy, fz] = solution.field.map(DVector::from_vec);
        let stress = &matrices.c31 * &fx + &matrices.c32 * &fy + &matrices.c33 * &fz;
        let residual = (stress - DVector::from_vec(frame.stress.clone())).amax();
        assert!(residual < 1e-8, "{}: {residual:e} Pa", frame.label);
    }
}

#[test]
fn a_filter_changes_the_result_a_little() {
    let plain = Solver::new(&design("sensor1-none")).unwrap();
    let frame = &frames("sensor1-hertz")[4];
    let reference = plain.solve(&frame.stress).unwrap();
    for name in ["sensor1-f1-l40", "sensor1-f2-p30"] {
        let solution = Solver::new(&design(name)).unwrap().solve(&frame.stress).unwrap();
        let difference =
            (0..3).map(|axis| (solution.resultant[axis] - reference.resultant[axis]).abs()).fold(0.0, f64::max);
        assert!(difference > 1e-6 && difference < 0.6, "{name}: {difference}");
    }
}

fn small_solver() -> Solver {
    Solver::new(&design("small")).unwrap()
}

fn solve(solver: &Solver, frame: &[f64]) -> Solution {
    solver.solve(frame).unwrap()
}

#[test]
fn frames_without_an_answer_have_a_status() {
    let solver = small_solver();
    let floor = 100_000.0 / 65536.0;

    let zeros = solve(&solver, &[0.0; 12]);
    assert_eq!(zeros, Solution::zeros(Status::NO_CONTACT, 12));
    let faint = solve(&solver, &[-0.99 * floor; 12]);
    assert_eq!(faint, Solution::zeros(Status::NO_CONTACT, 12));

    let pressed = solve(&solver, &[-1.01 * floor; 12]);
    assert_eq!(pressed.status.0, Status::DIRECTION_UNKNOWN.0 | Status::NO_TENSION.0);
    assert_eq!((pressed.mu_x, pressed.mu_y), (0.0, 0.0));
    assert!(pressed.resultant[2] < 0.0);
    let pulled = solve(&solver, &[500.0; 12]);
    assert_eq!(pulled.status, Status::DIRECTION_UNKNOWN);

    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut frame = [-5000.0; 12];
        frame[7] = bad;
        assert_eq!(solve(&solver, &frame), Solution::zeros(Status::NOT_FINITE, 12));
    }

    let error = solver.solve(&[0.0; 11]).unwrap_err().to_string();
    assert!(error.contains("11") && error.contains("12"), "{error}");
}

#[test]
fn stress_at_full_scale_is_flagged_and_beyond_it_clamped() {
    let solver = small_solver();
    let mut frame = [-2000.0; 12];
    frame[0] = 3000.0;
    frame[5] = -99_999.9;
    assert!(!solve(&solver, &frame).status.contains(Status::SATURATED));
    frame[5] = -100_000.0;
    let full = solve(&solver, &frame);
    assert!(full.status.contains(Status::SATURATED));
    frame[5] = -4e9;
    assert_eq!(solve(&solver, &frame), full);
}

#[test]
fn the_line_is_where_the_tangential_force_has_the_direction() {
    let sums = [[1.0, 6.0, 0.2], [-0.5, 0.1, 5.0], [-6.0, 0.3, 0.4]];
    for direction in [[2.0, 1.0], [1.0, -2.0]] {
        let line = line::line(direction, &sums).unwrap();
        assert_eq!(line.independent, usize::from(direction[0] < 1.5));
        let mut mu = [0.0; 2];
        mu[line.independent] = 0.3;
        mu[1 - line.independent] = line.offset + line.slope * 0.3;
        let force = [0, 1].map(|p| sums[p][0] + mu[0] * sums[p][1] + mu[1] * sums[p][2]);
        let cross: f64 = force[0] * direction[1] - force[1] * direction[0];
        assert!(cross.abs() < 1e-12, "{cross}");
    }
    assert_eq!(line::line([0.0, 0.0], &sums), None);
    assert_eq!(line::line([1.0, 0.0], &[[0.0; 3]; 3]), None);
    // Offset 4.1: beyond the limit.
    let steep = [[0.0, 1.0, 0.0], [4.1, 0.0, -1.0], [0.0; 3]];
    assert_eq!(line::line([1.0, 0.0], &steep), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn a_mirrored_frame_has_mirrored_forces(
        frame in proptest::collection::vec(-90_000.0..20_000.0_f64, 12)
    ) {
        let solver = small_solver();
        let mirrored: Vec<f64> = (0..12).map(|i| frame[i / 4 * 4 + 3 - i % 4]).collect();
        let (one, other) = (solve(&solver, &frame), solve(&solver, &mirrored));
        prop_assert!(one.mu.is_finite() && one.phi.is_finite());
        // A line that is all but degenerate may be judged either way; both are then without a direction or neither is.
        prop_assume!(one.status == other.status);
        let scale = 1e-6 * (1.0 + one.resultant[2].abs());
        prop_assert!((one.resultant[0] + other.resultant[0]).abs() < scale, "{one:?} {other:?}");
        prop_assert!((one.resultant[1] - other.resultant[1]).abs() < scale);
        prop_assert!((one.resultant[2] - other.resultant[2]).abs() < scale);
        prop_assert!((one.mu_x + other.mu_x).abs() < 1e-6);
    }
}
