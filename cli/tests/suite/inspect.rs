//! What `sptfra inspect` says of a design.

use std::fs;

use serde_json::{Value, json};

use crate::generate::{folder_with_design, good};
use crate::support::{PLAIN, design_text};

#[test]
fn inspect_tells_machines_what_is_promised() {
    let folder = folder_with_design("lanes = 5\n[algorithm]\nplan = \"paper\"");
    let report: Value = serde_json::from_str(&good(folder.path(), &["inspect", "pad.toml", "--json"])).unwrap();
    let keys = |value: &Value| {
        let mut keys: Vec<String> = value.as_object().unwrap().keys().cloned().collect();
        keys.sort();
        keys.join(" ")
    };
    assert_eq!(keys(&report["nnz"]), "A1 A2 A3 C33inv D10 D11 D12 D20 D21 D22 D30 D31 D32");
    assert!(report["nnz"].as_object().unwrap().values().all(|count| count == 144));
    assert_eq!(keys(&report["condition"]), "AAT C33");
    assert!(report["condition"]["AAT"].as_f64().unwrap() > report["condition"]["C33"].as_f64().unwrap());
    for key in ["latency_cycles", "interval_cycles", "dsp"] {
        assert!(report["predicted"][key].as_u64().is_some_and(|value| value > 0), "predicted.{key}");
    }
    assert!(report["predicted"]["bram36"].is_number());
    // One block after the other: the products' cycles are those of the frame, but for gaps and waits.
    let products = report["products"].as_array().unwrap();
    assert_eq!(products.len(), 16);
    assert!(
        products.iter().all(|product| product["nnz"] == 144 && product["busy"].as_f64().is_some_and(|busy| busy > 0.9))
    );
    let cycles: u64 = products.iter().map(|product| product["issue_cycles"].as_u64().unwrap()).sum();
    let all = report["predicted"]["spmv_cycles"].as_u64().unwrap();
    assert!(cycles <= all && all < cycles + 100, "{cycles} of {all}");
    assert!(report["rom_bits"].as_u64().is_some_and(|bits| bits > 10_000));
    assert_eq!(report["geometry"]["taxels"], 12);
}

#[test]
fn inspect_tells_people_the_same_figures() {
    let folder = folder_with_design("lanes = 1\n[algorithm]\nplan = \"paper\"");
    let report: Value = serde_json::from_str(&good(folder.path(), &["inspect", "pad.toml", "--json"])).unwrap();
    let text = good(folder.path(), &["inspect", "pad.toml"]);
    for (line, figure) in [
        ("  latency ", "latency_cycles"),
        ("  interval ", "interval_cycles"),
        ("  products ", "spmv_cycles"),
        ("  search ", "search_cycles"),
    ] {
        let words =
            text.lines().find_map(|text| text.strip_prefix(line)).and_then(|line| line.split_whitespace().next());
        assert_eq!(words, Some(report["predicted"][figure].to_string().as_str()), "{figure} in:\n{text}");
    }
    let unknown = "error        unknown; `sptfra calibrate`";
    for words in ["4 x 3 = 12 taxels", "pitch 4 x 2 mm", "well conditioned", unknown, "1 lane busy", "filter = none"] {
        assert!(text.contains(words), "no {words:?} in:\n{text}");
    }
    assert!(text.contains("point: F_z of a wide contact is off by -") && text.contains("phi the same"), "{text}");
    assert!(report["kernel_gain"].as_f64().is_some_and(|gain| gain > 1.0));
    assert!(text.contains(&format!("{} bits of ROM", report["rom_bits"])), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 110 && line.trim_end() == line), "{text}");
}

/// A matrix that inverts well is no praise of a layer whose forces fall between the taxels.
#[test]
fn inspect_praises_no_thin_layer() {
    let folder = tempfile::tempdir().unwrap();
    for (depth, thin) in [(3.0, false), (2.5, true)] {
        fs::write(folder.path().join("pad.toml"), design_text("pad", [4, 3], [4.0, 3.0], depth, "")).unwrap();
        let text = good(folder.path(), &["inspect", "pad.toml"]);
        let said = ["well conditioned", "but the layer is too thin, see below", "\n  thin  "]
            .map(|words| text.contains(words));
        assert_eq!(said, [!thin, thin, thin], "{depth}:\n{text}");
    }
}

