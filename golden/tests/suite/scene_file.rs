//! Scene files: what they make, and a clear refusal of everything else.

#![allow(clippy::float_cmp)] // the same bits are meant

use std::path::Path;

use golden::design::Sensor;
use golden::scene::{Medium, Scene};

const MINIMAL: &str = "[sensor]\ncolumns = 6\nrows = 5\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
    [medium]\nkind = \"bonded_layer\"\npoisson = 0.49\n\
    [[contact]]\nshape = \"hertz\"\nsemi_axes_mm = [5.0, 4.0]\ncentre_mm = [10.0, 8.0]\n\
    normal_force_n = 4.0\nfriction = 0.5\ndirection_deg = 30.0\n";

fn with(line: &str, replacement: &str) -> String {
    assert!(MINIMAL.contains(line), "no such line: {line}");
    MINIMAL.replace(line, replacement)
}

#[track_caller]
fn refused(text: &str, parts: &[&str]) {
    let message = Scene::from_toml(text, "push.toml").unwrap_err().to_string();
    assert!(message.contains("push.toml"), "no file name in: {message}");
    for part in parts {
        assert!(message.contains(part), "no {part:?} in: {message}");
    }
    assert!(!message.contains('\n'), "more than one line: {message}");
}

#[test]
fn the_true_force_is_that_of_the_contact() {
    let frames = Scene::from_toml(MINIMAL, "").unwrap().frames().unwrap();
    assert_eq!(frames.len(), 1);
    let [fx, fy, fz] = frames[0].force;
    assert!((fx - 2.0 * 30_f64.to_radians().cos()).abs() < 1e-12);
    assert!((fy - 1.0).abs() < 1e-12);
    assert_eq!(fz, -4.0);
    assert!((frames[0].friction - 0.5).abs() < 1e-12);
    assert!((frames[0].direction - 30_f64.to_radians()).abs() < 1e-12);
    assert!(frames[0].stress.iter().any(|stress| *stress < -1000.0));
}

#[test]
fn contacts_add_up() {
    let contact = &MINIMAL[MINIMAL.find("[[contact]]").unwrap()..];
    let twice = Scene::from_toml(&format!("{MINIMAL}{contact}"), "").unwrap();
    let one = &Scene::from_toml(MINIMAL, "").unwrap().frames().unwrap()[0];
    let two = &twice.frames().unwrap()[0];
    assert_eq!(two.force, one.force.map(|force| 2.0 * force));
    for (two, one) in two.stress.iter().zip(&one.stress) {
        assert!((two - 2.0 * one).abs() < 1e-9 * one.abs());
    }
}

#[test]
fn a_sweep_has_both_ends() {
    let sweep = "[sweep]\ndirection_deg = { from = 0, to = 0.3, step = 0.1 }\n";
    let text = with("direction_deg = 30.0\n", sweep);
    let frames = Scene::from_toml(&text, "").unwrap().frames().unwrap();
    assert_eq!(frames.len(), 4);
    assert!((frames[3].direction - 0.3_f64.to_radians()).abs() < 1e-12);
}

#[test]
fn a_push_along_an_axis_has_no_trace_of_the_other() {
    let sweep = "[sweep]\ndirection_deg = { from = -360, to = 360, step = 90 }\n";
    let text = with("direction_deg = 30.0\n", sweep);
    for frame in Scene::from_toml(&text, "").unwrap().frames().unwrap() {
        assert!(frame.force[0] == 0.0 || frame.force[1] == 0.0, "{frame:?}");
    }
}

#[test]
fn a_rigid_ground_gathers_the_stress() {
    // At its base a layer carries the force on a smaller area than a half-space does at the same depth.
    let layer = Scene::from_toml(MINIMAL, "").unwrap().frames().unwrap();
    let text = with("kind = \"bonded_layer\"\npoisson = 0.49", "kind = \"half_space\"");
    let scene = Scene::from_toml(&text, "").unwrap();
    assert_eq!(scene.medium, Medium::HalfSpace);
    let half_space = scene.frames().unwrap();
    let peak = |frames: &[golden::scene::SceneFrame]| frames[0].stress.iter().fold(0.0_f64, |low, &s| low.min(s));
    assert!(peak(&layer) < peak(&half_space) && peak(&half_space) < 0.5 * peak(&layer));
}

