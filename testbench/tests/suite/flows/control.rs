//! The scripts and lists of a design with a register bank.

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use hdl_gen::emit::{FileMap, emit};
use hdl_gen::plan::Plan;
use testbench::tools;

use super::folder::{Folder, run, workspace, yaml};
use crate::support::{icarus, icarus_runtime, shipped};

const NAME: &str = "small_control";

/// The small design with a register bank.
pub fn control() -> FileMap {
    let design = shipped("small-control");
    emit(&Plan::new(&design).expect("can be planned")).expect("is printed")
}

#[test]
fn the_ip_has_a_register_port_and_an_interrupt() {
    let folder = Folder::new(&control());
    let ran = folder.vivado("vivado/package_ip.tcl", &[], &[]).succeeded();
    ran.call("ipx::associate_bus_interfaces -busif s_axi_ctrl -clock aclk");
    ran.call("ipx::get_memory_maps s_axi_ctrl");
    let blind = folder.vivado("vivado/package_ip.tcl", &[], &[("STANDIN_BLIND", "1")]);
    blind.refused("the attributes on the ports of small_control made no interface s_axi_ctrl");
}

/// Name, lowest bit, width, and what software may do.
type Field = (String, u32, u32, String);

fn python() -> Command {
    Command::new(super::folder::environment().join("bin/python"))
}

/// Address and fields of each register, as `SystemRDL`'s compiler reads the map in the folder.
fn map(folder: &Folder) -> BTreeMap<String, (u32, Vec<Field>)> {
    let rdl = folder.design().join(format!("control/{NAME}.rdl"));
    let said = run(python().arg(workspace().join("tools/register_map.py")).arg(rdl)).succeeded();
    let registers: Vec<serde_json::Value> = serde_json::from_str(&said.stdout).expect("JSON");
    let number = |of: &serde_json::Value| u32::try_from(of.as_u64().expect("a number")).expect("32 bits");
    let field = |of: &serde_json::Value| {
        let access = match (of["readable"] == true, of["writable"] == true) {
            (true, true) => "read-write",
            (true, false) => "read-only",
            (false, _) => "write-only",
        };
        let (low, high) = (number(&of["low"]), number(&of["high"]));
        (of["name"].as_str().expect("a name").to_owned(), low, high + 1 - low, access.to_owned())
    };
    let register = |of: &serde_json::Value| {
        let fields = of["fields"].as_array().expect("fields").iter().map(field).collect();
        (of["name"].as_str().expect("a name").to_owned(), (number(&of["address"]), fields))
    };
    registers.iter().map(register).collect()
}

#[test]
fn the_ip_has_the_registers_of_the_map() {
    let folder = Folder::new(&control());
    let ran = folder.vivado("vivado/package_ip.tcl", &[], &[]).succeeded();
    let set = |object: &str, property: &str| {
        let start = format!("set_property {property} ");
        let mut calls = ran.calls.iter().filter_map(|call| call.strip_prefix(&start)?.strip_suffix(object));
        calls.next().unwrap_or_else(|| panic!("no {property} of {object}")).trim().to_owned()
    };
    let map = map(&folder);
    for (name, (address, fields)) in &map {
        assert_eq!(set(&format!("register:{name}"), "address_offset"), format!("0x{address:03X}"));
        for (field, low, width, access) in fields {
            let object = format!(" field:{name}.{field}");
            let found = ["bit_offset", "bit_width", "access"].map(|property| set(&object, property));
            assert_eq!(found, [low.to_string(), width.to_string(), access.clone()], "{object}");
        }
    }
    let added = |kind: &str| ran.calls.iter().filter(|call| call.starts_with(&format!("ipx::add_{kind} "))).count();
    let fields: usize = map.values().map(|(_, fields)| fields.len()).sum();
    assert_eq!((added("register"), added("field")), (map.len(), fields));
    let made = folder.vivado("vivado/package_ip.tcl", &[], &[("STANDIN_BLOCKLESS", "1")]).succeeded();
    made.call("ipx::add_address_block reg0 map:s_axi_ctrl");
    for (right, wrong, message) in [
        ("set_property size 32 $register", "set_property width 32 $register", "no property width"),
        ("set_property address_offset $offset", "set_property address_offset 0x10", "size or address is wrong"),
        ("{$high - $low + 1}", "{$high + 1}", "overlaps another or leaves its register"),
        ("$access($software)", "$software", "access of field:"),
        ("reg \\{\\n", "register \\{\\n", "has no register"),
    ] {
        let folder = Folder::new(&control());
        let text = folder.read("vivado/package_ip.tcl");
        assert_eq!(text.matches(right).count(), 1, "{right:?}");
        fs::write(folder.design().join("vivado/package_ip.tcl"), text.replace(right, wrong)).expect("can be written");
        folder.vivado("vivado/package_ip.tcl", &[], &[]).refused(message);
    }
}