/// Which search on the line a design has, and which of the two reasons decides.
#[test]
fn inspect_says_how_the_line_is_searched() {
    let folder = tempfile::tempdir().unwrap();
    let said = |lanes: usize, side: usize| {
        let lanes = format!("[algorithm]\nplan = \"reduced\"\n[hardware]\nlanes = {lanes}\n");
        let text = design_text("pad", [side, side], [4.0, 4.0], 3.0, &lanes);
        fs::write(folder.path().join("pad.toml"), text).unwrap();
        let text = good(folder.path(), &["inspect", "pad.toml"]);
        let json: Value = serde_json::from_str(&good(folder.path(), &["inspect", "pad.toml", "--json"])).unwrap();
        assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
        let rounds = text.lines().find_map(|line| line.strip_prefix("  rounds ")).expect("rounds").trim();
        assert!(
            text.contains(&format!("  search       {} cycles: minimum", json["predicted"]["search_cycles"])),
            "{text}"
        );
        rounds.to_owned()
    };
    assert!(said(32, 10).starts_with("17 of a bisection: up to 32 lanes do not wait"));
    assert!(said(64, 10).starts_with("9 of two bisections: 64 lanes, more than 32, would wait for 17; 4 taxels"));
    assert!(said(64, 20).starts_with("17 of a bisection: 16 taxels a cell, more than 8"));
}

/// The grid search's gain belongs to a kernel.
#[test]
fn inspect_compares_the_gain_with_what_the_kernel_lacks() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    good(here, &["new", "pad", "--paper-sensor", "2"]);
    assert!(good(here, &["inspect", "pad.toml"]).contains("has 1.254:\n               so F_z is right"));
    let text = fs::read_to_string(here.join("pad.toml")).unwrap();
    // Without a word of what the constants belong to, which would refuse the design.
    let kept = text.lines().filter(|line| !line.starts_with("calibrated_for")).collect::<Vec<_>>().join("\n");
    fs::write(here.join("cell.toml"), kept.replace("kernel = \"point\"", "kernel = \"cell\"")).unwrap();
    let said = good(here, &["inspect", "cell.toml"]);
    assert!(said.contains("wants a gain of 1.000") && said.contains("run sptfra calibrate"), "{said}");
    // On thin layers the kernels change places, and all is said in lines that fit.
    for (depth, kernel, advice) in [
        ("1.7", "joint", "mu comes out better than with \"point\""),
        ("1.4", "joint", "sptfra calibrate serves down to 0.3"),
        ("1", "joint", "take a thicker layer or a finer pitch"),
        ("1.7", "line", "take \"cell\", and for mu estimator = \"joint\""),
    ] {
        let name = format!("pad_{kernel}_{}", depth.replace('.', "_"));
        let small = ["--paper-sensor", "2", "--columns", "5", "--rows", "5"];
        good(here, &[&["new", &name, "--depth-mm", depth, "--estimator", kernel], &small[..]].concat());
        let said = good(here, &["inspect", &format!("{name}.toml")]);
        assert!(said.contains(advice) && said.lines().all(|line| line.chars().count() <= 110), "{said}");
    }
}

/// By people's and machines' reports, and in the folder of a core.
#[test]
fn the_expected_error_is_told_wherever_a_design_is() {
    let errors = "noise = [0.0, 0.01], median = [1.0, 5.0], p95 = [2.0, 22.0]";
    let folder = folder_with_design(&format!("[algorithm]\nexpected_error = {{ {errors} }}"));
    let told = "At a noise of 0.5 % expect the shear within 3.0 % of F_z (median; 95 %: 12)";
    let said = |report: &Value| {
        report["expected_error"] == json!({ "noise": 0.005, "median_percent": 3.0, "p95_percent": 12.0 })
    };
    let text = good(folder.path(), &["inspect", "pad.toml"]);
    let line = format!("  error        {}", told.replace(" (", "\n               ("));
    assert!(text.contains(&line) && text.lines().all(|line| line.chars().count() <= 110), "{text}");
    let report = good(folder.path(), &["inspect", "pad.toml", "--json"]);
    assert!(said(&serde_json::from_str(&report).unwrap()), "{report}");
    good(folder.path(), &["generate", "pad.toml", "--out", "out"]);
    let read = |file: &str| fs::read_to_string(folder.path().join("out").join(file)).unwrap();
    assert!(read("README.md").contains(&format!("\n{told}")));
    assert!(said(&serde_json::from_str(&read("metadata.json")).unwrap()));
}

