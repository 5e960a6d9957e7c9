//! Corner cases: nothing wrong in silence, and the RTL on the same frames.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

use golden::design::Estimator;
use golden::progress::Progress;
use xtask::corner_cases::cases::{self, Case};
use xtask::corner_cases::judge::{Judged, Row};
use xtask::corner_cases::{Scope, rtl, table, unsound};

use crate::support::effort::{share_of, some_of};
use crate::support::workspace;

/// Seconds for all cases; nobody changes them.
fn rows() -> &'static [Row] {
    static ROWS: LazyLock<Vec<Row>> =
        LazyLock::new(|| table(Scope { large: false, rtl: false }, &Progress::hidden()).expect("a table"));
    &ROWS
}

fn row<'a>(rows: &'a [Row], case: &str) -> &'a Row {
    rows.iter().find(|row| row.case == case).unwrap_or_else(|| panic!("{case}"))
}

#[test]
fn no_answer_is_wrong_in_silence() {
    let rows = rows();
    assert!(unsound(rows).is_empty());
    for row in rows {
        assert!(row.condition_c33.is_some_and(f64::is_finite), "{row:?}");
        let Some(fixed) = &row.fixed else {
            let why = row.refusal.as_ref().expect("a reason");
            assert!(why.contains("regularisation") && why.contains("condition number"), "{why}");
            continue;
        };
        let f64 = row.f64.as_ref().expect("solved");
        if row.estimator == Estimator::Joint {
            check_joint(row, f64, fixed);
            continue;
        }
        let f32 = row.f32.as_ref().expect("solved");
        // Where two pushes cancel, the direction is that of rounding, and f64 has more of it.
        if row.case != "two contacts, opposed pushes" {
            assert_eq!(fixed.status, f64.status, "{}", row.case);
        }
        // Where the conditioning is that of a sensible sensor, all three arithmetics have the estimator's error.
        for (reference, others) in
            [(f64.tangential, [f32.tangential, fixed.tangential]), (f64.normal, [f32.normal, fixed.normal])]
        {
            for other in others {
                let (Some(reference), Some(other)) = (reference, other) else { continue };
                assert!((reference - other).abs() < 0.5, "{}: {reference} {other}", row.case);
            }
        }
        for (judged, bound) in [(f64, 1e-12), (f32, 1e-4), (fixed, 1e-2)] {
            assert!(judged.backward.is_none_or(|error| error < bound), "{row:?}");
        }
    }
}

/// Matrices are those of the line search; there is no float32.
fn check_joint(row: &Row, f64: &Judged, fixed: &Judged) {
    assert!(row.f32.is_none());
    if row.case == "no tension" {
        // One pressed taxel: a normalised u is clipped in the search, which bit 3 says. f64 has no such limit.
        let said: Vec<_> = fixed.status.iter().map(|(name, count)| (name.as_str(), *count)).collect();
        assert_eq!(said, [("direction unknown", 1), ("saturated", 1), ("no tension", 1)]);
    } else {
        assert_eq!(fixed.status, f64.status, "{}", row.case);
    }
    for (reference, found) in [(f64.tangential, fixed.tangential), (f64.normal, fixed.normal)] {
        let difference = reference.zip(found).map_or(0.0, |(reference, found)| (reference - found).abs());
        assert!(difference < 0.5, "{}: {difference}", row.case);
    }
    // With its gain A f is not b; so much the hardware says too.
    let difference = f64.backward.zip(fixed.backward).map_or(0.0, |(reference, found)| (reference - found).abs());
    assert!(difference < 1e-2, "{row:?}");
}