#[test]
fn every_scene_of_the_repository_has_frames() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let scene = Scene::load(&entry.unwrap().path()).unwrap_or_else(|error| panic!("{error}"));
        let frames = scene.frames().unwrap();
        assert_eq!(frames.len(), scene.sweep_deg.len().max(1));
        assert!(frames.iter().flat_map(|frame| &frame.stress).all(|stress| stress.abs() <= 100_000.0));
        count += 1;
    }
    assert!(count >= 4);
}

#[test]
fn the_standing_set_fits_any_ordinary_sensor() {
    for (columns, rows, pitch_mm, depth_mm) in [
        (10, 10, [4.0, 2.0], 3.0),
        (4, 3, [4.0, 4.0], 3.0),
        (2, 2, [10.0, 10.0], 5.0),
        (32, 32, [1.0, 1.5], 1.0),
        (27, 32, [12.0, 12.0], 6.0),
    ] {
        let sensor = Sensor { columns, rows, pitch_mm, depth_mm };
        let frames = Scene::standing(&sensor).frames().unwrap();
        assert_eq!(frames.len(), 36);
        for frame in &frames {
            let low = frame.stress.iter().fold(0.0_f64, |low, &s| low.min(s));
            assert!(low < -10_000.0 && low > -100_000.0, "{sensor:?}: {low}");
            assert!((frame.friction - 0.5).abs() < 1e-12);
        }
    }
}

#[test]
fn the_standing_set_of_the_first_sensor_is_its_scene() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/sensor1-hertz.toml");
    let scene = Scene::load(&path).unwrap();
    let standing = Scene::standing(&scene.sensor);
    let pairs = scene.frames().unwrap();
    for (file, standing) in pairs.iter().zip(standing.frames().unwrap()) {
        for (a, b) in file.stress.iter().zip(&standing.stress) {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }
}

#[test]
fn wrong_files() {
    refused(&with("friction", "fricton"), &["fricton", "friction"]);
    refused(&with("poisson = 0.49\n", ""), &["medium.poisson", "missing"]);
    refused(&with("poisson = 0.49", "poisson = 0.51"), &["medium.poisson", "0.51", "0 to 0.5"]);
    refused(&with("bonded_layer", "water"), &["line 7", "kind = ", "water", "`bonded_layer` or `half_space`"]);
    refused(&with("bonded_layer", "half_space"), &["medium.poisson", "remove"]);
    refused(&with("\"hertz\"", "\"cone\""), &["line 10", "shape = ", "cone", "`hertz`, `rectangle`, `disc`, `punch`"]);
    refused(&with("\"hertz\"", "\"disc\""), &["contact[0].semi_axes_mm", "disc", "radius_mm"]);
    let of_shape =
        |shape: &str, size: &str| with("\"hertz\"", &format!("\"{shape}\"")).replace("semi_axes_mm = [5.0, 4.0]", size);
    refused(&of_shape("rectangle", "radius_mm = 3.0"), &["contact[0].radius_mm", "rectangle", "sides_mm"]);
    refused(&of_shape("rectangle", ""), &["contact[0].sides_mm", "missing", "[10.0, 6.0]"]);
    refused(&of_shape("rectangle", "sides_mm = [4.0, -1.0]"), &["contact[0].sides_mm[1]", "-1", "0.01 to 1000"]);
    refused(&of_shape("punch", "sides_mm = [4.0, 1.0]"), &["contact[0].sides_mm", "punch", "radius_mm"]);
    refused(&of_shape("punch", "radius_mm = 0.0"), &["contact[0].radius_mm", "0.01 to 1000"]);
    refused(&with("semi_axes_mm = [5.0, 4.0]\n", ""), &["contact[0].semi_axes_mm", "missing"]);
    refused(&with("[5.0, 4.0]", "[5.0]"), &["contact[0].semi_axes_mm", "two"]);
    refused(&with("[5.0, 4.0]", "[5.0, 0.0]"), &["contact[0].semi_axes_mm[1]", "0.01 to 1000"]);
    refused(&with("[10.0, 8.0]", "[nan, 8.0]"), &["contact[0].centre_mm[0]", "NaN"]);
    refused(&with("normal_force_n = 4.0", "normal_force_n = -4.0"), &["normal_force_n", "-4", "greater than 0"]);
    refused(&with("friction = 0.5", "friction = -0.5"), &["friction", "-0.5"]);
    refused(&with("direction_deg = 30.0\n", ""), &["direction_deg", "missing", "sweep"]);
    refused(&with("rows = 5", "rows = 0"), &["sensor.rows", "2 to 64"]);
    refused(&MINIMAL[..MINIMAL.find("[[contact]]").unwrap()], &["contact", "missing"]);
    let swept = |range: &str| format!("{MINIMAL}[sweep]\ndirection_deg = {range}\n");
    refused(&swept("{ from = 0, to = 9, step = 0 }"), &["step", "greater than 0"]);
    refused(&swept("{ from = 9, to = 0, step = 1 }"), &["to", "below"]);
    refused(&swept("{ from = 0, to = 360, step = 1e-6 }"), &["step", "360000001"]);
}

