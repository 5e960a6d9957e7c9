//! The estimators on frames of finite elements, which share nothing with the model that they were fitted to.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use crate::designs::{ESTIMATORS, design, renew_table};
use golden::forces::read_outcomes;
use golden::frames::read_recording;
use golden::geometry;
use golden::metrics::{Outcome, Quantiles};
use golden::solver::{Solver, Status};

use crate::contact_kinds::share;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// A frame's case, the press in millimetres, and its true forces.
struct Frame {
    case: String,
    press_mm: f64,
    stress: Vec<f64>,
    truth: Outcome,
}

fn frames(sensor: &str) -> Vec<Frame> {
    let file = repository(&format!("data/fe/{sensor}.csv"));
    let stress = read_recording(&file, &design(&format!("{sensor}-fast")), 0).unwrap().frames;
    let truth = read_outcomes(&file.with_extension("forces.csv"), stress.len()).unwrap();
    let cases = fs::read_to_string(repository("data/fe/cases.csv")).unwrap();
    let cases: Vec<Vec<&str>> = cases
        .lines()
        .filter(|line| line.starts_with(&format!("{sensor}.csv,")))
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(cases.len(), stress.len(), "a line for each frame");
    let named = cases.iter().zip(stress).zip(truth);
    named
        .map(|((case, stress), truth)| Frame {
            case: case[2].to_owned(),
            press_mm: case[4].parse().unwrap(),
            stress,
            truth,
        })
        .collect()
}

/// Length of the error of the tangential force, and error of the normal one, in percent of the normal force.
fn errors(solver: &Solver, frame: &Frame) -> [f64; 2] {
    let found = solver.solve(&frame.stress).unwrap().resultant;
    let [x, y, z] = [0, 1, 2].map(|axis| 100.0 * (found[axis] - frame.truth.force[axis]) / -frame.truth.force[2]);
    [x.hypot(y), z.abs()]
}

#[test]
fn the_frames_are_what_they_say() {
    for sensor in ["sensor1", "sensor2"] {
        geometry::compare(
            &repository(&format!("data/fe/{sensor}.csv")),
            sensor,
            &design(&format!("{sensor}-fast")).sensor,
        )
        .unwrap();
        for frame in frames(sensor) {
            let Outcome { force: [x, y, z], friction, .. } = frame.truth;
            assert!(z < -0.1 && friction <= 0.505, "Coulomb's law with 0.5: {} {friction}", frame.case);
            // The base carries the force; the taxels see nearly all of it, averaged over most of their cells.
            let area = if sensor == "sensor1" { 8e-6 } else { 16e-6 };
            let seen: f64 = frame.stress.iter().sum::<f64>() * area;
            assert!((seen / z - 1.0).abs() < 0.06, "{}: {seen} N of {z} N", frame.case);
            // The moment of the tangential force moves the stress the way it pushes, about the middle of all frames.
            assert!(x.hypot(y) < -0.51 * z);
        }
    }
}

#[test]
fn errors_are_those_of_the_results() {
    for (name, limit) in
        [("sensor1-fast", 30.0), ("sensor2-fast", 18.0), ("sensor1-wide", 16.0), ("sensor2-wide", 13.6)]
    {
        let solver = Solver::new(&design(name)).unwrap();
        let mut worst = [0.0_f64; 2];
        for frame in frames(&name[..7]) {
            let [tangential, normal] = errors(&solver, &frame);
            worst = [worst[0].max(tangential), worst[1].max(normal)];
        }
        assert!(worst[0] < limit && worst[1] < 6.0, "{name} {worst:?}");
    }
    // Of all frames with a press that linear theory is about, of both sensors or of the first.
    let stated = fs::read_to_string(repository("results/finite-elements-summary.csv")).unwrap();
    let rows = summary();
    assert!(stated.ends_with(&rows), "rows of results/finite-elements-summary.csv:\n{rows}");
}

