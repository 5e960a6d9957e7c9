//! Recordings without load: the tare that they give.

use std::fs;

use golden::design::Design;
use golden::frames::write_frames;
use golden::unloaded::Unloaded;

use crate::support::{PLAIN, sptfra};

const TAXELS: usize = 78;
const PA_PER_COUNT: f64 = -24.4;

fn text(more: &str) -> String {
    format!(
        "{PLAIN}name = \"mat\"\n[sensor]\ncolumns = 6\nrows = 13\npitch_mm = [3.4, 3.4]\ndepth_mm = 3.0\n\
         pa_per_count = {PA_PER_COUNT}\n{more}"
    )
}

fn mat(more: &str) -> Design {
    Design::from_toml(&text(more), "mat.toml").unwrap()
}

/// A number from 0 to 1 of two numbers.
fn uniform(a: usize, b: usize) -> f64 {
    let mut bits = (a as u64) << 32 ^ b as u64 ^ 0x9e37_79b9_7f4a_7c15;
    for _ in 0..2 {
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
    }
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// Nearly Gaussian, of deviation 1.
fn noise(frame: usize, taxel: usize) -> f64 {
    (0..12).map(|part| uniform(frame * TAXELS + taxel, part)).sum::<f64>() - 6.0
}

/// Offsets from 20 to 100 counts.
fn offset(taxel: usize) -> f64 {
    20.0 + 80.0 * uniform(taxel, 99)
}

fn frames(count: usize, reads: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..count).map(|frame| (0..TAXELS).map(|taxel| reads(frame, taxel).round() + 0.0).collect()).collect()
}

/// Unloaded frames that were recorded under the largest load of the others are no tare.
#[test]
fn a_tare_under_load_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [design, tare, loaded, written] = ["mat.toml", "tare.csv", "loaded.csv", "tared.csv"]
        .map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    fs::write(&design, text("")).unwrap();
    let bump = |frame: usize, taxel: usize| offset(taxel) + if taxel == 40 { 100.0 * (frame % 10) as f64 } else { 0.0 };
    for (name, recording) in
        [(&tare, frames(30, |frame, taxel| bump(9, taxel) + 2.0 * noise(frame, taxel))), (&loaded, frames(30, bump))]
    {
        write_frames(name.as_ref(), &recording).unwrap();
    }
    let said = sptfra(&["check", &design, "--frames", &tare, "--unloaded", "--loaded", &loaded, "--out", &written]);
    let wrong = String::from_utf8(said.stderr).unwrap();
    assert!(wrong.contains("--loaded: 27 of 27 frames read less load than the unloaded ones"), "{wrong}");
    assert!(!said.status.success() && !std::path::Path::new(&written).exists());
}