#[test]
fn wrong_sensor_errors() {
    for (line, parts) in [
        ("noise = -0.1", ["sensor_errors.noise", "-0.1", "0 to 1"]),
        ("gain_spread = 1.1", ["sensor_errors.gain_spread", "1.1", "0 to 1"]),
        ("seed = -1", ["sensor_errors.seed", "-1", "0 to"]),
        ("quantisation_bits = 1", ["sensor_errors.quantisation_bits", "is 1", "2 to 32"]),
        ("full_scale_pa = 0", ["sensor_errors.full_scale_pa", "is 0", "greater than 0"]),
        ("dead = [3, 30]", ["sensor_errors.dead[1]", "is 30", "0 to 29"]),
        ("saturated = [-1]", ["sensor_errors.saturated[0]", "is -1", "0 to 29"]),
        ("dead = [3, 5]\nsaturated = [5]", ["sensor_errors.saturated", "taxel 5", "one of the two"]),
        ("nois = 0.1", ["nois", "line 17", "noise"]),
    ] {
        refused(&format!("{MINIMAL}[sensor_errors]\n{line}\n"), &parts);
    }
}

#[test]
fn sensor_errors_change_the_stress_and_not_the_truth() {
    let clean = Scene::from_toml(MINIMAL, "").unwrap().frames().unwrap();
    let with_errors = |lines: &str| {
        let scene = Scene::from_toml(&format!("{MINIMAL}[sensor_errors]\n{lines}\n"), "").unwrap();
        scene.frames().unwrap()
    };
    assert_eq!(with_errors("seed = 5"), clean);
    let all = "seed = 5\nnoise = 0.01\ngain_spread = 0.02\nquantisation_bits = 10\nfull_scale_pa = 102400\n\
        dead = [7]\nsaturated = [8]";
    let [frame] = with_errors(all).try_into().unwrap();
    assert_eq!((frame.force, frame.friction), (clean[0].force, clean[0].friction));
    let peak = clean[0].stress.iter().fold(0.0_f64, |peak, stress| peak.max(stress.abs()));
    for (taxel, (&found, &clean)) in frame.stress.iter().zip(&clean[0].stress).enumerate() {
        match taxel {
            7 => assert_eq!(found, 0.0),
            8 => assert_eq!(found, -102_400.0),
            _ => {
                // Steps of 200 Pa; noise and gains within five deviations.
                assert_eq!(found % 200.0, 0.0);
                assert!((found - clean).abs() < 0.15 * peak + 100.0, "taxel {taxel}: {found} for {clean}");
            }
        }
    }
    assert_eq!(with_errors(all)[0], frame, "seeded");
    assert_ne!(with_errors(&all.replace("seed = 5", "seed = 6"))[0], frame);
}

