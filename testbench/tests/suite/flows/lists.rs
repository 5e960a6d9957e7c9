//! The plain file list and Bender's manifest name the same sources, and tools read them.

use serde_json::Value;
use testbench::tools;

use super::folder::{Folder, NAME, files, run, yaml};
use crate::support::icarus;

fn sources() -> Vec<String> {
    files(None).into_keys().filter(|path| path.starts_with("rtl/")).collect()
}

#[test]
fn the_file_list_is_complete() {
    let list = Folder::small().read("small_4x3.f");
    assert_eq!(list.lines().collect::<Vec<_>>(), sources());
}

#[test]
fn verilator_reads_the_file_list_from_anywhere() {
    let folder = Folder::small();
    let list = folder.design().join("small_4x3.f");
    let mut verilator = tools::verilator().expect("make tools was run");
    let arguments = ["--lint-only", "-Wall", "--top-module", NAME, "-F"];
    run(verilator.args(arguments).arg(list).current_dir(folder.work())).succeeded();
}

#[test]
fn icarus_reads_the_file_list() {
    let folder = Folder::small();
    let mut icarus = icarus();
    let arguments = ["-g2005", "-Wall", "-t", "null", "-s", NAME, "-c", "small_4x3.f"];
    let ran = run(icarus.args(arguments).current_dir(folder.design())).succeeded();
    assert_eq!((ran.stdout, ran.stderr), (String::new(), String::new()));
}

#[test]
fn yosys_reads_the_file_list() {
    let folder = Folder::small();
    let script = format!("read_verilog_file_list -F {NAME}.f; hierarchy -check -top {NAME}; proc; check -assert");
    let mut yosys = tools::yosys().expect("make tools was run");
    run(yosys.args(["-q", "-p", &script]).current_dir(folder.design())).succeeded();
}

#[test]
fn benders_manifest_names_the_same_sources() {
    let folder = Folder::small();
    let manifest = yaml(&folder.design().join("Bender.yml"));
    assert_eq!(manifest["package"]["name"], NAME);
    let listed = manifest["sources"].as_array().expect("sources").iter().filter_map(Value::as_str);
    assert_eq!(listed.collect::<Vec<_>>(), sources());
}
