//! The command, from files to a design that solves.

use std::fs;

use golden::design::Design;
use golden::frames::write_frames;
use golden::scene::Kind;
use tempfile::TempDir;

use crate::support::{PLAIN, only_progress, sptfra, text};
use simulated::{Indenter, Recipe, record, sensor as sensor_of_tests};

#[allow(dead_code, reason = "shared with the tests of the solver, which use all of it")]
#[path = "../../../golden/tests/suite/recorded/simulated.rs"]
mod simulated;

#[test]
fn from_recordings_to_a_design() {
    let folder = TempDir::new().unwrap();
    let file = |name: &str| folder.path().join(name);
    let [pad, frames, forces, out, page] =
        ["pad.toml", "press.npy", "weights.csv", "pad-calibrated.toml", "page.html"].map(file);
    let sensor = "[sensor]\ncolumns = 6\nrows = 13\npitch_mm = [3.4, 3.4]\ndepth_mm = 3.0\n";
    fs::write(&pad, format!("{PLAIN}name = \"pad\"\n{sensor}tension = \"clipped\"\npa_per_count = -1.0\n")).unwrap();
    let recipe = Recipe {
        power: 0.8,
        scale: 150.0,
        rest: 40.0,
        noise: 2.0,
        places: 10,
        frames: 2,
        ..Recipe::new(81, Indenter::Ball)
    };
    let recording = record(&recipe);
    write_frames(&frames, &recording.frames).unwrap();
    let lines: String =
        recording.measured.forces.iter().map(|force| format!("{}\n", -1000.0 * force[2].unwrap())).collect();
    fs::write(&forces, format!("F_z (mN)\n{lines}")).unwrap();
    let calibrate = |more: &[&str]| {
        sptfra(
            &[
                &["calibrate", text(&pad), "--frames", text(&frames), "--forces", text(&forces), "--out", text(&out)],
                more,
            ]
            .concat(),
        )
    };
    let output = calibrate(&["--page", text(&page)]);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(output.status.success() && only_progress(&output.stderr), "{output:?}");
    for part in [
        "pad_calibrated: calibrated design",
        "determined",
        "F_z: error",
        "not determined",
        "friction: no tangential",
        "next: sptfra solve",
    ] {
        assert!(said.contains(part), "no {part:?} in {said}");
    }
    let calibrated = Design::load(&out).unwrap();
    assert!(
        calibrated.name == "pad_calibrated"
            && calibrated.input.calibration.is_some()
            && calibrated.input.curve.is_some()
    );
    assert!(file("pad-calibrated.calibration.csv").exists() && file("pad-calibrated.curve.csv").exists());
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.starts_with("<!DOCTYPE html>") && html.matches("<svg").count() == 3 && html.ends_with("</html>\n"));
    // The command that it says runs as it stands.
    let next = said.lines().last().unwrap().strip_prefix("next: sptfra ").unwrap();
    let output = sptfra(&next.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{output:?}");
    // Again on its own result, to another name: nothing is left to find.
    let output = sptfra(&[
        "calibrate",
        text(&out),
        "--frames",
        text(&frames),
        "--forces",
        text(&forces),
        "--out",
        text(&file("again.toml")),
        "--json",
    ]);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["forces"]["errors"]["median"].as_f64().unwrap() < 4.0, "{report}");

    for (arguments, part) in [
        (vec!["calibrate", text(&pad), "--frames", text(&frames), "--out", text(&out)], "--forces"),
        (
            vec![
                "calibrate",
                text(&pad),
                "--frames",
                text(&frames),
                "--forces",
                text(&forces),
                "--out",
                text(&out),
                "--quick",
            ],
            "--quick",
        ),
        (
            vec!["calibrate", text(&pad), "--frames", text(&frames), "--forces", text(&forces), "--out", text(&pad)],
            "overwrite the input",
        ),
        (vec!["calibrate", text(&pad), "--page", text(&page), "--out", text(&out)], "for recordings"),
    ] {
        let output = sptfra(&arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.contains(part), "{said}");
    }
    let output = calibrate(&["--page", text(&frames)]);
    assert!(!output.status.success() && String::from_utf8(output.stderr).unwrap().contains("overwrite the input"));
}