#[test]
fn inspect_warns_of_what_will_not_work_well() {
    let folder = tempfile::tempdir().unwrap();
    let paper = "[algorithm]\nplan = \"paper\"";
    let deep = design_text("deep", [10, 10], [4.0, 4.0], 12.0, paper);
    fs::write(folder.path().join("deep.toml"), deep).unwrap();
    assert!(good(folder.path(), &["inspect", "deep.toml"]).contains("ill-conditioned: the depth is 3.00 pitches"));
    let huge = design_text("huge", [20, 20], [4.0, 4.0], 3.0, paper);
    fs::write(folder.path().join("huge.toml"), huge).unwrap();
    assert!(good(folder.path(), &["inspect", "huge.toml"]).contains("too much for xczu9eg-ffvb1156-2-e"));
    let thin = design_text("thin", [10, 10], [4.0, 4.0], 1.2, "");
    fs::write(folder.path().join("thin.toml"), thin).unwrap();
    for command in ["inspect", "generate"] {
        let said = good(folder.path(), &[command, "thin.toml"]);
        assert!(said.contains("the layer is 0.30 of a pitch thin"), "{said}");
    }
}

#[test]
fn a_design_that_is_too_large_for_its_part_is_written_with_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!(
        "{PLAIN}name = \"big_pad\"\n[sensor]\ncolumns = 20\nrows = 20\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"paper\"\n[hardware]\nlanes = 8\n"
    );
    std::fs::write(folder.path().join("large.toml"), text).expect("a file");
    let warned = |arguments: &[&str]| good(folder.path(), arguments).contains("too much for xczu9eg");
    assert!(warned(&["inspect", "large.toml"]) && warned(&["generate", "large.toml", "--out", "large"]));
    assert!(folder.path().join("large/rtl").is_dir());
}

#[test]
fn each_board_s_part_has_its_shares_and_its_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = |name: &str, part: &str, hardware: &str| {
        let text = format!(
            "{PLAIN}name = \"pad\"\n[sensor]\ncolumns = 10\nrows = 10\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
             [algorithm]\nplan = \"reduced\"\nestimator = \"line\"\n[hardware]\npart = \"{part}\"\n{hardware}\n"
        );
        std::fs::write(folder.path().join(format!("{name}.toml")), text).expect("a file");
        good(folder.path(), &["inspect", &format!("{name}.toml")])
    };
    let resources = |said: &str| said.lines().find(|line| line.contains(" bits of ROM")).expect("its line").to_owned();
    // Of 36 multipliers on each part and the memories of one board's design: DSP, RAMB36 that the device has.
    for (part, dsp) in
        [("xczu9eg-ffvb1156-2-e", 2520.0), ("xczu7ev-ffvc1156-2-e", 1728.0), ("xck26-sfvc784-2LV-c", 1248.0)]
    {
        let line = resources(&said("pad", part, "lanes = 16"));
        let share = format!(": {:.1} and ", 100.0 * 36.0 / dsp);
        assert!(line.contains("36 DSP48E2") && line.contains(&share) && line.ends_with(part), "{line}");
    }
    // The older multipliers: two for each but those of lanes and field, with 25 bits; two for all with 27.
    let narrow = said("pad", "xc7z020clg400-1", "lanes = 16\ndata_bits = 25");
    assert!(resources(&narrow).contains("55 DSP48E1") && !narrow.contains("data_bits = 25"), "{narrow}");
    let wide = said("pad", "xc7z020clg400-1", "lanes = 16");
    assert!(resources(&wide).contains("72 DSP48E1"), "{wide}");
    assert!(wide.contains("36 multipliers take 72 of them; with data_bits = 25"), "{wide}");
    let large = said("pad", "xc7z020clg400-1", "lanes = 112");
    assert!(
        large.contains("too much for xc7z020clg400-1, which has 220 DSP48E1 and 140 RAMB36; take fewer"),
        "{large}"
    );
    // Of a part without a board nothing is known.
    assert!(resources(&said("pad", "xc7k325tffg900-2", "lanes = 112")).ends_with(" bits of ROM"));
}
