//! The estimators on frames of finite elements, which share nothing with the model that they were fitted to.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use golden::forces::read_outcomes;
use golden::frames::read_recording;
use golden::metrics::{Outcome, Quantiles};
use golden::solver::{Solver, SolverError};

use super::{Fallible, Rows, design, estimators};

/// The columns of [`rows`].
pub const COLUMNS: &str = "sensor,case,press_mm,load_n,true_mu,estimator,tangential,normal_worst";
/// The columns of [`summary_rows`].
pub const SUMMARY_COLUMNS: &str = "designs,sensors,frames,median,p95,worst";

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

fn frames(sensor: &str) -> Fallible<Vec<Frame>> {
    let file = repository(&format!("data/fe/{sensor}.csv"));
    let stress = read_recording(&file, &design(&format!("{sensor}-fast")), 0)?.frames;
    let truth = read_outcomes(&file.with_extension("forces.csv"), stress.len())?;
    let cases = fs::read_to_string(repository("data/fe/cases.csv"))?;
    let cases: Vec<Vec<&str>> = cases
        .lines()
        .filter(|line| line.starts_with(&format!("{sensor}.csv,")))
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(cases.len(), stress.len(), "a line for each frame");
    let named = cases.iter().zip(stress).zip(truth);
    named
        .map(|((case, stress), truth)| {
            Ok(Frame { case: case[2].to_owned(), press_mm: case[4].parse()?, stress, truth })
        })
        .collect()
}

/// Length of the error of the tangential force, and error of the normal one, in percent of the normal force.
fn errors(solver: &Solver, frame: &Frame) -> Result<[f64; 2], SolverError> {
    let found = solver.solve(&frame.stress)?.resultant;
    let [x, y, z] = [0, 1, 2].map(|axis| 100.0 * (found[axis] - frame.truth.force[axis]) / -frame.truth.force[2]);
    Ok([x.hypot(y), z.abs()])
}

/// The table, by case.
pub fn rows() -> Rows {
    let mut rows = String::new();
    for sensor in ["sensor1", "sensor2"] {
        let (frames, solvers) = (frames(sensor)?, estimators(sensor)?);
        for group in frames.chunk_by(|a, b| a.case == b.case) {
            let (Frame { case, press_mm, .. }, load) = (&group[0], -group[0].truth.force[2]);
            for (estimator, solver) in &solvers {
                let found: Vec<[f64; 2]> = group.iter().map(|frame| errors(solver, frame)).collect::<Result<_, _>>()?;
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
    Ok(rows)
}

/// The table of all frames with a press that linear theory is about, of both sensors or of the first.
pub fn summary_rows() -> Rows {
    let kinds = [
        ("none", "line", true),
        ("fast", "sliding", true),
        ("wide", "general", true),
        ("fast", "sliding", false),
        ("wide", "general", false),
    ];
    let mut rows = String::new();
    for (kind, name, both) in kinds {
        let sensors: &[&str] = if both { &["sensor1", "sensor2"] } else { &["sensor1"] };
        let mut all = Vec::new();
        for sensor in sensors {
            let solver = Solver::new(&design(&format!("{sensor}-{kind}")))?;
            for frame in frames(sensor)?.iter().filter(|frame| !frame.case.ends_with("-soft")) {
                all.push(errors(&solver, frame)?[0]);
            }
        }
        let (of, count) = (if both { "1 and 2" } else { "1" }, all.len());
        let Quantiles { median, most, worst } = Quantiles::of(all);
        let digits = |value: f64| if value < 9.95 { format!("{value:.1}") } else { format!("{value:.0}") };
        // Writing to a String cannot fail.
        let _ = writeln!(rows, "{name},{of},{count},{}", [median, most, worst].map(digits).join(","));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use golden::geometry;

    use super::*;

    #[test]
    fn the_frames_are_what_they_say() {
        for sensor in ["sensor1", "sensor2"] {
            geometry::compare(
                &repository(&format!("data/fe/{sensor}.csv")),
                sensor,
                &design(&format!("{sensor}-fast")).sensor,
            )
            .expect("the geometry of the design");
            for frame in frames(sensor).expect("frames") {
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
            let solver = Solver::new(&design(name)).expect("matrices");
            let mut worst = [0.0_f64; 2];
            for frame in frames(&name[..7]).expect("frames") {
                let [tangential, normal] = errors(&solver, &frame).expect("forces");
                worst = [worst[0].max(tangential), worst[1].max(normal)];
            }
            assert!(worst[0] < limit && worst[1] < 6.0, "{name} {worst:?}");
        }
        let stated = fs::read_to_string(repository("results/finite-elements-summary.csv")).expect("a table");
        let rows = summary_rows().expect("rows");
        assert!(rows.contains("sliding,1 and 2,48,") && rows.contains("sliding,1,30,"), "{rows}");
        assert!(stated.ends_with(&rows), "rows of results/finite-elements-summary.csv:\n{rows}");
    }
}
