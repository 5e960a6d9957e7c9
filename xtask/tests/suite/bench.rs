//! `cargo xtask bench` on a tiny design: the page, the plot, the JSON. No time is judged.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const SOLVER: &str = r#"[{ "file": "slow.toml", "design": "slow", "plan": "paper", "taxels": 12, "setup_s": 0.1, "repetitions": 7,
    "one_by_one": { "frames_per_second": 1000.0, "us_per_frame": 1000.0, "us_per_frame_range": [900.0, 1100.0] },
    "in_batches": { "frames_per_second": 2000.0, "us_per_frame": 500.0, "us_per_frame_range": [400.0, 600.0] },
    "cores": 2, "on_all_cores": { "frames_per_second": 3800.0, "us_per_frame": 263.0, "us_per_frame_range": [250.0, 300.0] },
    "numpy_frames_per_second": 800.0 }]"#;
const CELLS: &str = r#"{ "file": "counted.toml", "design": "counted",
    "blocks": [{ "name": "lanes", "yosys": { "dsp": 4, "bram36": 2.5, "lut": 7, "ff": 8 },
                 "predicted": { "dsp": 4, "bram36": 2.0 } }],
    "total": { "name": "all", "yosys": { "dsp": 4, "bram36": 2.5, "lut": 7, "ff": 8 },
               "predicted": { "dsp": 4, "bram36": 2.0 } } }"#;

fn xtask(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask")).args(arguments).output().expect("starts")
}

fn small() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace");
    root.join("designs/small.toml").display().to_string()
}

#[test]
fn a_tiny_bench_has_a_page_a_plot_and_exact_cycles() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let [page, plot, solver, cells] = ["page.md", "plot.svg", "solver.json", "cells.json"].map(place);
    fs::write(&solver, SOLVER).expect("written");
    fs::write(&cells, CELLS).expect("written");
    let output = xtask(&[
        "bench",
        &small(),
        "--largest",
        "4",
        "--solver",
        &solver,
        "--cells",
        &cells,
        "--page",
        &page,
        "--plot",
        &plot,
        "--json",
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let figures: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let points = figures["cycles"].as_array().expect("points");
    assert_eq!(points.len(), 4 * 5, "four kinds, five numbers of lanes");
    let simulated: Vec<&Value> = points.iter().filter(|point| !point["simulated"].is_null()).collect();
    assert_eq!(simulated.len(), 1);
    assert_eq!(simulated[0]["simulated"], simulated[0]["predicted"]);
    assert!(figures["simulation"][0]["cycles_per_second"].as_f64().expect("a rate") > 0.0);
    assert_eq!(figures["generation"].as_array().map(Vec::len), Some(2));

    let page = fs::read_to_string(page).expect("written");
    for part in [
        "## Frames a second of the f64 solver",
        "| `slow` | paper | 12 | 0.10 | 1,000 | 1.00 | 2,000 | 2.00 | 3,800 | 1.90 |",
        "(`tools/bench_numpy.py`): 800 frames a",
        "2.5 times as many here.",
        "1 of 1 gave exactly",
        "plot.svg",
        "not as predicted: lanes",
        "--largest 4\n",
        "cargo xtask solver slow.toml\n",
        "tools/synth.sh counted.toml\n",
    ] {
        assert!(page.contains(part), "{part}\n{page}");
    }
    let widths = |table: &str| table.lines().map(|line| line.matches('|').count()).collect::<Vec<_>>();
    for table in page.split("\n\n").filter(|block| block.starts_with('|')) {
        assert!(widths(table).windows(2).all(|pair| pair[0] == pair[1]), "{table}");
    }
    let plot = fs::read_to_string(plot).expect("written");
    assert!(plot.starts_with("<svg") && plot.contains("F2, p = 1, 64 lanes") && plot.contains("7,335,000"), "{plot}");
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
