//! No emitted line and no module is longer than a person reads in one go, whatever the design.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use golden::design::{Design, WEIGHTS_FILE};
use hdl_gen::cores::Multiplier;
use hdl_gen::emit::emit;
use hdl_gen::emit::rtl::library;
use hdl_gen::plan::Plan;

use crate::support::designs::folders;
use crate::support::{design_text, plan};

/// Columns of a line, as in the project's own sources.
const MOST_COLUMNS: usize = 120;

/// Lines of a module, header and comments included.
const MOST_LINES: usize = 360;
/// Of the top, which has no logic: parameters, pins and wires, one a line. Each option of a design adds the ports of its
/// modules; the longest has a door that drops frames, a curve in banks, a map of dead taxels and a range.
const MOST_LINES_OF_TOP: usize = 680;

/// Data, not text: words of memories, rows of matrices, and the grid search's weights.
fn is_data(path: &str) -> bool {
    let memory = Path::new(path).extension().is_some_and(|ending| ending == "mem");
    memory || path.starts_with("mcsr/") || path == WEIGHTS_FILE
}

/// A calibration of each taxel.
const GAINS: &str = "calibration = \"gains.csv\"\n";

/// The shipped designs and those of the tests but the mat, whose text differs from theirs by widths only, and those that
/// take ways of the templates which none of these takes.
fn standing() -> Vec<Plan> {
    let entries = folders().into_iter().flat_map(|folder| fs::read_dir(folder).expect("readable"));
    let mut files: Vec<_> = entries.map(|entry| entry.expect("there").path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    assert!(files.len() > 20);
    let shipped = files.iter().filter(|file| file.file_stem().is_some_and(|name| name != "bed-mat"));
    let mut plans: Vec<Plan> =
        shipped.map(|file| Plan::new(&Design::load(file).expect("right")).expect("a plan")).collect();
    for (columns, rows, keys) in [
        (4, 3, "plan = \"paper\"\n[hardware]\ncontrol = true"),
        (7, 5, "plan = \"paper\"\n[hardware]\nlanes = 1"),
        (7, 5, "plan = \"reduced\"\n[hardware]\noptimise = \"latency\""),
        (7, 5, "plan = \"reduced\"\noutputs = \"resultants\"\n[hardware]\noptimise = \"latency\""),
        (8, 8, "plan = \"reduced\"\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]"),
        (
            8,
            8,
            "plan = \"reduced\"\nestimator = \"joint\"\ngain = 1\nfriction_correction = [1, 0]\noutputs = \"resultants\"",
        ),
        (64, 27, "plan = \"reduced\"\n[hardware]\nlanes = 128"),
        (7, 5, "plan = \"paper\"\n[hardware]\nstream_bits = 64"),
        (7, 5, "plan = \"reduced\"\n[hardware]\nstream_bits = 128\ncontrol = true"),
        (5, 9, "plan = \"paper\"\n[hardware]\nlanes = 128\npart = \"LFE5U-85F-6BG381C\""),
        (7, 5, "plan = \"reduced\"\n[hardware]\nstream_bits = 64\noverrun = \"drop\"\ncontrol = true"),
    ] {
        let more = format!("[algorithm]\n{keys}");
        plans.push(plan(&design_text("array", [columns, rows], [4.0, 4.0], 3.0, &more)));
    }
    for (kind, calibration) in [("paper", ""), ("paper", GAINS), ("reduced", GAINS)] {
        let more = format!("pa_per_count = -12.5\ndead = [3]\n{calibration}[algorithm]\nplan = \"{kind}\"");
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("gains.csv"), "1.01,-0.5\n".repeat(24)).expect("writable");
        let file = folder.path().join("counts.toml");
        fs::write(&file, design_text("counting_pad", [6, 4], [4.0, 4.0], 3.0, &more)).expect("writable");
        plans.push(Plan::new(&Design::load(&file).expect("right")).expect("a plan"));
    }
    let more = "pa_per_count = -12.5\n[hardware]\nsamples = \"uint16\"";
    plans.push(plan(&design_text("integer_pad", [6, 4], [4.0, 4.0], 3.0, more)));
    let more = "pa_per_count = -12.5\n[hardware]\ncontrol = true\ncalibration = \"ram\"";
    plans.push(plan(&design_text("calibrated_pad", [6, 4], [4.0, 4.0], 3.0, more)));
    let more = "pa_per_count = -12.5\ndead = { room = 8 }\n[hardware]\ncontrol = true\ncalibration = \"ram\"";
    plans.push(plan(&design_text("mapped_pad", [6, 4], [4.0, 4.0], 3.0, more)));
    let more = "pa_per_count = -12.5\n[hardware]\noverrun = \"drop\"\ncontrol = true\ncalibration = \"ram\"";
    plans.push(plan(&design_text("scanned_pad", [6, 4], [4.0, 4.0], 3.0, more)));
    plans.push(plan(&design_text("scanned_pad", [7, 5], [4.0, 4.0], 3.0, "[hardware]\noverrun = \"drop\"")));
    let more = "[hardware]\ncoefficient_bits = 27\ndata_bits = 35";
    plans.push(plan(&design_text("long_pad", [6, 4], [4.0, 4.0], 3.0, more)));
    plans.push(plan(&design_text("long_pad", [6, 4], [4.0, 4.0], 3.0, &format!("{more}\nstream_bits = 128"))));
    plans.push(plan(&design_text(
        "crosstalk_pad",
        [6, 4],
        [4.0, 4.0],
        3.0,
        "crosstalk = 0.02\nsmoothing = 3\ncreep = { strength = 0.4, seconds = 9.0, frames_per_second = 100.0 }\n",
    )));
    let more = "curve = { power = 1.25, scale = -0.5 }\n";
    plans.push(plan(&design_text("curved_pad", [6, 4], [4.0, 4.0], 3.0, more)));
    let more = "curve = { power = 1.25, scale = -0.5 }\ndead = { room = 8 }\nsmoothing = 4\n[hardware]\noverrun = \"drop\"\ncontrol = true\n\
                calibration = \"ram\"\nscaling = \"per_frame\"";
    plans.push(plan(&design_text("curved_banks", [6, 4], [4.0, 4.0], 3.0, more)));
    plans
}

#[test]
fn no_line_and_no_module_is_long() {
    let mut long: BTreeMap<String, String> = BTreeMap::new();
    let mut kinds = BTreeSet::new();
    for plan in standing() {
        for (path, bytes) in emit(&plan).expect("emitted") {
            let text = std::str::from_utf8(&bytes).expect("text");
            if path.starts_with("rtl/") {
                kinds.insert(path.replace(&plan.design.name, "NAME"));
                let lines = text.lines().count();
                let most = if path.starts_with("rtl/sptfra_") { MOST_LINES } else { MOST_LINES_OF_TOP };
                if lines > most {
                    long.insert(path.replace(&plan.design.name, "NAME"), format!("{lines} lines"));
                }
            }
            let lines = text.lines().enumerate().filter(|(_, line)| line.chars().count() > MOST_COLUMNS);
            for (number, line) in lines.filter(|_| !is_data(&path)) {
                let path = path.replace(&plan.design.name, "NAME");
                let columns = line.chars().count();
                long.insert(format!("{path}:{}", number + 1), format!("{columns} columns: {line}"));
            }
        }
    }
    // A module that no design takes would not have been looked at.
    for (module, _) in library(Multiplier::Whole) {
        assert!(kinds.contains(&format!("rtl/{module}.v")), "no design has {module}");
    }
    let long: Vec<String> = long.into_iter().map(|(place, line)| format!("{place}: {line}")).collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}
