//! Filters and constants that are found from frames.

use std::fs;
use std::path::{Path, PathBuf};

use golden::creep::Creep;
use golden::design::Design;
use golden::scene::Scene;
use tempfile::TempDir;

use super::{folder_with, row};
use crate::support::{PLAIN, only_progress, sptfra, text, workspace};

#[test]
fn choose_then_solve() {
    let folder = TempDir::new().unwrap();
    let [design, resolved, table] = ["pad.toml", "resolved.toml", "c.csv"].map(|name| folder.path().join(name));
    let scene = "[medium]\nkind = \"half_space\"\n[[contact]]\nshape = \"rectangle\"\nsides_mm = [7.0, 6.0]\n\
        centre_mm = [6.0, 4.0]\nnormal_force_n = 2.0\nfriction = 0.4\n\
        [sweep]\ndirection_deg = { from = 0, to = 315, step = 45 }\n";
    let sensor = "[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    fs::write(folder.path().join("scene.toml"), format!("{sensor}{scene}")).unwrap();
    let filter = "[algorithm]\nplan = \"paper\"\nfilter = { kind = \"f3\", scenes = [\"scene.toml\"] }\n\
                  standard_error = { model = 0.1, noise = 90.0, border = 1.0 }\n";
    fs::write(&design, format!("{PLAIN}name = \"pad\"\n{sensor}{filter}")).unwrap();

    let (_frames_folder, frames) = folder_with(&row("-900"));
    let out = folder.path().join("out.csv");
    let solve = |design: &Path| sptfra(&["solve", text(design), "--frames", text(&frames), "--out", text(&out)]);
    let refused = solve(&design);
    assert!(!refused.status.success());
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("sptfra tune-filter") && said.lines().count() == 1, "{said}");

    let output = sptfra(&["tune-filter", text(&design), "--out", text(&resolved), "--csv", text(&table), "--json"]);
    assert!(output.status.success(), "{output:?}");
    assert!(only_progress(&output.stderr), "{output:?}");
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
    let output = sptfra(&["tune-filter", text(&resolved), "--out", text(&again)]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("8 frames") && said.contains("all together"), "{said}");
    let moved = fs::read_to_string(&again).unwrap();
    assert!(!moved.contains("standard_error"), "that of other filters");
    assert!(moved.contains("\"../scene.toml\""), "{moved}");
    assert_eq!(moved.replace("../scene.toml", "scene.toml"), fs::read_to_string(&resolved).unwrap());

    for (arguments, part) in [
        (vec!["tune-filter", text(&design), "--out", text(&design)], "overwrite the input"),
        (vec!["tune-filter", text(&design), "--out", text(&again), "--csv", text(&again)], "two names"),
        (
            vec!["tune-filter", text(&workspace("golden/tests/designs/small.toml")), "--out", text(&again)],
            "nothing to choose",
        ),
    ] {
        let output = sptfra(&arguments);
        assert!(!output.status.success(), "{arguments:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(part) && said.lines().count() == 1, "{said}");
    }
    assert_eq!(fs::read_to_string(&again).unwrap(), moved);
}

