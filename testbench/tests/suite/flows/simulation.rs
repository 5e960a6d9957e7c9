//! The self-checking testbench by its script for Vivado's simulator. Stubs of the three programs check what they
//! are asked for and let Icarus Verilog do it, so that the verdict is a real one.

use std::env;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use super::control;
use super::folder::{Folder, NAME, Ran, files, run};

const SCRIPT: &str = "vivado/simulate.tcl";

/// Runs the script in plain Tcl with the stubs on the path; their calls are the record.
fn simulate_with(folder: &Folder, environment: &[(&str, &str)]) -> Ran {
    let programs = folder.work().join("programs of the simulator");
    fs::create_dir_all(&programs).expect("can be made");
    let stub = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/flows/simulator.tcl");
    for program in ["xvlog", "xelab", "xsim"] {
        let launcher = programs.join(program);
        fs::write(&launcher, format!("#!/bin/sh\nexec tclsh '{stub}' {program} \"$@\"\n")).expect("can be written");
        fs::set_permissions(&launcher, fs::Permissions::from_mode(0o755)).expect("can be set");
    }
    let record = folder.work().join("record_simulator");
    let _ = fs::remove_file(&record);
    let path = format!("{}:{}", programs.display(), env::var("PATH").unwrap_or_default());
    let mut command = Command::new("tclsh");
    command.arg(folder.design().join(SCRIPT)).env("PATH", path).envs(environment.iter().copied());
    let ran = run(command.current_dir(folder.work()));
    let calls = fs::read_to_string(record).unwrap_or_default();
    Ran { calls: calls.lines().map(str::to_owned).collect(), ..ran }
}

fn simulate(folder: &Folder) -> Ran {
    simulate_with(folder, &[])
}

/// The example for another simulator's users.
fn is_for_cocotb(path: &str) -> bool {
    path.ends_with("_cocotb.py")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn the_testbench_passes_and_every_file_is_used() {
    let folder = Folder::small();
    let before = names(&folder.design().join("sim"));
    let ran = simulate(&folder).succeeded();
    let line = ran.last_line();
    assert!(line.starts_with("small_4x3 in Vivado's simulator: PASS: 7 frames, "), "{line}");
    let compiled = ran.call("xvlog");
    let data = names(&folder.work().join(format!("{NAME}_xsim")));
    for path in files(None).into_keys() {
        let name = path.rsplit('/').next().expect("a name");
        if path.starts_with("rtl/") || path == format!("sim/{NAME}_tb.v") {
            assert!(compiled.contains(&format!("/{path}")), "{path} is not compiled");
        } else if path.starts_with("rom/") || path.starts_with("sim/") && !is_for_cocotb(&path) {
            assert!(data.iter().any(|file| file == name), "{path} is not beside the simulation");
        }
    }
    assert_eq!(ran.calls.len(), 3);
    assert_eq!(names(&folder.design().join("sim")), before, "nothing is written into the generated folder");
    // Again, over what the first run left.
    simulate(&folder).succeeded();
}

#[test]
fn a_design_with_a_register_bank_passes() {
    let ran = simulate(&Folder::new(&control::control())).succeeded();
    assert!(ran.last_line().starts_with("small_control in Vivado's simulator: PASS: 7 frames, "), "{ran:?}");
}

/// The simulator itself ends with 0 then, so the script must not.
#[test]
fn a_wrong_word_is_an_error() {
    let folder = Folder::small();
    let expected = folder.design().join(format!("sim/{NAME}_expected.mem"));
    let text = fs::read_to_string(&expected).expect("readable");
    fs::write(&expected, text.replacen("000000000", "000000001", 1)).expect("can be written");
    simulate(&folder).refused("small_4x3 in Vivado's simulator: FAIL: 1 words wrong");
}

#[test]
fn a_simulation_without_a_verdict_is_an_error() {
    simulate_with(&Folder::small(), &[("STANDIN_MUTE", "1")]).refused("no verdict");
}

#[test]
fn flawed_verilog_is_an_error_of_the_program_that_finds_it() {
    let folder = Folder::small();
    let top = folder.design().join(format!("rtl/{NAME}.v"));
    let text = fs::read_to_string(&top).expect("readable");
    fs::write(&top, text.replace("endmodule", "    nothing here (); \nendmodule")).expect("can be written");
    let ran = simulate(&folder);
    ran.refused("xelab failed, see above and xelab.log in ");
    assert!(ran.stdout.contains("nothing"), "{}", ran.stdout);
}

#[test]
fn without_the_simulator_the_message_says_what_to_do() {
    let folder = Folder::small();
    // Only Tcl itself is on the path.
    let tcl = env::split_paths(&env::var_os("PATH").unwrap_or_default())
        .map(|folder| folder.join("tclsh"))
        .find(|program| program.is_file())
        .expect("tclsh is installed: run `make tools`");
    let mut command = Command::new(tcl);
    command.arg(folder.design().join(SCRIPT)).env("PATH", folder.work()).current_dir(folder.work());
    run(&mut command).refused("xvlog is not on the path: run Vivado's settings64 script");
}

/// Broken copies of the script: each is refused, and for the reason given.
#[test]
fn every_fault_is_refused_for_its_reason() {
    for (right, wrong, message) in [
        (" -runall", "", "xsim failed"),
        (" -snapshot ", " -snap ", "xelab failed"),
        (" -timescale 1ns/1ps", "", "xelab failed"),
        ("call xvlog -sv -define SIMULATION {*}$rtl $testbench", "", "xelab failed"),
        ("{*}$rtl $testbench", "{*}$rtl", "xelab failed"),
        ("xsim ${design}_tb", "xsim $design", "xsim failed"),
        // Without its ROMs the core's words are unknown, without its frames the testbench's.
        ("[concat $rom $sim_data]", "$sim_data", "FAIL: "),
        ("[concat $rom $sim_data]", "$rom", "FAIL: "),
    ] {
        let folder = Folder::small();
        let text = folder.read(SCRIPT);
        assert_eq!(text.matches(right).count(), 1, "{SCRIPT} has {right:?} once");
        fs::write(folder.design().join(SCRIPT), text.replace(right, wrong)).expect("can be written");
        simulate(&folder).refused(message);
    }
}

#[test]
fn every_named_file_is_missed() {
    let folder = Folder::small();
    let used = |path: &String| ["rtl/", "rom/", "sim/"].iter().any(|start| path.starts_with(start));
    for path in files(None).into_keys().filter(|path| used(path) && !is_for_cocotb(path)) {
        let place = folder.design().join(&path);
        let aside = folder.design().join("aside");
        fs::rename(&place, &aside).expect("can be moved");
        let ran = simulate(&folder);
        assert!(!ran.ok, "{path}: {ran:?}");
        fs::rename(&aside, &place).expect("can be moved");
    }
}
