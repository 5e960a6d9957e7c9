//! The workflow in `docs/ci`: its steps, run here in the order in which a runner would. And the project's own.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::support::effort::ALL;
use crate::support::sptfra;

use super::folder::{environment, run, workspace, yaml};

/// Steps that fetch or install, which the checkout that runs this test has done already.
const DONE_BEFORE: [&str; 4] = ["Design", "Generator", "Earlier builds", "Tools"];
/// Steps that only a runner can take.
const RUNNER_ONLY: [&str; 1] = ["Keep the results"];

fn text<'a>(step: &'a Value, key: &str) -> Option<&'a str> {
    step[key].as_str()
}

#[test]
fn its_steps_generate_lint_and_simulate_a_design() {
    let workflow = yaml(&workspace().join("docs/ci/tactile-design.yml"));
    let place = tempfile::tempdir().expect("a folder");
    let program = sptfra();
    let target = program.ancestors().nth(2).expect("a target folder");
    let generator = place.path().join("generator");
    fs::create_dir(&generator).expect("can be made");
    symlink(target, generator.join("target")).expect("can be linked");
    symlink(environment(), generator.join(".venv")).expect("can be linked");
    let design = workflow["env"]["DESIGN"].as_str().expect("a design");
    fs::copy(workspace().join("golden/tests/designs/small.toml"), place.path().join(design)).expect("can be copied");

    let mut taken = Vec::new();
    for step in workflow["jobs"]["hardware"]["steps"].as_array().expect("steps") {
        let name = text(step, "name").expect("a name");
        if DONE_BEFORE.contains(&name) || RUNNER_ONLY.contains(&name) {
            continue;
        }
        let script = text(step, "run").unwrap_or_else(|| panic!("step {name} has nothing to run"));
        let folder = place.path().join(text(step, "working-directory").unwrap_or("."));
        let mut shell = Command::new("bash");
        shell.args(["--noprofile", "--norc", "-eo", "pipefail", "-c", script]).env("DESIGN", design);
        run(shell.current_dir(folder)).succeeded();
        taken.push(name);
    }
    assert_eq!(taken, ["Inspect", "Generate", "Lint with Verilator", "Lint with Icarus Verilog", "Simulate"]);
    assert!(place.path().join("hardware/small_4x3.core").exists());
    let report = fs::read(place.path().join("report.json")).expect("written");
    let report: Value = serde_json::from_slice(&report).expect("JSON");
    assert_eq!(report["bit_exact"], true);
}

/// What it runs is this test and all others; here only that it is a workflow and that the target exists.
#[test]
fn the_projects_own_workflow_runs_all_tests() {
    let workflow = yaml(&workspace().join(".github/workflows/test.yml"));
    let steps = workflow["jobs"]["test"]["steps"].as_array().expect("steps");
    let commands: Vec<&str> = steps.iter().filter_map(|step| text(step, "run")).collect();
    assert_eq!(commands.last(), Some(&"make test"));
    let menu = fs::read_to_string(workspace().join("Makefile")).expect("there");
    assert!(menu.contains("\n.PHONY: test\n"), "{menu}");
}

/// The nightly tests try all: their workflow calls the target, which sets the variable that tests read, and runs each crate in
/// which a test is left to it.
#[test]
fn the_long_tests_are_called_and_try_all() {
    let workflow = yaml(&workspace().join(".github/workflows/test-long.yml"));
    let steps = workflow["jobs"]["test"]["steps"].as_array().expect("steps");
    assert_eq!(steps.iter().filter_map(|step| text(step, "run")).next_back(), Some("make test-long"));
    let menu = fs::read_to_string(workspace().join("Makefile")).expect("there");
    let recipe = menu.split("\ntest-long:").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a target");
    assert!(recipe.contains(&format!("\t{ALL}=1 $(CARGO) test --workspace\n")), "{recipe}");
    for crate_name in ["golden", "hdl-gen", "testbench"] {
        let left = left_to_it(&workspace().join(crate_name).join("tests"));
        let run = recipe.contains(&format!(" -p sptfra-{crate_name} ")) && recipe.ends_with("-- --ignored");
        assert_eq!(left > 0, run, "{crate_name}: {left} tests are left to it");
    }
}

/// Tests below a folder that only `make test-long` runs.
fn left_to_it(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let in_entry = |path: PathBuf| match path.extension() {
        _ if path.is_dir() => left_to_it(&path),
        Some(ending) if ending == "rs" => {
            let text = fs::read_to_string(&path).expect("readable");
            let left = |line: &&str| line.starts_with("#[ignore = ") && line.ends_with(": part of `make test-long`\"]");
            text.lines().filter(left).count()
        }
        _ => 0,
    };
    entries.map(in_entry).sum()
}

/// That a release is made of what `make dist` and `tools/dist.py` make; both have tests of their own.
#[test]
fn the_release_workflow_calls_what_is_there() {
    let workflow = yaml(&workspace().join(".github/workflows/release.yml"));
    let steps = workflow["jobs"]["release"]["steps"].as_array().expect("steps");
    let commands = steps.iter().filter_map(|step| text(step, "run")).collect::<Vec<_>>().join("\n");
    let menu = fs::read_to_string(workspace().join("Makefile")).expect("there");
    for target in ["tools", "dist"] {
        assert!(commands.lines().any(|line| line == format!("make {target}")), "{commands}");
        assert!(menu.contains(&format!("\n.PHONY: {target}\n")), "{target}");
    }
    let options = fs::read_to_string(workspace().join("tools/dist.py")).expect("there");
    for option in ["--check", "--notes"] {
        assert!(commands.contains(&format!("tools/dist.py {option}")) && options.contains(option), "{option}");
    }
}