/// With one press in each part of the logs, the errors alone tell of frames that are missing.
#[test]
fn frames_that_may_be_missing_are_told_of() {
    let folder = TempDir::new().unwrap();
    let [pad, frames, forces, out] =
        ["pad.toml", "press.csv", "weights.csv", "out.toml"].map(|name| folder.path().join(name));
    let sensor = "[sensor]\ncolumns = 6\nrows = 13\npitch_mm = [3.4, 3.4]\ndepth_mm = 3.0\n";
    fs::write(&pad, format!("{PLAIN}name = \"pad\"\n{sensor}tension = \"clipped\"\npa_per_count = -40.0\n")).unwrap();
    let recording = record(&Recipe {
        scale: 40.0,
        noise: 2.0,
        places: 4,
        loads: vec![2.0, 5.0],
        frames: 48,
        ..Recipe::new(81, Indenter::Disc)
    });
    let names = |with_times: bool| if with_times { "time (s)," } else { "" };
    let time = |with_times: bool, frame: usize| if with_times { format!("{frame},") } else { String::new() };
    let calibrate = |lost: std::ops::Range<usize>, with_times: bool, lines: usize| {
        let taxels: Vec<String> = (0..78).map(|taxel| format!("p{taxel}")).collect();
        let mut text_of = names(with_times).to_owned() + &taxels.join(",") + "\n";
        for (number, frame) in recording.frames.iter().enumerate().filter(|(number, _)| !lost.contains(number)) {
            let counts: Vec<String> = frame.iter().map(f64::to_string).collect();
            text_of += &(time(with_times, number) + &counts.join(",") + "\n");
        }
        fs::write(&frames, text_of).unwrap();
        let force = |(number, force): (usize, &[Option<f64>; 3])| {
            format!("{}{}\n", time(with_times, number), force[2].unwrap())
        };
        let lines: String = recording.measured.forces.iter().take(lines).enumerate().map(force).collect();
        fs::write(&forces, format!("{}F_z (N)\n{lines}", names(with_times))).unwrap();
        let paths = ["--frames", text(&frames), "--forces", text(&forces), "--out", text(&out)];
        sptfra(&[&["calibrate", text(&pad)], &paths[..]].concat())
    };
    let errors = ["press.csv: F_z errs by", "frames may be missing: give a column of times in both files"];
    let lag = [
        "or frames are missing: line 1 to frame 1 fits the loads nearly as well as",
        "give both files a column of times",
    ];
    let all = recording.frames.len();
    for (lost, lines, parts) in [(120..123, all, lag), (120..123, all - 3, errors)] {
        let refused = calibrate(lost.clone(), false, lines);
        let said = String::from_utf8(refused.stderr).unwrap();
        assert!(!refused.status.success() && parts.iter().all(|part| said.contains(part)), "{lost:?}: {said}");
    }
    assert!(!out.exists());
    assert!(calibrate(0..0, false, all).status.success(), "none are missing");
    let output = calibrate(120..123, true, all);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(output.status.success() && said.contains("paired by their times"), "{output:?}");
}

/// What other commands warn of, of the frames as the calibrated design reads them: sign and unit are what was fitted.
#[test]
fn frames_of_another_order_are_told_of() {
    let folder = TempDir::new().unwrap();
    let file = |name: &str| folder.path().join(name);
    let [pad, frames, forces, out] = ["pad.toml", "press.npy", "weights.csv", "out.toml"].map(file);
    let sensor = "[sensor]\ncolumns = 6\nrows = 13\npitch_mm = [3.4, 3.4]\ndepth_mm = 3.0\n";
    fs::write(&pad, format!("{PLAIN}name = \"pad\"\n{sensor}tension = \"clipped\"\npa_per_count = 1.0\n")).unwrap();
    let pressed = Kind::MixedInside.frames(&sensor_of_tests(), 0.5, 0..60).unwrap();
    let counts = |stress: &Vec<f64>| stress.iter().map(|pascals| (-pascals / 40.0).max(0.0).round()).collect();
    let mut recording: Vec<Vec<f64>> = pressed.iter().map(|frame| counts(&frame.stress)).collect();
    let mut lines: String = pressed.iter().map(|frame| format!("{}\n", frame.force[2])).collect();
    for _ in 0..10 {
        recording.push(vec![0.0; 78]);
        lines += "0\n";
    }
    fs::write(&forces, format!("F_z (N)\n{lines}")).unwrap();
    let calibrate = |of: &dyn Fn(&Vec<f64>) -> Vec<f64>| {
        write_frames(&frames, &recording.iter().map(of).collect::<Vec<_>>()).unwrap();
        let paths = ["--frames", text(&frames), "--forces", text(&forces), "--out", text(&out)];
        let output = sptfra(&[&["calibrate", text(&pad)], &paths[..]].concat());
        assert!(output.status.success(), "{output:?}");
        let [said, warned] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert!(said.contains("sign: pressing changes the readings the other way"), "{said}");
        warned
    };
    assert_eq!(calibrate(&Clone::clone), "");
    let transposed = |frame: &Vec<f64>| (0..78).map(|at| frame[(at % 13) * 6 + at / 13]).collect();
    let warned = calibrate(&transposed);
    assert!(warned.starts_with("warning: ") && warned.contains("column after column"), "{warned}");
    // One that is broken.
    let dead =
        |frame: &Vec<f64>| frame.iter().enumerate().map(|(taxel, &v)| if taxel == 38 { 0.0 } else { v }).collect();
    let warned = calibrate(&dead);
    assert!(warned.contains("38 (2, 6)"), "{warned}");
}

#[test]
fn comments_and_order_of_a_design_file_stay() {
    let folder = TempDir::new().unwrap();
    let [pad, out, again] = ["pad.toml", "out.toml", "again.toml"].map(|name| folder.path().join(name));
    let sensor = "# mine\n[sensor]\ncolumns = 4 # of them\nrows = 4\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    let algorithm = "\n[algorithm]\n# no filter\nfilter = { kind = \"none\" }\nestimator = \"joint\"\n";
    fs::write(&pad, format!("# a pad\nformat = 3\nname = \"pad\"\n{sensor}{algorithm}")).unwrap();
    let calibrate = |from, to| {
        let output = sptfra(&["calibrate", text(from), "--quick", "--out", text(to)]);
        assert!(output.status.success(), "{output:?}");
        fs::read_to_string(to).unwrap()
    };
    let resolved = calibrate(&pad, &out);
    let kept = ["# a pad\nformat = 3\nname = \"out\"\n", sensor, "# no filter\nfilter = { kind = \"none\" }\n"];
    assert!(kept.iter().all(|part| resolved.contains(part)), "{resolved}");
    assert!(resolved.contains("\n[algorithm.correction]\n"), "{resolved}");
    let resolved = calibrate(&out, &again);
    assert_eq!((resolved.matches("# Resolved by").count(), resolved.matches("# mine").count()), (1, 1), "{resolved}");
    assert_eq!(Design::load(&again).unwrap().algorithm.joint, Design::load(&out).unwrap().algorithm.joint);
}
