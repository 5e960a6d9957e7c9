//! `FuseSoC` takes the core file: it lists the core, lints it, simulates it and writes a Vivado project for it.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use super::folder::{Folder, NAME, Ran, environment, files, run};
use crate::support::effort;

const CORE: &str = "user.org:tactile:small_4x3";

/// `FuseSoC` on the folder's core, with the pinned Verilator and a home of its own.
fn fusesoc(folder: &Folder, arguments: &[&str]) -> Ran {
    let home = folder.work().join("home");
    fs::create_dir_all(&home).expect("can be made");
    let mut command = Command::new(environment().join("bin/fusesoc"));
    for variable in ["HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME"] {
        command.env(variable, &home);
    }
    run(command.arg("--cores-root").arg(folder.design()).args(arguments).env("PATH", path()).current_dir(folder.work()))
}

/// `PATH` with the launcher of the pinned Verilator in front.
fn path() -> String {
    let launchers = concat!(env!("CARGO_MANIFEST_DIR"), "/../tools/bin");
    format!("{launchers}:{}", std::env::var("PATH").unwrap_or_default())
}

/// Runs a target in a folder without a space in its path, which the makefiles that `FuseSoC` writes cannot have.
fn target(folder: &Folder, target: &str) -> Ran {
    let place = tempfile::tempdir().expect("a folder");
    let root = place.path().join("work").display().to_string();
    fusesoc(folder, &["run", "--target", target, "--work-root", &root, CORE])
}

#[test]
fn the_core_is_listed_with_its_targets() {
    let folder = Folder::small();
    let listed = fusesoc(&folder, &["core", "list"]).succeeded();
    assert!(listed.stdout.contains(CORE), "{}", listed.stdout);
    let shown = fusesoc(&folder, &["core", "show", CORE]).succeeded();
    assert!(shown.stdout.contains("lint ") && shown.stdout.contains("synth "), "{}", shown.stdout);
}

#[test]
fn lint_passes_and_a_flaw_fails() {
    let folder = Folder::small();
    target(&folder, "lint").succeeded();
    let top = folder.design().join("rtl/small_4x3.v");
    let flawed = folder.read("rtl/small_4x3.v").replace("endmodule", "    wire never_used;\nendmodule");
    fs::write(top, flawed).expect("can be written");
    target(&folder, "lint").refused("never_used");
}

#[test]
fn a_file_that_is_missing_fails() {
    let folder = Folder::small();
    fs::remove_file(folder.design().join("rom/small_4x3_slots.mem")).expect("can be removed");
    target(&folder, "lint").refused("small_4x3_slots.mem");
}

#[test]
#[ignore = "twenty seconds: part of `make test-long`"]
fn the_testbench_runs_in_icarus_and_verilator() {
    let folder = Folder::small();
    let shown = fusesoc(&folder, &["core", "show", CORE]).succeeded();
    assert!(files(None).contains_key(&format!("sim/{NAME}_tb.v")) && shown.stdout.contains("sim "), "{}", shown.stdout);
    for simulator in ["sim", "sim_verilator"] {
        let ran = target(&folder, simulator).succeeded();
        let said = format!("{}{}", ran.stdout, ran.stderr);
        assert!(said.contains("PASS") && !said.contains("FAIL"), "{said}");
    }
}

/// A flipped bit of an expected word ends each simulator with an error, and so the flow.
#[test]
#[ignore = "twenty seconds: part of `make test-long`"]
fn a_wrong_word_fails_in_icarus_and_verilator() {
    let folder = Folder::small();
    flip_a_bit(&folder);
    for simulator in ["sim", "sim_verilator"] {
        let ran = target(&folder, simulator);
        assert!(!ran.ok && format!("{}{}", ran.stdout, ran.stderr).contains("FAIL: 1 words wrong"), "{ran:?}");
    }
}

fn flip_a_bit(folder: &Folder) {
    let expected = folder.design().join(format!("sim/{NAME}_expected.mem"));
    let text = fs::read_to_string(&expected).expect("readable");
    fs::write(&expected, text.replacen("000000000", "000000001", 1)).expect("can be written");
}