#[test]
fn the_calibration_takes_the_offsets_off() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [design, rest, out] = ["mat.toml", "rest.csv", "mat.calibration.csv"].map(path);
    fs::write(&design, text("calibration = \"gains.csv\"\n")).unwrap();
    let gains: String = (0..TAXELS).map(|taxel| format!("{},1.0\n", 1.0 + 0.001 * taxel as f64)).collect();
    fs::write(path("gains.csv"), gains).unwrap();
    let recording =
        frames(100, |frame, taxel| if taxel == 9 { 0.0 } else { offset(taxel) + 2.0 * noise(frame, taxel) });
    write_frames(rest.as_ref(), &recording).unwrap();
    let asked = ["check", &design, "--frames", &rest, "--unloaded", "--out", &out];
    let said = sptfra(&asked);
    let lines = String::from_utf8(said.stdout).unwrap();
    assert!(said.status.success() && said.stderr.is_empty(), "{:?}", String::from_utf8(said.stderr));
    assert!(lines.lines().count() <= 8, "{lines}");
    for part in [
        "Dead: [9]",
        "noise_floor_pa = 1",
        "noise = { deviation = 2.",
        "calibration = \"mat.calibration.csv\"",
        "--json",
    ] {
        assert!(lines.contains(part), "no {part:?} in: {lines}");
    }
    let report: serde_json::Value =
        serde_json::from_slice(&sptfra(&[&asked[..], &["--json"]].concat()).stdout).unwrap();
    assert_eq!((&report["dead"][0], report["taxels"].as_array().unwrap().len()), (&serde_json::json!(9), TAXELS));
    assert_eq!(report["beyond"]["readings"], 0);

    // Relative to contacts that read 1000 counts above their offsets, in every second frame.
    let contacts = frames(20, |frame, taxel| {
        let load = if taxel == 40 && frame % 2 == 0 { 1000.0 / 1.04 } else { 0.0 };
        if taxel == 9 { 0.0 } else { offset(taxel) + load }
    });
    let loaded = path("loaded.csv");
    write_frames(loaded.as_ref(), &contacts).unwrap();
    let said = sptfra(&["check", &design, "--frames", &rest, "--unloaded", "--loaded", &loaded]);
    let lines = String::from_utf8(said.stdout).unwrap();
    let line = lines.lines().find(|line| line.starts_with("noise = ")).expect("a noise");
    let with_key = path("with-key.toml");
    // Both tables as they are printed.
    let (_, tables) = lines.split_once("[sensor]\n").expect("a table");
    fs::write(&with_key, text(&format!("calibration = \"gains.csv\"\n{tables}"))).unwrap();
    let measured = Design::load(with_key.as_ref()).unwrap().input.measured_noise.expect("as it is printed");
    // Of counts: two, and a thousand.
    assert!((1.9..2.3).contains(&measured.deviation) && (990.0..=1000.0).contains(&measured.largest), "{line}");
    // At this noise, not the design's, the error is told.
    let errors = "noise = [0.0, 0.004, 0.02], median = [5.0, 5.0, 80.0], p95 = [9.0, 9.0, 90.0]";
    let keys = format!("noise = 0.02\n[algorithm]\nexpected_error = {{ {errors} }}\n");
    let told = path("told.toml");
    fs::write(&told, text(&keys)).unwrap();
    let contacts = ["--unloaded", "--loaded", &loaded];
    for (loaded, median, noise, words) in [
        (&contacts[..], 5.0, "At a noise of 0.2", "within 5.0 % of F_z"),
        (&contacts[..1], 80.0, "This noise is the design's.", "within 80 %"),
    ] {
        let asked = [&["check", &told, "--frames", &rest], loaded].concat();
        let said = |more: &[&str]| String::from_utf8(sptfra(&[&asked[..], more].concat()).stdout).unwrap();
        assert!(
            said(&[]).contains(noise) && said(&[]).contains(&format!(" expect the shear {words}")),
            "{}",
            said(&[])
        );
        let report: serde_json::Value = serde_json::from_str(&said(&["--json"])).unwrap();
        assert_eq!(report["expected_error"]["median_percent"], median);
    }
    let said = sptfra(&["check", &design, "--frames", &rest, "--unloaded", "--loaded", &rest]);
    let wrong = String::from_utf8(said.stderr).unwrap();
    assert!(!said.status.success() && wrong.contains("--loaded"), "{wrong}");
    // The design reads it, and is tared.
    fs::write(&design, text("calibration = \"mat.calibration.csv\"\n")).unwrap();
    let tared = Design::load(design.as_ref()).unwrap();
    assert_eq!(tared.input.dead, [9]);
    for taxel in (0..TAXELS).filter(|taxel| *taxel != 9) {
        let mean = recording.iter().map(|frame| tared.input.to_pa(taxel, frame[taxel])).sum::<f64>() / 100.0;
        assert!(mean.abs() < 1e-6, "{taxel}: {mean}");
        let gain = tared.input.calibration.as_ref().unwrap().gain[taxel];
        assert!((gain - 1.0 - 0.001 * taxel as f64).abs() < 1e-12, "{gain}");
    }
    // With the noise floor that was printed nothing is left to find.
    let check = |design: &str| sptfra(&["check", design, "--frames", &rest]);
    let said = check(&design);
    let found = String::from_utf8(said.stdout).unwrap();
    assert!(!said.status.success() && found.contains("nothing presses"), "{found}");
    let floor = lines.lines().find(|line| line.starts_with("noise_floor_pa = ")).unwrap();
    let keys = format!("calibration = \"mat.calibration.csv\"\n[algorithm]\n{floor}\n");
    fs::write(&design, text(&keys)).unwrap();
    let said = check(&design);
    let found = String::from_utf8(said.stdout).unwrap();
    assert!(said.status.success() && found.contains("Nothing presses: tare and noise are within"), "{found}");
    // Not over a file that the design names, and not for pascals.
    let said = sptfra(&asked);
    assert!(!said.status.success(), "{said:?}");
    fs::write(&design, text("").replace(&format!("pa_per_count = {PA_PER_COUNT}\n"), "")).unwrap();
    let other = path("other.csv");
    let said = sptfra(&["check", &design, "--frames", &rest, "--unloaded", "--out", &other]);
    let wrong = String::from_utf8(said.stderr).unwrap();
    assert!(!said.status.success() && wrong.contains("pa_per_count"), "{wrong}");
    assert!(!std::path::Path::new(&other).exists());
    // More dead ones than can be replaced.
    let many = frames(100, |frame, taxel| if taxel < 9 { 0.0 } else { offset(taxel) + 2.0 * noise(frame, taxel) });
    let design = mat("");
    let found = Unloaded::of(&design, &many).unwrap();
    assert!(found.calibration(&design, &many).unwrap_err().starts_with("9 taxels are dead or stuck, and 8 of"));
}

/// A tare with what lies on the sensor in it would make that thing unseen.
#[test]
fn no_calibration_is_written_of_a_sensor_with_load() {
    let folder = tempfile::tempdir().unwrap();
    let [design, rest, out] =
        ["mat.toml", "rest.csv", "tare.csv"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    fs::write(&design, text("")).unwrap();
    let lying = |taxel: usize| {
        let [x, y] = [(taxel % 6) as f64 - 2.5, (taxel / 6) as f64 - 6.0];
        1000.0 * (-(x * x + y * y) / 4.0).exp()
    };
    write_frames(rest.as_ref(), &frames(100, |frame, taxel| lying(taxel) + 2.0 * noise(frame, taxel))).unwrap();
    let asked = ["check", &design, "--frames", &rest, "--unloaded", "--out", &out, "--json"];
    for arguments in [&asked[..7], &asked] {
        let said = sptfra(arguments);
        let [lines, errors] = [said.stdout, said.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert!(!said.status.success() && !fs::exists(&out).unwrap(), "{lines}");
        assert!(lines.contains("noise_floor_pa") && !lines.contains("tare.csv"), "{lines}");
        for part in ["warning: neighbours have like offsets", "tare.csv: not written; take everything off"] {
            assert!(errors.contains(part), "no {part:?} in: {errors}");
        }
    }
    assert!(sptfra(&asked[..5]).status.success(), "nothing was to be written");
}
