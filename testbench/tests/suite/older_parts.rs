//! Multipliers on a 7-series part, whose DSP48E1 multiplies 25 by 18 bits: as many as Yosys makes of the whole design.

use std::fs;

use golden::design::Design;
use hdl_gen::emit::emit;
use hdl_gen::plan::Plan;
use testbench::tools;

use crate::support::shipped;

/// The device of the board in `hdl-gen/boards` that has one.
const PART: &str = "xc7z020clg400-1";

/// The grid search with its correction on 4 x 3 taxels: lanes, field, features, network, points, friction and summary.
fn plan(data_bits: u32) -> Plan {
    let mut design: Design = shipped("small-joint");
    PART.clone_into(&mut design.hardware.part);
    design.hardware.data_bits = data_bits;
    Plan::new(&design).expect("a plan")
}

/// Vectors of 25 bits: the whole design flattened, since only then does a tool see how long an operand really is.
#[test]
#[ignore = "twenty seconds of Yosys: part of `make test-long`"]
fn multipliers_of_a_7_series_part_are_those_that_yosys_makes() {
    let plan = plan(25);
    let folder = tempfile::tempdir().expect("a folder");
    for (path, contents) in emit(&plan).expect("files") {
        let place = folder.path().join(&path);
        fs::create_dir_all(place.parent().expect("a folder")).expect("made");
        fs::write(place, contents).expect("written");
    }
    let name = &plan.design.name;
    let dsp = plan.resources.dsp;
    assert!(plan.resources.multipliers < dsp && dsp < 2 * plan.resources.multipliers, "{:?}", plan.resources);
    let count = |dsp: usize| {
        let script = format!(
            "read_verilog -sv -defer rtl/*.v; chparam -set ROM_DIR \"rom/\" {name}; \
             synth_xilinx -family xc7 -noiopad -noclkbuf -flatten -top {name} -run begin:coarse; \
             select -assert-count {dsp} t:DSP48E1; select -assert-none t:$mul t:$__soft_mul"
        );
        tools::yosys().expect("installed").args(["-q", "-p", &script]).current_dir(&folder).output().expect("starts")
    };
    let output = count(dsp);
    assert!(output.status.success(), "{dsp}: {}", String::from_utf8_lossy(&output.stderr));
}

/// What a longer vector costs, and where it costs nothing more.
#[test]
fn a_longer_vector_takes_two_in_lanes_and_field() {
    let (short, long) = (plan(25), plan(27));
    let by_name = |plan: &Plan, name: &str| {
        let block = plan.resources.blocks.iter().find(|block| block.name == name).expect("the block");
        (block.multipliers, block.dsp)
    };
    for (name, with_25, with_27) in [
        ("lanes", (4, 4), (4, 8)),
        ("field", (1, 1), (1, 2)),
        ("features", (6, 12), (6, 12)),
        ("friction", (1, 2), (1, 2)),
        ("summary", (1, 2), (1, 2)),
        // Five squares of 17 bits, and two moments of the grid search.
        ("search", (7, 9), (7, 9)),
    ] {
        assert_eq!((by_name(&short, name), by_name(&long, name)), (with_25, with_27), "{name}");
    }
    let mut design = long.design.clone();
    design.hardware.part = shipped("small-joint").hardware.part;
    let newer = Plan::new(&design).expect("a plan");
    assert_eq!(newer.resources.dsp, newer.resources.multipliers);
    assert_eq!(newer.resources.multipliers, long.resources.multipliers);
}