/// The rows of `results/finite-elements-summary.csv`.
fn summary() -> String {
    let kinds = [
        ("none", "line", true),
        ("fast", "sliding", true),
        ("wide", "general", true),
        ("fast", "sliding", false),
        ("wide", "general", false),
    ];
    let row = |(kind, name, both): (&str, &str, bool)| {
        let sensors: &[&str] = if both { &["sensor1", "sensor2"] } else { &["sensor1"] };
        let errors_of = |sensor: &&str| -> Vec<f64> {
            let solver = Solver::new(&design(&format!("{sensor}-{kind}"))).unwrap();
            let small = frames(sensor).into_iter().filter(|frame| !frame.case.ends_with("-soft"));
            small.map(|frame| errors(&solver, &frame)[0]).collect()
        };
        let all: Vec<f64> = sensors.iter().flat_map(errors_of).collect();
        assert_eq!(all.len(), if both { 48 } else { 30 });
        let (of, count) = (if both { "1 and 2" } else { "1" }, all.len());
        let Quantiles { median, most, worst } = Quantiles::of(all);
        let digits = |value: f64| if value < 9.95 { format!("{value:.1}") } else { format!("{value:.0}") };
        format!("{name},{of},{count},{}\n", [median, most, worst].map(digits).join(","))
    };
    kinds.map(row).concat()
}

/// Shares of frames in percent, presses of 4 % of the depth and others: those of low confidence, and those with an
/// error within two standard errors.
fn low_confidence(name: &str) -> [[f64; 2]; 2] {
    let solver = Solver::new(&design(name)).unwrap();
    let (small, large): (Vec<Frame>, Vec<Frame>) =
        frames(&name[..7]).into_iter().partition(|frame| !frame.case.ends_with("-soft"));
    [small, large].map(|frames| {
        let mut counts = [0.0; 2];
        for frame in &frames {
            let found = solver.solve(&frame.stress).unwrap();
            let [x, y] = [0, 1].map(|axis| found.resultant[axis] - frame.truth.force[axis]);
            let says = [found.status.contains(Status::LOW_CONFIDENCE), x.hypot(y) <= 2.0 * found.standard_error];
            counts.iter_mut().zip(says).for_each(|(count, says)| *count += f64::from(u8::from(says)));
        }
        counts.map(|count| 100.0 * count / frames.len() as f64)
    })
}

/// So many standard errors nine tenths of all frames' errors are within.
fn nine_tenths(name: &str) -> f64 {
    let solver = Solver::new(&design(name)).unwrap();
    let mut all: Vec<f64> = frames(&name[..7])
        .iter()
        .map(|frame| {
            let found = solver.solve(&frame.stress).unwrap();
            let [x, y] = [0, 1].map(|axis| found.resultant[axis] - frame.truth.force[axis]);
            x.hypot(y) / found.standard_error
        })
        .collect();
    all.sort_by(f64::total_cmp);
    share(&all, 0.9)
}

#[test]
#[ignore = "writes results/finite-elements.csv and its summary"]
fn table() {
    for name in ["sensor1-wide", "sensor2-wide"] {
        let [small, large] = low_confidence(name);
        println!(
            "{name}: low confidence, within two standard errors, %: {small:.0?}; with the large press {large:.0?}"
        );
        println!("{name}: 90 % are within {:.1} standard errors", nine_tenths(name));
    }
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        let frames = frames(sensor);
        let estimators = [("none", "line"), ("fast", "sliding"), ("wide", "general")];
        let solvers = estimators.map(|(kind, name)| (name, Solver::new(&design(&format!("{sensor}-{kind}"))).unwrap()));
        for group in frames.chunk_by(|a, b| a.case == b.case) {
            let (Frame { case, press_mm, .. }, load) = (&group[0], -group[0].truth.force[2]);
            for (estimator, solver) in &solvers {
                let found: Vec<[f64; 2]> = group.iter().map(|frame| errors(solver, frame)).collect();
                let normal = found.iter().fold(0.0_f64, |worst, found| worst.max(found[1]));
                for (frame, [tangential, _]) in group.iter().zip(found) {
                    let (sensor, friction) = (&sensor[6..], frame.truth.friction);
                    // Writing to a String cannot fail.
                    let _ = writeln!(
                        rows,
                        "{sensor},{case},{press_mm},{load:.1},{friction:.2},{estimator},{tangential:.1},{normal:.1}"
                    );
                }
            }
        }
    }
    let columns = "sensor,case,press_mm,load_n,true_mu,estimator,tangential,normal_worst";
    renew_table("finite-elements.csv", &ESTIMATORS, columns, &rows);
    let columns = "designs,sensors,frames,median,p95,worst";
    renew_table("finite-elements-summary.csv", &ESTIMATORS, columns, &summary());
}