/// Plain `vvp`, without a flow around it.
#[test]
fn a_wrong_word_or_a_missing_rom_ends_plain_icarus_with_an_error() {
    let simulate = |folder: &Folder| {
        let files = ["-g2005", "-Wall", "-DSIMULATION", "-o", "tb.vvp", "-c", &format!("{NAME}.f")].map(str::to_owned);
        let mut compile = Command::new("iverilog");
        compile.args(files).arg(format!("sim/{NAME}_tb.v"));
        for (parameter, value) in
            [("ROM_DIR", "rom/"), ("STIMULUS", &stream("stimulus")), ("EXPECTED", &stream("expected"))]
        {
            compile.arg(format!("-P{NAME}_tb.{parameter}=\"{value}\""));
        }
        run(compile.current_dir(folder.design())).succeeded();
        run(Command::new("vvp").args(["-n", "tb.vvp"]).current_dir(folder.design()))
    };
    let folder = Folder::small();
    simulate(&folder).succeeded();
    flip_a_bit(&folder);
    let ran = simulate(&folder);
    assert!(!ran.ok && ran.stdout.contains("FAIL: 1 words wrong"), "{ran:?}");
    let folder = Folder::small();
    fs::remove_file(folder.design().join(format!("rom/{NAME}_slots.mem"))).expect("can be removed");
    let ran = simulate(&folder);
    assert!(!ran.ok && ran.stdout.contains("FAIL: "), "{ran:?}");
}

fn stream(name: &str) -> String {
    format!("sim/{NAME}_{name}.mem")
}

/// As docs/how-to/vivado.md has it, also with the system's Verilator.
#[test]
fn the_testbench_runs_as_a_binary_of_verilator() {
    binary_passes(Command::new("verilator").env("PATH", path()));
    if effort::all() {
        binary_passes(&mut Command::new("verilator"));
    }
}

fn binary_passes(command: &mut Command) {
    let folder = Folder::small();
    let binary = tempfile::tempdir().expect("a folder");
    command.args(["--binary", "--timing", "--top-module", &format!("{NAME}_tb"), "-F", &format!("{NAME}.f")]);
    command.arg(format!("sim/{NAME}_tb.v")).arg("--Mdir").arg(binary.path()).arg("-GROM_DIR=\"rom/\"");
    for (parameter, file) in [("STIMULUS", "stimulus"), ("EXPECTED", "expected")] {
        command.arg(format!("-G{parameter}=\"sim/{NAME}_{file}.mem\""));
    }
    // For a few frames the compiler need not make haste.
    command.env("MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0");
    run(command.current_dir(folder.design())).succeeded();
    let program = binary.path().join(format!("V{NAME}_tb"));
    let ran = run(Command::new(program).current_dir(folder.design())).succeeded();
    assert!(ran.stdout.contains("PASS: "), "{}", ran.stdout);
}

/// The project script that `FuseSoC` writes is Vivado Tcl again, and the stub runs it.
#[test]
fn the_vivado_project_reads_every_file() {
    let folder = Folder::small();
    let work = folder.work().join("synth");
    let root = work.display().to_string();
    fusesoc(&folder, &["run", "--target", "synth", "--setup", "--work-root", &root, CORE]).succeeded();
    let script: PathBuf = work.join(format!("user.org_tactile_{NAME}_1.0.tcl"));
    let record = folder.work().join("record");
    let mut command = Command::new("tclsh");
    let stub = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/flows/vivado.tcl");
    run(command.arg(stub).arg(&record).arg(script).current_dir(&work)).succeeded();
    let calls = fs::read_to_string(record).expect("recorded");
    assert!(calls.contains("-value {-mode out_of_context} -objects run:synth_1"), "{calls}");
    for path in files(None).into_keys().filter(|path| path.starts_with("rtl/") || path.starts_with("rom/")) {
        let name = path.rsplit('/').next().expect("a name");
        assert!(calls.contains(name), "{path} is not read:\n{calls}");
    }
}
