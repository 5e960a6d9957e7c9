//! Forces from frames: files, right and wrong.

mod files;
mod filter;
mod fitting;

use std::fs;
use std::path::{Path, PathBuf};

use golden::design::Design;
use golden::frames::{read_recording, write_frames};
use tempfile::TempDir;

use crate::support::{PLAIN, sptfra, text, workspace};

/// A folder with a frame file for the small design.
fn folder_with(frames: &str) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("frames.csv");
    fs::write(&path, frames).unwrap();
    (folder, path)
}

/// So many taxels in a row.
fn line_of(columns: usize) -> Design {
    let mut design = Design::load(&workspace("golden/tests/designs/small.toml")).unwrap();
    (design.sensor.columns, design.sensor.rows) = (columns, 1);
    design
}

/// The first line of every force file.
const HEADER: &str =
    "status,F_x (N),F_y (N),F_z (N),mu,phi (rad),mu_x,mu_y,T_x (N m),T_y (N m),T_z (N m),standard_error (N),contacts";

fn row(value: &str) -> String {
    [value; 12].join(",")
}

#[test]
fn a_layer_that_is_too_thin_is_told_of() {
    let (folder, frames) = folder_with(&row("-1000.5"));
    let [design, forces] = ["thin.toml", "out.csv"].map(|name| folder.path().join(name));
    for (depth, told) in [("1.2", true), ("3.0", false)] {
        let sensor = format!("[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = {depth}\n");
        fs::write(&design, format!("{PLAIN}name = \"thin\"\n{sensor}")).unwrap();
        let output = sptfra(&["solve", text(&design), "--frames", text(&frames), "--out", text(&forces)]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(said.contains("warning: the layer is 0.30 of a pitch thin"), told, "{said}");
    }
}

#[test]
fn scene_then_solve() {
    let folder = TempDir::new().unwrap();
    let [frames, forces] = ["f.csv", "out.csv"].map(|name| folder.path().join(name));
    let reference = folder.path().join("f.forces.csv");
    let scene = workspace("scenes/sensor1-hertz.toml");
    let output = sptfra(&["scene", text(&scene), "--out", text(&frames)]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("36 frames") && said.contains("f.forces.csv"), "{said}");

    let design = workspace("designs/paper.toml");
    let output = sptfra(&[
        "solve",
        text(&design),
        "--frames",
        text(&frames),
        "--out",
        text(&forces),
        "--reference",
        text(&reference),
        "--field",
        "--json",
    ]);
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "progress belongs on a terminal");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["frames"], 36);
    // The design's standard error is above a tenth of F_z at any load, and says so.
    assert_eq!(report["status_counts"][0]["status"], 64);
    let error = report["errors"]["e_fz"]["max"].as_f64().unwrap();
    assert!((error - 10.8).abs() < 0.05, "{error}");

    let lines = fs::read_to_string(&forces).unwrap();
    assert_eq!(lines.lines().count(), 1 + 36);
    assert!(lines.starts_with(&format!("{HEADER},taxel0_f_x (N),taxel0_f_y (N),taxel0_f_z (N),taxel1_f_x (N),")));
    for line in lines.lines().skip(1) {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        assert_eq!(values.len(), 13 + 300);
        let mut torque = [0.0; 3];
        for axis in 0..3 {
            let sum: f64 = values[13..].iter().skip(axis).step_by(3).sum();
            assert!((sum - values[1 + axis]).abs() < 1e-9);
        }
        for (taxel, force) in values[13..].as_chunks::<3>().0.iter().enumerate() {
            let (x, y) = (0.004 * (taxel % 10) as f64 - 0.018, 0.002 * (taxel / 10) as f64 - 0.009);
            let part = [y * force[2], -x * force[2], x * force[1] - y * force[0]];
            torque.iter_mut().zip(part).for_each(|(torque, part)| *torque += part);
        }
        for (found, expected) in values[8..11].iter().zip(torque) {
            assert!((found - expected).abs() < 1e-11, "{found} {expected}");
        }
        assert!((values[12] - 1.0).abs() < f64::EPSILON);
    }
    // The contact is in the middle.
    let truth = fs::read_to_string(&reference).unwrap();
    assert_eq!(truth.lines().next(), Some(HEADER));
    let first: Vec<f64> = truth.lines().nth(1).unwrap().split(',').map(|value| value.parse().unwrap()).collect();
    let expected = [0.0, 3.0, 0.0, -6.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(first.len(), expected.len());
    assert!(first.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-15), "{first:?}");
    // Besides these three and the frames' sensor nothing is left behind.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
}

#[test]
fn without_field_a_line_is_the_summary() {
    let (folder, frames) = folder_with(&format!("{}\n{}\n", row("-900"), row("0")));
    let out = folder.path().join("out.csv");
    let design = workspace("golden/tests/designs/small.toml");
    let output = sptfra(&["solve", text(&design), "--frames", text(&frames), "--out", text(&out)]);
    assert!(output.status.success(), "{output:?}");
    let lines = fs::read_to_string(&out).unwrap();
    assert!(lines.lines().all(|line| line.split(',').count() == 13));
    assert_eq!(lines.lines().next(), Some(HEADER));
    assert_eq!(lines.lines().nth(2), Some("1,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0"));
}

#[test]
fn the_scene_file_of_the_help_is_one() {
    let output = sptfra(&["scene", "--help"]);
    let help = String::from_utf8(output.stdout).unwrap();
    let scene = help.split("Scene file:\n").nth(1).unwrap();
    let frames = golden::scene::Scene::from_toml(scene, "help").unwrap().frames().unwrap();
    assert_eq!(frames.len(), 36);
}

