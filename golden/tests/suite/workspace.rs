//! Solving frame after frame and in batches: the same results as one at a time, and no memory asked for.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use golden::design::{Correction, Design, Estimator, Filter, JointConstants, MatrixFilter, Outputs, PlanKind, Slip};
use golden::estimators::line;
use golden::solver::{PIECE, Past, Slips, Solution, Solver, Status};
use nalgebra::DVector;

use crate::stages;

/// Counts what this thread asks for; the other topics' tests run on other threads.
struct Counting;

thread_local! {
    static REQUESTS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        REQUESTS.with(|requests| requests.set(requests.get() + 1));
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        REQUESTS.with(|requests| requests.set(requests.get() + 1));
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        REQUESTS.with(|requests| requests.set(requests.get() + 1));
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn design(columns: usize, rows: usize) -> Design {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"pad\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 3.0]\ndepth_mm = 3.0\n"
    );
    Design::from_toml(&text, "pad.toml").unwrap()
}

/// Frames of every kind: pushed contacts, none, too large, not finite, without tension.
fn frames(solver: &Solver) -> Vec<Vec<f64>> {
    let matrices = solver.matrices();
    let m = solver.taxels();
    let mut frames: Vec<Vec<f64>> = (0..140)
        .map(|number| {
            let place = 0.01 * f64::from(number);
            let press = DVector::from_fn(m, |i, _| 0.05 * (1.0 + (0.7 * i as f64 + place).sin()).powi(2));
            let (sine, cosine) = (3.0 * place).sin_cos();
            let pushed = &matrices.c31 * &press * (0.5 * cosine) + &matrices.c32 * &press * (0.5 * sine);
            (pushed - &matrices.c33 * &press).as_slice().to_vec()
        })
        .collect();
    frames[3].fill(0.0);
    frames[7].fill(-5e6);
    frames[8][1] = f64::NAN;
    frames[131].fill(-500.0);
    frames[132].fill(0.0);
    frames
}

fn assert_close(one: &Solution, other: &Solution) {
    assert_eq!(one.status, other.status);
    let scale = 1e-10 * one.field.iter().flatten().fold(1e-3_f64, |peak, force| peak.max(force.abs()));
    let taxels = one.field[0].len().max(1) as f64;
    assert!(
        one.resultant.iter().zip(other.resultant).all(|(a, b)| (a - b).abs() <= taxels * scale),
        "{one:?} {other:?}"
    );
    assert!((one.mu_x - other.mu_x).abs() < 1e-10 && (one.mu_y - other.mu_y).abs() < 1e-10);
    for (one, other) in one.field.iter().zip(&other.field) {
        assert_eq!(one.len(), other.len());
        assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() <= scale));
    }
}

/// Constants that nothing was fitted to.
fn constants() -> JointConstants {
    let hidden = vec![vec![700, -300, 500, 90, -40, 310, -820, 60, 75, 210, -190, 33, 480, 120]; 2];
    let output = [vec![400, -150], vec![90, 260]];
    let correction = Correction { half_window: [1, 1], hidden, output };
    JointConstants {
        gain: 1.25,
        friction_correction: [0.9, -0.1],
        correction: Some(correction),
        ..JointConstants::default()
    }
}

/// Both plans, with and without a field, with and without a filter, on even and odd sides; then the other estimator.
fn solvers() -> Vec<Solver> {
    let mut solvers = Vec::new();
    for (columns, rows) in [(6, 5), (4, 4)] {
        for (plan, outputs, filter) in [
            (PlanKind::Paper, Outputs::Field, Filter::None),
            (PlanKind::Paper, Outputs::Field, Filter::F2 { p: 0.1 }),
            (PlanKind::Reduced, Outputs::Field, Filter::None),
            (PlanKind::Reduced, Outputs::Resultants, Filter::None),
            (PlanKind::Reduced, Outputs::Field, Filter::F2 { p: 0.1 }),
            (PlanKind::Reduced, Outputs::Field, Filter::F2 { p: 0.0015 }),
        ] {
            let mut design = design(columns, rows);
            (design.algorithm.plan, design.algorithm.outputs, design.algorithm.filter) =
                (plan, outputs, filter.clone());
            solvers.push(Solver::new(&design).unwrap());
            if filter == Filter::None {
                design.algorithm.estimator = Estimator::Joint;
                *design.algorithm.joint = constants();
                solvers.push(Solver::new(&design).unwrap());
            }
        }
    }
    solvers
}

#[test]
fn one_workspace_does_for_all_frames() {
    for solver in solvers() {
        let frames = frames(&solver);
        let mut workspace = solver.workspace();
        let mut solution = Solution::zeros(Status::default(), 0);
        for frame in &frames {
            solver.solve_into(&mut workspace, frame, &mut solution).unwrap();
            assert_eq!(solution, solver.solve(frame).unwrap());
        }
        // A wrong frame leaves the solution as it was.
        let before = solution.clone();
        assert!(solver.solve_into(&mut workspace, &frames[0][1..], &mut solution).is_err());
        assert_eq!(solution, before);
    }
}

#[test]
fn a_workspace_of_another_solver_is_replaced() {
    let solvers = solvers();
    let frame = frames(&solvers[0]).swap_remove(0);
    let mut solution = Solution::zeros(Status::default(), 0);
    for other in &solvers {
        let mut workspace = other.workspace();
        solvers[0].solve_into(&mut workspace, &frame, &mut solution).unwrap();
        assert_eq!(solution, solvers[0].solve(&frame).unwrap());
    }
}

