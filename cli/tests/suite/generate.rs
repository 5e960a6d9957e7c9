//! Designs to hardware: folders, files, boards.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use golden::calibrate::{Settings, calibrate};
use golden::design::{Estimator, Samples, Scaling, Tension};
use tempfile::TempDir;

use crate::support::{design_text, sptfra_in};

/// Runs `hdl-gen` in `folder`.
/// What it prints on success.
pub fn good(folder: &Path, arguments: &[&str]) -> String {
    let output = sptfra_in(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    // On a machine that is slow enough it says how long it has been at work.
    let is_progress = |line: &str| {
        line.rsplit_once(", ")
            .and_then(|(_, time)| time.strip_suffix(" s"))
            .is_some_and(|time| time.parse::<u64>().is_ok())
    };
    assert!(output.status.success() && errors.lines().all(is_progress), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// A folder with `pad.toml`, a good design.
pub fn folder_with_design(hardware: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = design_text("pad", [4, 3], [4.0, 2.0], 3.0, &format!("[hardware]\n{hardware}"));
    fs::write(folder.path().join("pad.toml"), text).unwrap();
    folder
}

/// Every file below a folder with its contents.
pub fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

#[test]
fn from_a_new_design_to_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    assert!(good(here, &["new", "my_pad", "--paper-sensor", "1"]).contains("my_pad.toml"));
    let text = fs::read_to_string(here.join("my_pad.toml")).unwrap();
    assert!(
        text.contains("\nformat = 3\n")
            && text.contains("\nname = \"my_pad\"\n")
            && text.lines().filter(|line| line.contains('#')).count() > 15
    );
    assert!(good(here, &["inspect", "my_pad.toml"]).starts_with("my_pad\n"));
    let said = good(here, &["generate", "my_pad.toml"]);
    assert!(said.starts_with("rtl-out/my_pad: ") && said.contains("100 taxels, 16 lanes"), "{said}");
    let files = contents(&here.join("rtl-out/my_pad"));
    for name in ["rtl/my_pad.v", "rom/my_pad_slots.mem", "mcsr/00_C33inv.txt", "metadata.json", "design.toml"] {
        assert!(files.contains_key(name), "no {name}");
    }
    let beside: Vec<_> = fs::read_dir(here.join("rtl-out")).unwrap().collect();
    assert_eq!(beside.len(), 1, "nothing is left beside the folder");
}

/// `contacts` is for software: hardware, its figures and its files are those of a design for one contact.
#[test]
fn several_contacts_change_no_hardware() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let of = |keys: &str| design_text("pad", [4, 3], [4.0, 2.0], 3.0, &format!("dead = [3]\n[algorithm]\n{keys}"));
    fs::write(here.join("one.toml"), of("count_contacts = true\n")).unwrap();
    fs::write(here.join("several.toml"), of("count_contacts = true\ncontacts = 3\n")).unwrap();
    let [one, several] = ["one.toml", "several.toml"].map(|name| good(here, &["inspect", name]));
    let line = |text: &str| text.lines().find(|line| line.contains("  contacts ")).expect("a line").to_owned();
    assert!(line(&several).contains("counted in ") && line(&several).contains("up to 3 separated by software"));
    assert_eq!(several.replace(&line(&several), &line(&one)), one);
    let json =
        |name: &str| -> serde_json::Value { serde_json::from_str(&good(here, &["inspect", name, "--json"])).unwrap() };
    assert_eq!(json("several.toml")["contacts"], 3);
    assert!(json("one.toml").get("contacts").is_none());
    let [one, several] = ["one", "several"].map(|name| {
        good(here, &["generate", &format!("{name}.toml"), "--out", name]);
        let mut files = contents(&here.join(name));
        files.retain(|path, _| path.starts_with("rtl/sptfra_") || path.starts_with("rom/"));
        files
    });
    assert!(one.len() > 20 && one == several, "Verilog or ROM files differ");
}

/// Deeper than 1.5 pitches a new design is regularised: without it there would be no hardware.
#[test]
fn a_new_design_of_a_deep_sensor_has_hardware() {
    let design = new_design(&["--pitch-mm", "4", "4", "--depth-mm", "16"]);
    assert!(design.algorithm.regularisation.factor() > 0.0);
    hdl_gen::plan::Plan::new(&design).unwrap();
}

/// What `sptfra new` writes with some options.
fn new_design(options: &[&str]) -> golden::design::Design {
    let folder = tempfile::tempdir().unwrap();
    good(folder.path(), &[&["new", "full", "--paper-sensor", "1"], options].concat());
    golden::design::Design::load(&folder.path().join("full.toml")).unwrap()
}

#[test]
fn the_new_designs_values_are_the_defaults() {
    let text = design_text("full", [5, 4], [4.0, 2.0], 3.0, "");
    let mut defaults = golden::design::Design::from_toml(&text, "full.toml").unwrap();
    // But for the count of contacts, which designs without a word of it never had.
    defaults.algorithm.count_contacts = true;
    // And for each frame's own range, likewise.
    defaults.hardware.scaling = Scaling::PerFrame;
    let small = ["--columns", "5", "--rows", "4"];
    let line = new_design(&[&small[..], &["--estimator", "line"]].concat());
    assert!(line.algorithm.standard_error.is_some());
    defaults.algorithm.standard_error = line.algorithm.standard_error;
    defaults.algorithm.expected_error.clone_from(&line.algorithm.expected_error);
    assert_eq!(line, defaults);
    // And for the estimator, which is the better one.
    let mut joint = new_design(&small);
    assert_eq!(joint.algorithm.estimator, Estimator::Joint);
    (joint.algorithm.estimator, joint.algorithm.joint) = (Estimator::Line, defaults.algorithm.joint.clone());
    joint.algorithm.standard_error = defaults.algorithm.standard_error;
    joint.algorithm.expected_error.clone_from(&defaults.algorithm.expected_error);
    assert_eq!(joint, defaults);
}

#[test]
fn a_new_designs_constants_are_those_of_its_sensor() {
    let shipped = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs").join(name);
        golden::design::Design::load(&path).unwrap().algorithm.joint
    };
    for (pitch_y, name) in [("2", "sensor1-fast.toml"), ("4", "sensor2-fast.toml")] {
        let options = ["--columns", "10", "--rows", "10", "--pitch-mm", "4", pitch_y, "--depth-mm", "3"];
        let mut design = new_design(&options);
        let (calibrated_for, sensor) = (&design.algorithm.joint.calibrated_for, format!("4 x {pitch_y} mm, 3 mm deep"));
        assert!(calibrated_for.as_ref().is_some_and(|known| known.contains(&sensor)), "{calibrated_for:?}");
        assert_eq!(design.algorithm.joint.correction, None);
        // The shipped ones are for more noise.
        design.input.noise = 0.01;
        let (found, shipped) = (calibrate(&design, &Settings::constants(), &mut || ()).unwrap(), shipped(name));
        assert!((found.gain / shipped.gain - 1.0).abs() < 5e-3, "{name}: {} {}", found.gain, shipped.gain);
        for (found, shipped) in found.friction_correction.into_iter().zip(shipped.friction_correction) {
            assert!((found - shipped).abs() < 0.02, "{name}: {found} {shipped}");
        }
    }
    let other = new_design(&["--columns", "6", "--rows", "5", "--pitch-mm", "3.5", "3", "--depth-mm", "2.5"]);
    assert_eq!((other.sensor.columns, other.sensor.rows, other.sensor.pitch_mm), (6, 5, [3.5, 3.0]));
    // The estimator's gain on half the depth of a pitch is far from one.
    assert!(other.algorithm.joint.gain > 1.05, "{}", other.algorithm.joint.gain);
}

