//! Contacts on the command line: their true forces, those found, and the errors of each.

use std::fs;
use std::path::Path;
use std::process::Output;

use golden::contacts::ContactForces;
use golden::design::Design;
use golden::forces::{columns, read_contacts};

use crate::support::{sptfra_in, workspace};

fn done(folder: &Path, arguments: &[&str]) -> Output {
    let output = sptfra_in(folder, arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

/// A folder with a design for three contacts, calibrated, and the frame of two without what is wrong with the sensor.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(workspace("designs/sensor1-fast.toml")).unwrap();
    let text = text.replacen("[algorithm]\n", "[algorithm]\ncontacts = 3\n", 1);
    fs::write(folder.path().join("pad.toml"), text).unwrap();
    let weights = "sensor1-fast.weights.csv";
    fs::copy(workspace("designs").join(weights), folder.path().join(weights)).unwrap();
    let scene = fs::read_to_string(workspace("scenes/two-contacts.toml")).unwrap();
    let scene = scene.split("[sensor_errors]").next().unwrap().to_owned();
    fs::write(
        folder.path().join("two.toml"),
        scene + "[sweep]\ndirection_deg = { from = 0.0, to = 300.0, step = 60.0 }\n",
    )
    .unwrap();
    folder
}

#[test]
fn the_forces_of_each_contact_are_told_and_judged() {
    let folder = folder();
    let here = folder.path();
    done(here, &["scene", "two.toml", "--out", "f.csv"]);
    let truth = fs::read_to_string(here.join("f.forces.csv")).unwrap();
    let header = columns(2, 0).join(",");
    let of = |contact: usize| {
        let names = ["taxels", "status", "x (m)", "y (m)", "F_x (N)", "F_y (N)", "F_z (N)", "mu", "standard_error (N)"];
        names.map(|name| format!("contact{contact}_{name}")).join(",")
    };
    let torque = |contact: usize| ["x", "y", "z"].map(|axis| format!("contact{contact}_T_{axis} (N m)")).join(",");
    assert!(header.ends_with(&[of(1), of(2), torque(1), torque(2)].join(",")), "{header}");
    assert_eq!(truth.lines().next(), Some(header.as_str()));
    let sensor = Design::load(&here.join("pad.toml")).unwrap().sensor;
    let contacts = read_contacts(&here.join("f.forces.csv"), 6, &sensor).unwrap().unwrap();
    let close = |found: &[f64], expected: &[f64]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(close(&contacts[0][0].force, &[0.0, 1.2, -3.0]) && close(&contacts[0][1].force, &[0.0, -1.2, -2.0]));
    assert!(close(&contacts[0][0].centre_m, &[0.010, 0.006]) && close(&contacts[0][1].centre_m, &[0.027, 0.012]));

    // About the middle, 18 and 9 mm from the first taxel: arms of (-8, -3) and (9, 3) mm.
    assert!(close(&contacts[0][0].torque, &[0.009, -0.024, -0.0096]), "{:?}", contacts[0]);
    assert!(close(&contacts[0][1].torque, &[-0.006, 0.018, -0.0108]), "{:?}", contacts[0]);
    // A file of before, without them, is read as ever.
    let (mut lines, older) = (truth.lines(), here.join("older.csv"));
    let without = |line: &str| line.split(',').take(31).collect::<Vec<_>>().join(",") + "\n";
    let header = without(lines.next().unwrap());
    fs::write(&older, header + &lines.map(without).collect::<String>()).unwrap();
    let read = read_contacts(&older, 6, &sensor).unwrap().unwrap();
    let bare = |contact: &ContactForces| ContactForces { torque: [0.0; 3], ..*contact };
    assert_eq!(read[0], contacts[0].iter().map(bare).collect::<Vec<_>>());
    // Contacts of an older version's names would go unread.
    for quote in ["", "\""] {
        let oldest = truth.replace("contact1_", &format!("{quote}body0_")).replace("contact2_", "body1_");
        fs::write(here.join("oldest.csv"), oldest).unwrap();
        let error = read_contacts(&here.join("oldest.csv"), 6, &sensor).unwrap_err().to_string();
        assert!(["oldest.csv", "body0_taxels", "contact1_taxels"].iter().all(|part| error.contains(part)), "{error}");
    }

    let solve = ["solve", "pad.toml", "--frames", "f.csv", "--out", "out.csv"];
    let judged = [&solve[..], &["--reference", "f.forces.csv"]].concat();
    let said = String::from_utf8(done(here, &judged).stdout).unwrap();
    assert!(said.contains("6 of 6 frames have the right number of contacts"), "{said}");
    assert!(
        ["errors of each contact", "centre, mm", "T_z over F_z, mm"].iter().all(|row| said.contains(row)),
        "{said}"
    );
    let json = done(here, &[&judged[..], &["--json"]].concat()).stdout;
    let report: serde_json::Value = serde_json::from_slice(&json).unwrap();
    assert_eq!((&report["contacts"]["frames"], &report["contacts"]["right"]), (&6.into(), &6.into()));
    let error = |of: &str, at: &str| report["contacts"][of][at].as_f64().unwrap();
    assert!(error("tangential", "worst") < 20.0 && error("normal", "worst") < 8.0, "{report}");
    assert!(error("tangential", "worst") > 0.1, "{report}");
    assert!((0.1..2.0).contains(&error("centre_mm", "worst")), "{report}");
    assert!((0.01..3.0).contains(&error("turn_mm", "worst")), "{report}");
    // Of true forces without torques nothing is said of them.
    let older = [&solve[..], &["--reference", "older.csv"]].concat();
    let said = String::from_utf8(done(here, &older).stdout).unwrap();
    assert!(said.contains("centre, mm") && !said.contains("T_z"), "{said}");

    // The same lines from a filter, with a field and as an array.
    let lines = fs::read_to_string(here.join("out.csv")).unwrap();
    assert_eq!(lines.lines().next(), Some(columns(3, 0).join(",").as_str()));
    let filtered = done(here, &["solve", "pad.toml", "--frames", "f.csv", "--out", "-"]).stdout;
    assert_eq!(String::from_utf8(filtered).unwrap(), lines);
    done(here, &["solve", "pad.toml", "--frames", "f.csv", "--out", "field.csv", "--field"]);
    let field = fs::read_to_string(here.join("field.csv")).unwrap();
    assert_eq!(field.lines().next(), Some(columns(3, 100).join(",").as_str()));
    done(here, &["solve", "pad.toml", "--frames", "f.csv", "--out", "out.npy"]);
    let [array, text, with_field] =
        ["out.npy", "out.csv", "field.csv"].map(|name| read_contacts(&here.join(name), 6, &sensor).unwrap().unwrap());
    assert_eq!(array, text);
    assert_eq!(with_field, text);
    assert!(text.iter().all(|contacts| contacts.len() == 2), "the third of three records is empty");
}

#[test]
fn a_scene_of_one_contact_judges_the_only_record() {
    let folder = folder();
    let here = folder.path();
    done(here, &["scene", "--design", "pad.toml", "--out", "f.csv"]);
    let header = fs::read_to_string(here.join("f.forces.csv")).unwrap().lines().next().unwrap().to_owned();
    assert_eq!(header, columns(0, 0).join(","));
    let judged = ["solve", "pad.toml", "--frames", "f.csv", "--out", "out.csv", "--reference", "f.forces.csv"];
    let said = String::from_utf8(done(here, &judged).stdout).unwrap();
    assert!(said.contains("36 of 36 frames have the right number of contacts"), "{said}");
    // Without records there is no telling what each of two does.
    done(here, &["scene", "two.toml", "--out", "f.csv"]);
    let truth = fs::read_to_string(here.join("f.forces.csv")).unwrap();
    let short: String =
        truth.lines().map(|line| line.split(',').take(13).collect::<Vec<_>>().join(",") + "\n").collect();
    fs::write(here.join("f.forces.csv"), short).unwrap();
    let said = String::from_utf8(done(here, &judged).stdout).unwrap();
    assert!(said.contains("e_Fx") && !said.contains("each contact"), "{said}");
}
