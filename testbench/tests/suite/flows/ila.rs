//! The logic analyser that `generate --debug` prepares, in the stub.

use std::fs;

use hdl_gen::emit::{FileMap, Options, emit_for};
use hdl_gen::plan::Plan;

use super::folder::{Folder, Ran};
use crate::support::shipped;

const SYSTEM: &str = "vivado/block_design.tcl";
const ANALYSER: &str = "vivado/ila.tcl";
const MARK: &str = "    (* mark_debug = \"true\" *)\n";

/// The files of a design with marked nets.
fn marked(design: &str) -> FileMap {
    let design = shipped(design);
    let plan = Plan::new(&design).expect("can be planned");
    emit_for(&plan, &Options { debug: true, ..Options::default() }).expect("is printed")
}

#[test]
fn every_kind_of_core_has_the_nets() {
    // Of taxels by themselves there is one kind of result less, of components without a field two.
    let designs = ["small", "small-scanner", "odd", "sensor1-fast", "sensor1-f1-l40"];
    for (design, nets) in designs.into_iter().zip([20, 18, 19, 20, 19]) {
        let files = marked(design);
        let marks = files.values().map(|text| String::from_utf8_lossy(text).matches(MARK).count()).sum::<usize>();
        assert_eq!(marks, nets, "{design}");
        let script = String::from_utf8_lossy(&files[ANALYSER]).into_owned();
        assert_eq!(
            script
                .split("set probes {")
                .nth(1)
                .and_then(|list| list.split('}').next())
                .map(|list| { list.split_whitespace().count() }),
            Some(nets),
            "{design}"
        );
    }
}

fn implemented(folder: &Folder, environment: &[(&str, &str)]) -> Ran {
    folder.vivado(SYSTEM, &["bitstream"], environment)
}

#[test]
fn every_marked_net_has_a_probe_in_the_clock_of_the_core() {
    for (design, core, within) in [
        ("small", "rtl/small_4x3.v", "system_i/core/inst/"),
        ("small-control", "rtl/small_control_core.v", "system_i/core/inst/core/"),
    ] {
        let files = marked(design);
        let verilog = std::str::from_utf8(&files[core]).expect("text");
        let nets: Vec<&str> = verilog
            .split(MARK)
            .skip(1)
            .filter_map(|after| after.lines().next()?.split(';').next()?.split_whitespace().last())
            .collect();
        assert_eq!(nets.len(), 20, "{nets:?}");
        let folder = Folder::new(&files);
        let ran = implemented(&folder, &[]).succeeded();
        let of_probes: Vec<&String> =
            ran.calls.iter().filter(|call| call.starts_with("connect_debug_port") && call.contains("/probe")).collect();
        assert_eq!(of_probes.len(), nets.len());
        for net in nets {
            let path = format!("{within}{net}");
            let mut found = of_probes.iter().filter(|call| {
                let after = call.split(&path).nth(1);
                after.is_some_and(|rest| rest.is_empty() || rest.starts_with(['[', '}']))
            });
            assert!(found.next().is_some() && found.next().is_none(), "{path}: {of_probes:?}");
        }
        assert!(ran.call("connect_debug_port").ends_with("/clk system_i/clock"));
        // The lowest bit of the words is the probe's lowest.
        let words = of_probes.iter().find(|call| call.contains("out_tdata")).expect("words");
        assert!(words.find("out_tdata[0]") < words.find("out_tdata[31]"), "{words}");
        let board = if design == "small" { "small_4x3_zcu102" } else { "small_control_zcu102" };
        assert!(folder.work().join(format!("{board}.ltx")).exists());
    }
}

#[test]
fn a_design_without_it_has_neither_script_nor_mark() {
    let folder = Folder::small();
    assert!(!folder.design().join(ANALYSER).exists() && !folder.read("rtl/small_4x3.v").contains("mark_debug"));
    let ran = implemented(&folder, &[]).succeeded();
    assert!(!ran.calls.iter().any(|call| call.contains("debug")));
    assert!(!folder.work().join("small_4x3_zcu102.ltx").exists());
    // The hash apart, marks and what attaches the analyser are all that differs.
    let files = marked("small");
    let bare = std::str::from_utf8(&files["rtl/small_4x3.v"]).expect("text").replace(MARK, "");
    let lines = |text: &str| text.lines().skip(3).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(lines(&bare), lines(&folder.read("rtl/small_4x3.v")));
}

#[test]
fn broken_copies_are_refused() {
    let files = marked("small");
    for (path, right, wrong, message) in [
        (
            "rtl/small_4x3.v",
            "    (* mark_debug = \"true\" *)\n    wire in_tlast;",
            "    wire in_tlast;",
            "no net in_tlast is",
        ),
        (ANALYSER, "{MARK_DEBUG == 1}", "{DEBUG == 1}", "get_nets: filter DEBUG == 1"),
        (ANALYSER, "port_width [llength $nets]", "port_width 1", "has 1 channels for 6 nets"),
        (ANALYSER, "        create_debug_port $ila probe\n", "", "no debug port ila_small_4x3/probe1"),
        (ANALYSER, "[lindex $places 0]aclk", "aclk", "net is aclk"),
        (ANALYSER, "set samples 1024", "set samples 1000", "depth is 1000"),
        (ANALYSER, "C_TRIGIN_EN false", "C_TRIGGER_IN false", "no property C_TRIGGER_IN"),
        (ANALYSER, "    connect_debug_port $ila/probe$index [get_nets $nets]\n", "", "has unconnected channels"),
        (SYSTEM, "vivado ila.tcl]", "vivado analyser.tcl]", "analyser.tcl"),
    ] {
        let folder = Folder::new(&files);
        let text = folder.read(path);
        assert_eq!(text.matches(right).count(), 1, "{path} has {right:?} once");
        fs::write(folder.design().join(path), text.replace(right, wrong)).expect("can be written");
        implemented(&folder, &[]).refused(message);
    }
    implemented(&Folder::new(&files), &[("STANDIN_CORES", "other")]).refused("an analyser is for one core");
}
