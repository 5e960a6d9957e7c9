//! The line search on a bonded layer, as RTL, by both plans and with filter F3 (in `make test`, by the reduced plan): its
//! errors are those of the f64 solver.

use std::fmt::Write as _;
use std::io::Write as _;

use crate::support::effort::some_of;
use crate::support::frames::encode;
use crate::support::{built, in_parallel, planned, shipped, simulate_exactly, workspace};
use golden::metrics::{ERROR_NAMES, ErrorSummary, Outcome};
use golden::scene::Scene;
use golden::solver::{Solution, Solver};
use testbench::accuracy::against_truth;
use testbench::stream_words::{as_received, decode};

/// Percentage points between an error of the RTL and that of f64.
const MOST_DIFFERENCE: f64 = 0.1;
const FRICTIONS: [f64; 3] = [0.5, 0.2, 0.8];

/// The stresses and true outcomes of a shipped scene, pushed with a friction coefficient in 36 directions.
fn pushed(scene: &str, friction: f64) -> (Vec<Vec<f64>>, Vec<Outcome>) {
    let mut scene = Scene::load(&workspace(&format!("scenes/{scene}.toml"))).expect("a good scene");
    for contact in &mut scene.contacts {
        contact.friction = friction;
    }
    let frames = scene.frames().expect("frames");
    assert_eq!(frames.len(), 36);
    let truth = frames.iter().map(Outcome::from).collect();
    (frames.into_iter().map(|frame| frame.stress).collect(), truth)
}

/// Errors by f64 and by the RTL for each friction coefficient.
fn errors(design: &str, scene: &str) -> Vec<[ErrorSummary; 2]> {
    let design = shipped(design);
    let solver = Solver::new(&design).expect("a solver");
    let scenes = FRICTIONS.map(|friction| pushed(scene, friction));
    let packets: Vec<Vec<u32>> = scenes.iter().flat_map(|(stress, _)| stress).map(|stress| encode(stress)).collect();
    let plan = planned(&design);
    let simulation =
        simulate_exactly(&plan, &built(&plan), &packets, 5).unwrap_or_else(|error| panic!("{}: {error}", design.name));
    let answers: Vec<Solution> = simulation.answers.iter().map(|words| decode(words).expect("a whole frame")).collect();
    let mut first = 0;
    let of = |(stress, truth): &(Vec<Vec<f64>>, Vec<Outcome>)| {
        let frames = first..first + stress.len();
        first = frames.end;
        let solved = packets[frames.clone()]
            .iter()
            .map(|packet| solver.solve(&as_received(plan.streams(), packet)).expect("a frame of the right length"))
            .map(|solution| Outcome::from(&solution));
        let pairs: Vec<(Outcome, Outcome)> = truth.iter().copied().zip(solved).collect();
        [ErrorSummary::new(&pairs), against_truth(&answers[frames], truth)]
    };
    scenes.iter().map(of).collect()
}

#[test]
fn the_rtl_has_the_errors_of_the_f64_solver_on_the_layer() {
    let subjects = some_of([
        ("sensor1-reduced", "sensor1-hertz"),
        ("sensor1-none", "sensor1-hertz"),
        ("sensor1-f3", "sensor1-hertz"),
        ("sensor2-none", "sensor2-disc"),
        ("sensor2-f3", "sensor2-disc"),
        ("sensor2-reduced", "sensor2-disc"),
    ]);
    let tables = in_parallel(&subjects, |(design, scene)| {
        let mut table = String::new();
        for (friction, [solver, rtl]) in FRICTIONS.into_iter().zip(errors(design, scene)) {
            for (name, summary) in [("f64", &solver), ("RTL", &rtl)] {
                let cells: String = summary.spreads().iter().map(|spread| format!("{:>8.2}", spread.max)).collect();
                // Writing to a String cannot fail.
                let _ = writeln!(table, "{design:<18} µ = {friction} {name:>5}{cells}");
            }
            for ((name, one), other) in ERROR_NAMES.into_iter().zip(solver.spreads()).zip(rtl.spreads()) {
                for (one, other) in [(one.max, other.max), (one.standard_error, other.standard_error)] {
                    assert!((one - other).abs() <= MOST_DIFFERENCE, "{design}, µ = {friction}, {name}: {one} {other}");
                }
            }
        }
        table
    });
    let names: String = ERROR_NAMES.iter().map(|name| format!("{name:>8}")).collect();
    let table = format!("\n{:<32}{names}\n{}\n", "largest error, %", tables.concat());
    std::io::stdout().write_all(table.as_bytes()).expect("standard output is open");
}
