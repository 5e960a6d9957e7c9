//! Two cores of different ages in one project: their libraries share names, and a prefix keeps them apart.

use std::fs;
use std::process::Command;

use golden::design::Design;
use hdl_gen::emit::{FileMap, Options, emit_for};
use hdl_gen::plan::Plan;

use super::folder::{Folder, NAME, Ran, files, run, workspace};

/// The small design under another name, with a prefix or none.
fn other(prefix: Option<&str>) -> FileMap {
    let text = fs::read_to_string(workspace().join("golden/tests/designs/small.toml")).expect("the design is there");
    let design = Design::from_toml(&text.replace(NAME, "other_4x3"), "other.toml").expect("is right");
    let prefix = prefix.map(|prefix| prefix.parse().expect("a prefix"));
    emit_for(&Plan::new(&design).expect("can be planned"), &Options { prefix, ..Options::default() })
        .expect("is printed")
}

/// The small design with an earlier library, of which one file differs.
fn earlier() -> FileMap {
    let mut files = files(None);
    let reset = files.get_mut("rtl/sptfra_reset.v").expect("a module");
    *reset = String::from_utf8_lossy(reset).replace("sptfra_reset (", "sptfra_reset /* earlier */ (").into_bytes();
    files
}

/// Both folders' Verilog in one run of Icarus Verilog, with the testbench of `name` at the top.
fn simulate(one: &Folder, other: &Folder, name: &str) -> Ran {
    let place = if name == NAME { one } else { other };
    let program = place.work().join("both.vvp");
    let mut compile = Command::new("iverilog");
    compile.args(["-g2005", "-s", &format!("{name}_tb"), "-o"]).arg(&program);
    for folder in [one, other] {
        let list = fs::read_dir(folder.design().join("rtl")).expect("a folder");
        compile.args(list.map(|entry| entry.expect("an entry").path()));
    }
    compile.arg(place.design().join(format!("sim/{name}_tb.v")));
    let stream = |kind: &str| format!("sim/{name}_{kind}.mem");
    for (parameter, value) in
        [("ROM_DIR", "rom/".to_owned()), ("STIMULUS", stream("stimulus")), ("EXPECTED", stream("expected"))]
    {
        compile.arg(format!("-P{name}_tb.{parameter}=\"{value}\""));
    }
    let compiled = run(&mut compile);
    if !compiled.ok {
        return compiled;
    }
    run(Command::new("vvp").arg("-n").arg(program).current_dir(place.design()))
}

#[test]
fn both_simulate_where_one_has_a_prefix() {
    let (old, new) = (Folder::new(&earlier()), Folder::new(&other(Some("v2_"))));
    for name in [NAME, "other_4x3"] {
        let ran = simulate(&old, &new, name).succeeded();
        assert!(ran.stdout.contains("PASS: "), "{ran:?}");
    }
}

#[test]
fn without_a_prefix_the_modules_are_declared_twice() {
    let ran = simulate(&Folder::new(&earlier()), &Folder::new(&other(None)), NAME);
    assert!(!ran.ok && ran.stderr.contains("sptfra_"), "{ran:?}");
}

#[test]
fn lists_scripts_and_metadata_follow_and_every_file_says_its_version() {
    let files = other(Some("v2_"));
    let text = |path: &str| String::from_utf8_lossy(&files[path]).into_owned();
    for list in ["other_4x3.f", "other_4x3.core", "Bender.yml", "vivado/files.tcl", "metadata.json"] {
        let text = text(list);
        assert!(text.contains("rtl/v2_sptfra_reset.v") || text.contains("v2_sptfra_reset.v"), "{list}: {text}");
        assert!(!text.contains("rtl/sptfra_") && !text.contains(" sptfra_reset"), "{list}: {text}");
    }
    for path in files.keys().filter(|path| path.starts_with("rtl/")) {
        assert!(text(path).lines().take(3).any(|line| line.contains(hdl_gen::emit::VERSION)), "{path}");
    }
}