#[test]
fn a_new_design_takes_what_the_sensors_maker_knows() {
    let line = ["--columns", "4", "--rows", "3", "--estimator", "line"];
    let of = |options: &[&str]| new_design(&[&line[..], options].concat());
    let design = of(&["--counts", "12", "--full-scale-pa", "90000"]);
    let step = design.input.pa_per_count.expect("counts");
    assert!((step + 90_000.0 / 4095.0).abs() < 1e-9, "{step}");
    let hardware = &design.hardware;
    assert_eq!(hardware.full_scale_pa.to_bits(), 90_000_f64.to_bits());
    // The largest count may have been clipped, and says so; the one below it has not.
    assert!(design.input.to_pa(0, 4095.0).abs() >= hardware.full_scale_in_frames());
    assert!(design.input.to_pa(0, 4094.0).abs() < hardware.full_scale_in_frames());
    let plain = of(&[]);
    assert_eq!((plain.input.pa_per_count, plain.hardware.samples), (None, Samples::Float32));
    // Integers that hold every count, and a negative one after a tare if there is room.
    assert_eq!(hardware.samples, Samples::Int16);
    for (bits, samples) in [("15", Samples::Int16), ("16", Samples::Uint16), ("17", Samples::Float32)] {
        let design = of(&["--counts", bits]);
        let largest = f64::from(bits.parse::<i32>().expect("bits")).exp2() - 1.0;
        assert!(design.hardware.samples == samples && samples.takes(largest) && samples.takes(0.0), "{bits} bits");
    }
}

