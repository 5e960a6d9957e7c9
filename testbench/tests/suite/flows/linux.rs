//! Device-tree overlays, compiled by `dtc` without a warning and laid over a tree with the labels of the kernel's own.

use std::fs;
use std::process::Command;

use hdl_gen::emit::{FileMap, emit};
use hdl_gen::plan::Plan;

use super::control::control;
use super::folder::{Folder, Ran, files, run};
use crate::support::shipped;

/// What an overlay refers to, and no more: the labels of `zynqmp.dtsi` with `zynqmp-clk-ccf.dtsi`, of `zynq-7000.dtsi`.
fn base(cells: usize, interrupts: &str, clocks: &str) -> String {
    format!(
        "/dts-v1/;\n/ {{\n#address-cells = <{cells}>;\n#size-cells = <{cells}>;\n\
         fpga_full: fpga-region {{ compatible = \"fpga-region\"; #address-cells = <{cells}>; #size-cells = <{cells}>; \
         ranges; }};\n\
         {interrupts}: interrupt-controller {{ interrupt-controller; #interrupt-cells = <3>; #address-cells = <0>; }};\n\
         {clocks}: clock-controller {{ #clock-cells = <1>; }};\n}};\n"
    )
}

fn dtc(folder: &Folder, source: &str, out: &str) -> Ran {
    let mut command = Command::new("dtc");
    command.args(["-@", "-I", "dts", "-O", "dtb", "-o"]).arg(folder.work().join(out));
    run(command.arg(folder.design().join(source)).current_dir(folder.work()))
}

/// The overlay of `path` over its base; nothing may be said.
fn merged(folder: &Folder, path: &str, base_text: &str) {
    fs::write(folder.design().join("base.dts"), base_text).expect("written");
    for (source, out) in [("base.dts", "base.dtb"), (path, "overlay.dtbo")] {
        let ran = dtc(folder, source, out).succeeded();
        assert_eq!(ran.stderr, "", "{source}");
    }
    let mut overlay = Command::new("fdtoverlay");
    overlay.args(["-i", "base.dtb", "-o", "merged.dtb", "overlay.dtbo"]).current_dir(folder.work());
    run(&mut overlay).succeeded();
}

/// A property of a node of the merged tree, its cells in hexadecimal.
fn property(folder: &Folder, node: &str, name: &str, kind: &str) -> String {
    let mut command = Command::new("fdtget");
    command.args(["-t", kind, "merged.dtb", &format!("/fpga-region{node}"), name]).current_dir(folder.work());
    run(&mut command).succeeded().stdout.trim().to_owned()
}

fn has_node(folder: &Folder, node: &str) -> bool {
    let mut command = Command::new("fdtget");
    run(command.args(["-l", "merged.dtb", "/fpga-region"]).current_dir(folder.work()))
        .succeeded()
        .stdout
        .lines()
        .any(|line| line == node)
}

fn control_on(part: &str) -> FileMap {
    let mut design = shipped("small-control");
    part.clone_into(&mut design.hardware.part);
    emit(&Plan::new(&design).expect("can be planned")).expect("is printed")
}

#[test]
fn linux_finds_registers_interrupts_and_memory() {
    let ultra = base(2, "gic", "zynqmp_clk");
    let folder = Folder::new(&control());
    merged(&folder, "linux/small_control_zcu102.dtso", &ultra);
    assert_eq!(property(&folder, "", "firmware-name", "s"), "small_control_zcu102.bit.bin");
    for (node, reg, interrupt) in
        [("/sptfra-dma@a0000000", "0 a0000000 0 10000", 104), ("/sptfra-core@a0010000", "0 a0010000 0 1000", 90)]
    {
        assert_eq!(property(&folder, node, "compatible", "s"), "generic-uio");
        assert_eq!(property(&folder, node, "reg", "x"), reg);
        assert_eq!(property(&folder, node, "interrupts", "u"), format!("0 {interrupt} 4"));
    }
    assert_eq!(property(&folder, "/sptfra-clock", "assigned-clock-rates", "u"), "125000000");
    assert_eq!(property(&folder, "/sptfra-buffer", "compatible", "s"), "ikwzm,u-dma-buf");
    let metadata: serde_json::Value = serde_json::from_str(&folder.read("metadata.json")).expect("JSON");
    let lines = |key: &str| metadata[key].as_u64().expect("bytes").next_multiple_of(64);
    let bytes: u64 = property(&folder, "/sptfra-buffer", "size", "u").parse().expect("a number");
    assert!(bytes >= 32 * (lines("bytes_in") + lines("bytes_out") + 128), "{bytes}");

    // The addresses are those that the block design gives, on either processor.
    let folder = Folder::new(&control_on("xc7z020clg400-1"));
    merged(&folder, "linux/small_control_pynq-z2.dtso", &base(1, "intc", "clkc"));
    let said = folder.vivado("vivado/block_design.tcl", &[], &[]).succeeded().stdout;
    for (node, at, range, interrupt) in [("dma", "40000000", "10000", 31), ("core", "40010000", "1000", 30)] {
        let place = format!("/sptfra-{node}@{at}");
        assert_eq!(property(&folder, &place, "reg", "x"), format!("{at} {range}"));
        assert_eq!(property(&folder, &place, "interrupts", "u"), format!("0 {interrupt} 4"));
        assert!(said.lines().any(|line| line.contains(&format!("SEG_{node}_")) && line.contains(at)), "{said}");
    }
    assert!(!has_node(&folder, "sptfra-ports"));
}

#[test]
fn a_core_without_registers_has_no_node_and_another_device_no_overlay() {
    let folder = Folder::small();
    merged(&folder, "linux/small_4x3_zcu102.dtso", &base(2, "gic", "zynqmp_clk"));
    assert!(has_node(&folder, "sptfra-dma@a0000000") && !has_node(&folder, "sptfra-core@a0010000"));
    let none = files(Some("xc7a200tfbg676-2"));
    assert!(!none.keys().any(|path| path.starts_with("linux/")));
    let seven = files(Some("xc7z020clg400-1"));
    let text = String::from_utf8(seven["linux/small_4x3_pynq-z2.dtso"].clone()).expect("text");
    assert!(text.contains("interrupts = <0 30 4>"), "the second of two on IRQ_F2P");
}

/// `dtc` and `fdtoverlay` see what is wrong.
#[test]
fn a_broken_overlay_is_refused() {
    for (right, wrong) in [
        ("&gic>", "&gicc>"),
        ("&fpga_full", "&fpga"),
        ("reg = <0x0 0xa0010000 0x0 0x1000>", "reg = <0xa0010000 0x1000>"),
    ] {
        let folder = Folder::new(&control());
        let path = "linux/small_control_zcu102.dtso";
        let text = folder.read(path);
        assert!(text.contains(right), "{right}");
        fs::write(folder.design().join(path), text.replace(right, wrong)).expect("written");
        fs::write(folder.design().join("base.dts"), base(2, "gic", "zynqmp_clk")).expect("written");
        dtc(&folder, "base.dts", "base.dtb").succeeded();
        let said = dtc(&folder, path, "overlay.dtbo").succeeded().stderr;
        let mut overlay = Command::new("fdtoverlay");
        overlay.args(["-i", "base.dtb", "-o", "merged.dtb", "overlay.dtbo"]).current_dir(folder.work());
        assert!(!said.is_empty() || !run(&mut overlay).ok, "{right}");
    }
}