#[test]
fn the_system_reaches_the_registers_and_hears_the_interrupt() {
    let ran = Folder::new(&control()).vivado("vivado/block_design.tcl", &[], &[]).succeeded();
    ran.call("connect_bd_intf_net registers/M01_AXI core/s_axi_ctrl");
    ran.call("connect_bd_net -net interrupt_1 core/interrupt interrupt_concat/In1");
    ran.call("connect_bd_net -net interrupts interrupt_concat/dout ps/pl_ps_irq0");
    assert!(ran.stdout.contains("interrupt ps/pl_ps_irq0[1]: core/interrupt\n"), "{}", ran.stdout);
    ran.call("connect_bd_net -net interrupt_out dma/s2mm_introut ps/pl_ps_irq1");
    assert!(ran.stdout.contains("SEG_core_s_axi_ctrl: offset 0xA0010000, range 4K"), "{}", ran.stdout);
}

#[test]
fn broken_connections_are_refused() {
    let script = "vivado/block_design.tcl";
    for (right, wrong, message) in [
        ("connect_interface registers/M01_AXI core/s_axi_ctrl\n", "", "core/s_axi_ctrl is not connected"),
        ("CONFIG.NUM_SI 1 CONFIG.NUM_MI 2", "CONFIG.NUM_SI 1 CONFIG.NUM_MI 1", "no pin registers/M01_AXI"),
        (
            "s_axi_ctrl [dict get $boards $board core]",
            "s_axi_ctrl [dict get $boards $board dma]",
            "both be at 0xA0000000",
        ),
        ("set index 0\n", "set index 1\n", "no pin interrupt_concat/In2"),
        ("{dma/mm2s_introut core/interrupt} ps", "{dma/mm2s_introut core/irq} ps", "no pin core/irq"),
    ] {
        let folder = Folder::new(&control());
        let text = folder.read(script);
        assert_eq!(text.matches(right).count(), 1, "{right:?}");
        fs::write(folder.design().join(script), text.replace(right, wrong)).expect("can be written");
        folder.vivado(script, &[], &[]).refused(message);
    }
}

/// What Vivado makes interfaces from: one attribute for each port of the bus, and the clock with all three.
#[test]
fn every_port_of_the_bus_says_what_it_is() {
    let files = control();
    let top = String::from_utf8(files[&format!("rtl/{NAME}.v")].clone()).expect("text");
    assert!(top.contains("ASSOCIATED_BUSIF s_axi_ctrl:s_axis:m_axis, ASSOCIATED_RESET aresetn"));
    let lines: Vec<&str> = top.lines().collect();
    let ports = lines.windows(2).filter(|pair| pair[1].contains(" s_axi_ctrl_") && pair[1].ends_with(','));
    let mut count = 0;
    for pair in ports {
        let signal = pair[1].trim_end_matches(',').rsplit("s_axi_ctrl_").next().expect("a name");
        let attribute = format!("xilinx.com:interface:aximm:1.0 s_axi_ctrl {}\"", signal.to_uppercase());
        assert!(pair[0].contains(&attribute), "{}", pair[1]);
        count += 1;
    }
    assert_eq!(count, 19);
    assert!(top.contains("xilinx.com:signal:interrupt:1.0 interrupt INTERRUPT"));
    // The core inside is no interface of the IP.
    let core = String::from_utf8(files[&format!("rtl/{NAME}_core.v")].clone()).expect("text");
    assert!(!core.contains("X_INTERFACE"));
}

