//! The `testbench` command: its JSON, its table, its refusals.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use golden::design::Design;
use golden::progress::Progress;
use hdl_gen::plan::Plan;
use serde_json::Value;
use testbench::frame_set::FrameSet;
use testbench::run::{Options, page, run_plan};

use crate::support::{program, sptfra, workspace};

fn small() -> String {
    workspace("golden/tests/designs/small.toml").display().to_string()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {}", text(&output.stderr)))
}

/// Fails with one line of message on standard error, nothing on standard output.
fn refused(arguments: &[&str]) -> String {
    let output = sptfra(arguments);
    assert!(!output.status.success(), "{arguments:?}");
    assert_eq!(text(&output.stdout), "");
    let message = text(&output.stderr);
    assert!(message.starts_with("error: "), "{message}");
    message
}

fn file(folder: &tempfile::TempDir, name: &str, contents: &str) -> (PathBuf, String) {
    let path = folder.path().join(name);
    fs::write(&path, contents).expect("writable");
    let name = path.display().to_string();
    (path, name)
}

#[test]
fn the_small_design_is_bit_exact_and_its_json_is_complete() {
    let output = sptfra(&["run", &small(), "--json"]);
    let report = json(&output);
    assert_eq!(report["bit_exact"], true, "{report:#}");
    assert!(output.status.success());
    assert_eq!(report["mismatches"], 0);
    assert_eq!(report["frames"], 36);
    assert_eq!(report["latency_cycles"], report["predicted"]["latency_cycles"]);
    assert_eq!(report["interval_cycles"], report["predicted"]["interval_cycles"]);
    for key in ["resultant_max", "field_max"] {
        let error = report["error"][key].as_f64().expect(key);
        assert!(error > 0.0 && error < 2e-3, "{key} {error}");
    }
    assert_eq!(report["modes"].as_array().map(Vec::len), Some(4));
    assert!(report["status_counts"]["good"].is_u64());
    for key in ["dsp", "bram36", "rom_bits", "microseconds", "nnz", "true_force_errors", "lanes_busy"] {
        assert!(!report[key].is_null(), "{key}");
    }
    assert_eq!(report["nnz"].as_object().map(serde_json::Map::len), Some(13));
}

/// Beside the grid search stands the paper's line search on the same frames; beside the line search stands nothing.
#[test]
fn the_paper_is_in_the_same_table() {
    let run = |design: &str| {
        let plan = Plan::new(&Design::load(Path::new(design)).expect("a design")).expect("a plan");
        let frames = FrameSet::standing(&plan.design.sensor).expect("frames");
        run_plan(&plan, &frames, &Options::default(), &Progress::hidden()).expect("runs")
    };
    let [line, grid] =
        [small(), workspace("designs/sensor1-fast.toml").display().to_string()].map(|design| run(&design));
    assert_eq!(line.paper_errors, None);
    assert!(!page::render(&line).contains("paper's, %"));
    let page = page::render(&grid);
    assert!(page.contains("paper's, %"), "{page}");
    let [own, papers] = [grid.true_force_errors, grid.paper_errors].map(|errors| errors.expect("both").e_fz.max);
    // The largest error of the line search is eleven percent of the normal force; the correction leaves a tenth of it.
    assert!(own < 3.0 && (10.0..12.0).contains(&papers), "{own} {papers}");
}

#[test]
fn the_table_has_no_control_codes_off_a_terminal() {
    let output = sptfra(&["run", &small()]);
    let (page, messages) = (text(&output.stdout), text(&output.stderr));
    assert!(page.contains("latency, cycles") && page.contains("RTL against the model"), "{page}");
    assert!(!page.contains('\u{1b}') && messages.is_empty(), "{messages}");
    let width = page.lines().map(|line| line.chars().count()).max();
    assert!(width < Some(120), "{width:?}");
}

/// As if the hardware took a cycle more, or two fewer, than the plan says.
#[test]
fn other_cycles_than_predicted_are_wrong() {
    let mut plan = Plan::new(&Design::load(Path::new(&small())).expect("a design")).expect("a plan");
    let frames = FrameSet::standing(&plan.design.sensor).expect("frames");
    let report = |plan: &Plan| run_plan(plan, &frames, &Options::default(), &Progress::hidden()).expect("runs");
    let right = report(&plan);
    assert!(right.faults.is_empty() && right.timing == "as_predicted");
    let page = page::render(&right);
    assert!(!page.contains("Zeros") && !page.contains("WRONG"), "{page}");
    plan.timeline.latency_cycles -= 1;
    plan.timeline.interval_cycles += 2;
    let wrong = report(&plan);
    assert!(!wrong.faults.is_empty() && wrong.bit_exact && wrong.timing == "wrong");
    let [fault] = &wrong.faults[..] else { panic!("{:?}", wrong.faults) };
    let (found, predicted) = (right.predicted, wrong.predicted);
    for figures in [found, predicted] {
        let cycles = format!("{} / {}", figures.latency_cycles, figures.interval_cycles);
        assert!(fault.contains(&cycles), "{fault}");
    }
    assert!(page::render(&wrong).contains("WRONG CYCLES"));
    let json = serde_json::to_value(&wrong).expect("JSON");
    assert_eq!((&json["timing"], &json["faults"]), (&Value::from("wrong"), &Value::from(vec![fault.clone()])));
}

