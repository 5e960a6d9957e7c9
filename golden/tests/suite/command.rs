//! The command and its files, right and wrong.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use golden::design::Design;
use golden::frames::{read_frames, write_frames};
use golden::sensor::Sensor;
use tempfile::TempDir;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn golden(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_golden")).args(arguments).output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A folder with a frame file for the small design.
fn folder_with(frames: &str) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("frames.csv");
    fs::write(&path, frames).unwrap();
    (folder, path)
}

/// The first line of every force file.
const HEADER: &str = "status,F_x,F_y,F_z,mu,phi,mu_x,mu_y,T_x,T_y,T_z,standard_error,bodies";

fn row(value: &str) -> String {
    [value; 12].join(",")
}

#[test]
fn scene_then_solve() {
    let folder = TempDir::new().unwrap();
    let [frames, forces] = ["f.csv", "out.csv"].map(|name| folder.path().join(name));
    let reference = folder.path().join("f.forces.csv");
    let scene = repository("scenes/sensor1-hertz.toml");
    let output = golden(&["scene", text(&scene), "--out", text(&frames)]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("36 frames") && said.contains("f.forces.csv"), "{said}");

    let design = repository("designs/sensor1-none.toml");
    let output = golden(&[
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
    assert_eq!(report["status_counts"][0]["status"], 0);
    let error = report["errors"]["e_fz"]["max"].as_f64().unwrap();
    assert!((error - 10.8).abs() < 0.05, "{error}");

    let lines = fs::read_to_string(&forces).unwrap();
    assert_eq!(lines.lines().count(), 1 + 36);
    assert!(lines.starts_with(&format!("{HEADER},taxel0_f_x,taxel0_f_y,taxel0_f_z,taxel1_f_x,")));
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
    let design = repository("designs/small.toml");
    let output = golden(&["solve", text(&design), "--frames", text(&frames), "--out", text(&out)]);
    assert!(output.status.success(), "{output:?}");
    let lines = fs::read_to_string(&out).unwrap();
    assert!(lines.lines().all(|line| line.split(',').count() == 13));
    assert_eq!(lines.lines().next(), Some(HEADER));
    assert_eq!(lines.lines().nth(2), Some("1,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0"));
}

#[test]
fn bad_frames_get_one_message_and_no_output() {
    let good = row("-1.5");
    for (frames, parts) in [
        (format!("{good}\n-1,-2,-3\n"), vec!["line 2", "column 3", "12 values"]),
        (format!("{good},-7\n"), vec!["line 1", "column 13", "12 values"]),
        (format!("{good}\n{}\n", good.replacen("-1.5", "abc", 1)), vec!["line 2", "column 1", "abc"]),
        (format!("{good}\n\n{}\n", row("NaN")), vec!["line 3", "column 1", "NaN"]),
        (row("inf"), vec!["line 1", "column 1", "inf"]),
        (row("1e999"), vec!["line 1", "column 1", "1e999"]),
        (good.replacen("-1.5", "", 1), vec!["line 1", "column 1", "\"\""]),
        (String::new(), vec!["no frame"]),
    ] {
        let (folder, path) = folder_with(&frames);
        let out = folder.path().join("out.csv");
        let design = repository("designs/small.toml");
        let output = golden(&["solve", text(&design), "--frames", text(&path), "--out", text(&out)]);
        assert!(!output.status.success(), "{frames}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains("frames.csv"), "{said}");
        for part in parts {
            assert!(said.contains(part), "no {part:?} in: {said}");
        }
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(!out.exists());
    }
}

/// So many taxels in a row.
fn line_of(columns: usize) -> Sensor {
    Sensor { columns, rows: 1, pitch_mm: [4.0, 4.0], depth_mm: 3.0 }
}

#[test]
fn frames_that_are_no_text() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("frames.csv");
    fs::write(&path, [0xff, 0xfe, b',', b'1', b'\n']).unwrap();
    let error = read_frames(&path, &line_of(2)).unwrap_err().to_string();
    assert!(error.contains("line 1, column 1"), "{error}");
}

#[test]
fn frames_read_back_to_the_bit() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("frames.csv");
    let frames = vec![vec![-0.1, 1.0 / 3.0, 1e-300], vec![-0.0, 123_456_789.123, f64::from(f32::MAX)]];
    write_frames(&path, &frames).unwrap();
    let again = read_frames(&path, &line_of(3)).unwrap();
    let array = path.with_extension("npy");
    write_frames(&array, &frames).unwrap();
    assert!(fs::read(&array).unwrap().starts_with(b"\x93NUMPY"));
    assert_eq!(read_frames(&array, &line_of(3)).unwrap(), again);
    let bits = |frames: &[Vec<f64>]| -> Vec<u64> { frames.iter().flatten().map(|value| value.to_bits()).collect() };
    assert_eq!(bits(&again), bits(&frames));

    // The sensor's stream is float32: what does not fit there is no stress.
    write_frames(&path, &[vec![0.0, 1e39, 0.0]]).unwrap();
    let error = read_frames(&path, &line_of(3)).unwrap_err().to_string();
    assert!(error.contains("line 1, column 2"), "{error}");
}

#[test]
fn other_bad_input() {
    let (folder, frames) = folder_with(&row("-900"));
    let design = repository("designs/small.toml");
    let out = folder.path().join("out.csv");
    let nowhere = folder.path().join("no/such/out.csv");
    let reference = folder.path().join("reference.csv");
    fs::write(&reference, "0,1,2,-3,0.5,0,0.5,0\n0,1,2,-3,0.5,0,0.5,0\n").unwrap();
    let [design, frames, out, nowhere, reference] =
        [&design, &frames, &out, &nowhere, &reference].map(|path| text(path));
    let dir = text(folder.path());
    for (arguments, part) in [
        (vec!["solve", "absent.toml", "--frames", frames, "--out", out], "absent.toml"),
        (vec!["solve", design, "--frames", "absent.csv", "--out", out], "absent.csv"),
        (vec!["solve", design, "--frames", frames, "--out", nowhere], "out.csv"),
        (vec!["solve", design, "--frames", frames, "--out", dir], "no regular file"),
        (vec!["solve", design, "--frames", frames, "--out", out, "--reference", reference], "2 frames"),
        (vec!["scene", design, "--out", out], "small.toml"),
    ] {
        let output = golden(&arguments);
        assert!(!output.status.success(), "{arguments:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(part) && said.starts_with("error: "), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(!Path::new(out).exists(), "{arguments:?}");
    }
    assert!(folder.path().is_dir());
}

#[test]
fn choose_then_solve() {
    let folder = TempDir::new().unwrap();
    let [design, resolved, table] = ["pad.toml", "resolved.toml", "c.csv"].map(|name| folder.path().join(name));
    let scene = "[medium]\nkind = \"half_space\"\n[[contact]]\nshape = \"rectangle\"\nsides_mm = [7.0, 6.0]\n\
        centre_mm = [6.0, 4.0]\nnormal_force_n = 2.0\nfriction = 0.4\n\
        [sweep]\ndirection_deg = { from = 0, to = 315, step = 45 }\n";
    let sensor = "[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    fs::write(folder.path().join("scene.toml"), format!("{sensor}{scene}")).unwrap();
    let filter = "[algorithm]\nfilter = { kind = \"f3\", scenes = [\"scene.toml\"] }\n";
    fs::write(&design, format!("name = \"pad\"\n{sensor}{filter}")).unwrap();

    let (_frames_folder, frames) = folder_with(&row("-900"));
    let out = folder.path().join("out.csv");
    let solve = |design: &Path| golden(&["solve", text(design), "--frames", text(&frames), "--out", text(&out)]);
    let refused = solve(&design);
    assert!(!refused.status.success());
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("golden choose") && said.lines().count() == 1, "{said}");

    let output = golden(&["choose", text(&design), "--out", text(&resolved), "--csv", text(&table), "--json"]);
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "progress belongs on a terminal");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["design"], &report["frames"]), (&"pad".into(), &8.into()));
    let candidates = report["candidates"].as_array().unwrap();
    let lines = fs::read_to_string(&table).unwrap();
    assert_eq!(lines.lines().count(), 1 + 13 * 10);
    assert_eq!(lines.lines().next(), Some("matrix,filter,nnz,e_mu,e_mu_nnz,chosen"));
    for (line, candidate) in lines.lines().skip(1).zip(candidates) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(
            (cells[0], cells[1]),
            (candidate["matrix"].as_str().unwrap(), candidate["filter"].as_str().unwrap())
        );
        assert_eq!(cells[2].parse::<u64>().unwrap(), candidate["nnz"].as_u64().unwrap());
        assert_eq!(cells[5] == "1", candidate["chosen"].as_bool().unwrap());
        let choice = format!("\n{} = \"{}\"\n", cells[0], cells[1]);
        assert_eq!(fs::read_to_string(&resolved).unwrap().contains(&choice), cells[5] == "1", "{choice}");
    }
    assert!(solve(&resolved).status.success());

    // From the resolved design, to another folder: the scenes are found from there, and the choices are the same.
    let elsewhere = folder.path().join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    let again = elsewhere.join("again.toml");
    let output = golden(&["choose", text(&resolved), "--out", text(&again)]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("8 frames") && said.contains("all together"), "{said}");
    let moved = fs::read_to_string(&again).unwrap();
    assert!(moved.contains("\"../scene.toml\""), "{moved}");
    assert_eq!(moved.replace("../scene.toml", "scene.toml"), fs::read_to_string(&resolved).unwrap());

    for (arguments, part) in [
        (vec!["choose", text(&design), "--out", text(&design)], "overwrite the input"),
        (vec!["choose", text(&design), "--out", text(&again), "--csv", text(&again)], "two names"),
        (vec!["choose", text(&repository("designs/small.toml")), "--out", text(&again)], "nothing to choose"),
    ] {
        let output = golden(&arguments);
        assert!(!output.status.success(), "{arguments:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(part) && said.lines().count() == 1, "{said}");
    }
    assert_eq!(fs::read_to_string(&again).unwrap(), moved);
}