#[test]
fn a_choice_keeps_the_calibration() {
    let folder = TempDir::new().unwrap();
    let [design, gains, out] = ["pad.toml", "gains.csv", "out"].map(|name| folder.path().join(name));
    let scene = workspace("scenes/sensor1-hertz.toml");
    let paper = fs::read_to_string(workspace("designs/paper.toml")).unwrap();
    let start = paper
        .replace("filter = { kind = \"none\" }\n", "")
        .replace("depth_mm = 3.0", "depth_mm = 3.0\npa_per_count = -0.5\ncalibration = \"gains.csv\"");
    fs::write(&design, format!("{start}[algorithm.filter]\nkind = \"f3\"\nscenes = [{:?}]\n", text(&scene))).unwrap();
    fs::write(&gains, "1.25,-3\n".repeat(100)).unwrap();
    fs::create_dir(&out).unwrap();
    let resolved = out.join("resolved.toml");
    let choose = || sptfra(&["tune-filter", text(&design), "--out", text(&resolved)]);
    // The second time it is there already.
    for _ in 0..2 {
        assert!(choose().status.success());
        let [before, after] = [&design, &resolved].map(|path| golden::design::Design::load(path).unwrap());
        assert_eq!(before.input, after.input);
        // Scenes are in pascals: the counts change nothing of the choice.
        let stored = golden::design::Design::load(&workspace("golden/tests/designs/sensor1-f3.toml")).unwrap();
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
fn calibrate_then_solve() {
    let folder = TempDir::new().unwrap();
    let [design, resolved, frames, out] =
        ["pad.toml", "out/resolved.toml", "f.csv", "out.csv"].map(|name| folder.path().join(name));
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::write(folder.path().join("gains.csv"), "1.25,-3\n".repeat(12)).unwrap();
    let sensor = "[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\npa_per_count = 2.0\n\
                  calibration = \"gains.csv\"\n";
    // Without the constants, which the command fits.
    let joint = |constants: &str| {
        fs::write(&design, format!("{PLAIN}name = \"pad\"\n{sensor}[algorithm]\nestimator = \"joint\"\n{constants}"))
            .unwrap();
    };
    joint("");
    fs::write(&frames, row("-900")).unwrap();

    let calibrate = |more: &[&str]| {
        sptfra(&[&["calibrate", text(&design), "--out", text(&resolved), "--quick", "--hidden", "3"], more].concat())
    };
    let output = calibrate(&["--json", "--seed", "9"]);
    assert!(output.status.success(), "{output:?}");
    assert!(only_progress(&output.stderr), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let written = fs::read_to_string(&resolved).unwrap();
    assert!(written.contains("seed 9") && written.contains("\nfile = \"resolved.weights.csv\"\n"), "{written}");
    let weights = resolved.with_file_name("resolved.weights.csv");
    assert_eq!(fs::read_to_string(&weights).unwrap().lines().count(), 4, "a header and three hidden units");
    assert!(Design::load(&design).unwrap_err().to_string().contains("algorithm.gain is missing"));
    joint("gain = 1\nfriction_correction = [1, 0]\n");
    let before = Design::load(&design).unwrap();
    let Design { algorithm, input, .. } = Design::load(&resolved).unwrap();
    assert_eq!(input, before.input, "the file of gains is there too");
    let found = algorithm.joint;
    assert_eq!(found.correction.unwrap().hidden.len(), 3);
    // JSON is read with an error in the last digit.
    let near = |said: &serde_json::Value, found: f64| (said.as_f64().unwrap() - found).abs() < 1e-12;
    assert!(
        near(&report["gain"], found.gain) && near(&report["friction_correction"][1], found.friction_correction[1]),
        "{report}"
    );
    let solve = |design: &Path| sptfra(&["solve", text(design), "--frames", text(&frames), "--out", text(&out)]);
    assert!(solve(&resolved).status.success());
    let calibrated = fs::read_to_string(&out).unwrap();
    assert!(solve(&design).status.success());
    assert_ne!(calibrated, fs::read_to_string(&out).unwrap());

    let said = String::from_utf8(calibrate(&[]).stdout).unwrap();
    assert!(algorithm.standard_error.is_some(), "every calibrated design has one");
    assert!(said.contains("gain") && said.contains("mu |mu|^2") && said.contains("weights"), "{said}");
    assert!(said.contains("At a noise of 0.5 % expect the shear within "), "{said}");
    // Another design's weights are not written over.
    let other = resolved.with_file_name("other.toml");
    fs::rename(&weights, resolved.with_file_name("other.weights.csv")).unwrap();
    fs::write(&resolved, fs::read_to_string(&resolved).unwrap().replace("resolved.w", "other.w")).unwrap();
    for (arguments, part) in [
        (vec!["calibrate", text(&resolved), "--out", text(&other)], "overwrite the input"),
        (vec!["calibrate", text(&design), "--out", text(&design)], "overwrite the input"),
    ] {
        let output = sptfra(&arguments);
        assert!(!output.status.success(), "{arguments:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(part) && said.lines().count() == 1, "{said}");
    }
}

#[test]
fn one_command_fits_the_constants_to_a_changed_sensor() {
    let folder = TempDir::new().unwrap();
    let [pad, fitted] = ["pad.toml", "pad-calibrated.toml"].map(|name| folder.path().join(name));
    let sensor = "[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";
    let stale = "[algorithm]\nestimator = \"joint\"\ngain = 1.1\nfriction_correction = [1, 0]\n\
        calibrated_for = \"6 x 5 taxels of 4 x 2 mm, 3 mm deep, point, 0, noise 0.005, sliding\"\n";
    fs::write(&pad, format!("{PLAIN}name = \"pad\"\n{sensor}{stale}")).unwrap();
    let frames = folder.path().join("f.csv");
    let output = sptfra(&["scene", "--design", text(&pad), "--out", text(&frames)]);
    let said = String::from_utf8(output.stderr).unwrap();
    let command = said.split('`').nth(1).unwrap_or_else(|| panic!("no command in: {said}")).to_owned();
    let mut words = command.split(' ');
    assert_eq!(words.next(), Some("sptfra"));
    let arguments: Vec<&str> = words.chain(["--hidden", "0", "--quick"]).collect();
    let output = sptfra(&arguments);
    assert!(output.status.success(), "{output:?}");
    let design = Design::load(&fitted).unwrap();
    assert_eq!(design.name, "pad_calibrated", "a design of its own");
    assert!(design.algorithm.joint.calibrated_for.is_some_and(|sensor| sensor.contains("4 x 4 mm")));
}

/// Creep of the sensor in these recordings, which have 20 frames a second.
const CREEP: Creep = Creep { strength: 0.4, seconds: 8.0, frames_per_second: 20.0 };

/// A file of frames with creep, in counts, with a column of times.
fn creeping(design: &Design, stress: &[Vec<f64>]) -> String {
    let mut sensor = design.clone();
    sensor.input.creep = Some(CREEP);
    let mut frames = stress.to_vec();
    sensor.deliver_in_order(&mut frames);
    let taxels = design.sensor.taxels();
    let mut text = "time (s)".to_owned() + &(0..taxels).map(|taxel| format!(",p{taxel}")).collect::<String>() + "\n";
    for (number, frame) in frames.iter().enumerate() {
        text += &(number as f64 / CREEP.frames_per_second).to_string();
        text += &frame.iter().map(|count| format!(",{count}")).collect::<String>();
        text += "\n";
    }
    text
}

/// 5 s without load, then 43 s of a weight.
fn weight_that_stays() -> Vec<Vec<f64>> {
    let load = |frame: usize, taxel: usize| if frame < 100 { 0.0 } else { -600.0 * [0.2, 1.0, 0.9, 0.1][taxel % 4] };
    (0..960).map(|frame| (0..36).map(|taxel| load(frame, taxel)).collect()).collect()
}

/// A pad in counts, the file of a weight that stays, and a folder with both.
fn creeping_pad() -> (TempDir, Design, [PathBuf; 2]) {
    let folder = TempDir::new().unwrap();
    let paths = ["pad.toml", "load.csv"].map(|name| folder.path().join(name));
    let sensor = "[sensor]\ncolumns = 6\nrows = 6\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\npa_per_count = -2.0\n";
    fs::write(&paths[0], format!("{PLAIN}name = \"pad\"\n{sensor}")).unwrap();
    let pad = Design::load(&paths[0]).unwrap();
    fs::write(&paths[1], creeping(&pad, &weight_that_stays())).unwrap();
    (folder, pad, paths)
}

/// `F_z` of a recording.
fn normal_forces(design: &Path, frames: &Path) -> Vec<f64> {
    let forces = frames.with_extension("forces.csv");
    let solve = ["solve", text(design), "--frames", text(frames), "--labels", "1", "--out", text(&forces)];
    assert!(sptfra(&solve).status.success());
    let table = fs::read_to_string(&forces).unwrap();
    let column = table.lines().next().unwrap().split(',').position(|name| name.starts_with("F_z")).unwrap();
    table.lines().skip(1).map(|line| line.split(',').nth(column).unwrap().parse().unwrap()).collect()
}

/// Solved with the creep that is found, the force of a weight that stays does too.
#[test]
fn creep_is_found_from_a_weight_that_stays() {
    let (folder, _, [design, load]) = creeping_pad();
    let found = folder.path().join("found.toml");
    let calibrate = |more: &[&str]| {
        let fixed = ["calibrate", text(&design), "--out", text(&found), "--constant-load", text(&load)];
        sptfra(&[&fixed, more].concat())
    };
    let output = calibrate(&["--labels", "1"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && said.contains("from constant load: the readings rise by 40.0 %"), "{said}");
    assert!(said.contains("at 20 frames a second"), "{said}");
    let creep = Design::load(&found).unwrap().input.creep.unwrap();
    assert!((creep.strength - CREEP.strength).abs() < 0.01 && (creep.seconds - CREEP.seconds).abs() < 0.3, "{creep:?}");
    let [without, with] = [&design, &found].map(|design| normal_forces(design, &load));
    let rise = |forces: &[f64]| forces[959] / forces[101] - 1.0;
    assert!(rise(&without) > 0.35 && rise(&with).abs() < 0.02, "{} {}", rise(&without), rise(&with));

    let timed = fs::read_to_string(&load).unwrap();
    let clock = |name: &str, of: &dyn Fn(usize) -> String| {
        let lines = timed.lines().enumerate().map(|(number, line)| {
            let values = line.split_once(',').unwrap().1;
            if number == 0 { format!("{name},{values}\n") } else { format!("{},{values}\n", of(number)) }
        });
        fs::write(&load, lines.collect::<String>()).unwrap();
        let output = calibrate(&["--labels", "1"]);
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    };
    let milliseconds = |number: usize| (50 * number).to_string();
    let stamps = |number: usize| format!("01.03.2026 12:00:{number}");
    for (name, of, said) in [
        (
            "time",
            &milliseconds as &dyn Fn(usize) -> String,
            "column 1, time, without a unit would be 50 s from frame to frame",
        ),
        ("timestamp", &|number| (1_772_366_400_000 + number as u64).to_string(), "name the unit, `time (ms)`"),
        ("Zeit", &stamps, "column 1, Zeit, holds no time that is understood"),
        ("time (min)", &milliseconds, "column 1, time (min), holds no time that is understood"),
    ] {
        let (succeeded, refused) = clock(name, of);
        assert!(!succeeded && refused.contains(said), "{name}: {refused}");
    }
    assert!(clock("time (ms)", &milliseconds).0);
    let untimed = timed;
    let untimed: String =
        untimed.lines().skip(1).map(|line| line.split_once(',').unwrap().1.to_owned() + "\n").collect();
    fs::write(&load, untimed).unwrap();
    for (more, said) in [(&[][..], "no column of times"), (&["--page", "page.html"], "--page shows loads and gains")] {
        let refused = String::from_utf8(calibrate(more).stderr).unwrap();
        assert!(refused.contains(said), "{refused}");
    }
}

/// Gains and curve are fitted to readings without creep, and creep to what these make of them. Weights that stay then read
/// what they weigh.
#[test]
fn gains_are_those_of_readings_without_creep() {
    let (folder, pad, [design, load]) = creeping_pad();
    let mut scene = Scene::standing(&pad.sensor);
    scene.sweep_deg.clear();
    let (mut stress, mut forces) = (vec![vec![0.0; 36]; 100], vec![0.0; 100]);
    for centre_m in [[8e-3, 8e-3], [12e-3, 8e-3], [8e-3, 12e-3], [12e-3, 12e-3]] {
        scene.contacts[0].centre_m = centre_m;
        let frame = scene.frames().unwrap().remove(0);
        for load in [0.0, 0.1, 0.0, 0.2, 0.0, 0.4, 0.0] {
            for _ in 0..60 {
                stress.push(frame.stress.iter().map(|stress| load * stress).collect());
                forces.push(load * frame.force[2]);
            }
        }
    }
    let [frames, weights, found] = ["press.csv", "weights.csv", "found.toml"].map(|name| folder.path().join(name));
    let lines: String = forces.iter().map(|force| format!("{force}\n")).collect();
    fs::write(&weights, format!("F_z (N)\n{lines}")).unwrap();
    let recordings =
        ["--frames", text(&frames), "--forces", text(&weights), "--constant-load", text(&load), "--labels", "1"];
    let worst = |design: &Path| {
        let solved = normal_forces(design, &frames);
        let share = |(found, force): (&f64, &f64)| if *force < -0.05 { (found / force - 1.0).abs() } else { 0.0 };
        solved.iter().zip(&forces).map(share).fold(0.0, f64::max)
    };
    let straight = fs::read_to_string(&design).unwrap();
    for (counts, settles) in [
        ("pa_per_count = -2.0", true),
        ("curve = { power = 1.25, scale = -0.3 }", true),
        ("curve = { power = 2.0, scale = -0.01 }", false),
    ] {
        let sensor = Design::from_toml(&straight.replace("pa_per_count = -2.0", counts), text(&design)).unwrap();
        fs::write(&frames, creeping(&sensor, &stress)).unwrap();
        fs::write(&load, creeping(&sensor, &weight_that_stays())).unwrap();
        let output = sptfra(&[&["calibrate", text(&design), "--out", text(&found)], &recordings[..]].concat());
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(
            output.status.success() && said.contains("still change after 10 rounds") != settles,
            "{counts}: {said}"
        );
        if !settles {
            continue;
        }
        let creep = Design::load(&found).unwrap().input.creep.unwrap();
        assert!((creep.strength - CREEP.strength).abs() < 0.01, "{counts}: {creep:?}");
        assert!((creep.seconds - CREEP.seconds).abs() < 0.3, "{counts}: {creep:?}");
        assert!(worst(&found) < 0.02, "{counts}: {}", worst(&found));
        assert!(worst(&design) > 0.2, "{counts}: {}", worst(&design));
    }
}

/// Too few frames for a lag: the error alone tells that the pressures are those of other frames.
#[test]
fn pressures_of_other_frames_are_refused() {
    let folder = TempDir::new().unwrap();
    let [pad, frames, pressures, found] =
        ["pad.toml", "bladder.csv", "pressures.csv", "found.toml"].map(|name| folder.path().join(name));
    fs::write(
        &pad,
        format!("{PLAIN}name = \"pad\"\n[sensor]\ncolumns = 3\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\npa_per_count = -10.0\n"),
    )
    .unwrap();
    let steps: Vec<u32> = [0, 5, 10, 20, 40, 60, 30, 0, 20, 60, 0].into_iter().flat_map(|step| [step; 3]).collect();
    let counts = |(frame, step): (usize, &u32)| {
        let taxel = |taxel: usize| (100 * step + ((5 * frame + 3 * taxel) % 4) as u32).to_string();
        (0..9).map(taxel).collect::<Vec<_>>().join(",") + "\n"
    };
    fs::write(&frames, steps.iter().enumerate().map(counts).collect::<String>()).unwrap();
    let calibrate = |late: usize| {
        let logged = (0..steps.len()).map(|line| format!("{}\n", line.checked_sub(late).map_or(0, |line| steps[line])));
        fs::write(&pressures, format!("pressure (kPa)\n{}", logged.collect::<String>())).unwrap();
        sptfra(&[
            "calibrate",
            text(&pad),
            "--uniform",
            text(&frames),
            "--pressures",
            text(&pressures),
            "--out",
            text(&found),
        ])
    };
    let refused = calibrate(2);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(1), "{said}");
    for part in ["bladder.csv: the pressure errs by ", "column of times in both files", "begin together"] {
        assert!(said.contains(part), "{said}");
    }
    assert!(!found.exists());
    let together = calibrate(0);
    assert!(together.status.success(), "{together:?}");
}
