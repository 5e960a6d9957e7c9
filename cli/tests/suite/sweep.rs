//! `sptfra sweep` on tiny sensors: its points, its resuming, its files.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use golden::design::{Design, Estimator, Filter, PlanKind};
use golden::estimators::StandardError;
use serde_json::Value;
use testbench::sweep::grid::{Axes, FilterAxis, jobs};
use testbench::sweep::{SweepError, SweepScene};

use crate::support::{only_progress, sptfra};

const SCENE: &str = "[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
    [medium]\nkind = \"half_space\"\n\
    [[contact]]\nshape = \"hertz\"\nsemi_axes_mm = [4.0, 3.0]\ncentre_mm = [6.0, 4.0]\n\
    normal_force_n = 1.0\nfriction = 0.4\n\
    [sweep]\ndirection_deg = { from = 0, to = 270, step = 90 }\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace").to_owned()
}

/// 4 by 3 taxels.
fn small() -> String {
    root().join("golden/tests/designs/small.toml").display().to_string()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn succeeds(arguments: &[&str]) -> String {
    let output = sptfra(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(only_progress(&output.stderr), "quiet off a terminal: {}", text(&output.stderr));
    text(&output.stdout)
}

fn scene_in(folder: &Path) -> String {
    let path = folder.join("push.toml");
    fs::write(&path, SCENE).expect("written");
    path.display().to_string()
}

fn points_in(out: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        fs::read_dir(out.join("points")).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files
}

#[test]
fn points_are_the_combinations_that_exist_each_once() {
    let base = Design::load(Path::new(&small())).expect("a design");
    let named = Design { name: "other_name".to_owned(), ..base.clone() };
    let both = jobs(&[base.clone(), named], &Axes::default(), &mut Vec::new(), 0).expect("points");
    let one = jobs(std::slice::from_ref(&base), &Axes::default(), &mut Vec::new(), 0).expect("points");
    assert_eq!(both.len(), one.len(), "a name makes no other point");
    let keys: BTreeSet<&String> = one.iter().map(|job| &job.key).collect();
    assert_eq!(keys.len(), one.len());
    assert_eq!(one.iter().filter(|job| job.base).count(), 1);
    // 12 taxels: F1 has no band but L = 10.
    let of_plan = |kind| one.iter().filter(|job| job.design.algorithm.plan == kind).count();
    let filters = 1 + 1 + 9;
    assert!(of_plan(PlanKind::Paper) >= filters && of_plan(PlanKind::Reduced) >= filters);
    for job in &one {
        assert!(job.design.algorithm.plan == PlanKind::Paper || job.design.hardware.lanes % 4 == 0);
    }

    let axes = Axes {
        filters: vec![FilterAxis::None, FilterAxis::F2(Some(50.0))],
        plans: vec![PlanKind::Reduced, PlanKind::Paper],
        lanes: vec![2, 4],
        coefficient_bits: vec![12, 18],
        ..Axes::default()
    };
    let named = jobs(std::slice::from_ref(&base), &axes, &mut Vec::new(), 0).expect("points");
    // The reduced plan has no two lanes.
    assert_eq!(named.len(), 2 * 2 * (2 + 1));
    let full = jobs(std::slice::from_ref(&base), &Axes { full: true, ..Axes::default() }, &mut Vec::new(), 0);
    assert_eq!(full.expect("points").len(), filters * 2 * 5 * 6 * 6);
    let none = Axes { plans: vec![PlanKind::Reduced], lanes: vec![3], ..Axes::default() };
    assert!(matches!(jobs(&[base], &none, &mut Vec::new(), 0), Err(SweepError::NoPoints)));
}

#[test]
fn the_joint_estimator_is_an_axis_with_the_constants_of_a_design_that_has_it() {
    let line = Design::load(Path::new(&small())).expect("a design");
    let mut joint = line.clone();
    (joint.algorithm.plan, joint.algorithm.estimator) = (PlanKind::Reduced, Estimator::Joint);
    joint.algorithm.joint.gain = 1.125;
    let errors = StandardError { model: 0.03, noise: 100.0, border: 1.0 };
    joint.algorithm.standard_error = Some(errors);
    let axes = |estimators: &[Estimator]| Axes {
        filters: vec![FilterAxis::None, FilterAxis::F2(Some(50.0))],
        estimators: estimators.to_vec(),
        ..Axes::default()
    };
    let points = |designs: &[Design], estimators: &[Estimator]| {
        jobs(designs, &axes(estimators), &mut Vec::new(), 0).expect("points")
    };
    let by = |jobs: &[testbench::sweep::grid::Job], estimator| {
        jobs.iter().filter(|job| job.design.algorithm.estimator == estimator).count()
    };
    let both = [line.clone(), joint.clone()];
    let swept = points(&both, &[Estimator::Line, Estimator::Joint]);
    // The paper's plan has the line search only.
    assert_eq!((by(&swept, Estimator::Line), by(&swept, Estimator::Joint)), (4, 2));
    for job in &swept {
        let (algorithm, is_joint) = (&job.design.algorithm, job.design.algorithm.estimator == Estimator::Joint);
        assert_eq!(algorithm.joint.gain.to_bits(), if is_joint { 1.125_f64 } else { 1.0 }.to_bits());
        // Errors were found for these constants without a filter.
        let holds = is_joint && algorithm.filter == Filter::None;
        assert_eq!(algorithm.standard_error, holds.then_some(errors));
    }
    assert_eq!(by(&points(&both, &[]), Estimator::Joint), 0, "filters are judged with the line search");
    let alone = jobs(std::slice::from_ref(&line), &axes(&[Estimator::Joint]), &mut Vec::new(), 0);
    assert!(matches!(alone, Err(SweepError::NoPoints)), "no constants");
    // Constants are a part of the key.
    let mut other = joint.clone();
    other.algorithm.joint.gain = 1.25;
    let keys = |joint: &Design| {
        points(&[line.clone(), joint.clone()], &[Estimator::Joint]).into_iter().map(|job| job.key).collect::<Vec<_>>()
    };
    assert!(keys(&joint).iter().all(|key| !keys(&other).contains(key)));
}

#[test]
fn the_key_follows_design_and_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene_in(folder.path());
    let base = Design::load(Path::new(&small())).expect("a design");
    let key = |design: &Design| {
        let mut scenes = vec![SweepScene::load(Path::new(&path)).expect("a scene")];
        jobs(std::slice::from_ref(design), &Axes::default(), &mut scenes, 0).expect("points")[0].key.clone()
    };
    let first = key(&base);
    assert_eq!(key(&base), first);
    let mut other = base.clone();
    other.hardware.clock_mhz += 1.0;
    assert_ne!(key(&other), first);
    fs::write(&path, SCENE.replace("0.4", "0.3")).expect("written");
    assert_ne!(key(&base), first);
}

#[test]
fn a_sweep_goes_on_where_it_stopped_and_gives_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene_in(folder.path());
    let place = |name: &str| folder.path().join(name).display().to_string();
    let sweep = |out: &str| {
        succeeds(&["sweep", &small(), "--scene", &scene, "--filters", "none,f2", "--lanes", "4,8", "--out", out])
    };
    let [one, two] = ["one", "two"].map(place);
    assert!(sweep(&one).starts_with("40 points, 40 of them computed now\n"));
    let files = ["report.html", "sweep.json", "sweep.csv"];
    let read = |out: &str| files.map(|name| fs::read(Path::new(out).join(name)).expect("written"));
    let first = read(&one);
    assert!(sweep(&one).starts_with("40 points, 0 of them computed now\n"));
    assert!(read(&one) == first, "a second run changes nothing");
    // As if it had been killed: one point is not there, one is cut off by a full disk.
    let points = points_in(Path::new(&one));
    assert_eq!(points.len(), 40);
    fs::remove_file(&points[3]).expect("removed");
    fs::write(&points[7], "{ \"key\":").expect("written");
    assert!(sweep(&one).starts_with("40 points, 2 of them computed now\n"));
    assert!(read(&one) == first, "what was missing is as it was");
    assert!(sweep(&two).starts_with("40 points, 40 of them computed now\n"));
    assert!(read(&two) == first, "another folder, the same bytes");
}