#[test]
fn a_recording_in_counts_with_labels() {
    let (folder, frames) = folder_with(&format!("name,no,{}\nlying,7,{}\n", row("r"), row("40")));
    let [design, forces] = ["pad.toml", "out.csv"].map(|name| folder.path().join(name));
    let small = fs::read_to_string(workspace("golden/tests/designs/small.toml")).unwrap();
    fs::write(&design, small.replace("depth_mm = 3.0", "depth_mm = 3.0\npa_per_count = -12.5")).unwrap();
    let solve = |labels| {
        sptfra(&["solve", text(&design), "--frames", text(&frames), "--labels", labels, "--out", text(&forces)])
    };
    let output = solve("2");
    assert!(output.status.success(), "{output:?}");
    let found = fs::read_to_string(&forces).unwrap();
    fs::write(&frames, row("-500")).unwrap();
    fs::write(&design, &small).unwrap();
    assert!(solve("0").status.success());
    assert_eq!(found, fs::read_to_string(&forces).unwrap());
    assert!(!solve("2").status.success());
}

#[test]
fn frames_for_a_design_and_for_no_other() {
    let folder = TempDir::new().unwrap();
    let sensor = "[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    let [pad, other, frames, forces] =
        ["pad.toml", "other.toml", "push.csv", "forces.csv"].map(|name| folder.path().join(name));
    fs::write(&pad, format!("{PLAIN}name = \"pad\"\n{sensor}pa_per_count = -2.0\n")).unwrap();
    fs::write(&other, format!("{PLAIN}name = \"other\"\n{}", sensor.replace("4.0, 4.0", "4.0, 2.0"))).unwrap();
    // The ending of a design may be left out.
    let output = sptfra(&["scene", "--design", text(&pad.with_extension("")), "--out", text(&frames), "--json"]);
    assert!(output.status.success(), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["frames"], &report["taxels"]), (&36.into(), &30.into()));
    let counts = read_recording(&frames, &line_of(30), 0).unwrap().frames;
    assert!(counts.iter().flatten().all(|count| count.fract() == 0.0), "a sensor that counts");
    assert!(counts.iter().flatten().any(|&count| count > 5000.0));
    let solve = |design: &Path| sptfra(&["solve", text(design), "--frames", text(&frames), "--out", text(&forces)]);
    let output = solve(&pad);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    fs::remove_file(&forces).unwrap();

    for command in ["solve", "check"] {
        let mut arguments = vec![command, text(&other), "--frames", text(&frames)];
        if command == "solve" {
            arguments.extend(["--out", text(&forces)]);
        }
        let output = sptfra(&arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.lines().count() == 1, "{said}");
        for part in ["4 x 4 mm", "4 x 2 mm", "push.sensor.toml", "other", "sptfra scene --design"] {
            assert!(said.contains(part), "no {part:?} in: {said}");
        }
        assert!(!forces.exists());
    }
    // Frames whose sensor nobody knows are solved as ever.
    fs::remove_file(folder.path().join("push.sensor.toml")).unwrap();
    assert!(solve(&other).status.success());

    let scene = workspace("scenes/sensor1-hertz.toml");
    let output = sptfra(&["scene", text(&scene), "--design", text(&pad), "--out", text(&frames)]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("10 x 10 taxels of 4 x 2 mm") && said.contains("6 x 5 taxels of 4 x 4 mm"), "{said}");
    let design = workspace("designs/paper.toml");
    assert!(sptfra(&["scene", text(&scene), "--design", text(&design), "--out", text(&frames)]).status.success());
    let output = sptfra(&["scene", "--out", text(&frames)]);
    assert!(!output.status.success());
}

#[test]
fn suspicious_frames_are_solved_with_a_warning_and_found_by_check() {
    let folder = TempDir::new().unwrap();
    let [frames, pulled, forces] = ["push.csv", "pulled.csv", "forces.csv"].map(|name| folder.path().join(name));
    let design = workspace("designs/paper.toml");
    assert!(sptfra(&["scene", "--design", text(&design), "--out", text(&frames)]).status.success());
    let check = |file: &Path, json: bool| {
        let arguments = ["check", text(&design), "--frames", text(file), "--json"];
        sptfra(&arguments[..if json { 5 } else { 4 }])
    };
    let output = check(&frames, false);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && said.contains("36 frames") && said.contains("nothing suspicious"), "{said}");

    let turned: Vec<Vec<f64>> = read_recording(&frames, &line_of(100), 0)
        .unwrap()
        .frames
        .iter()
        .map(|frame| frame.iter().map(|stress| -stress).collect())
        .collect();
    write_frames(&pulled, &turned).unwrap();
    let output = check(&pulled, false);
    let (said, wrong) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(!output.status.success() && said.lines().count() == 1 && said.contains("F_z > 0"), "{said}");
    assert!(wrong.starts_with("error: ") && wrong.contains("pulled.csv"), "{wrong}");
    let report: serde_json::Value = serde_json::from_slice(&check(&pulled, true).stdout).unwrap();
    assert_eq!(report["findings"][0]["kind"], "sign");

    let output = sptfra(&["solve", text(&design), "--frames", text(&pulled), "--out", text(&forces)]);
    let wrong = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && wrong.starts_with("warning: ") && wrong.lines().count() == 1, "{wrong}");
    assert!(forces.exists());
}