/// How many times float32's error words of 27 x 35 bits have at most: of `A f = b`, and of a taxel's force where the
/// friction is the same. Of a deep layer's worst frame no contact is more than a small part, and its numbers keep few bits
/// of a fixed step; a stress has 27 bits of the full scale however faint the frame is; where rows are regular float32 errs
/// least.
fn beyond_float32(case: &str) -> [f64; 2] {
    let regularised = case.ends_with("regularised") || case.contains("regularisation");
    let depth = case.strip_prefix("h/s = ").and_then(|ratio| ratio.split(',').next()?.parse().ok()).unwrap_or(0.0);
    match case {
        _ if depth >= 3.0 && !regularised => [5.0, 200.0],
        _ if depth >= 3.0 => [1.6, 5.0],
        _ if depth >= 1.5 => [3.0, 6.0],
        _ if case.starts_with("peak at 100 noise floors") => [40.0, 130.0],
        "needle between four taxels" | "µ = 0" => [1.0, 1.7],
        // What stands in for dead taxels is of 18-bit weights, whatever the words behind them.
        _ if case.ends_with(", named") => [110.0, 200.0],
        _ if case == "µ = 0.2" || push_is_regular(case) => [1.4, 1.3],
        _ => [1.0, 1.05],
    }
}

fn push_is_regular(case: &str) -> bool {
    case == "on the axes"
        || case == "on the diagonals"
        || case.starts_with("0.000000001°")
        || case.starts_with("0.001°")
}

/// An error that a case has.
type Figure = fn(&Judged) -> Option<f64>;

#[test]
fn wide_words_err_no_more_than_float32() {
    let mut judged = 0;
    for row in rows().iter().filter(|row| row.estimator == Estimator::Line) {
        let figures: [(&str, Figure); 2] =
            [("A f = b", |judged| judged.backward), ("at its friction", |judged| judged.at_its_friction)];
        for ((what, value), most) in figures.into_iter().zip(beyond_float32(&row.case)) {
            let of = |judged: &Option<Judged>| judged.as_ref().and_then(value);
            let Some((float32, wide)) = of(&row.f32).zip(of(&row.wide)) else { continue };
            assert!(wide <= most * float32, "{}, {what}: {wide:.2e}, float32 {float32:.2e}", row.case);
            // Where 18 x 27 bits have hardware they err more; scaled frames, whose stress has no more bits, by less, and
            // so those that 18-bit weights made.
            let gain = match () {
                () if row.case.ends_with(", named") => 1.3,
                () if row.case.contains("noise floors") => 2.0,
                () => 10.0,
            };
            assert!(of(&row.fixed).is_none_or(|fixed| wide < fixed / gain), "{}, {what}: {wide:.2e}", row.case);
            judged += usize::from(most <= 1.0);
        }
    }
    assert!(judged >= 40, "{judged} cases are no worse than float32");
}

#[test]
fn a_single_silent_frame_is_not_sound() {
    let mut rows = rows().to_vec();
    assert!(rows.iter().all(|row| row.rtl_is_model.is_none()), "none was asked");
    rows[0].rtl_is_model = Some(false);
    assert_eq!(unsound(&rows).len(), 1);
    rows[0].rtl_is_model = Some(true);
    assert!(unsound(&rows).is_empty());
    rows[0].fixed.as_mut().expect("hardware").silent = 1;
    assert_eq!(unsound(&rows).len(), 1);
}

#[test]
fn statuses_say_what_a_frame_is() {
    let rows = rows();
    for (case, status) in [
        ("no contact", "no contact"),
        ("no tension", "direction unknown"),
        ("one taxel", "direction unknown"),
        ("NaN and infinities", "NaN or infinity"),
        ("peak at one step", "no contact"),
        ("peak at twice the full scale", "saturated"),
        ("a taxel beyond the full scale", "saturated"),
        ("h/s = 0.5", "low confidence"),
    ] {
        let row = row(rows, case);
        for judged in [&row.f64, &row.f32, &row.fixed] {
            let judged = judged.as_ref().expect("answered");
            let count = judged.status.iter().find(|(name, _)| name == status).map(|&(_, count)| count);
            assert_eq!(count, Some(row.frames), "{case}: {judged:?}");
        }
    }
}

/// What a frame's own range is for, by both estimators: 100 noise floors are as good as the full scale.
#[test]
fn a_range_of_its_own_keeps_faint_frames_exact() {
    let rows = rows();
    let own = |case: &str| format!("{case}, scaling = \"per_frame\"");
    let [faint, strong] = ["peak at 100 noise floors", "peak at the full scale"];
    for estimator in [Estimator::Line, Estimator::Joint] {
        let error = |case: &str| {
            let row = rows.iter().find(|row| row.case == case && row.estimator == estimator);
            row.and_then(|row| row.fixed.as_ref()?.against_f64).unwrap_or_else(|| panic!("{case}"))
        };
        assert!(error(faint) > 30.0 * error(strong), "{estimator:?}");
        assert!(error(&own(faint)) < 2.0 * error(strong), "{estimator:?}: {}", error(&own(faint)));
        assert_eq!(error(&own(strong)).to_bits(), error(strong).to_bits(), "{estimator:?}");
    }
}