#[test]
fn the_scene_file_of_the_help_is_one() {
    let output = golden(&["scene", "--help"]);
    let help = String::from_utf8(output.stdout).unwrap();
    let scene = help.split("Scene file:\n").nth(1).unwrap();
    let frames = golden::scene::Scene::from_toml(scene, "help").unwrap().frames().unwrap();
    assert_eq!(frames.len(), 36);
}

#[test]
fn an_old_file_is_replaced_whole() {
    let (folder, frames) = folder_with(&row("-900"));
    let out = folder.path().join("out.csv");
    fs::write(&out, "old\n".repeat(1000)).unwrap();
    let design = repository("designs/small.toml");
    let output = golden(&["solve", text(&design), "--frames", text(&frames), "--out", text(&out)]);
    assert!(output.status.success());
    assert_eq!(fs::read_to_string(&out).unwrap().lines().count(), 2);
}

#[test]
fn an_input_is_never_overwritten() {
    let (_folder, frames) = folder_with(&row("-900"));
    let before = fs::read(&frames).unwrap();
    let design = repository("designs/small.toml");
    let output = golden(&["solve", text(&design), "--frames", text(&frames), "--out", text(&frames)]);
    assert!(!output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("overwrite the input"), "{said}");
    assert_eq!(fs::read(&frames).unwrap(), before);
}