#[test]
fn json_and_csv_agree_and_errors_are_finite() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let json = succeeds(&["sweep", &small(), "--out", &out.display().to_string(), "--json"]);
    let points: Vec<Value> = serde_json::from_str(&json).expect("JSON");
    assert_eq!(fs::read_to_string(out.join("sweep.json")).expect("written"), json);
    let mut table = csv::Reader::from_path(out.join("sweep.csv")).expect("CSV");
    let header = table.headers().expect("a header").clone();
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), points.len());
    let column = |name: &str| header.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name}"));
    for (row, point) in rows.iter().zip(&points) {
        assert_eq!(row[column("key")], *point["key"].as_str().expect("a key"));
        for (name, value) in [
            ("latency_cycles", &point["hardware"]["latency_cycles"]),
            ("dsp", &point["hardware"]["dsp"]),
            ("rom_bits", &point["hardware"]["rom_bits"]),
            ("nnz_total", &point["nnz_total"]),
            ("lanes", &point["lanes"]),
            ("e_Fx_max", &point["errors"]["e_fx"]["max"]),
            ("e_phi_standard_error", &point["errors"]["e_phi"]["standard_error"]),
            ("f64_e_mu_max", &point["solver_errors"]["e_mu"]["max"]),
            ("field_max", &point["against_solver"]["field_max"]),
        ] {
            let (cell, value): (f64, f64) = (row[column(name)].parse().expect(name), value.as_f64().expect(name));
            assert!(cell.is_finite() && (cell - value).abs() <= 1e-12 * value.abs(), "{name} {cell} {value}");
        }
        let sum: u64 = point["nnz"].as_object().expect("counts").values().filter_map(Value::as_u64).sum();
        assert_eq!(Some(sum), point["nnz_total"].as_u64());
    }
}