#[test]
fn batches_have_the_same_results() {
    for solver in solvers() {
        let frames = frames(&solver);
        let mut workspace = solver.workspace();
        let mut solutions = Vec::new();
        // More than a batch, then less, then none, with the same memory.
        for count in [140, 5, 0] {
            solver.solve_batch(&mut workspace, &frames[..count], &mut solutions).unwrap();
            assert_eq!(solutions.len(), count);
            for (frame, solution) in frames.iter().zip(&solutions) {
                assert_close(&solver.solve(frame).unwrap(), solution);
            }
        }
        let short = [frames[0].clone(), frames[1][1..].to_vec()];
        assert!(solver.solve_batch(&mut workspace, &short, &mut solutions).is_err());
    }
}

/// Memory of a batch holds the matrices that it was made with.
#[test]
fn a_workspace_serves_another_solver_of_the_same_sensor() {
    for plan in [PlanKind::Paper, PlanKind::Reduced] {
        let [plain, filtered] = [Filter::None, Filter::F2 { p: 0.1 }].map(|filter| {
            let mut design = design(6, 5);
            (design.algorithm.plan, design.algorithm.filter) = (plan, filter);
            Solver::new(&design).unwrap()
        });
        let frames = frames(&plain);
        let (mut workspace, mut solutions) = (plain.workspace(), Vec::new());
        for solver in [&plain, &filtered, &plain] {
            solver.solve_batch(&mut workspace, &frames[..5], &mut solutions).unwrap();
            for (frame, solution) in frames.iter().zip(&solutions) {
                assert_close(&solver.solve(frame).unwrap(), solution);
            }
        }
    }
}

#[test]
fn frames_ask_for_no_memory() {
    for solver in solvers() {
        let frames = frames(&solver);
        let mut workspace = solver.workspace();
        let mut solution = Solution::zeros(Status::default(), 0);
        let mut solve = || frames.iter().for_each(|f| solver.solve_into(&mut workspace, f, &mut solution).unwrap());
        solve();
        let before = REQUESTS.with(Cell::get);
        solve();
        assert_eq!(REQUESTS.with(Cell::get) - before, 0);
    }
    // The counter counts.
    let before = REQUESTS.with(Cell::get);
    assert!(std::hint::black_box(vec![0.0; 10]).len() == 10 && REQUESTS.with(Cell::get) == before + 1);
}

#[test]
fn the_papers_plan_is_its_stages() {
    let mut design = design(7, 5);
    design.algorithm.plan = PlanKind::Paper;
    design.algorithm.filter = Filter::F1 { l: 9 };
    assert_eq!(design.algorithm.filter.of(golden::matrices::MatrixName::A1), Some(MatrixFilter::F1 { l: 9 }));
    let solver = Solver::new(&design).unwrap();
    let positions: Vec<[f64; 2]> = (0..35).map(|taxel| design.sensor.position_m(taxel)).collect();
    let filtered = solver.filtered().unwrap();
    for frame in frames(&solver).iter().take(3) {
        let solution = solver.solve(frame).unwrap();
        let b = DVector::from_vec(frame.clone());
        let contact = golden::solver::cean::cean(&b, &positions, design.algorithm.noise_floor_pa);
        let coefficients = stages::co(&b, &stages::we(&b, filtered), filtered);
        let forces = stages::op(&contact, &coefficients, solver.matrices(), line::LEVEL);
        let [mu_x, mu_y] = forces.friction;
        assert!((mu_x - solution.mu_x).abs() < 1e-10 && (mu_y - solution.mu_y).abs() < 1e-10);
        for (p, component) in solution.field.iter().enumerate() {
            let error = (DVector::from_vec(component.clone()) - &forces.field[p]).amax();
            assert!(error < 1e-10 * forces.field[2].amax(), "{error:e}");
            assert!((forces.resultant[p] - solution.resultant[p]).abs() < 1e-9 * forces.resultant[2].abs());
        }
    }
}

#[test]
fn all_cores_give_what_one_gives() {
    let mut design = design(5, 4);
    let solver = Solver::new(&design).unwrap();
    // Twice and a bit what a core takes at a time.
    let frames: Vec<Vec<f64>> = frames(&solver).into_iter().cycle().take(2 * PIECE + 7).collect();
    let mut expected = Vec::new();
    solver.solve_batch(&mut solver.workspace(), &frames, &mut expected).unwrap();
    let most = expected.iter().map(|solution| solution.mu).fold(0.0, f64::max);
    design.algorithm.slip = Some(Slip { limit: 0.7 * most, hysteresis: 0.4 * most });
    let solver = Solver::new(&design).unwrap();
    solver.solve_batch(&mut solver.workspace(), &frames, &mut expected).unwrap();
    let slipping = expected.iter().filter(|solution| solution.status.contains(Status::SLIP)).count();
    assert!((1..frames.len()).contains(&slipping), "{slipping}");
    let mut found = vec![Solution::zeros(Status::default(), 0); frames.len()];
    let places = found.chunks_mut(PIECE);
    let mut past = Past::default();
    solver
        .solve_on_all_cores(&frames.concat(), &mut past, places, |place, index, found| {
            place[index].clone_from(found);
        })
        .unwrap();
    let mut slips = Slips::default();
    solver.follow_slips(
        &mut slips,
        found.iter_mut().map(|solution| {
            let mu = solution.mu;
            (&mut solution.status, mu, solution.records.as_mut_slice())
        }),
    );
    assert_eq!(found, expected);
    // A single one as if it had come alone.
    let mut alone = Solution::zeros(Status::default(), 0);
    solver.solve_on_all_cores(&frames[0], &mut past, [&mut alone], |place, _, found| place.clone_from(found)).unwrap();
    assert_eq!(alone, solver.solve(&frames[0]).unwrap());
    let said = solver.solve_on_all_cores(&[0.0; 21], &mut past, [()], |(), _, _| ()).unwrap_err().to_string();
    assert!(said.contains("the frame has 1 values, the sensor 20 taxels"), "{said}");
}
