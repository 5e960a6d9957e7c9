//! `cargo xtask bench` on a tiny design, and the tables that its figures become. No time is judged.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use golden::design::Design;
use serde_json::Value;

const SOLVER: &str = r#"[{ "file": "slow.toml", "design": "slow", "hash": "01", "plan": "paper", "taxels": 12, "setup_s": 0.1, "repetitions": 7,
    "one_by_one": { "frames_per_second": 1000.0, "us_per_frame": 1000.0, "us_per_frame_range": [900.0, 1100.0] },
    "in_batches": { "frames_per_second": 2000.0, "us_per_frame": 500.0, "us_per_frame_range": [400.0, 600.0] },
    "cores": 2, "on_all_cores": { "frames_per_second": 3800.0, "us_per_frame": 263.0, "us_per_frame_range": [250.0, 300.0] },
    "numpy_frames_per_second": 800.0 }]"#;
const CELLS: &str = r#"{ "file": "designs/counted.toml", "design": "counted", "hash": "02",
    "blocks": [{ "name": "lanes", "yosys": { "dsp": 4, "bram36": 2.5, "lut": 7, "ff": 8 },
                 "predicted": { "dsp": 4, "bram36": 2.0 } }],
    "total": { "name": "all", "yosys": { "dsp": 4, "bram36": 2.5, "lut": 7, "ff": 8 },
               "predicted": { "dsp": 4, "bram36": 2.0 } } }"#;

fn xtask(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask")).args(arguments).output().expect("starts")
}

fn small() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace");
    root.join("golden/tests/designs/small.toml").display().to_string()
}

#[test]
fn a_tiny_bench_has_its_tables_and_exact_cycles() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let [solver, cells, json] = ["solver.json", "cells.json", "figures.json"].map(place);
    fs::write(&solver, SOLVER).expect("written");
    fs::write(&cells, CELLS).expect("written");
    let output = xtask(&["bench", &small(), "--largest", "4", "--solver", &solver, "--cells", &cells]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::write(&json, &output.stdout).expect("written");
    let figures: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let points = figures["cycles"].as_array().expect("points");
    assert_eq!(points.len(), 4 * 5, "four kinds, five numbers of lanes");
    let simulated: Vec<&Value> = points.iter().filter(|point| !point["simulated"].is_null()).collect();
    assert_eq!(simulated.len(), 1);
    assert_eq!(simulated[0]["simulated"], simulated[0]["predicted"]);
    assert!(figures["simulation"][0]["cycles_per_second"].as_f64().expect("a rate") > 0.0);
    assert_eq!(figures["generation"].as_array().map(Vec::len), Some(2));

    let results = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tools/results.py");
    let about = "# Cells.\n# designs: other 00\ndesign,block\n";
    fs::write(folder.path().join("cells.csv"), about).expect("written");
    let mut python = Command::new("python3");
    python.arg(results).args(["bench", &json, "--out"]).arg(folder.path());
    assert!(python.status().expect("starts").success());
    for (file, row) in [
        ("solver-speed.csv", "slow,paper,12,0.10,1000,2000,3800"),
        ("cells.csv", "counted,lanes,4,4,2.5,2.0,7,8,"),
        ("simulation-speed.csv", "small,"),
        ("generation-time.csv", "small,12,"),
        ("filters.csv", "design,filter,macs,"),
    ] {
        let table = fs::read_to_string(folder.path().join(file)).expect(file);
        assert!(table.lines().any(|line| line.starts_with(row)), "{file}: {table}");
    }
    let own = Design::load(Path::new(&small())).expect("a design").hash();
    for (file, lines) in [
        ("cells.csv", "# Cells.\n# designs: counted 02\ndesign,".to_owned()),
        ("solver-speed.csv", "# designs: slow 01\ndesign,".to_owned()),
        ("simulation-speed.csv", format!("# designs: small {own}\ndesign,")),
        ("generation-time.csv", format!("# designs: small {own}\ndesign,")),
        ("filters.csv", format!("# designs: small {own}\ndesign,")),
        // Squares that are no files.
        ("cycles.csv", "plan,".to_owned()),
    ] {
        let table = fs::read_to_string(folder.path().join(file)).expect(file);
        assert!(table.starts_with(&lines), "{file}: {table}");
    }
    let cycles = fs::read_to_string(folder.path().join("cycles.csv")).expect("cycles.csv");
    assert_eq!(cycles.lines().filter(|line| line.ends_with(",yes")).count(), 1, "{cycles}");
}

#[test]
fn missing_figures_are_named() {
    let output = xtask(&["bench", "--largest", "4", "--solver", "no-such.json"]);
    assert!(!output.status.success() && output.stdout.is_empty());
    assert!(String::from_utf8_lossy(&output.stderr).contains("no-such.json"));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("statistics.json");
    fs::write(&file, "[]").expect("written");
    let output = xtask(&["bench", "--largest", "4", "--cells", &file.display().to_string()]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && message.contains("statistics.json"), "{message}");
}