#[test]
fn every_shape_presses_with_its_force_on_either_medium() {
    // A grid so fine and wide that the sum over the taxels is the force.
    let text = with("columns = 6\nrows = 5\npitch_mm = [4.0, 4.0]", "columns = 32\nrows = 32\npitch_mm = [1.5, 1.5]")
        .replace("[10.0, 8.0]", "[23.0, 24.0]");
    for (shape, size) in [
        ("hertz", "semi_axes_mm = [5.0, 4.0]"),
        ("rectangle", "sides_mm = [9.0, 5.0]"),
        ("disc", "radius_mm = 4.0"),
        ("punch", "radius_mm = 4.0"),
    ] {
        let text = text.replace("\"hertz\"", &format!("\"{shape}\"")).replace("semi_axes_mm = [5.0, 4.0]", size);
        let half_space = text.replace("kind = \"bonded_layer\"\npoisson = 0.49", "kind = \"half_space\"");
        for (text, share) in [(&text, 0.997..1.001), (&half_space, 0.985..1.0)] {
            let frame = &Scene::from_toml(text, "").unwrap().frames().unwrap()[0];
            let sum: f64 = frame.stress.iter().sum::<f64>() * 2.25e-6 / frame.force[2];
            assert!(share.contains(&sum), "{shape}: {sum}");
        }
    }
}

#[test]
fn in_a_sweep_contacts_keep_their_angle_to_each_other() {
    // Equal forces, opposed: nothing is left of them in any direction but a turn.
    let contact = &MINIMAL[MINIMAL.find("[[contact]]").unwrap()..];
    let other = contact.replace("30.0", "210.0").replace("[10.0, 8.0]", "[4.0, 8.0]");
    let text = format!("{MINIMAL}{other}[sweep]\ndirection_deg = {{ from = 0, to = 315, step = 45 }}\n");
    let frames = Scene::from_toml(&text, "").unwrap().frames().unwrap();
    assert_eq!(frames.len(), 8);
    for frame in &frames {
        assert!(frame.force[0].hypot(frame.force[1]) < 1e-12 && frame.friction < 1e-12);
        assert_eq!(frame.force[2], -8.0);
    }
    assert_ne!(frames[0].stress, frames[4].stress);
}

#[test]
fn a_depth_out_of_proportion_is_refused() {
    let text = with("depth_mm = 3.0", "depth_mm = 0.01");
    let error = Scene::from_toml(&text, "").unwrap().frames().unwrap_err();
    let message = error.to_string();
    assert!(message.contains("contact 1") && message.contains("0.01 mm"), "{message}");
}

#[test]
fn contacts_of_other_kinds_are_read_and_make_frames() {
    let plain = Scene::from_toml(MINIMAL, "").unwrap().frames().unwrap();
    for (keys, tangential) in [
        ("tilt = [0.5, -0.3]", 2.0),
        ("turn_deg = 30", 2.0),
        ("edge = 1.5", 2.0),
        ("shear = \"held\"\nheld = 0.5", 1.0),
        ("shear = \"even\"", 2.0),
        ("spin = 0.0\ntilt = [0.1, 0.0]", 2.0),
    ] {
        let frames = Scene::from_toml(&format!("{MINIMAL}{keys}\n"), "").unwrap().frames().unwrap();
        let [x, y, z] = frames[0].force;
        assert!((x.hypot(y) - tangential).abs() < 1e-9 && (z + 4.0).abs() < 1e-9, "{keys}: {:?}", frames[0].force);
        assert_ne!(frames[0].stress, plain[0].stress, "{keys}");
    }
    let spinning = Scene::from_toml(&format!("{MINIMAL}spin = 2.0\n"), "").unwrap().frames().unwrap();
    assert!(spinning[0].friction < 0.4, "what turns pushes less: {}", spinning[0].friction);
    // A frame is that of its own direction: tilt and push turn together.
    let sweep = with(
        "direction_deg = 30.0\n",
        "tilt = [0.5, 0.0]\n[sweep]\ndirection_deg = { from = 0, to = 180, step = 180 }\n",
    );
    let frames = Scene::from_toml(&sweep, "").unwrap().frames().unwrap();
    assert!((frames[0].force[0] + frames[1].force[0]).abs() < 1e-9);
}

