//! Registers that are equal in all lanes, cells, or points, and are there so that each has its own at hand: a tool that joins equal
//! registers, and leaves alone those that are marked, leaves one in each.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use crate::support::{by_plan, planned, shipped, with_joint};
use golden::design::{Design, Outputs, PlanKind};
use hdl_gen::emit::emit;
use serde_json::Value;
use testbench::tools;

/// Marks of registers count for their cells in Yosys: it looks for none on a wire where it joins what is equal.
const KEEP: &str = "setattr -set keep 1 a:keep %ci1:+[Q] t:$*dff* %i";

/// The registers of which lanes or cells share one, by name, after equal ones were joined.
fn shared(design: &Design, marked: bool) -> BTreeSet<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut sources = Vec::new();
    for (path, contents) in emit(&planned(design)).expect("emitted") {
        let place = folder.path().join(&path);
        fs::create_dir_all(place.parent().expect("a file has a folder")).expect("writable");
        fs::write(&place, contents).expect("writable");
        if path.starts_with("rtl/") {
            sources.push(path);
        }
    }
    let top = &design.name;
    let script = format!(
        "read_verilog -sv -defer {}; chparam -set ROM_DIR \"rom/\" {top}; hierarchy -top {top}; proc; {}; flatten; \
         opt_merge -share_all; write_json joined.json",
        sources.join(" "),
        if marked { KEEP } else { "" }
    );
    let mut yosys = tools::yosys().expect("installed");
    let made = yosys.args(["-q", "-p", &script]).current_dir(&folder).output().expect("starts");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let text = fs::read_to_string(folder.path().join("joined.json")).expect("written");
    let netlist: Value = serde_json::from_str(&text).expect("JSON");
    let module = &netlist["modules"][top.as_str()];
    let bits =
        |value: &Value| -> Vec<u64> { value.as_array().into_iter().flatten().filter_map(Value::as_u64).collect() };
    // What registers drive; then who has each of these bits, by the register's name without the copy's number. Those that
    // have a name outside are no lane's or cell's.
    let cells = module["cells"].as_object().expect("cells").values();
    let registers = cells.filter(|cell| cell["type"].as_str().is_some_and(|kind| kind.contains("dff")));
    let driven: BTreeSet<u64> = registers.flat_map(|cell| bits(&cell["connections"]["Q"])).collect();
    let mut owners: BTreeMap<u64, BTreeSet<(String, String)>> = BTreeMap::new();
    let mut outside: BTreeSet<u64> = BTreeSet::new();
    // Yosys' own names say nothing of who looks at them.
    let wires = module["netnames"].as_object().expect("wires").iter();
    for (name, wire) in wires.filter(|(name, _)| !name.starts_with('$')) {
        let copy = ["gen_pes[", "gen_cells[", "gen_points["].iter().find_map(|array| name.find(array));
        let Some((number, register)) = copy.and_then(|at| Some(name.split_at(at + name[at..].find("].")? + 2))) else {
            outside.extend(bits(&wire["bits"]));
            continue;
        };
        for bit in bits(&wire["bits"]).into_iter().filter(|bit| driven.contains(bit)) {
            owners.entry(bit).or_default().insert((number.to_owned(), register.to_owned()));
        }
    }
    owners.retain(|bit, _| !outside.contains(bit));
    let several = owners.into_values().filter(|owners| {
        let copies: BTreeSet<&String> = owners.iter().map(|(number, _)| number).collect();
        copies.len() > 1
    });
    several.flatten().map(|(_, register)| register).filter(|register| !register.contains('$')).collect()
}

/// What each point of the grid search has of its own.
const OF_POINTS: [&str; 3] = ["point.clears", "point.counts", "point.is_nothing"];

/// The test below finds the same in a design with cells, too.
#[test]
#[ignore = "six seconds of Yosys: part of `make test-long`"]
fn each_point_has_its_own() {
    let design = shipped("small-joint");
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<BTreeSet<_>>();
    let [marked, free] = [true, false].map(|marked| shared(&design, marked));
    assert_eq!(&free - &marked, names(&OF_POINTS));
}

#[test]
fn each_lane_and_cell_has_its_own() {
    let mut line = by_plan(shipped("small"), PlanKind::Reduced, Outputs::Field);
    line.hardware.lanes = 8;
    let joint = with_joint(line.clone());
    let of_pes = ["pe.base_2"];
    let of_cells = ["element_1", "element_2", "element_3"];
    // A flag of a leaf core, and what becomes a register of the multiplier.
    let of_none = ["pe.row_sequencer.primes"];
    let factor = ["factor_1", "multiplier.coefficient"];
    for (design, copies, free) in [(line, &of_cells[..], &factor[..]), (joint, &OF_POINTS[..], &[][..])] {
        let names = |parts: &[&[&str]]| -> BTreeSet<String> {
            parts.iter().flat_map(|part| part.iter().map(|&name| name.to_owned())).collect()
        };
        let left = names(&[&of_none, free]);
        assert_eq!(shared(&design, true), left);
        assert_eq!(shared(&design, false), names(&[&of_pes, copies, &of_none, free]));
    }
}