#[test]
fn regularisation_keeps_deep_sensors_and_leaves_shallow_ones() {
    let rows = rows();
    let tangential = |case: &str| row(rows, case).f64.as_ref().and_then(|judged| judged.tangential);
    assert!(row(rows, "h/s = 4, noise 0.2 %").refusal.as_ref().expect("refused").contains("regularisation"));
    assert!(tangential("h/s = 4, noise 0.2 %, regularised").is_some_and(|error| error < 15.0));
    assert!(tangential("h/s = 3, noise 0.2 %") > Some(30.0));
    assert!(tangential("h/s = 3, noise 0.2 %, regularised").is_some_and(|error| error < 6.0));
    for ratio in ["0.5", "0.75", "1"] {
        let [plain, regularised] = ["", ", regularised"].map(|what| tangential(&format!("h/s = {ratio}{what}")));
        let difference = plain.expect("an error") - regularised.expect("an error");
        assert!(difference.abs() < 0.5, "{ratio}: {difference}");
    }
}

/// All cases go through the RTL in `make corner-cases`; here three frames of those of five designs.
#[test]
fn the_rtl_answers_hard_frames_as_the_model_does() {
    let line = cases::all(false).expect("cases");
    let joint = cases::by_joint(&line).expect("cases");
    let design = |cases: &[Case], name: &str| {
        cases.iter().find(|case| case.name == name).unwrap_or_else(|| panic!("{name}")).design.clone()
    };
    let own_range = "peak at 100 noise floors, scaling = \"per_frame\"";
    let wanted = some_of([
        design(&line, "no contact"),
        design(&joint, "no contact"),
        design(&line, "h/s = 4, regularised"),
        design(&line, own_range),
        design(&joint, own_range),
    ]);
    let mut cases: Vec<Case> = line.into_iter().chain(joint).filter(|case| wanted.contains(&case.design)).collect();
    for case in &mut cases {
        case.frames.truncate(3);
    }
    assert!(wanted.iter().all(|design| cases.iter().any(|case| case.design == *design)) && cases.len() > share_of(60));
    let exact = rtl::check(&cases, &Progress::hidden()).expect("simulated");
    for (case, exact) in cases.iter().zip(exact) {
        assert_eq!(exact, Some(true), "{}, {:?}", case.name, case.design.algorithm.estimator);
    }
}

/// What `--quick` leaves out apart, the rows of the results are those of today.
#[test]
fn the_rows_of_the_results_are_those_of_today() {
    let output = Command::new(env!("CARGO_BIN_EXE_xtask")).args(["corner-cases", "--quick"]).output().expect("starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let folder = tempfile::tempdir().expect("a folder");
    let json = folder.path().join("rows.json");
    fs::write(&json, &output.stdout).expect("written");
    let mut results = Command::new("python3");
    results.arg(workspace("tools/results.py")).arg("corner-cases").arg(&json).arg("--out").arg(folder.path());
    assert!(results.status().expect("starts").success());
    let read = |file: &Path| -> Vec<Vec<String>> {
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(file).expect("a table");
        reader.records().map(|row| row.expect("a row").iter().map(str::to_owned).collect()).collect()
    };
    let committed = read(&workspace("results/corner-cases.csv"));
    let today = read(&folder.path().join("corner-cases.csv"));
    assert!(today.len() > 150, "{}", today.len());
    for mut row in today {
        let simulated = row.len() - 2;
        assert_eq!(row[simulated], "", "--quick simulates nothing");
        let case = committed.iter().find(|case| case[..3] == row[..3]);
        let case = case.unwrap_or_else(|| panic!("{:?} is no row of the results: run `make corner-cases`", &row[..3]));
        row[simulated].clone_from(&case[simulated]);
        assert_eq!(row, *case, "run `make corner-cases`");
    }
}