#[test]
fn lists_name_the_bank_and_tools_read_them() {
    let files = control();
    let folder = Folder::new(&files);
    let sources: Vec<&str> = files.keys().map(String::as_str).filter(|path| path.starts_with("rtl/")).collect();
    assert!(sources.contains(&"rtl/sptfra_stream_gate.v") && sources.contains(&"rtl/sptfra_registers.v"));
    assert_eq!(folder.read("small_control.f").lines().collect::<Vec<_>>(), sources);
    let bender = yaml(&folder.design().join("Bender.yml"));
    let listed = bender["sources"].as_array().expect("sources").iter().filter_map(serde_json::Value::as_str);
    assert_eq!(listed.collect::<Vec<_>>(), sources);
    let core = folder.read("small_control.core");
    assert!(sources.iter().all(|source| core.contains(&format!("      - {source}\n"))));
    let script = format!("read_verilog_file_list -F ../{NAME}.f; hierarchy -check -top {NAME}; proc; check -assert");
    let mut yosys = tools::yosys().expect("make tools was run");
    run(yosys.args(["-q", "-p", &script]).current_dir(folder.design().join("rom"))).succeeded();
}

/// The plain testbench reads the frame counter too, and fails where it is wrong.
#[test]
fn the_plain_testbench_counts_with_the_core() {
    let simulate = |files: &FileMap| {
        let folder = Folder::new(files);
        let out = folder.work().join("tb");
        let mut icarus = icarus();
        icarus.args(["-g2005", "-Wall", "-s", "small_control_tb", "-c", "small_control.f", "sim/small_control_tb.v"]);
        icarus.arg("-Psmall_control_tb.ROM_DIR=\"../rom/\"").arg("-o").arg(&out).current_dir(folder.design());
        run(&mut icarus).succeeded();
        let mut vvp = icarus_runtime();
        run(vvp.arg("-n").arg(&out).current_dir(folder.design().join("sim")))
    };
    let mut files = control();
    let said = simulate(&files).succeeded().stdout;
    assert!(said.contains("PASS") && !said.contains("FAIL"), "{said}");
    let bank = files.get_mut("rtl/sptfra_registers.v").expect("is there");
    *bank = String::from_utf8(bank.clone()).expect("text").replace("frames_out + 32'd1", "frames_out").into_bytes();
    let ran = simulate(&files);
    let said = &ran.stdout;
    assert!(!ran.ok && said.contains("FAIL: 0 words wrong") && said.contains("frames counted by the core"), "{ran:?}");
}

/// Names no tool of the list above knows, but the folder's users do.
#[test]
fn the_register_map_is_in_the_folder() {
    let folder = Folder::new(&control());
    let output = Command::new(workspace().join("tools/registers.sh"))
        .arg(folder.design().join("control/small_control.rdl"))
        .arg(folder.work().join("registers"))
        .env(tools::TOOLS_VARIABLE, super::folder::environment())
        .output()
        .expect("a shell");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(folder.work().join("registers/sptfra_registers.h").is_file());
    // The IP-XACT file is what the standard's schema allows, and a copy with one word more is not.
    let ipxact = folder.work().join("registers/registers.xml");
    let said = run(python().arg(workspace().join("testbench/tests/suite/flows/ipxact.py")).arg(&ipxact)).succeeded();
    let listed: BTreeMap<String, (u32, Vec<Field>)> = serde_json::from_str(&said.stdout).expect("JSON");
    assert_eq!(listed, map(&folder));
    let text = fs::read_to_string(&ipxact).expect("readable");
    assert!(text.contains("<ipxact:name>small_control</ipxact:name>"));
    fs::write(
        &ipxact,
        text.replace("<ipxact:access>", "<ipxact:acces>").replace("</ipxact:access>", "</ipxact:acces>"),
    )
    .expect("written");
    run(python().arg(workspace().join("testbench/tests/suite/flows/ipxact.py")).arg(&ipxact)).refused("acces");
    let metadata: serde_json::Value = serde_json::from_str(&folder.read("metadata.json")).expect("JSON");
    assert_eq!(metadata["registers"], "control/small_control.rdl");
    let none =
        Command::new(workspace().join("tools/registers.sh")).args(["none.rdl", "out"]).output().expect("a shell");
    assert!(String::from_utf8_lossy(&none.stderr).contains("set control = true"), "{none:?}");
}
