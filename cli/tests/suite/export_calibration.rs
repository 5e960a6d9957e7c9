//! The calibration that a board loads.

use std::fs;

use golden::bank;
use golden::design::Design;

use crate::support::{PLAIN, program};

const PAD: &str = "name = \"pad\"\n[sensor]\ncolumns = 3\nrows = 2\npitch_mm = [4.0, 2.0]\ndepth_mm = 2.0\n\
    pa_per_count = -2.0\n";

#[test]
fn the_command_writes_it() {
    let folder = tempfile::tempdir().unwrap();
    let [file, rom, out] = ["pad.toml", "rom.toml", "pad.bank.csv"].map(|name| folder.path().join(name));
    let text =
        format!("{PLAIN}{PAD}dead = {{ taxels = [1], room = 1 }}\n[hardware]\ncontrol = true\ncalibration = \"ram\"\n");
    let design = Design::from_toml(&text, "pad.toml").unwrap();
    fs::write(&file, design.to_toml()).unwrap();
    fs::write(&rom, format!("{PLAIN}{PAD}")).unwrap();
    let export = |design: &std::path::Path| {
        let mut command = program();
        command.arg("export-calibration").arg(design).arg("--out").arg(&out).arg("--json").output().unwrap()
    };
    let refused = export(&rom);
    assert!(!refused.status.success() && !out.exists());
    let message = String::from_utf8(refused.stderr).unwrap();
    assert!(message.contains("is in ROM") && message.contains("calibration = \"ram\""), "{message}");
    let done = export(&file);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert_eq!(fs::read_to_string(&out).unwrap(), bank::to_csv(&design).unwrap());
    let report: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((&report["taxels"], &report["replaced"]), (&6.into(), &serde_json::json!([1])));
}