#[test]
fn the_page_needs_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene_in(folder.path());
    let out = folder.path().join("out");
    succeeds(&["sweep", &small(), "--scene", &scene, "--out", &out.display().to_string()]);
    let page = fs::read_to_string(out.join("report.html")).expect("written");
    let without_names = page.replace("http://www.w3.org/2000/svg", "");
    for foreign in ["http:", "https:", "<script", "<link", "<img", "src=", "url(", "@import", "NaN", "inf"] {
        assert!(!without_names.contains(foreign), "{foreign}");
    }
    assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
    for part in [
        "prefers-color-scheme: dark",
        "Scene push",
        "4 frames",
        "recommended: F1 L = 10, reduced plan",
        "finds the expected error of",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn the_rtl_is_asked_where_that_is_wanted() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene_in(folder.path());
    let out = folder.path().join("out").display().to_string();
    let sweep = |simulate: &str| {
        let options =
            ["sweep", &small(), "--scene", &scene, "--filters", "none", "--out", &out, "--json", "--simulate"];
        let json = succeeds(&[&options[..], &[simulate]].concat());
        let points: Vec<Value> = serde_json::from_str(&json).expect("JSON");
        points
    };
    let model = sweep("none");
    assert!(model.iter().all(|point| point["verified"] == "model"), "{model:#?}");
    let simulated = sweep("base");
    let by_rtl: Vec<&Value> = simulated.iter().filter(|point| point["verified"] == "rtl").collect();
    assert_eq!(by_rtl.len(), 1);
    let before = model.iter().find(|point| point["key"] == by_rtl[0]["key"]).expect("the same point");
    assert_eq!(before["errors"], by_rtl[0]["errors"]);
    // What went through the RTL stays.
    assert_eq!(sweep("none"), simulated);
}

#[test]
fn a_design_without_hardware_is_a_point_that_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let design = fs::read_to_string(small()).expect("read");
    let path = folder.path().join("fine.toml");
    let fine = design.replace("[hardware]", "noise_floor_pa = 1e-6\n\n[hardware]");
    assert_ne!(fine, design);
    fs::write(&path, fine).expect("written");
    let (design, out) = (path.display().to_string(), folder.path().join("out").display().to_string());
    let json = succeeds(&["sweep", &design, "--filters", "none", "--plans", "reduced", "--out", &out, "--json"]);
    let points: Vec<Value> = serde_json::from_str(&json).expect("JSON");
    assert_eq!(points.len(), 1);
    assert_eq!(points[0]["verified"], "golden");
    assert!(points[0]["hardware"].is_null() && points[0]["refusal"].as_str().expect("why").contains("data_bits"));
    assert_eq!(points[0]["errors"], points[0]["solver_errors"]);
}