#[test]
fn frames_and_reference_come_from_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let row = "-900,-1000,-900,-800,-500,300,-900,-800,20,-10,-5,-1\n";
    let (_, frames) = file(&folder, "frames.csv", &row.repeat(3));
    let (_, forces) = file(&folder, "forces.csv", &"0,0.1,0.0,-0.2,0.5,0.0,0.5,0.0\n".repeat(3));
    let output = sptfra(&["run", &small(), "--frames", &frames, "--reference", &forces, "--json"]);
    let report = json(&output);
    assert_eq!((&report["frames"], &report["true_force_errors"]["frames"]), (&Value::from(3), &Value::from(3)));
}

#[test]
fn a_trace_is_written_where_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let row = "-900,-1000,-900,-800,-500,300,-900,-800,20,-10,-5,-1\n";
    let (_, frames) = file(&folder, "frames.csv", row);
    let wave = folder.path().join("wave.vcd");
    sptfra(&["run", &small(), "--frames", &frames, "--trace", &wave.display().to_string()]);
    assert!(fs::read_to_string(wave).expect("written").contains("m_axis_tvalid"));
}

#[test]
fn bad_files_are_refused_with_their_place() {
    let folder = tempfile::tempdir().expect("a folder");
    assert!(refused(&["run", "no-such.toml"]).contains("no-such.toml"));
    let (_, unknown) = file(&folder, "unknown.toml", "format = 3\nname = \"x\"\nfrobnicate = 1\n");
    assert!(refused(&["run", &unknown]).contains("frobnicate"));
    let joint = fs::read_to_string(workspace("designs/sensor1-fast.toml")).expect("a design");
    let weights = fs::read_to_string(workspace("designs/sensor1-fast.weights.csv")).expect("weights");
    file(&folder, "sensor1-fast.weights.csv", &weights);
    let (_, paper) = file(&folder, "paper.toml", &joint.replace("plan = \"reduced\"", "plan = \"paper\""));
    assert!(refused(&["run", &paper]).contains("plan = \"reduced\""));
    let (_, short) = file(&folder, "short.csv", "1,2,3\n");
    let message = refused(&["run", &small(), "--frames", &short]);
    assert!(message.contains("short.csv") && message.contains('1'), "{message}");
    let (_, frames) = file(&folder, "frames.csv", &format!("{}\n", ["-1"; 12].join(",")));
    let (_, forces) = file(&folder, "forces.csv", &"0,0,0,-1,0,0,0,0\n".repeat(2));
    let message = refused(&["run", &small(), "--frames", &frames, "--reference", &forces]);
    assert!(message.contains("forces.csv"), "{message}");
}

#[test]
fn a_reference_needs_frames() {
    assert!(refused(&["run", &small(), "--reference", "forces.csv"]).contains("--frames"));
}

#[test]
fn missing_tools_are_named_with_the_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = program().args(["run", &small()]).env("SPTFRA_TOOLS", folder.path()).output().expect("starts");
    let message = text(&output.stderr);
    assert!(!output.status.success());
    assert!(message.contains("verilator not found in") && message.contains("make tools"), "{message}");
}

#[test]
fn a_compiler_that_does_not_run_is_named_with_the_remedy() {
    let output = program().args(["run", &small()]).env("CXX", "false").output().expect("starts");
    let message = text(&output.stderr);
    assert!(!output.status.success() && text(&output.stdout).is_empty());
    assert!(message.starts_with("error: the C++ compiler (false) does not run: "), "{message}");
    assert!(message.contains("set CXX"), "{message}");
}

#[test]
fn activity_is_written_to_files_that_say_so() {
    let message = refused(&["run", &small(), "--saif", "activity.txt"]);
    assert!(message.contains("activity.txt: the name of a SAIF file ends in .saif"), "{message}");
    assert!(refused(&["run", &small(), "--saif", "--trace"]).contains("cannot be used with"));
}