#[test]
fn taxels_average_and_layers_are_deeper_than_they_should_be() {
    let plain = Scene::from_toml(MINIMAL, "").unwrap().frames().unwrap();
    let tiny = with("depth_mm = 3.0", "depth_mm = 3.0\ntaxel_mm = [0.001, 0.001]");
    let peak = plain[0].stress.iter().fold(0.0_f64, |peak, s| peak.max(s.abs()));
    let far = |text: &str| {
        let frames = Scene::from_toml(text, "").unwrap().frames().unwrap();
        let pairs = frames[0].stress.iter().zip(&plain[0].stress);
        pairs.fold(0.0_f64, |far, (a, b)| far.max((a - b).abs())) / peak
    };
    assert!(far(&tiny) < 2e-5, "{}", far(&tiny));
    let whole = with("depth_mm = 3.0", "depth_mm = 3.0\ntaxel_mm = [4.0, 4.0]");
    assert!((0.01..0.5).contains(&far(&whole)), "{}", far(&whole));
    let deeper = format!("{MINIMAL}[sensor_errors]\ndepth = 0.1\n");
    let true_depth = Scene::from_toml(&with("depth_mm = 3.0", "depth_mm = 3.3"), "").unwrap().frames().unwrap();
    let found = Scene::from_toml(&deeper, "").unwrap().frames().unwrap();
    for (a, b) in found[0].stress.iter().zip(&true_depth[0].stress) {
        assert!((a - b).abs() < 1e-9 * peak);
    }
}

#[test]
fn keys_of_contacts_that_contradict_themselves() {
    let refused_with = |keys: &str, parts: &[&str]| refused(&format!("{MINIMAL}{keys}\n"), parts);
    refused_with("tilt = [0.8, 0.4]", &["contact[0].tilt", "pull", "at most 1"]);
    refused_with("tilt = [0.8]", &["contact[0].tilt", "two"]);
    refused_with("edge = -0.7", &["contact[0].edge", "-0.5"]);
    refused_with("shear = \"held\"", &["contact[0].held", "is missing"]);
    refused_with("held = 0.5", &["contact[0].held", "shear = \"held\""]);
    refused_with("shear = \"held\"\nheld = 1.5", &["contact[0].held", "0 to 1"]);
    refused_with("shear = \"held\"\nheld = 0.5\ntilt = [0.1, 0.0]", &["contact[0].shear", "Hertz"]);
    refused_with("shear = \"even\"\nspin = 1.0", &["contact[0].spin", "slides"]);
    refused_with("shear = \"rolling\"", &["line 16", "shear = ", "rolling", "`sliding`, `held`, `even`"]);
    refused(&with("depth_mm = 3.0", "depth_mm = 3.0\ntaxel_mm = [5.0, 1.0]"), &["sensor.taxel_mm[0]", "pitch"]);
    refused(&with("depth_mm = 3.0", "depth_mm = 3.0\ntaxel_mm = 2.0"), &["taxel_mm", "[2.0, 2.0]"]);
}

/// The scene that the docs show has every key that they speak of, and makes frames.
#[test]
fn the_scene_of_the_docs_is_one() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reference/files.md"))
        .expect("a page");
    let mut blocks = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let text = blocks.find(|block| block.contains("[medium]")).expect("a scene");
    let mut scene = Scene::from_toml(text, "docs/reference/files.md").expect("a scene as it is written");
    assert_eq!(scene.frames().expect("frames").len(), 36);
    // What it has as a remark is the other way to be held.
    let held = text
        .replace("shear = \"sliding\"", "shear = \"held\"")
        .replace("spin = 1.0", "")
        .replace("# held = 0.5", "held = 0.5");
    scene = Scene::from_toml(&held.replace("edge = 2.0", "").replace("tilt = [0.6, 0.0]", ""), "held").expect("held");
    scene.sweep_deg.truncate(1);
    assert_eq!(scene.frames().expect("frames").len(), 1);
}
