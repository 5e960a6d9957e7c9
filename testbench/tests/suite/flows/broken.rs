//! Broken copies of the scripts: each must be refused, and for the reason given.

use std::fs;

use super::folder::{Folder, NAME, files};

const SYNTH: &str = "vivado/synth.tcl";
const CLOCK: &str = "vivado/small_4x3.xdc";
const PACKAGE: &str = "vivado/package_ip.tcl";
const SYSTEM: &str = "vivado/block_design.tcl";

/// Script, text, what stands in its place, what the refusal says.
const FAULTS: [(&str, &str, &str, &str); 33] = [
    (SYNTH, "read_mem $rom", "read_memory $rom", "invalid command name"),
    (SYNTH, "read_mem $rom", "", "Synth 8-4445"),
    (SYNTH, "-mode out_of_context", "-mode out-of-context", "mode is out-of-context"),
    (SYNTH, "-flatten_hierarchy rebuilt", "-flatten rebuilt", "unknown flag -flatten"),
    (SYNTH, "-top $design", "-top other", "no source holds module other"),
    (SYNTH, "opt_design\nplace_design", "place_design\nopt_design", "opt_design is to come first"),
    (SYNTH, "read_xdc $constraints", "", "no path is timed"),
    (SYNTH, "\"CLB LUTs\" \"Slice LUTs\"", "\"Slice LUTs\"", "no row named Slice LUTs"),
    (SYNTH, "[get_timing_paths -delay_type max -max_paths 1]", "[get_timing_paths -worst]", "unknown flag -worst"),
    (SYNTH, "ORIG_REF_NAME == $module ||", "ORIG_REF == $module ||", "get_cells: filter ORIG_REF =="),
    (CLOCK, "get_ports aclk", "get_ports clk", "no port clk"),
    (CLOCK, "-period 8.000", "-frequency 125", "unknown flag -frequency"),
    (PACKAGE, "add_files -norecurse $rom", "", "is missing from file group"),
    (PACKAGE, "add_files -fileset constrs_1 -norecurse $constraints", "", "the project has no file small_4x3.xdc"),
    (PACKAGE, "{synthesis implementation out_of_context}", "{synthesis}", "is not for synthesis out of context only"),
    (PACKAGE, "implementation out_of_context}", "implementation ooc}", "use of xdc:"),
    (PACKAGE, "-clock aclk -reset aresetn", "-clock aclk -reset areset", "no interface areset"),
    (PACKAGE, "ipx::associate_bus_interfaces -busif $stream -clock aclk $core", "", "has no clock"),
    (PACKAGE, "ipx::create_xgui_files $core", "", "ipx::create_xgui_files is to come first"),
    (PACKAGE, "ipx::check_integrity $core", "", "ipx::check_integrity is to come first"),
    (PACKAGE, "set_property version", "set_property versoin", "no property versoin"),
    (PACKAGE, " -import_files", "", "-import_files is missing"),
    (SYSTEM, "CONFIG.c_include_sg $queue", "CONFIG.c_include_sg 1", "dma/M_AXI_SG is not connected"),
    (SYSTEM, "CONFIG.c_include_sg $queue", "CONFIG.c_include_sgg $queue", "no parameter CONFIG.c_include_sgg"),
    (SYSTEM, "CONFIG.PSU__USE__IRQ1 1", "CONFIG.PSU__USE__IRQ1 0", "no pin ps/pl_ps_irq1"),
    (SYSTEM, "connect_interface dma/M_AXIS_MM2S core/s_axis", "", "core/s_axis is not connected"),
    (SYSTEM, "core/m_axis dma/S_AXIS_S2MM", "core/s_axis dma/S_AXIS_S2MM", "does not fit"),
    (SYSTEM, "dma/axi_resetn core/aresetn", "dma/axi_resetn", "core/aresetn is not connected"),
    (SYSTEM, "reset/peripheral_aresetn dma", "ps/pl_clk0 dma", "connected already"),
    (SYSTEM, "place dma/S_AXI_LITE", "place dma/M_AXI_MM2S", "kind of slave is master aximm"),
    (SYSTEM, "assign_bd_address\n", "", "assign_bd_address is to come first"),
    (SYSTEM, "[get_bd_pins core/aclk]", "[get_bd_pins core/clk]", "no pin core/clk"),
    (
        SYSTEM,
        "xilinx.com:bd_rule:zynq_ultra_ps_e",
        "xilinx.com:bd_rule:zynq_ps_e",
        "rule is xilinx.com:bd_rule:zynq_ps_e",
    ),
];

#[test]
fn every_fault_is_refused_for_its_reason() {
    for (script, right, wrong, message) in FAULTS {
        let folder = Folder::small();
        let text = folder.read(script);
        assert_eq!(text.matches(right).count(), 1, "{script} has {right:?} once");
        fs::write(folder.design().join(script), text.replace(right, wrong)).expect("can be written");
        let entry = if script == CLOCK { SYNTH } else { script };
        folder.vivado(entry, &[], &[]).refused(message);
    }
}

#[test]
fn every_named_file_is_missed() {
    let listed = files(None)
        .into_keys()
        .filter(|path| path.starts_with("rtl/") || path.starts_with("rom/") || *path == format!("vivado/{NAME}.xdc"));
    let folder = Folder::small();
    for path in listed {
        let place = folder.design().join(&path);
        let aside = folder.design().join("aside");
        fs::rename(&place, &aside).expect("can be moved");
        folder.vivado(SYNTH, &[], &[]).refused("no file");
        fs::rename(&aside, &place).expect("can be moved");
    }
    folder.vivado(SYNTH, &[], &[]).succeeded();
}