#[test]
fn a_recording_in_counts_with_labels() {
    let (folder, frames) = folder_with(&format!("name,no,{}\nlying,7,{}\n", row("r"), row("40")));
    let [design, forces] = ["pad.toml", "out.csv"].map(|name| folder.path().join(name));
    let small = fs::read_to_string(repository("designs/small.toml")).unwrap();
    fs::write(&design, small.replace("depth_mm = 3.0", "depth_mm = 3.0\npa_per_count = -12.5")).unwrap();
    let solve = |labels| {
        golden(&["solve", text(&design), "--frames", text(&frames), "--labels", labels, "--out", text(&forces)])
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
fn a_choice_keeps_the_calibration() {
    let folder = TempDir::new().unwrap();
    let [design, gains, out] = ["pad.toml", "gains.csv", "out"].map(|name| folder.path().join(name));
    let scene = repository("scenes/sensor1-hertz.toml");
    let f3 = fs::read_to_string(repository("designs/sensor1-f3.toml")).unwrap();
    let start = f3.split("[algorithm.filter]").next().unwrap();
    let start = start.replace("depth_mm = 3.0", "depth_mm = 3.0\npa_per_count = -0.5\ncalibration = \"gains.csv\"");
    fs::write(&design, format!("{start}[algorithm.filter]\nkind = \"f3\"\nscenes = [{:?}]\n", text(&scene))).unwrap();
    fs::write(&gains, "1.25,-3\n".repeat(100)).unwrap();
    fs::create_dir(&out).unwrap();
    let resolved = out.join("resolved.toml");
    let choose = || golden(&["choose", text(&design), "--out", text(&resolved)]);
    // The second time it is there already.
    for _ in 0..2 {
        assert!(choose().status.success());
        let [before, after] = [&design, &resolved].map(|path| golden::design::Design::load(path).unwrap());
        assert_eq!(before.input, after.input);
        // Scenes are in pascals: the counts change nothing of the choice.
        let stored = golden::design::Design::load(&repository("designs/sensor1-f3.toml")).unwrap();
        for name in golden::matrices::MatrixName::ALL {
            assert_eq!(after.algorithm.filter.of(name), stored.algorithm.filter.of(name));
        }
    }
    fs::write(out.join("calibration.csv"), "1.5,-3\n".repeat(100)).unwrap();
    fs::remove_file(&resolved).unwrap();
    let refused = choose();
    let message = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && message.contains("another folder"), "{message}");
    assert!(!resolved.exists());
}

#[test]
fn bench_measures_each_design() {
    let designs = ["designs/small.toml", "designs/odd.toml"].map(repository);
    let output = golden(&["bench", text(&designs[0]), text(&designs[1]), "--json"]);
    assert!(output.status.success(), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for (report, (name, plan, taxels)) in
        report.as_array().unwrap().iter().zip([("small_4x3", "reduced", 12), ("odd", "paper", 35)])
    {
        assert_eq!(
            (&report["design"], &report["plan"], &report["taxels"]),
            (&name.into(), &plan.into(), &taxels.into())
        );
        for way in ["one_by_one", "in_batches"] {
            let figure = |key: &str| report[way][key].as_f64().unwrap();
            let [rate, time] = ["frames_per_second", "us_per_frame"].map(figure);
            assert!((rate * time / 1e6 - 1.0).abs() < 1e-9 && time > 0.1 && time < 1e5, "{report}");
            let range = [0, 1].map(|end| report[way]["us_per_frame_range"][end].as_f64().unwrap());
            assert!(range[0] <= time && time <= range[1], "{report}");
        }
    }
    let refused = golden(&["bench", "no/such.toml"]);
    assert!(!refused.status.success() && String::from_utf8(refused.stderr).unwrap().contains("no/such.toml"));
}

#[test]
fn calibrate_then_solve() {
    let folder = TempDir::new().unwrap();
    let [design, resolved, frames, out] =
        ["pad.toml", "out/resolved.toml", "f.csv", "out.csv"].map(|name| folder.path().join(name));
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::write(folder.path().join("gains.csv"), "1.25,-3\n".repeat(12)).unwrap();
    let sensor = "[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\npa_per_count = 2.0\n\
                  calibration = \"gains.csv\"\n";
    fs::write(&design, format!("name = \"pad\"\n{sensor}[algorithm]\nestimator = \"joint\"\n")).unwrap();
    fs::write(&frames, row("-900")).unwrap();

    let calibrate = |more: &[&str]| {
        golden(&[&["calibrate", text(&design), "--out", text(&resolved), "--quick", "--hidden", "3"], more].concat())
    };
    let output = calibrate(&["--json", "--seed", "9"]);
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "progress belongs on a terminal");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let written = fs::read_to_string(&resolved).unwrap();
    assert!(written.contains("seed 9") && written.contains("\nfile = \"resolved.weights.csv\"\n"), "{written}");
    let weights = resolved.with_file_name("resolved.weights.csv");
    assert_eq!(fs::read_to_string(&weights).unwrap().lines().count(), 4, "a header and three hidden units");
    let before = Design::load(&design).unwrap();
    let Design { algorithm, input, .. } = Design::load(&resolved).unwrap();
    assert_eq!(input, before.input, "the file of gains is there too");
    let found = algorithm.joint;
    assert_eq!(found.correction.unwrap().hidden.len(), 3);
    // JSON is read with an error in the last digit.
    let near = |said: &serde_json::Value, found: f64| (said.as_f64().unwrap() - found).abs() < 1e-12;
    assert!(near(&report["gain"], found.gain) && near(&report["tangential"][1], found.tangential[1]), "{report}");
    let solve = |design: &Path| golden(&["solve", text(design), "--frames", text(&frames), "--out", text(&out)]);
    assert!(solve(&resolved).status.success());
    let calibrated = fs::read_to_string(&out).unwrap();
    assert!(solve(&design).status.success());
    assert_ne!(calibrated, fs::read_to_string(&out).unwrap());

    let said = String::from_utf8(calibrate(&[]).stdout).unwrap();
    assert!(said.contains("gain") && said.contains("mu |mu|^2") && said.contains("weights"), "{said}");
    // Another design's weights are not written over.
    let other = resolved.with_file_name("other.toml");
    fs::rename(&weights, resolved.with_file_name("other.weights.csv")).unwrap();
    fs::write(&resolved, fs::read_to_string(&resolved).unwrap().replace("resolved.w", "other.w")).unwrap();
    for (arguments, part) in [
        (vec!["calibrate", text(&resolved), "--out", text(&other)], "overwrite the input"),
        (vec!["calibrate", text(&design), "--out", text(&design)], "overwrite the input"),
        (vec!["calibrate", text(&repository("designs/small.toml")), "--out", text(&out)], "nothing to calibrate"),
    ] {
        let output = golden(&arguments);
        assert!(!output.status.success(), "{arguments:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(part) && said.lines().count() == 1, "{said}");
    }
}

#[test]
fn frames_for_a_design_and_for_no_other() {
    let folder = TempDir::new().unwrap();
    let sensor = "[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    let [pad, other, frames, forces] =
        ["pad.toml", "other.toml", "push.csv", "forces.csv"].map(|name| folder.path().join(name));
    fs::write(&pad, format!("name = \"pad\"\n{sensor}pa_per_count = -2.0\n")).unwrap();
    fs::write(&other, format!("name = \"other\"\n{}", sensor.replace("4.0, 4.0", "4.0, 2.0"))).unwrap();
    // The ending of a design may be left out.
    let output = golden(&["scene", "--design", text(&pad.with_extension("")), "--out", text(&frames), "--json"]);
    assert!(output.status.success(), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["frames"], &report["taxels"]), (&36.into(), &30.into()));
    let counts = read_frames(&frames, &line_of(30)).unwrap();
    assert!(counts.iter().flatten().all(|count| count.fract() == 0.0), "a sensor that counts");
    assert!(counts.iter().flatten().any(|&count| count > 5000.0));
    let solve = |design: &Path| golden(&["solve", text(design), "--frames", text(&frames), "--out", text(&forces)]);
    let output = solve(&pad);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    fs::remove_file(&forces).unwrap();

    for command in ["solve", "check"] {
        let mut arguments = vec![command, text(&other), "--frames", text(&frames)];
        if command == "solve" {
            arguments.extend(["--out", text(&forces)]);
        }
        let output = golden(&arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.lines().count() == 1, "{said}");
        for part in ["4 x 4 mm", "4 x 2 mm", "push.sensor.toml", "other", "golden scene --design"] {
            assert!(said.contains(part), "no {part:?} in: {said}");
        }
        assert!(!forces.exists());
    }
    // Frames whose sensor nobody knows are solved as ever.
    fs::remove_file(folder.path().join("push.sensor.toml")).unwrap();
    assert!(solve(&other).status.success());

    let scene = repository("scenes/sensor1-hertz.toml");
    let output = golden(&["scene", text(&scene), "--design", text(&pad), "--out", text(&frames)]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("10 x 10 taxels of 4 x 2 mm") && said.contains("6 x 5 taxels of 4 x 4 mm"), "{said}");
    let design = repository("designs/sensor1-none.toml");
    assert!(golden(&["scene", text(&scene), "--design", text(&design), "--out", text(&frames)]).status.success());
    let output = golden(&["scene", "--out", text(&frames)]);
    assert!(!output.status.success());
}

#[test]
fn suspicious_frames_are_solved_with_a_warning_and_found_by_check() {
    let folder = TempDir::new().unwrap();
    let [frames, pulled, forces] = ["push.csv", "pulled.csv", "forces.csv"].map(|name| folder.path().join(name));
    let design = repository("designs/sensor1-none.toml");
    assert!(golden(&["scene", "--design", text(&design), "--out", text(&frames)]).status.success());
    let check = |file: &Path, json: bool| {
        let arguments = ["check", text(&design), "--frames", text(file), "--json"];
        golden(&arguments[..if json { 5 } else { 4 }])
    };
    let output = check(&frames, false);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && said.contains("36 frames") && said.contains("nothing suspicious"), "{said}");

    let turned: Vec<Vec<f64>> = read_frames(&frames, &line_of(100))
        .unwrap()
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

    let output = golden(&["solve", text(&design), "--frames", text(&pulled), "--out", text(&forces)]);
    let wrong = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && wrong.starts_with("warning: ") && wrong.lines().count() == 1, "{wrong}");
    assert!(forces.exists());
}