/// `sptfra run` on a prepared point; the report goes to `runs`.
fn run_prepared(job: &Path, runs: &Path) {
    let file = |name: &str| job.join(name).display().to_string();
    let (design, frames, forces) = (file("design.toml"), file("frames.csv"), file("frames.forces.csv"));
    let report = succeeds(&["run", &design, "--frames", &frames, "--reference", &forces, "--json"]);
    fs::create_dir_all(runs).expect("a folder");
    let key = job.file_name().expect("a key").to_str().expect("UTF-8");
    fs::write(runs.join(format!("{key}.json")), report).expect("written");
}

#[test]
fn a_point_can_be_a_run_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let [out, runs] = ["out", "runs"].map(|name| folder.path().join(name));
    let (place, reports) = (out.display().to_string(), runs.display().to_string());
    let options = ["sweep", &small(), "--filters", "none", "--plans", "reduced", "--out", &place];
    assert!(succeeds(&[&options[..], &["--prepare"]].concat()).starts_with("1 of 1 points to run"));
    let job = fs::read_dir(out.join("jobs")).expect("a folder").next().expect("a job").expect("an entry").path();
    run_prepared(&job, &runs);
    let with_runs = [&options[..], &["--runs", &reports, "--json"]].concat();
    let points: Vec<Value> = serde_json::from_str(&succeeds(&with_runs)).expect("JSON");
    assert_eq!((points.len(), &points[0]["verified"]), (1, &Value::from("rtl")));
    // A report of something else proves nothing.
    let key = points[0]["key"].as_str().expect("a key").to_owned();
    let report = runs.join(key.clone() + ".json");
    let text = fs::read_to_string(&report).expect("read");
    for (from, to) in [("\"bit_exact\": true", "\"bit_exact\": false"), ("\"frames\":", "\"images\":")] {
        fs::write(&report, text.replace(from, to)).expect("written");
        fs::remove_file(out.join(format!("points/{key}.json"))).ok();
        let output = sptfra(&with_runs);
        assert!(!output.status.success() && output.stdout.is_empty(), "{output:?}");
        assert!(["point ", &key, "run the point again"].iter().all(|word| self::text(&output.stderr).contains(word)));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out").display().to_string();
    let refused = |arguments: &[&str]| {
        let output = sptfra(&[&["sweep", &small(), "--out", &out], arguments].concat());
        assert!(!output.status.success() && output.stdout.is_empty(), "{arguments:?}");
        text(&output.stderr)
    };
    let foreign = root().join("scenes/sensor1-hertz.toml").display().to_string();
    assert!(refused(&["--scene", &foreign]).contains("sensor1-hertz"));
    assert!(refused(&["--filters", "f9"]).contains("f9"));
    assert!(refused(&["--filters", "f1-x"]).contains("f1-x"));
    assert!(refused(&["--lanes", "3", "--plans", "reduced"]).contains("no point is left"));
    assert!(refused(&["--scene", "no-such.toml"]).contains("no-such.toml"));
}

/// With Snakemake's local executor, two points: `sptfra run` for each, then the report of both.
#[test]
fn the_workflow_makes_the_same_report() {
    let folder = tempfile::tempdir().expect("a folder");
    let [jobs, here] = ["jobs", "here"].map(|name| folder.path().join(name));
    let snakemake = root().join(".venv/bin/snakemake");
    assert!(snakemake.exists(), "Snakemake is missing: make sweep-tools");
    let output = Command::new(&snakemake)
        .args(["--snakefile", "tools/sweep.smk", "--cores", "2", "--quiet", "--directory"])
        .arg(folder.path())
        .env("SPTFRA", env!("CARGO_BIN_EXE_sptfra"))
        .env("SWEEP_FOLDER", &jobs)
        .env("SWEEP_DESIGNS", small())
        .env("SWEEP_OPTIONS", "--filters none")
        .current_dir(root())
        .output()
        .expect("Snakemake starts");
    assert!(output.status.success(), "{}{}", text(&output.stdout), text(&output.stderr));
    assert_eq!(fs::read_dir(jobs.join("runs")).expect("reports").count(), 2, "both plans");
    succeeds(&["sweep", &small(), "--filters", "none", "--simulate", "--out", &here.display().to_string()]);
    for file in ["report.html", "sweep.json", "sweep.csv"] {
        let read = |folder: &Path| fs::read(folder.join(file)).expect("written");
        assert!(read(&jobs) == read(&here), "{file}");
    }
}