#[test]
fn a_new_design_without_tension_is_fitted_to_what_such_taxels_read() {
    let sensor = ["--columns", "6", "--rows", "6", "--pitch-mm", "4", "4"];
    let [reads, clipped] =
        ["read", "clipped"].map(|tension| new_design(&[&sensor[..], &["--tension", tension]].concat()));
    assert_eq!([reads.input.tension, clipped.input.tension], [Tension::Read, Tension::Clipped]);
    let joint = &clipped.algorithm.joint;
    assert!(joint.calibrated_for.as_deref().is_some_and(|sensor| sensor.contains("tension clipped")), "{joint:?}");
    let [c1, other] = [joint, &reads.algorithm.joint].map(|joint| joint.friction_correction[0]);
    assert!((c1 - other).abs() > 0.01, "fitted to other frames: {c1} {other}");
}

#[test]
fn new_writes_into_another_folder() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("designs")).unwrap();
    good(folder.path(), &["new", "pad", "--dir", "designs", "--paper-sensor", "1", "--columns", "4", "--rows", "4"]);
    assert!(contents(folder.path()).into_keys().eq(["designs/pad.toml"]));
}

#[test]
fn generating_again_changes_nothing() {
    let folder = folder_with_design("");
    good(folder.path(), &["generate", "pad.toml", "--out", "a/b/out"]);
    let before = contents(folder.path());
    good(folder.path(), &["generate", "pad.toml", "--out", "a/b/out"]);
    assert_eq!(contents(folder.path()), before);
    good(folder.path(), &["generate", "pad.toml", "--out", "elsewhere"]);
    assert_eq!(contents(&folder.path().join("elsewhere")), contents(&folder.path().join("a/b/out")));
}

#[test]
fn a_design_that_became_smaller_leaves_no_file_of_the_larger() {
    let folder = folder_with_design("lanes = 12");
    good(folder.path(), &["generate", "pad.toml", "--out", "out"]);
    let text = fs::read_to_string(folder.path().join("pad.toml")).unwrap().replace("lanes = 12", "lanes = 4");
    fs::write(folder.path().join("pad.toml"), text).unwrap();
    good(folder.path(), &["generate", "pad.toml", "--out", "out"]);
    let files = contents(&folder.path().join("out"));
    assert_eq!(files.keys().filter(|name| name.contains("values_pe")).count(), 1);
}

#[test]
fn no_progress_is_drawn_off_a_terminal() {
    let folder = folder_with_design("");
    let output = sptfra_in(folder.path(), &["generate", "pad.toml"]);
    assert!(output.stderr.is_empty() && !output.stdout.contains(&0x1b));
}

#[test]
fn every_command_has_help() {
    let folder = tempfile::tempdir().unwrap();
    for command in ["new", "inspect", "generate"] {
        assert!(good(folder.path(), &[command, "--help"]).contains("Usage: sptfra"));
    }
    assert!(good(folder.path(), &["--version"]).starts_with("sptfra "));
}

/// A board that its user describes is in the scripts and among the device trees as those that are here, for its device.
#[test]
fn a_board_of_ones_own_is_one_more() {
    let folder = folder_with_design("part = \"xczu3eg-sbva484-1-e\"");
    let here = folder.path();
    let text = include_str!("../../../hdl-gen/boards/zcu104.toml");
    let own = text.replace("xczu7ev-ffvc1156-2-e", "xczu3eg-sbva484-1-i").replace("\"ZCU104\"", "\"My carrier\"");
    fs::write(here.join("my-carrier.toml"), own.replace("1728", "10").replace("0xA0000000", "0xB0000000")).unwrap();
    let said = good(here, &["generate", "pad.toml", "--board", "my-carrier.toml"]);
    assert!(said.contains("warning: too much for xczu3eg-sbva484-1-i, which has 10 DSP48E2"), "{said}");
    let files = contents(&here.join("rtl-out/pad"));
    let script = String::from_utf8(files["vivado/block_design.tcl"].clone()).unwrap();
    assert!(script.contains("my-carrier {title {My carrier} pattern") && script.contains("dma 0xB0000000"), "{script}");
    let overlays: Vec<_> = files.keys().filter(|path| path.starts_with("linux/")).collect();
    assert_eq!(overlays, ["linux/pad_my-carrier.dtso"]);
    // Without it the folder is that of any design for this part; with it for another part it says what to change.
    good(here, &["generate", "pad.toml", "--out", "without"]);
    assert!(!contents(&here.join("without")).keys().any(|path| path.starts_with("linux/")));
    let other = folder_with_design("");
    fs::copy(here.join("my-carrier.toml"), other.path().join("my-carrier.toml")).unwrap();
    let said = good(other.path(), &["generate", "pad.toml", "--board", "my-carrier.toml"]);
    assert!(said.contains("warning: the My carrier has a xczu3eg-sbva484-1-i, the design is for xczu9eg"), "{said}");
}