#[test]
fn one_command_fits_the_constants_to_a_changed_sensor() {
    let folder = TempDir::new().unwrap();
    let [pad, fitted] = ["pad.toml", "pad-calibrated.toml"].map(|name| folder.path().join(name));
    let sensor = "[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    let stale = "[algorithm]\nestimator = \"joint\"\ngain = 1.1\n\
        fitted_to = \"6 x 5 taxels of 4 x 2 mm, 3 mm deep, point, 0\"\n";
    fs::write(&pad, format!("name = \"pad\"\n{sensor}{stale}")).unwrap();
    let frames = folder.path().join("f.csv");
    let output = golden(&["scene", "--design", text(&pad), "--out", text(&frames)]);
    let said = String::from_utf8(output.stderr).unwrap();
    let command = said.split('`').nth(1).unwrap_or_else(|| panic!("no command in: {said}")).to_owned();
    let mut words = command.split(' ');
    assert_eq!(words.next(), Some("golden"));
    let arguments: Vec<&str> = words.chain(["--hidden", "0", "--quick"]).collect();
    let output = golden(&arguments);
    assert!(output.status.success(), "{output:?}");
    let design = Design::load(&fitted).unwrap();
    assert_eq!(design.name, "pad_calibrated", "a design of its own");
    assert!(design.algorithm.joint.fitted_to.is_some_and(|sensor| sensor.contains("4 x 4 mm")));
}
