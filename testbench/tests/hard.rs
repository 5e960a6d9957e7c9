//! Hard cases: nothing wrong in silence, and the RTL on the same frames.

mod support;

use std::process::Command;

use golden::design::Design;
use serde_json::Value;
use testbench::hard::cases::{self, Case};
use testbench::hard::judge::Row;
use testbench::hard::{is_sound, table};
use testbench::progress::Progress;
use testbench::words::encode;

fn rows() -> Vec<Row> {
    table(false, &Progress::hidden()).expect("a table")
}

fn row<'a>(rows: &'a [Row], case: &str) -> &'a Row {
    rows.iter().find(|row| row.case == case).unwrap_or_else(|| panic!("{case}"))
}

#[test]
fn no_answer_is_wrong_in_silence() {
    let rows = rows();
    assert!(is_sound(&rows));
    for row in &rows {
        assert!(row.condition_c33.is_some_and(f64::is_finite), "{row:?}");
        let Some(fixed) = &row.fixed else {
            let why = row.refusal.as_ref().expect("a reason");
            assert!(why.contains("regularisation") && why.contains("condition number"), "{why}");
            continue;
        };
        let [f64, f32] = [&row.f64, &row.f32].map(|judged| judged.as_ref().expect("solved"));
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

#[test]
fn a_single_silent_frame_is_not_sound() {
    let mut rows = rows();
    rows[0].fixed.as_mut().expect("hardware").silent = 1;
    assert!(!is_sound(&rows));
}

#[test]
fn statuses_say_what_a_frame_is() {
    let rows = rows();
    for (case, status) in [
        ("no contact", "no contact"),
        ("no tension", "direction unknown"),
        ("one taxel", "direction unknown"),
        ("NaN and infinities", "NaN or infinity in"),
        ("peak at one step", "no contact"),
        ("peak at twice the full scale", "saturated"),
        ("a taxel beyond the full scale", "saturated"),
    ] {
        let row = row(&rows, case);
        for judged in [&row.f64, &row.f32, &row.fixed] {
            let judged = judged.as_ref().expect("answered");
            let count = judged.status.iter().find(|(name, _)| name == status).map(|&(_, count)| count);
            assert_eq!(count, Some(row.frames), "{case}: {judged:?}");
        }
    }
}

#[test]
fn regularisation_keeps_deep_sensors_and_leaves_shallow_ones() {
    let rows = rows();
    let tangential = |case: &str| row(&rows, case).f64.as_ref().and_then(|judged| judged.tangential);
    assert!(row(&rows, "h/s = 4, noise 0.2 %").refusal.as_ref().expect("refused").contains("regularisation"));
    assert!(tangential("h/s = 4, noise 0.2 %, regularised").is_some_and(|error| error < 15.0));
    assert!(tangential("h/s = 3, noise 0.2 %") > Some(30.0));
    assert!(tangential("h/s = 3, noise 0.2 %, regularised").is_some_and(|error| error < 6.0));
    for ratio in ["0.5", "0.75", "1"] {
        let [plain, regularised] = ["", ", regularised"].map(|what| tangential(&format!("h/s = {ratio}{what}")));
        let difference = plain.expect("an error") - regularised.expect("an error");
        assert!(difference.abs() < 0.5, "{ratio}: {difference}");
    }
}

/// One frame of each case of a design.
fn packets(cases: &[Case], design: &Design) -> Vec<Vec<u32>> {
    let own = cases.iter().filter(|case| case.design == *design);
    own.flat_map(|case| case.frames.iter().take(3)).map(|frame| encode(frame)).collect()
}

#[test]
fn the_rtl_answers_hard_frames_as_the_model_does() {
    let cases = cases::all(false).expect("cases");
    for (case, fewest) in [("no contact", 60), ("h/s = 3, regularised", 3)] {
        let design = &cases.iter().find(|other| other.name == case).expect("a case").design;
        let packets = packets(&cases, design);
        assert!(packets.len() >= fewest, "{case}: {}", packets.len());
        let plan = support::planned(design);
        support::simulate_exactly(&plan, &support::built(&plan), &packets, 3)
            .unwrap_or_else(|error| panic!("{case}: {error}"));
    }
}

#[test]
fn the_command_prints_a_table_and_writes_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("hard.md");
    let run = |more: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_testbench"))
            .args(["hard", "--quick"])
            .args(more)
            .output()
            .expect("starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    let json: Vec<Value> = serde_json::from_str(&run(&["--json"])).expect("JSON");
    let text = run(&["--page", &page.display().to_string()]);
    assert!(text.split_whitespace().all(|word| word != "inf"), "{text}");
    let written = std::fs::read_to_string(&page).expect("written");
    for row in &json {
        let case = row["case"].as_str().expect("a name");
        assert!(text.contains(case) && written.contains(case), "{case}");
        assert_eq!(row["f64"].as_object().map_or(0, |judged| judged["silent"].as_u64().expect("a count") as usize), 0);
    }
    assert!(written.contains("## Depth over pitch") && written.contains("| h/s = 4 |"));
}
